// SPDX-License-Identifier: BSD-3-Clause
#include "core/structure/structure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/structure/measure.hpp"
#include "core/structure/node_positions.hpp"

namespace unfurl {

double LinearForm::operator()(const ConstVec& q) const {
  return rate(q) + offset;
}

double LinearForm::rate(const ConstVec& v) const {
  double sum = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) sum += coefficients[i].dot(v.segment<3>(3 * nodes[i]));
  return sum;
}

double Deployment::fold_angle(const ConstVec& q) const {
  return std::atan2(fold_sine(q), fold_cosine(q));
}

double Deployment::fold_rate(const ConstVec& q, const ConstVec& v) const {
  const double s = fold_sine(q), c = fold_cosine(q);
  return (c * fold_sine.rate(v) - s * fold_cosine.rate(v)) / (s * s + c * c);
}

namespace {

MeasureFunction function_of(const Deployment& deployment) {
  return {deployment.measure, deployment};
}

double measured_value(const Deployment& deployment, const ConstVec& q, const VectorXd& angles) {
  const MeasureFunction function = function_of(deployment);
  if (angles.size() == 0)
    return function.wraps() ? function.value(q.data(), 0.5 * (deployment.stowed + deployment.deployed))
                            : function.value(q.data());
  const VectorXd at_rest = VectorXd::Zero(angles.size());
  Moment at(0.0);
  at.angles = angles.data(), at.rates = at_rest.data();
  return function.value(q.data(), at, 0);
}

}  // namespace

VectorXd Deployment::first_angles() const {
  const std::vector<Measure> own = measured ? turning_angles(measure) : std::vector<Measure>();
  VectorXd angles(static_cast<Index>(own.size()));
  for (std::size_t i = 0; i < own.size(); ++i) angles[static_cast<Index>(i)] = own[i].reference;
  return angles;
}

void Deployment::count_on(const ConstVec& q, VectorXd& angles) const {
  if (!measured) return;
  Index i = 0;
  for (const Measure& angle : turning_angles(measure)) {
    angles[i] = MeasureFunction(angle, *this).value(q.data(), angles[i]);
    ++i;
  }
}

double Deployment::fraction(const ConstVec& q, const VectorXd& angles) const {
  if (measured) return (measured_value(*this, q, angles) - stowed) / (deployed - stowed);
  // cos a - cos b, which would cancel next to b: both are halved, and so is their quotient.
  const auto beyond = [b = initial_fold_angle](double a) {
    return std::sin(0.5 * (b + a)) * std::sin(0.5 * (b - a));
  };
  return beyond(fold_angle(q)) / beyond(deployed_fold_angle);
}

double remaining_of_fold(double sine, double cosine) {
  return cosine >= 0 ? sine : std::copysign(2 - std::abs(sine), sine);
}

double Deployment::remaining(const ConstVec& q, const VectorXd& angles) const {
  if (measured) return (deployed - measured_value(*this, q, angles)) / (deployed - stowed);
  const double c = std::cos(deployed_fold_angle), s = std::sin(deployed_fold_angle), sine = fold_sine(q),
               cosine = fold_cosine(q);
  return remaining_of_fold(c * sine - s * cosine, c * cosine + s * sine);
}

double Deployment::remaining_rate(const ConstVec& q, const ConstVec& v) const {
  if (measured) {
    const MeasureFunction function = function_of(*this);
    std::vector<double> gradient(function.stencil().size());
    function.value_and_gradient(q.data(), gradient.data());
    return -function.rate(gradient.data(), v.data()) / (deployed - stowed);
  }
  const double c = std::cos(deployed_fold_angle), s = std::sin(deployed_fold_angle),
               rate = c * fold_sine.rate(v) - s * fold_cosine.rate(v);
  return c * fold_cosine(q) + s * fold_sine(q) >= 0 ? rate : -rate;
}

double Deployment::rounded(const ConstVec& q) const {
  constexpr double nothing = 1e-12, ulps = 16 * std::numeric_limits<double>::epsilon();
  double largest = 0, by_coordinates = 0;  // of their nodes; sum of the derivatives' sizes
  const auto add = [&](int node, double derivative) {
    largest = std::max(largest, q.segment<3>(3 * node).lpNorm<Eigen::Infinity>());
    by_coordinates += derivative;
  };
  if (measured) {
    const MeasureFunction function = function_of(*this);
    std::vector<double> gradient(function.stencil().size());
    function.value_and_gradient(q.data(), gradient.data());
    for (std::size_t i = 0; i < gradient.size(); ++i)
      add(function.stencil()[i] / 3, std::abs(gradient[i] / (deployed - stowed)));
  } else {
    for (std::size_t i = 0; i < fold_sine.nodes.size(); ++i)
      add(fold_sine.nodes[i], fold_sine.coefficients[i].lpNorm<1>());
  }
  return std::max(nothing, ulps * largest * by_coordinates);
}

bool is_fold_passed(double left_before, double left_after) {
  const auto angle = [](double left) {
    return std::abs(left) <= 1 ? std::asin(left) : std::copysign(pi - std::asin(2 - std::abs(left)), left);
  };
  return angle(left_before) - angle(left_after) < pi;
}

bool Deployment::is_passed(double left_before, double left_after) const {
  return measured || is_fold_passed(left_before, left_after);
}

std::vector<char> shown_rods(const Structure& structure) {
  std::vector<char> shown(structure.rods.size(), 0);
  for (const RodCopy& copy : structure.rod_copies) shown[static_cast<std::size_t>(copy.source)] = 1;
  return shown;
}

void show_as_solved(Structure& structure) {
  structure.node_copies.clear();
  structure.rod_copies.clear();
  structure.load_copies.clear();
  for (std::size_t i = 0; i < structure.nodes.size(); ++i)
    if (!structure.nodes[i].ghost)
      structure.node_copies.push_back(
          {structure.nodes[i].name, static_cast<int>(i), Mat3::Identity(), Vec3::Zero()});
  for (std::size_t i = 0; i < structure.rods.size(); ++i)
    structure.rod_copies.push_back(
        {structure.rods[i].name, structure.rods[i].a, structure.rods[i].b, static_cast<int>(i)});
  for (const Load& load : structure.loads)
    if (load.shown) structure.load_copies.push_back({load.node, load.force});
}

double ReportedSurface::rms(const ConstVec& q) const {
  double mean = 0, sum = 0;
  const auto off = [&](int node) {
    const auto x = q.segment<3>(3 * node);
    return x[2] - x.head<2>().squaredNorm() / (4 * focal_length);
  };
  for (const int node : nodes) mean += off(node) / static_cast<double>(nodes.size());
  for (const int node : nodes) sum += (off(node) - mean) * (off(node) - mean);
  return std::sqrt(sum / static_cast<double>(nodes.size()));
}

Index space_coordinates(const Structure& structure) {
  return 3 * std::ranges::count_if(structure.nodes, [](const Node& node) { return !node.ghost; });
}

VectorXd node_positions(const Structure& structure) {
  VectorXd q(3 * static_cast<Index>(structure.nodes.size()));
  for (std::size_t i = 0; i < structure.nodes.size(); ++i)
    q.segment<3>(3 * static_cast<Index>(i)) = structure.nodes[i].position;
  return q;
}

VectorXd whole_positions(const Structure& structure, const ConstVec& q) {
  VectorXd x(3 * static_cast<Index>(structure.node_copies.size()));
  for (std::size_t i = 0; i < structure.node_copies.size(); ++i) {
    const NodeCopy& copy = structure.node_copies[i];
    x.segment<3>(3 * static_cast<Index>(i)) = copy.map * q.segment<3>(3 * copy.source) + copy.offset;
  }
  return x;
}

VectorXd whole_velocities(const Structure& structure, const ConstVec& v) {
  VectorXd x(3 * static_cast<Index>(structure.node_copies.size()));
  for (std::size_t i = 0; i < structure.node_copies.size(); ++i) {
    const NodeCopy& copy = structure.node_copies[i];
    x.segment<3>(3 * static_cast<Index>(i)) = copy.map * v.segment<3>(3 * copy.source);
  }
  return x;
}

GivenRod given_rod(const Structure& structure, std::size_t rod) {
  GivenRod given;
  std::size_t first = 0;
  for (std::size_t r = 1; r <= rod; ++r)
    if (structure.rods[r].whole.empty() || structure.rods[r].whole != structure.rods[first].whole)
      first = r, ++given.place;
  given.rod = structure.rods[first];
  if (given.rod.whole.empty()) return given;
  const Rod& last = structure.rods[first + static_cast<std::size_t>(given.rod.parts) - 1];
  const double parts = given.rod.parts;
  given.rod.b = last.b, given.rod.name = given.rod.whole;
  given.rod.length *= parts, given.rod.mass *= parts, given.rod.free_length *= parts;
  return given;
}

}  // namespace unfurl
