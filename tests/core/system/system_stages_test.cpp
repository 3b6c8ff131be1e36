// SPDX-License-Identifier: BSD-3-Clause
// The kernels for all stages of a step against those for one pose.
#include <catch2/catch.hpp>
#include <random>

#include "core/system/system.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace system_stages_test {

namespace {

// Kinds with kernels of their own (rods, linear rows) and without (the others), some of them prescribed.
Structure every_kind() {
  Structure s = double_pendulum();
  const Vec3 n = Vec3(1, 2, 2) / 3;
  s.constraints.push_back({"relation", "relation", {1, 2}, {Vec3(1, 0, 1), Vec3(0, 2, 0)}, 0.5});
  s.constraints.push_back({"collinear", "collinear", {0, 1, 2}, {}, 0.0});
  s.constraints.push_back({"measure", "measure", {}, {}, 0.0, {MeasureKind::coordinate, {2}, n, 0, {}}, {}});
  TimeFunction& target = s.constraints.back().target;
  target.kind = TimeFunction::Kind::smooth;
  target.rise = 0.7;
  target.duration = 2.0;
  return s;
}

Interleaved random_columns(Index rows, Index columns, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  Interleaved x(rows, columns);
  for (Index i = 0; i < x.size(); ++i) x.data()[i] = uniform(random);
  return x;
}

// Sums of some ten terms of order one, in another order.
constexpr double round_off = 1e-14;

void compare(const System& system, int poses, std::mt19937& random) {
  const Index n = system.solved_coordinates(), m = system.constraints(), nodes = system.coordinates();
  const Interleaved z = random_columns(n, poses, random), lambda = random_columns(m, poses, random);
  const VectorXd scale = random_columns(poses, 1, random), t = random_columns(poses, 1, random);
  Interleaved Q = random_columns(nodes, poses + 1, random), phi(m, poses), f(nodes, poses), r(n, poses);
  const VectorXd first = Q.col(0);
  System::StageScratch scratch;
  system.expand_stages(z, 1, Q);
  CHECK(Q.col(0) == first);  // the start's pose is left alone
  system.constraint_stages(t.data(), Q, 1, phi, scratch);
  f.setZero();
  system.add_constraint_force_stages(Q, 1, lambda, scale.data(), f, scratch);
  system.reduce_force_stages(f, r);
  for (Index c = 0; c < poses; ++c) {
    VectorXd q(nodes), one_phi(m), one_f = VectorXd::Zero(nodes), one_r(n);
    system.expand(VectorXd(z.col(c)), q);
    CHECK((Q.col(c + 1) - q).lpNorm<Eigen::Infinity>() <= round_off);
    system.constraint(t[c], q, one_phi);
    CHECK((phi.col(c) - one_phi).lpNorm<Eigen::Infinity>() <= round_off);
    system.add_constraint_force(q, VectorXd(lambda.col(c)), scale[c], one_f);
    CHECK((f.col(c) - one_f).lpNorm<Eigen::Infinity>() <= round_off);
    system.reduce_force(one_f, one_r);
    CHECK((r.col(c) - one_r).lpNorm<Eigen::Infinity>() <= 10 * round_off);
  }
}

}  // namespace

TEST_CASE("all stages at once give what each gives alone") {
  std::mt19937 random(11);
  for (const Structure& structure : {every_kind(), hoop_structure(), ladder_structure(1, 1.0)})
    for (const bool eliminate : {true, false}) {
      const System system(structure, eliminate);
      for (int poses = 1; poses <= 7; ++poses) {
        INFO(poses << " poses, " << system.constraints() << " constraints");
        compare(system, poses, random);
      }
    }
}

TEST_CASE("rates of all constraints are G v less the rate of what is prescribed") {
  std::mt19937 random(12);
  for (const Structure& structure : {every_kind(), hoop_structure({{"model", std::string("sector")}})})
    for (const bool eliminate : {true, false}) {
      const System system(structure, eliminate);
      const VectorXd q = random_columns(system.coordinates(), 1, random),
                     v = random_columns(system.coordinates(), 1, random);
      std::vector<double> scratch;
      // g' by a central difference: 1e-11 of truncation and of round-off.
      constexpr double t = 0.8, step = 3e-6;
      VectorXd rate(system.all_constraints()), before(rate.size()), after(rate.size());
      system.all_constraint_rates(t, q, v, rate, scratch);
      system.all_constraint_values(t - step, q, before);
      system.all_constraint_values(t + step, q, after);
      const VectorXd expected = system.all_jacobian(q) * v + (after - before) / (2 * step);
      CHECK((rate - expected).lpNorm<Eigen::Infinity>() <= 1e-9);
    }
}

TEST_CASE("what small motions change of rods is right to the digits of the motion") {
  // Against long double. Phi itself would leave 1e-16 m, a ten-thousandth of these changes and more.
  const Structure s = double_pendulum();
  for (const bool eliminate : {true, false}) {
    const System system(s, eliminate);
    std::mt19937 random(11);
    const VectorXd q0 = random_columns(system.coordinates(), 1, random);
    const Interleaved D = 1e-12 * random_columns(system.solved_coordinates(), 3, random);
    Interleaved phi(system.constraints(), 3);
    System::StageScratch scratch;
    if (!system.constraint_changes(q0, D, phi, scratch)) {
      CHECK(!eliminate);  // rows that hold nodes do not offer it
      continue;
    }
    for (Index c = 0; c < 3; ++c) {
      VectorXd moved(system.coordinates());
      system.expand_rate(VectorXd(D.col(c)), moved);
      for (std::size_t r = 0; r < s.rods.size(); ++r) {
        const Rod& rod = s.rods[r];
        long double sum = 0;
        for (Index k = 0; k < 3; ++k) {
          const long double d = static_cast<long double>(q0[3 * rod.b + k]) - q0[3 * rod.a + k],
                            u = static_cast<long double>(moved[3 * rod.b + k]) - moved[3 * rod.a + k];
          sum += (2 * d + u) * u;
        }
        const auto exact = static_cast<double>(sum / (2.0L * rod.length));
        CHECK(std::abs(phi(system.rod_rows()[r], c) - exact) <= 1e-15 * 1e-12 * 10 / rod.length);
      }
    }
  }
}

}  // namespace system_stages_test
