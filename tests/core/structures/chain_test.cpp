// SPDX-License-Identifier: BSD-3-Clause
#include "core/structures/chain.hpp"

#include <catch2/catch.hpp>

#include "core/math/factors.hpp"
#include "tests/support/deployment_check.hpp"
#include "tests/support/family_structure.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;
using namespace unfurl::testing;

namespace chain_test {

namespace {

constexpr double g = 9.81;

Structure under_gravity(const Changes& changes) {
  Structure s = family_structure("chain", changes);
  s.gravity = {0, 0, -g};
  return s;
}

}  // namespace

TEST_CASE("a chain held at both ends stays in its catenary, with the pull that the span asks for") {
  for (const auto& [links, span] : {std::pair{2L, 0.1}, {7L, 0.9}, {24L, 0.8}, {24L, 4.7}}) {
    const double l = 0.2;
    const Structure s =
        under_gravity({{"links", links}, {"link_length", l}, {"span", span}, {"held", std::string("both")}});
    CHECK(s.nodes.back().position.x() == Approx(span).epsilon(1e-14));
    CHECK(std::abs(s.nodes.back().position.z()) <= 1e-13);
    const Simulation run = simulate(make_model(s), dvm_options(3, 0.01, 0.5));
    INFO(links << " links: " << run.message);
    REQUIRE(run.status == RunStatus::completed);
    const VectorXd drift = run.trajectory.positions(run.trajectory.size() - 1) - run.trajectory.positions(0);
    CHECK(drift.lpNorm<Eigen::Infinity>() <=
          1e-12);  // an equilibrium that is stable: round-off stays round-off
    const Diagnostics d = diagnose(run);
    const double weight = s.rods[0].mass * g;
    for (long i = 0; i < links; ++i) {
      const Vec3 along =
          s.nodes[static_cast<std::size_t>(i) + 1].position - s.nodes[static_cast<std::size_t>(i)].position;
      const double pull = d.axial_force(0, i) * along.x() / l, lift = d.axial_force(0, i) * along.z() / l;
      CHECK(pull == Approx(d.axial_force(0, 0) * (s.nodes[1].position.x() / l)).epsilon(1e-9));
      CHECK(lift == Approx((static_cast<double>(i) - 0.5 * static_cast<double>(links - 1)) * weight)
                        .margin(1e-9 * weight));
    }
  }
}

TEST_CASE("a chain swings slightly as its linear modes say") {
  // Angles phi_i of N uniform rods of mass m from the vertical, counted from the top: with r = N - max(i, j)
  // links below, T = 1/2 sum M_ij phi_i' phi_j', M_ij = m l^2 (r + 1/2), M_ii = m l^2 (r + 1/3), V = 1/2 sum
  // m g l (N - i + 1/2) phi_i^2. From rest at phi_i = a the modes give phi(t); terms of order a^3 are left
  // out: 1e-12 rad at a = 1e-4 rad.
  constexpr int N = 6;
  const double l = 0.3, a_degrees = 1e-4 / radians_per_degree, t = 1.7;
  MatrixXd M(N, N), K = MatrixXd::Zero(N, N);
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) M(i, j) = l * l * (N - 1 - std::max(i, j) + (i == j ? 1.0 / 3 : 0.5));
  for (int i = 0; i < N; ++i) K(i, i) = g * l * (N - 1 - i + 0.5);
  // K x = w^2 M x with y = sqrt(K) x: 1 / w^2 are the eigenvalues of sqrt(K)^-1 M sqrt(K)^-1.
  const VectorXd root = K.diagonal().cwiseSqrt(), back = root.cwiseInverse();
  const SymmetricEigen modes = symmetric_eigen(back.asDiagonal() * M * back.asDiagonal());
  const VectorXd share = modes.vectors.transpose() * root * 1e-4;
  const VectorXd phase = (modes.values.cwiseSqrt().cwiseInverse() * t).array().cos();
  const VectorXd phi = back.cwiseProduct(modes.vectors * share.cwiseProduct(phase));

  const Simulation run = simulate(make_model(under_gravity({{"links", long{N}},
                                                            {"link_length", l},
                                                            {"shape", std::string("straight")},
                                                            {"angle", a_degrees}})),
                                  dvm_options(4, 0.005, t));
  REQUIRE(run.status == RunStatus::completed);
  const VectorXd q = run.trajectory.positions(run.trajectory.size() - 1);
  for (int i = 0; i < N; ++i) {
    const Vec3 link = q.segment<3>(3 * i + 3) - q.segment<3>(3 * i);
    CHECK(std::atan2(link.x(), -link.z()) ==
          Approx(phi[i]).epsilon(0).margin(1e-10));  // 1e-6 of the swing: order a^3, a hundredfold
  }
}

TEST_CASE("a chain that cannot hang is refused by the parameter at fault") {
  CHECK(refusal("chain", {{"links", 10L}, {"link_length", 0.2}, {"span", 2.0}}) ==
        "span: a span of 2 m is out of reach for links and link_length: 10 links of 0.2 m hang between ends "
        "less than 2 m "
        "apart");
  CHECK(refusal("chain", {{"links", 9L}, {"link_length", 0.2}, {"span", 0.2}})
            .starts_with("span: a span of 0.2 m is too small"));
  // The number that is refused is not the one that is given as the limit.
  CHECK(refusal("chain", {{"links", 10L}, {"link_length", 0.1}, {"span", 1.0000001}})
            .starts_with("span: a span of 1.0000001 m is out of reach"));
  CHECK(refusal("chain", {{"links", 1L}, {"held", std::string("both")}}).starts_with("held: a single link"));
}

}  // namespace chain_test
