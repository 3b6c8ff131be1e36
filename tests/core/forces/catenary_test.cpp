// SPDX-License-Identifier: BSD-3-Clause
// Code_Aster's test SSNL100: a heavy elastic cable from 0 over a pulley at 100 m to 200 m, 10 m paid in.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/math/factors.hpp"
#include "core/structure/node_positions.hpp"
#include "core/system/system.hpp"

using namespace unfurl;

namespace catenary_test {

namespace {

constexpr double stiffness = 5e7, weight = 30.0, span = 100.0, half_length = 105.0;

Force cable_over(std::vector<int> nodes, double unstressed) {
  Force cable;
  cable.kind = "cable";
  cable.measure.kind = MeasureKind::combination;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    MeasureTerm term;
    term.measure.nodes = {nodes[i], nodes[i + 1]};
    cable.measure.terms.push_back(term);
  }
  cable.axial_stiffness = stiffness;
  cable.one_sided = false;  // none is slack in the end; on the way Newton's method needs their slopes
  cable.rest = cable.unstressed.offset = unstressed;
  return cable;
}

// n pieces in each span; the two beside the pulley are one cable that runs over it.
Structure heavy_cable(int n) {
  Structure s;
  const double piece = half_length / n;
  for (int i = 0; i <= 2 * n; ++i) {
    const double u = static_cast<double>(i % n) / n, x = span * i / n;
    Node node{std::to_string(i), Vec3(x, 0, -4 * 14.2 * u * (1 - u))};
    node.mass = 1.0;
    s.nodes.push_back(node);
    if (i % n == 0)
      s.constraints.push_back({"fixed", "support", {i}, {}, 0.0, {}, {}});
    else
      s.loads.push_back({i, Vec3(0, 0, -weight * piece)});
    s.constraints.push_back({"plane", "plane", {i}, {Vec3::UnitY()}, 0.0, {}, {}});
  }
  for (int i = 0; i + 1 <= 2 * n; ++i)
    if (i != n - 1 && i != n) s.forces.push_back(cable_over({i, i + 1}, piece));
  s.forces.push_back(cable_over({n - 1, n, n + 1}, 2 * piece));
  return s;
}

// The height at the middle of the first span, in equilibrium: Newton's method on F(z) = 0.
double middle_height(int n) {
  const System system(heavy_cable(n), true);
  VectorXd q = node_positions(heavy_cable(n)), f(q.size()), r(system.solved_coordinates());
  VectorXd z = system.reduce(q);
  const VectorXd rest = VectorXd::Zero(q.size());
  for (int it = 0; it < 200; ++it) {
    system.expand(z, q);
    f.setZero();
    system.add_applied_force(0.0, q, rest, 1.0, f);
    system.reduce_force(f, r);
    SparseRows by_z, by_w;
    system.force_derivatives(0.0, q, rest, by_z, by_w);
    VectorXd step = SparseLu(SparseColumns(by_z)).solve(-r);
    step *= std::min(1.0, 2.0 / step.lpNorm<Eigen::Infinity>());  // not beyond where slopes mean something
    z += step;
    if (step.lpNorm<Eigen::Infinity>() < 1e-12) break;
  }
  system.expand(z, q);
  return q[3 * (n / 2) + 2];
}

// Half of an elastic catenary: x = H s / EA + (H / w) asinh(w s / H), with its sag.
double exact_sag() {
  const double s = 0.5 * half_length;
  double low = 10, high = 1e5;
  for (int i = 0; i < 200; ++i) {
    const double h = 0.5 * (low + high);
    (h * s / stiffness + h / weight * std::asinh(weight * s / h) > 0.5 * span ? high : low) = h;
  }
  const double v = weight * s / low;
  return weight * s * s / (2 * stiffness) + low / weight * (v * v / (std::sqrt(1 + v * v) + 1));
}

}  // namespace

// A polygon of n straight pieces with its weight in the corners is off by even powers of 1 / n: extrapolation
// from 8 to 128 pieces leaves (1/8)^10 times constants.
TEST_CASE("a heavy cable over a pulley hangs as the elastic catenary: SSNL100") {
  std::vector<double> heights;
  for (const int n : {8, 16, 32, 64, 128}) heights.push_back(middle_height(n));
  CHECK(heights.back() == Approx(-13.930).epsilon(1e-3));  // published
  for (std::size_t level = 1; level < heights.size(); ++level)
    for (std::size_t i = heights.size() - 1; i >= level; --i)
      heights[i] += (heights[i] - heights[i - 1]) / (std::pow(4.0, static_cast<double>(level)) - 1);
  CHECK(heights.back() == Approx(-exact_sag()).epsilon(1e-9));
  CHECK(exact_sag() == Approx(13.93919).epsilon(1e-6));
}

}  // namespace catenary_test
