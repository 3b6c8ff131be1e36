// SPDX-License-Identifier: BSD-3-Clause
// Every claim of every method of the table, checked. Slow claims use the sector model or one rod, so that the
// walk stays quick.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <functional>

#include "core/integrators/integrator.hpp"
#include "core/simulate/initial_state.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace conformance_test {

namespace {

// The methods with the options that give them different claims.
std::vector<std::pair<std::string, SolverOptions>> variants() {
  std::vector<std::pair<std::string, SolverOptions>> out;
  for (const Method& method : methods()) {
    SolverOptions options;
    options.method = method.name;
    out.emplace_back(method.name, options);
    if (method.name != "dvm") continue;
    for (int s : {2, 4, 5}) {
      options.stages = s;
      out.emplace_back("dvm lobatto " + std::to_string(s), options);
    }
    options.nodes = "equidistant";
    out.emplace_back("dvm equidistant 5", options);
    options.constraints_at = "ends";
    options.stages = 3;
    out.emplace_back("dvm equidistant 3 at ends", options);
  }
  return out;
}

Claims claims_of(const SolverOptions& options) {
  return find_method(options.method)->claims(options);
}

// A method on a model, stepped by hand.
struct Stepper {
  explicit Stepper(const Structure& structure, const SolverOptions& options, bool eliminate = true)
      : model(make_model(structure, eliminate)),
        state(initial_state(structure, model->system).state),
        integrator(find_method(options.method)->make(model->system, options)) {}

  void run(int steps, double h, const std::function<void()>& after = {}) {
    for (int i = 0; i < steps; ++i) {
      const StepReport report = integrator->step(state, h);
      if (!report.ok()) FAIL("a step failed at t = " << state.t);
      if (after) after();
    }
  }
  const System& system() const { return model->system; }
  VectorXd q() const {
    VectorXd out(system().coordinates());
    system().expand(state.z, out);
    return out;
  }
  VectorXd v() const {
    VectorXd out(system().coordinates());
    system().expand_rate(state.w, out);
    return out;
  }
  double energy() const { return system().kinetic_energy(state.w) + system().potential_energy(q()); }
  Vec3 angular_momentum() const {  // about the origin
    const VectorXd p = system().node_mass() * v(), x = q();
    Vec3 L = Vec3::Zero();
    for (Index i = 0; i < x.size(); i += 3) L += x.segment<3>(i).cross(p.segment<3>(i));
    return L;
  }

  std::shared_ptr<const Model> model;
  State state;
  std::unique_ptr<Integrator> integrator;
};

// A uniform rod of 2 kg and 1 m that swings in space about a fixed end.
Structure spherical_rod() {
  CustomSpec spec;
  spec.nodes = {{"O", {0, 0, 0}, {0, 0, 0}, 0.0, true}, {"A", {0.6, 0, -0.8}, {0, 2.0, 0}, 0.0, false}};
  spec.rods = {{"OA", {"O", "A"}, 2.0}};
  Structure structure = build_custom(spec);
  structure.gravity = {0, 0, -9.81};
  return structure;
}

// Three rods in a triangle, tumbling freely.
Structure free_triangle() {
  CustomSpec spec;
  spec.nodes = {{"A", {0, 0, 0}, {0.3, 0, 1.0}, 0.1, false},
                {"B", {1, 0, 0}, {0.3, 1.5, -0.5}, 0.0, false},
                {"C", {0, 1, 0}, {-1.2, 0, 0.2}, 0.4, false}};
  spec.rods = {{"AB", {"A", "B"}, 1.0}, {"BC", {"B", "C"}, 2.0}, {"CA", {"C", "A"}, 1.5}};
  return build_custom(spec);
}

VectorXd pendulum_after(const SolverOptions& options, double h, double end) {
  Stepper s(double_pendulum(), options);
  s.run(static_cast<int>(std::lround(end / h)), h);
  return s.q();
}

}  // namespace

TEST_CASE("conformance: every method has the order that it claims") {
  // Reference: order 12 at h = 0.005; halving its step moves it by round-off only (orders of the variational
  // methods).
  const VectorXd reference = pendulum_after(dvm_options(7, 0.005, 1.0), 0.005, 1.0);
  for (const auto& [name, options] : variants()) {
    const int order = claims_of(options).order;
    // Steps at which the error is far above round-off and the next term of its series far below the first.
    const double h = order <= 2 ? 0.005 : order <= 4 ? 0.0125 : 0.05;
    const double coarse = (pendulum_after(options, h, 1.0) - reference).norm();
    const double fine = (pendulum_after(options, h / 2, 1.0) - reference).norm();
    INFO(name << ": errors " << coarse << ", " << fine);
    CHECK(std::log2(coarse / fine) == Approx(order).epsilon(0).margin(0.4));
  }
}

TEST_CASE("conformance: a symmetric method comes back") {
  for (const auto& [name, options] : variants()) {
    Stepper s(double_pendulum(), options);
    const State start = s.state;
    s.run(20, 0.02);
    s.integrator->restart();
    s.run(20, -0.02);
    const double apart = (s.state.z - start.z).norm() + (s.state.w - start.w).norm();
    INFO(name << ": " << apart << " after 20 steps there and back");
    // 40 steps of residuals at round-off of numbers up to 6 (momenta over masses). A method that is not
    // symmetric comes back with the error of its order, above 1e-8 at this step.
    if (claims_of(options).symmetric)
      CHECK(apart <= 1e-11);
    else
      CHECK(apart > 1e-9);
  }
}

TEST_CASE("conformance: a symplectic method keeps its energy bounded over 10^5 steps") {
  for (const auto& [name, options] : variants()) {
    if (options.stages > 4 && options.method == "dvm") continue;  // round-off only: nothing to see
    Stepper s(spherical_rod(), options);
    const double h = 0.02, scale = 2.0 * 9.81 * 1.0, start = s.energy();
    double first = 0, last = 0;  // largest errors over the first and the last tenth
    const int tenth = 10000;
    s.run(tenth, h, [&] { first = std::max(first, std::abs(s.energy() - start) / scale); });
    const bool symplectic = claims_of(options).symplectic;
    if (!symplectic && options.method != "rk4_projected")
      continue;  // rk4's rods stretch: nothing is promised
    s.run(8 * tenth, h);
    s.run(tenth, h, [&] { last = std::max(last, std::abs(s.energy() - start) / scale); });
    INFO(name << ": energy error " << first << " at first, " << last << " at last");
    // Bounded: the oscillation of the first thousands of swings, and a random walk of round-off (10^5 steps
    // of 1e-14).
    if (symplectic)
      CHECK(last <= 1.2 * first + 1e-11);
    else
      CHECK(last >
            3 * first);  // Runge-Kutta loses energy at a steady rate: 10 times as much in 10 times the time
  }
}

TEST_CASE("conformance: constraints are held at the levels that are claimed") {
  for (const auto& [name, options] : variants()) {
    const Claims claims = claims_of(options);
    Stepper s(double_pendulum(), options);
    double position = 0, velocity = 0;
    s.run(100, 0.01, [&] {
      const VectorXd q = s.q();
      VectorXd phi(s.system().constraints());
      s.system().constraint(s.state.t, q, phi);
      position = std::max(position, phi.lpNorm<Eigen::Infinity>());
      SparseRows G = s.system().jacobian_pattern();
      std::vector<double> scratch;
      s.system().jacobian(q, G, scratch);
      velocity = std::max(velocity, (G * s.state.w).lpNorm<Eigen::Infinity>());
    });
    INFO(name << ": position " << position << " m, velocity " << velocity << " m/s");
    // Coordinates up to 2 m and speeds up to 8 m/s: some ulp. Without a claim the error is that of the
    // method.
    if (claims.holds_positions)
      CHECK(position <= 3e-14);
    else
      CHECK(position > 1e-13);
    if (claims.holds_velocities)
      CHECK(velocity <= 1e-13);
    else
      CHECK(velocity > 1e-13);
  }
}

TEST_CASE("conformance: a momentum map is conserved where it is claimed") {
  for (const auto& [name, options] : variants()) {
    Stepper swing(spherical_rod(), options), tumble(free_triangle(), options);
    const double about_vertical = swing.angular_momentum().z();
    const Vec3 whole = tumble.angular_momentum();
    double swing_error = 0, tumble_error = 0;
    swing.run(500, 0.02, [&] {
      swing_error = std::max(swing_error, std::abs(swing.angular_momentum().z() - about_vertical));
    });
    tumble.run(500, 0.02,
               [&] { tumble_error = std::max(tumble_error, (tumble.angular_momentum() - whole).norm()); });
    INFO(name << ": swing " << swing_error << ", tumble " << tumble_error << " of " << whole.norm()
              << " kg m^2/s");
    // 500 steps that each leave a few ulp of momenta of order one.
    if (claims_of(options).conserves_momentum_maps) {
      CHECK(swing_error <= 1e-12);
      CHECK(tumble_error <= 1e-12 * whole.norm());
    } else {
      CHECK(std::max(swing_error, tumble_error) > 1e-10);
    }
  }
}

TEST_CASE("conformance: the same run gives the same bits") {
  for (const auto& [name, options] : variants()) {
    INFO(name);
    Stepper one(hoop_structure(), options), other(hoop_structure(), options);
    one.run(50, 0.01);
    other.run(50, 0.01);
    const auto bytes = static_cast<std::size_t>(one.state.z.size()) * sizeof(double);
    CHECK(std::memcmp(one.state.z.data(), other.state.z.data(), bytes) == 0);
    CHECK(std::memcmp(one.state.w.data(), other.state.w.data(), bytes) == 0);
  }
}

TEST_CASE("conformance: a step that fails leaves the state as it was") {
  for (const auto& [name, options] : variants()) {
    Stepper s(double_pendulum(), options);
    State state = s.state;
    state.w *= 1e200;  // velocities whose squares overflow
    const State before = state;
    const StepReport report = s.integrator->step(state, 0.01);
    INFO(name);
    REQUIRE_FALSE(report.ok());
    CHECK(state.t == before.t);
    CHECK(state.z == before.z);
    CHECK(state.w == before.w);
  }
}

}  // namespace conformance_test
