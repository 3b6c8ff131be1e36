// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/validation_elements.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"
#include "core/math/factors.hpp"
#include "core/math/types.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"
#include "core/structure/node_positions.hpp"
#include "core/system/system.hpp"

namespace unfurl {

namespace {

// 1 kg on a spring of 100 N/m, rubbed by 1 N, let go 0.495 m aside: half swings of pi/10 s about +-0.01 m.
constexpr const char* rubbed_mass = R"([structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true},
  {name = "A", position = [2.495, 0, 0], mass = 1}]
[[forces]]
kind = "spring"
nodes = ["O", "A"]
stiffness = 100
free_length = 2
[[forces]]
kind = "friction"
nodes = ["A"]
direction = [1, 0, 0]
kinetic = 1
[solver]
stages = 6
step = 0.01
end_time = 9
)";

// 1.7 kg on a rope of 2.3 m from a trolley that stays, at 0.3 m/s.
constexpr const char* hung_mass = R"([structure]
kind = "custom"
nodes = [{name = "A", position = [0.4, 0.3, 1], velocity = [0.3, -0.2, 0], mass = 1.7}]
[gravity]
acceleration = [0, 0, -9.81]
[[forces]]
kind = "offload"
nodes = ["A"]
length = 2.3
[solver]
stages = 6
step = 0.01
end_time = 4
)";

// Two tumbling rods on trolleys that follow.
constexpr const char* hung_arms = R"([structure]
kind = "custom"
nodes = [
  {name = "O", position = [0.1, -0.2, 0.3], fixed = true},
  {name = "A", position = [0.73, 0.31, -0.17], velocity = [0.4, 1.1, -0.6]},
  {name = "B", position = [1.21, -0.14, -0.62], velocity = [-0.3, 0.9, 1.3], mass = 0.37}]
rods = [{nodes = ["O", "A"], mass = 1.3}, {nodes = ["A", "B"], mass = 0.7}]
[gravity]
acceleration = [0.7, -1.9, -9.1]
[[forces]]
kind = "offload"
nodes = ["*"]
trolley = "following"
[solver]
stages = 6
step = 0.01
end_time = 1.5
)";

// Half span 1, rise 0.25, E A = 1; the apex is pushed down slowly, by a drive that tells its force. Its mass
// takes 1e-13 kg times 6 m/s^2.
constexpr const char* shallow_truss = R"([structure]
kind = "custom"
youngs_modulus = 1e4
rod_model = "elastic"
nodes = [
  {name = "L", position = [-1, 0, 0], fixed = true}, {name = "R", position = [1, 0, 0], fixed = true},
  {name = "top", position = [0, 0.25, 0], mass = 1e-13}]
rods = [{nodes = ["L", "top"], mass = 0, area = 1e-4}, {nodes = ["R", "top"], mass = 0, area = 1e-4}]
[[constraints]]
kind = "line"
nodes = ["top"]
direction = [0, 1, 0]
[[constraints]]
kind = "coordinate"
name = "push"
nodes = ["top"]
direction = [0, 1, 0]
motion = "smooth"
to = 0.05
duration = 1
[solver]
step = 4e-4
end_time = 0.7
)";

constexpr const char* ring_of_joints = R"([structure]
kind = "hoop"
units = 6
fold_angle = 83
[solver]
stages = 4
step = 0.02
end_time = 1.5
)";

Simulation run_element(const std::string& text, const std::vector<std::string>& changes = {}) {
  const Scene scene = read_scene_text(text, "validation.toml", changes);
  return simulate(build_model(scene), scene.solver);
}

// Of all nodes at the run's end; not a number where it ended early.
VectorXd end_of(const Simulation& run) {
  const VectorXd q = run.trajectory.node_positions(run.trajectory.size() - 1);
  return run.status == RunStatus::completed ? q : VectorXd::Constant(q.size(), std::nan(""));
}

// Both ends of every bottom rod of a ring mesh with those of the rods beside it.
std::string gears_of_ring() {
  std::string text;
  const auto wheel = [](int post, int hinge) {
    const std::string i = std::to_string(post);
    return "\"T" + i + "\", \"B" + i + "\", \"Mb" + std::to_string(hinge) + "\"";
  };
  const auto mesh = [&](const std::string& a, const std::string& b) {
    text += "[[constraints]]\nkind = \"gear\"\nradii = [0.7, -0.7]\nnodes = [" + a + ", " + b + "]\n";
  };
  for (int k = 1; k < 6; ++k) mesh(wheel(k, k), wheel(k, k - 1));
  for (int k = 0; k < 6; ++k) mesh(wheel(k, k), wheel((k + 1) % 6, k));
  return text;
}

void add_friction(std::vector<ValidationRow>& rows) {
  constexpr std::string_view problem = "mass on a spring with dry friction", source = "closed form";
  // Order 10 at omega h = 0.1, and events located to round-off: some 1e-12 s and m of 25 half swings.
  constexpr double located = 1e-10;
  const Simulation run = run_element(rubbed_mass);
  double first = std::nan(""), rest = std::nan("");
  for (const Event& event : run.events) {
    if (event.kind == "reversal" && std::isnan(first)) first = event.t;
    if (event.kind == "stick") rest = event.t;
  }
  const double turned = std::isnan(first) ? first : run.trajectory.positions_at(first)[3];
  rows.push_back({problem, source, "x where it first turns (m)", "1.525", turned, located});
  rows.push_back({problem, source, "x where it comes to rest (m)", "2.005", end_of(run)[3], located});
  rows.push_back({problem, source, "time of rest, 2.5 pi (s)", "7.8539816339744831", rest, located});
}

void add_offload(std::vector<ValidationRow>& rows) {
  constexpr std::string_view source = "closed form";
  // Round-off of 400 steps at 0.3 m/s; weights that cancel, in 150 steps of a tumbling chain.
  constexpr double swung = 1e-12, tumbled = 1e-11;
  rows.push_back({"mass on a rope from a fixed trolley", source, "x at 4 s (m)", "0.53339667966853724",
                  end_of(run_element(hung_mass))[0], swung});
  const VectorXd tested = end_of(run_element(hung_arms)),
                 flown = end_of(
                     run_element(hung_arms, {"gravity.acceleration=[0,0,0]", "forces[0].enabled=false"}));
  rows.push_back({"arms on trolleys that follow", "the same at 0 g", "farthest node from there at 1.5 s (m)",
                  "0", (tested - flown).lpNorm<Eigen::Infinity>(), tumbled});
}

// The peak of the drive's force over its height: the parabola through three states about it. Heights 1.5e-4 m
// apart leave 1e-12 of the third order in the force; where that is flat, its square root in the height.
void add_truss(std::vector<ValidationRow>& rows) {
  const Diagnostics d = diagnose(run_element(shallow_truss));
  const std::vector<double>&height = d.at("push.value_m").values, &force = d.at("push.force_N").values;
  double at = std::nan(""), peak = at;
  std::size_t top = 1;
  for (std::size_t i = 1; i + 1 < force.size(); ++i)
    if (std::abs(force[i]) > std::abs(force[top])) top = i;
  if (top + 1 < force.size()) {
    const double x0 = height[top - 1], x1 = height[top], x2 = height[top + 1];
    const double f0 = std::abs(force[top - 1]), f1 = std::abs(force[top]), f2 = std::abs(force[top + 1]);
    const double s01 = (f1 - f0) / (x1 - x0), s12 = (f2 - f1) / (x2 - x1), c = (s12 - s01) / (x2 - x0);
    at = 0.5 * (x0 + x1) - s01 / (2 * c);
    peak = f0 + (at - x0) * (s01 + c * (at - x1));
  }
  constexpr std::string_view problem = "shallow truss of two bars, E A = 1 N", source = "closed form";
  rows.push_back({problem, source, "limit load (N)", "0.005659141161730162", peak, 1e-11});
  rows.push_back({problem, source, "height there (m)", "0.1428767842560051", at, 1e-6});
}

// What is left of a cable's tension behind so many right angles, mu = 0.1, while it slips at 0.37 m/s.
double left_behind(int pulleys) {
  std::string nodes, names;
  for (int i = 0; i <= pulleys + 1; ++i) {
    const std::string name = "'P" + std::to_string(i) + "'";
    nodes += std::string(i ? ", " : "") + "{name = " + name + ", mass = 1, position = [" +
             std::to_string((i + 1) / 2) + ", " + std::to_string(i / 2) + ", 0]}";
    names += (i ? ", " : "") + name;
  }
  const auto model = build_model(read_scene_text(
      "[structure]\nkind = 'custom'\nnodes = [" + nodes + "]\n[[constraints]]\nkind = 'cable'\nnodes = [" +
          names + "]\naxial_stiffness = 700\npulley_friction = 0.1\nlength = " + std::to_string(pulleys) +
          ".5\n",
      "validation.toml"));
  const VectorXd q = node_positions(model->structure);
  VectorXd v = VectorXd::Zero(q.size()), f = v;
  v.tail<3>() = -0.37 * (q.tail<3>() - q.segment<3>(q.size() - 6)).normalized();
  model->system.add_applied_force(0.0, q, v, 1.0, f);
  return f.tail<3>().norm() / f.head<3>().norm();
}

void add_capstan(std::vector<ValidationRow>& rows) {
  constexpr std::string_view problem = "cable that slips over pulleys of 90 degrees",
                             source = "capstan, mu = 0.1";
  rows.push_back({problem, source, "tension left behind 12 of them", "0.151835802", left_behind(12), 5e-10});
  rows.push_back({problem, source, "tension left behind 30 of them", "0.008983291", left_behind(30), 5e-10});
}

// With gears all units have one fold angle, and what drives the ring is the sum of the forces.
void add_gears(std::vector<ValidationRow>& rows) {
  const VectorXd geared =
                     end_of(run_element(ring_of_joints + gears_of_ring(),
                                        {"structure.model=joints", "structure.hinge_force=150",
                                         "structure.perturbed_unit=2", "structure.perturbed_force=690"})),
                 mirrored = end_of(run_element(ring_of_joints, {"structure.hinge_force=240"}));
  // Other rows: round-off of a few hundred of them in 75 steps.
  rows.push_back({"ring of six units coupled by gears", "the ring with mirror planes",
                  "farthest node from there at 1.5 s (m)", "0", (geared - mirrored).lpNorm<Eigen::Infinity>(),
                  1e-12});
}

// A free body of moments of inertia (1, 2, 3) kg m^2: a plate with sum m x x^T = diag(2, 1, 0), which three
// equal masses on an ellipse have.
std::vector<Vec3> corners_of_top() {
  std::vector<Vec3> at;
  for (const double turn : {0.25, 0.25 + 1.0 / 3, 0.25 + 2.0 / 3})
    at.emplace_back(std::sqrt(4.0 / 3) * std::cos(2 * pi * turn),
                    std::sqrt(2.0 / 3) * std::sin(2 * pi * turn), 0);
  return at;
}

std::string masses_of_top() {
  const auto vector = [](const Vec3& x) {
    return "[" + exact_number(x[0]) + ", " + exact_number(x[1]) + ", " + exact_number(x[2]) + "]";
  };
  std::string nodes;
  int k = 0;
  for (const Vec3& x : corners_of_top())
    nodes += std::string(nodes.empty() ? "" : ", ") + "{name = 'P" + std::to_string(k++) +
             "', mass = 1, position = " + vector(x) + ", velocity = " + vector(Vec3(0.1, 2, 0.1).cross(x)) +
             "}";
  return nodes;
}

// Its angular velocity about its own axes: sum m x x_0^T = R diag(2, 1, 0) turns them, and the angular
// momentum is that of the masses.
Vec3 own_angular_velocity(const VectorXd& q, const VectorXd& v) {
  const std::vector<Vec3> first = corners_of_top();
  Mat3 R = Mat3::Zero();
  Vec3 momentum = Vec3::Zero(), center = Vec3::Zero();
  for (std::size_t k = 0; k < first.size(); ++k) center += q.segment<3>(3 * static_cast<Index>(k)) / 3;
  for (std::size_t k = 0; k < first.size(); ++k) {
    const Vec3 x = q.segment<3>(3 * static_cast<Index>(k)) - center;
    R += x * first[k].transpose();
    momentum += x.cross(v.segment<3>(3 * static_cast<Index>(k)));
  }
  R.col(0) /= 2;
  R.col(2) = R.col(0).cross(R.col(1));
  return (R.transpose() * momentum).cwiseQuotient(Vec3(1, 2, 3));
}

void add_top(std::vector<ValidationRow>& rows) {
  const std::string scene = "[structure]\nkind = 'custom'\nnodes = [" + masses_of_top() +
                            "]\nrods = [{nodes = ['P0', 'P1'], mass = 0}, " +
                            "{nodes = ['P1', 'P2'], mass = 0}, {nodes = ['P2', 'P0'], mass = 0}]\n" +
                            "[solver]\nstages = 6\nstep = 0.01\nend_time = 10\n";
  const Simulation run = run_element(scene);
  const auto at = [&](double t) {
    if (run.trajectory.end_time() < t - 1e-12) return Vec3(Vec3::Constant(std::nan("")));
    return own_angular_velocity(run.trajectory.positions_at(t), run.trajectory.velocities_at(t));
  };
  const Vec3 middle = at(5), end = at(10);
  constexpr std::string_view problem = "free top, I = (1, 2, 3) kg m^2",
                             source = "Jacobi's elliptic functions";
  // About the middle axis errors grow by exp(2 t / sqrt(3)), 1e5 in 10 s: so much of 1e-14.
  constexpr double grown = 1e-9;
  rows.push_back({problem, source, "omega 1 at 5 s (rad/s)", "-1.206774221178068", middle[0], grown});
  rows.push_back({problem, source, "omega 2 at 5 s (rad/s)", "-1.598028779183925", middle[1], grown});
  rows.push_back({problem, source, "omega 3 at 5 s (rad/s)", "0.7014993516033909", middle[2], grown});
  rows.push_back({problem, source, "omega 1 at 10 s (rad/s)", "1.10506663441742", end[0], grown});
  rows.push_back({problem, source, "omega 2 at 10 s (rad/s)", "-1.669978363182397", end[1], grown});
  rows.push_back({problem, source, "omega 3 at 10 s (rad/s)", "0.643213874876945", end[2], grown});
}

// The pose at rest from the one given: Newton's method on F(q) - G^T lambda = 0, Phi(q) = 0, with the loads
// in so many equal parts, by no more than `longest` at once [m].
VectorXd pose_at_rest(const Model& model, int parts, double longest) {
  const System& system = model.system;
  const Index n = system.solved_coordinates(), m = system.constraints();
  VectorXd q = node_positions(model.structure), lambda = VectorXd::Zero(m), z = system.reduce(q);
  const VectorXd still = VectorXd::Zero(q.size());
  VectorXd load = still, r(n), phi(m);
  for (const Load& l : model.structure.loads) load.segment<3>(3 * l.node) += l.force;
  SparseRows G = system.jacobian_pattern(), by_z, by_w;
  std::vector<double> scratch;
  for (int part = 1; part <= parts; ++part)
    for (int iteration = 0; iteration < 100; ++iteration) {
      system.expand(z, q);
      VectorXd f = (static_cast<double>(part) / parts - 1) * load;
      system.add_applied_force(0, q, still, 1.0, f);
      system.add_constraint_force(q, lambda, -1.0, f);
      system.reduce_force(f, r);
      system.constraint(0, q, phi);
      system.jacobian(q, G, scratch);
      system.force_derivatives(0, q, still, by_z, by_w);
      MatrixXd A = MatrixXd::Zero(n + m, n + m);
      A.topLeftCorner(n, n) = MatrixXd(system.curvature(q, lambda)) - MatrixXd(by_z);
      A.topRightCorner(n, m) = MatrixXd(G).transpose();
      A.bottomLeftCorner(m, n) = MatrixXd(G);
      VectorXd b(n + m);
      b << r, -phi;
      VectorXd x = SparseLu(SparseColumns(A.sparseView())).solve(b);
      const double most = x.head(n).lpNorm<Eigen::Infinity>();
      x *= std::min(1.0, longest / most);
      z += x.head(n);
      lambda += x.tail(m);
      if (most < 1e-12) break;
    }
  system.expand(z, q);
  return q;
}

// Values at 1/h = 8, 16, 32, ... to h = 0, where errors have powers of h from `power` on, in steps of `step`.
double extrapolated(std::vector<double> values, int power, int step) {
  for (std::size_t level = 1; level < values.size(); ++level, power += step)
    for (std::size_t i = values.size() - 1; i >= level; --i)
      values[i] += (values[i] - values[i - 1]) / (std::pow(2.0, power) - 1);
  return values.back();
}

// A cantilever of k segments along x with E I = L = 1 under alpha across its end. The clamp is a node half a
// segment behind the first: its bend belongs to half a segment, of E I over l / 2 where the mean length is
// 3/4 l.
std::string cantilever(int k, double alpha) {
  const double l = 1.0 / k;
  std::string nodes = "{name = 'wall', position = [" + exact_number(-l / 2) + ", 0, 0], fixed = true}", rods,
              bends;
  for (int i = 0; i <= k; ++i) {
    const auto name = [](int j) { return j < 0 ? "'wall'" : "'N" + std::to_string(j) + "'"; };
    nodes += ", {name = " + name(i) + ", position = [" + exact_number(i * l) + ", 0, 0], " +
             (i == 0 ? "fixed = true}" : "mass = 0.1}");
    if (i == k) break;
    rods += (i ? ", {nodes = [" : "{nodes = [") + name(i) + ", " + name(i + 1) + "], mass = 0}";
    bends += "[[forces]]\nkind = 'bending'\nnodes = [" + name(i - 1) + ", " + name(i) + ", " + name(i + 1) +
             "]\nstiffness = " + (i == 0 ? "1.5" : "1") + "\n";
  }
  return "[structure]\nkind = 'custom'\nnodes = [" + nodes + "]\nrods = [" + rods + "]\n" + bends +
         "[[loads]]\nnodes = ['N" + std::to_string(k) + "']\nforce = [0, " + exact_number(alpha) + ", 0]\n";
}

void add_elastica(std::vector<ValidationRow>& rows) {
  struct Load {
    double alpha;
    std::string_view problem, slope, shortening, deflection;
  };
  constexpr Load loads[] = {
      {1, "cantilever, P L^2 / E I = 1", "0.46135194971188", "0.056433236283377", "0.30172077379981"},
      {2, "cantilever, P L^2 / E I = 2", "0.78174983155654", "0.16064172082517", "0.49345748039671"},
      {5, "cantilever, P L^2 / E I = 5", "1.2153681176117", "0.38762836072443", "0.71379152361191"}};
  for (const Load& load : loads) {
    std::vector<double> slope, shortening, deflection;
    for (const int k : {8, 16, 32, 64}) {
      const auto model = build_model(read_scene_text(cantilever(k, load.alpha), "validation.toml"));
      const VectorXd q = pose_at_rest(*model, 5, 0.2);
      const Vec3 tip = q.tail<3>(), before = q.segment<3>(q.size() - 6);
      slope.push_back(std::atan2(tip.y() - before.y(), tip.x() - before.x()));
      shortening.push_back(1 - tip.x());
      deflection.push_back(tip.y());
    }
    constexpr std::string_view source = "elastica, elliptic integrals";
    // The fifth power of h is left: 34 h^5 = 3.2e-8, times a constant that grows with alpha; 30 is granted.
    constexpr double left = 1e-6;
    rows.push_back({load.problem, source, "tip slope (rad)", load.slope, extrapolated(slope, 2, 1), left});
    rows.push_back(
        {load.problem, source, "shortening u / L", load.shortening, extrapolated(shortening, 2, 1), left});
    rows.push_back(
        {load.problem, source, "deflection w / L", load.deflection, extrapolated(deflection, 2, 1), left});
  }
}

// A cable of 30 N/m and E A = 5e7 N over supports 100 m apart, the middle one a pulley, of 2 x 105 m: n
// straight pieces in each span with their weight in the corners, the two beside the pulley one cable that
// runs over it.
std::string heavy_cable(int n) {
  const double piece = 105.0 / n;
  std::string nodes, springs, loads;
  const auto name = [](int i) { return "'C" + std::to_string(i) + "'"; };
  for (int i = 0; i <= 2 * n; ++i) {
    const double u = static_cast<double>(i % n) / n;
    nodes += (i ? ", {name = " : "{name = ") + name(i) + ", position = [" + exact_number(100.0 * i / n) +
             ", 0, " + exact_number(-4 * 14.2 * u * (1 - u)) + "], " +
             (i % n == 0 ? "fixed = true}" : "mass = 1}");
    if (i % n != 0)
      loads += "[[loads]]\nnodes = [" + name(i) + "]\nforce = [0, 0, " + exact_number(-30 * piece) + "]\n";
    if (i < 2 * n && i != n - 1 && i != n)
      springs += "[[forces]]\nkind = 'spring'\nnodes = [" + name(i) + ", " + name(i + 1) +
                 "]\nstiffness = " + exact_number(5e7 / piece) + "\nfree_length = " + exact_number(piece) +
                 "\n";
  }
  return "[structure]\nkind = 'custom'\nnodes = [" + nodes + "]\n" + springs +
         "[[constraints]]\nkind = 'cable'\nnodes = [" + name(n - 1) + ", " + name(n) + ", " + name(n + 1) +
         "]\naxial_stiffness = 5e7\nlength = " + exact_number(2 * piece) + "\n" + loads;
}

void add_catenary(std::vector<ValidationRow>& rows) {
  std::vector<double> height;
  for (const int n : {8, 16, 32, 64}) {
    const auto model = build_model(read_scene_text(heavy_cable(n), "validation.toml"));
    height.push_back(pose_at_rest(*model, 1, 2.0)[3 * (n / 2) + 2]);
  }
  // The eighth power of h is left: 4100 h^8 = 1.5e-11 of 14 m, times a constant; 50 is granted.
  rows.push_back({"heavy cable over a pulley",
                  "elastic catenary; Code_Aster SSNL100 has -13.930, not quite mid-span",
                  "height at mid-span (m)", "-13.939193351630529", extrapolated(height, 2, 2), 1e-8});
}

}  // namespace

void add_element_benchmarks(std::vector<ValidationRow>& rows) {
  add_top(rows);
  add_elastica(rows);
  add_catenary(rows);
  add_truss(rows);
  add_capstan(rows);
  add_friction(rows);
  add_offload(rows);
  add_gears(rows);
}

}  // namespace unfurl
