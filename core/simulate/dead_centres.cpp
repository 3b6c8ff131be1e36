// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/dead_centres.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/math/golden_section.hpp"
#include "core/math/singular_values.hpp"

namespace unfurl {
namespace {

// Singular values of rows of length 1: rounding, and where sides are worth asking for.
constexpr double no_distance = 1e-7, near_one = 0.2;

// Nothing leads to a dead centre and rests or turns round there but a drive that does so itself.
bool slows(const std::vector<Drive>& drives, double from, double to) {
  constexpr double much = 0.7;
  return std::ranges::any_of(drives, [&](const Drive& drive) {
    const double before = drive.target.derivative(1, from), behind = drive.target.derivative(1, to);
    return before * behind <= 0 || std::abs(before) < much * std::abs(behind) ||
           std::abs(behind) < much * std::abs(before);
  });
}

}  // namespace

void DeadCentres::find_parts(const State& from, const State& to) {
  if (std::exchange(known_, true)) return;
  const auto jacobian = std::make_shared<JacobianInPoses>(system_);
  for (const SparsePart& part : parts_with_rows(*jacobian)) {
    Part found;
    for (const Drive& drive : system_.drives())
      if (std::ranges::find(part.rows(), drive.row) != part.rows().end()) found.drives.push_back(drive);
    if (found.drives.empty() ||
        std::max(std::ssize(part.rows()), std::ssize(part.columns())) > max_singular_size)
      continue;
    const Index redundant =
        std::ssize(part.rows()) - std::max(rank_at(*jacobian, part, from.z), rank_at(*jacobian, part, to.z));
    found.sigma = std::make_unique<SmallestSingularValue>(
        jacobian, part, redundant, std::min<Index>(std::ssize(found.drives), most_columns));
    if (!found.sigma->all_zeros()) parts_.push_back(std::move(found));
  }
}

DeadCentres::Verdict DeadCentres::judge(const State& from, const State& to) {
  if (system_.drives().empty()) return {};
  find_parts(from, to);
  Verdict verdict;
  for (Part& part : parts_)
    if (const Verdict one = judge(part, from, to); one.side > verdict.side) verdict = one, judged_ = &part;
  return verdict;
}

DeadCentres::Verdict DeadCentres::judge(Part& part, const State& from, const State& to) const {
  if (!slows(part.drives, from.t, to.t)) return {};
  SmallestSingularValue& sigma = *part.sigma;
  const double before = from.z.size() == part.known_at.size() && from.z == part.known_at ? part.left : 0.0;
  sigma.moved(from.z);
  const double way = sigma.moved(to.z);
  part.known_at = to.z;
  if (before > way) return part.left = before - way, Verdict{};
  const double behind = sigma.at(to.z);
  part.left = behind;
  if (!(behind <= way)) return {};
  Verdict verdict;
  for (const auto& [near, far] : {std::pair{&to, &from}, {&from, &to}}) {
    sigma.at(near->z);
    for (const SmallestSingularValue::Pair& pair : sigma.pairs()) {
      if (!(pair.sigma <= way)) break;
      if (const Verdict one = parabola(part, *near, *far, pair); one.side > verdict.side) verdict = one;
    }
  }
  return verdict;
}

DeadCentres::Verdict DeadCentres::parabola(const Part& of, const State& near, const State& far,
                                           const SmallestSingularValue::Pair& pair) const {
  constexpr double own = 0.5;  // of the squared distance: what the next power of it may change
  constexpr double alike = 4;  // of that at the step's other end
  constexpr int samples = 32, cuts = 40;
  const double sigma = pair.sigma, other = of.sigma->between(pair, far.z),
               c = (other - sigma) / pair.v.dot(far.z - near.z);
  if (!(sigma < near_one && std::abs(other) > 0.9 * sigma)) return {};  // seen from there, else
  double led = 0;
  for (const Drive& drive : of.drives) led = std::max(led, std::abs(pair.u[drive.row]));
  if (!(led > 10 * sigma)) return {};
  if (!(sigma > no_distance)) return {beside(near, pair, c) ? Side::lost : Side::unknown};
  const double square = std::pow(sigma / c, 2), there = std::pow(other / c, 2);
  const auto at = [&](double t) {
    double moved = 0;
    for (const Drive& drive : of.drives)
      moved += pair.u[drive.row] / pair.lengths[drive.row] * drive.scale *
               (drive.target(t) - drive.target(near.t));
    return square + 2 * moved / c;
  };
  if (const double told = at(far.t); !(told < alike * there && there < alike * told)) return {};
  const double part = std::abs(far.t - near.t) / samples, first = std::min(near.t, far.t);
  int least = 0;
  for (int k = 1; k <= samples; ++k)
    if (at(first + k * part) < at(first + least * part)) least = k;
  const bool inside = 0 < least && least < samples;
  double t = first + least * part;
  if (inside) t = golden_section(at, t - part, t + part, cuts);
  const double bottom = at(t);
  if (bottom > own * square) return {other < 0 ? Side::lost : Side::kept};
  if (other > 0 || !inside || bottom < -square) return {};
  return {Side::turns, t};
}

// A state in a dead centre is one that was led to it: constraints that do not hold there do so beside it.
bool DeadCentres::beside(const State& in_one, const SmallestSingularValue::Pair& pair, double c) const {
  VectorXd q(system_.coordinates()), phi(system_.constraints());
  system_.expand(in_one.z, q);
  system_.at(in_one).constraint(in_one.t, q, phi);
  return -2 * c * pair.u.dot(phi.cwiseQuotient(pair.lengths)) > std::pow(3 * no_distance, 2);
}

bool DeadCentres::in_one(const State& state) {
  return !(judged_->sigma->at(state.z) > 3 * no_distance);
}

}  // namespace unfurl
