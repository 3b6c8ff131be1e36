// SPDX-License-Identifier: BSD-3-Clause
#include "core/structure/structure.hpp"

#include <cmath>

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

double Deployment::fraction(const ConstVec& q) const {
  const double folded = std::cos(initial_fold_angle);
  return (std::cos(fold_angle(q)) - folded) / (std::cos(deployed_fold_angle) - folded);
}

double Deployment::remaining_sine(const ConstVec& q) const {
  return std::cos(deployed_fold_angle) * fold_sine(q) - std::sin(deployed_fold_angle) * fold_cosine(q);
}

double Deployment::remaining_rate(const ConstVec& v) const {
  return std::cos(deployed_fold_angle) * fold_sine.rate(v) -
         std::sin(deployed_fold_angle) * fold_cosine.rate(v);
}

void show_as_solved(Structure& structure) {
  structure.node_copies.clear();
  structure.rod_copies.clear();
  structure.load_copies.clear();
  for (std::size_t i = 0; i < structure.nodes.size(); ++i)
    structure.node_copies.push_back(
        {structure.nodes[i].name, static_cast<int>(i), Mat3::Identity(), Vec3::Zero()});
  for (std::size_t i = 0; i < structure.rods.size(); ++i)
    structure.rod_copies.push_back(
        {structure.rods[i].name, structure.rods[i].a, structure.rods[i].b, static_cast<int>(i)});
  for (const Load& load : structure.loads)
    if (load.shown) structure.load_copies.push_back({load.node, load.force});
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

}  // namespace unfurl
