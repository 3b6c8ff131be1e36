// SPDX-License-Identifier: BSD-3-Clause
#include "core/forces/straight_springs.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/forces/pulleys.hpp"
#include "core/forces/spring.hpp"

namespace unfurl {

bool StraightSprings::fits(const Force& force) {
  return force.measure.kind == MeasureKind::length && force.measure.nodes.size() == 2 &&
         !Pulleys::rubs(force) && !force.unstressed.moves();
}

void StraightSprings::push_back(const Force& force) {
  const SpringLaw law = spring_law(force, 0.0, nullptr);
  members_.push_back({force.measure.nodes[0], force.measure.nodes[1], law.rest, law.stiffness, force.damping,
                      force.smoothing, force.one_sided, force.slack});
}

struct StraightSprings::Tension {
  Vec3 u;
  double s, rate, N, elastic;  // elastic: N without its damper's part
  PullByLength pull;
};

// Whether there is a force at all.
bool StraightSprings::pulls(const Member& m, const double* q, const double* v, Tension& at) {
  const Vec3 d = node_vector(q, m.b) - node_vector(q, m.a);
  at.s = d.norm();
  if (m.one_sided && at.s - m.rest <= -m.smoothing) return false;
  at.u = at.s > 0 ? Vec3(d / at.s) : Vec3::Zero();
  at.rate = m.damping > 0 ? at.u.dot(node_vector(v, m.b) - node_vector(v, m.a)) : 0.0;
  at.pull = pull_of(m, at.s - m.rest);
  at.elastic = m.stiffness * at.pull.elastic;
  at.N = at.elastic + m.damping * at.pull.share * at.rate;
  if (m.one_sided) at.N = m.slack ? 0.0 : std::max(at.N, 0.0);
  return true;
}

void StraightSprings::add(const double* q, const double* v, double scale, double* f) const {
  Tension at;
  for (const Member& m : members_) {
    if (!pulls(m, q, v, at)) continue;
    const Vec3 pull = (scale * at.N) * at.u;
    Eigen::Map<Vec3>(f + 3 * static_cast<Index>(m.a)) += pull;
    Eigen::Map<Vec3>(f + 3 * static_cast<Index>(m.b)) -= pull;
  }
}

double StraightSprings::potential_of(const Member& m, const double* q) {
  const double s = (node_vector(q, m.b) - node_vector(q, m.a)).norm();
  return m.stiffness * pull_of(m, s - m.rest).energy;
}

double StraightSprings::potential(const double* q) const {
  double sum = 0;
  for (const Member& m : members_) sum += potential_of(m, q);
  return sum;
}

double StraightSprings::dissipation(const double* q, const double* v) const {
  double sum = 0;
  Tension at;
  for (const Member& m : members_)
    if (m.damping > 0 && !m.slack && pulls(m, q, v, at)) sum -= (at.N - at.elastic) * at.rate;
  return sum;
}

double StraightSprings::taken(const double* q) const {
  double sum = 0;
  for (const Member& m : members_)
    if (m.damping > 0 && m.slack) sum -= potential_of(m, q);
  return sum;
}

// By x_b - x_a, of what pulls b: -N Hess s - u (k share u + c bend s' u + c share Hess s (v_b - v_a))^T; by
// v_b - v_a: -c share u u^T.
void StraightSprings::derivatives(const double* q, const double* v, ForceDerivative& by_q,
                                  ForceDerivative& by_v) const {
  const auto add = [](const Member& m, const Mat3& block, ForceDerivative& entries) {
    for (const auto& [row, column, sign] :
         {std::tuple{m.a, m.a, 1.0}, {m.a, m.b, -1.0}, {m.b, m.a, -1.0}, {m.b, m.b, 1.0}})
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) entries.emplace_back(3 * row + i, 3 * column + j, sign * block(i, j));
  };
  Tension at;
  for (const Member& m : members_) {
    const double c = m.damping;
    if (!pulls(m, q, v, at) || (m.one_sided && at.N == 0.0)) {
      if (c > 0 && by_v.keeps_places) add(m, Mat3::Zero(), by_v);
      if (by_q.keeps_places) add(m, Mat3::Zero(), by_q);
      continue;
    }
    const Mat3 along = at.u * at.u.transpose();
    const Mat3 hessian = at.s > 0 ? Mat3((Mat3::Identity() - along) / at.s) : Mat3(Mat3::Zero());
    Mat3 block = -at.N * hessian - (m.stiffness * at.pull.share + c * at.pull.bend * at.rate) * along;
    // In proportion to x_b - x_a, at one place too.
    if (m.rest == 0 && !m.one_sided && !(c > 0)) block = -m.stiffness * Mat3::Identity();
    if (c > 0) {
      const Vec3 turned = hessian * (node_vector(v, m.b) - node_vector(v, m.a));
      block -= c * at.pull.share * at.u * turned.transpose();
      add(m, -c * at.pull.share * along, by_v);
    }
    add(m, block, by_q);
  }
}

}  // namespace unfurl
