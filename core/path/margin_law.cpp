// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/margin_law.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/text/nearest_name.hpp"

namespace unfurl {
namespace {

void add_value(const ScalarLaw::Value& one, ScalarLaw::Value& sum) {
  sum.Q += one.Q;
  sum.by_s += one.by_s;
  sum.by_v += one.by_v;
  sum.scale += one.scale;
  sum.noise += one.noise;
}

}  // namespace

MarginLaw::MarginLaw(const Path& path, const Structure& structure,
                     const std::map<std::string, double>& factors)
    : PathLaw(path, structure, true) {
  const std::vector<PathForces::Source>& sources = forces().sources();
  for (std::size_t k = 0; k < sources.size(); ++k) {
    const auto same = [&](const Group& group) {
      return group.name == sources[k].name && group.kind == sources[k].kind;
    };
    auto group = std::find_if(groups_.begin(), groups_.end(), same);
    if (group == groups_.end())
      group = groups_.insert(groups_.end(), {sources[k].name, sources[k].kind, 1.0, {}});
    group->sources.push_back(k);
  }
  factors_.assign(sources.size(), 1.0);
  std::vector<std::string_view> names;
  for (const Group& group : groups_) names.push_back(group.name);
  for (const auto& [name, factor] : factors) {
    const auto named = std::count(names.begin(), names.end(), name);
    if (named == 0)
      throw StudyError("nothing that acts is called " + in_quotes(name) + did_you_mean(name, names));
    if (named > 1)
      throw StudyError("more than one thing that acts is called " + in_quotes(name) +
                       ": a factor needs a name of its own");
    Group& group =
        groups_[static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin())];
    group.factor = factor;
    for (const std::size_t k : group.sources) factors_[k] = factor;
  }
}

const PathForces::Friction* MarginLaw::friction_of(std::size_t k) const {
  const int i = forces().sources()[k].friction;
  return i < 0 ? nullptr : &forces().frictions()[static_cast<std::size_t>(i)];
}

ScalarLaw::Value MarginLaw::value_of(const PathTable::Segment& here, std::size_t k, double s, double v,
                                     double t, bool pulls) const {
  const PathForces::Source& source = forces().sources()[k];
  if (source.cable >= 0 && !pulls) return {};
  const ValueAndSlope p = here.at(source.position, s);
  if (const PathForces::Friction* law = friction_of(k)) {
    const double size = -factors_[k] * going * law->kinetic;
    return {size * std::abs(p.value), size * std::copysign(p.slope, p.value * p.slope), 0.0,
            std::abs(size) * here.scale[source.position], std::abs(size) * here.noise[source.position]};
  }
  const ValueAndSlope c = here.at(source.damping, s);
  const double f = factors_[k], size = f * (source.timed ? source.size(t) : 1.0);
  return {size * p.value - f * c.value * v, size * p.slope - f * c.slope * v, -f * c.value,
          std::abs(size) * here.scale[source.position] + std::abs(f * c.value * v),
          std::abs(size) * here.noise[source.position] + std::abs(f * v) * here.noise[source.damping] +
              f * source.size_noise(t) * std::abs(p.value)};
}

ScalarLaw::Value MarginLaw::at(double s, double v, double t) const {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const PathTable::Segment* here = in_reach(s);
  if (!here) return {nan, nan, nan, nan, nan};
  Value sum;
  for (std::size_t k = 0; k < factors_.size(); ++k) {
    const int cable = forces().sources()[k].cable;
    add_value(value_of(*here, k, s, v, t, cable >= 0 && pulls(static_cast<std::size_t>(cable))), sum);
  }
  if (jam_torque > 0) {
    const ValueAndSlope turn = jam_turn(s);
    add_value({-going * jam_torque * turn.value, -going * jam_torque * turn.slope, 0.0,
               jam_torque * turn.value, 0.0},
              sum);
  }
  sum.noise += looseness * sum.scale;
  return sum;
}

double MarginLaw::force(std::size_t group, double s, double v, double t) const {
  const PathTable::Segment* here = table().segment(s);
  if (!here) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0;
  for (const std::size_t k : groups_[group].sources) {
    const int cable = forces().sources()[k].cable;
    sum += value_of(*here, k, s, v, t, cable >= 0 && pulls(static_cast<std::size_t>(cable))).Q;
  }
  return sum;
}

bool MarginLaw::damps(std::size_t group, double s) const {
  const PathTable::Segment* here = table().segment(s);
  return here && std::ranges::any_of(groups_[group].sources, [&](std::size_t k) {
           return value_of(*here, k, s, 0.0, 0.0, true).by_v != 0;
         });
}

bool MarginLaw::stretched(const PathTable::Segment& here, std::size_t k, double s) const {
  const int i = forces().sources()[k].cable;
  if (i < 0) return false;
  const PathForces::Cable& cable = forces().cables()[static_cast<std::size_t>(i)];
  return here.at(cable.measure, s).value > cable.rest;
}

ScalarLaw::Value MarginLaw::at_rest(std::size_t group, double s, double t) const {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const PathTable::Segment* here = table().segment(s);
  if (!here) return {nan, nan, nan, nan, nan};
  Value sum;
  for (const std::size_t k : groups_[group].sources)
    if (!friction_of(k)) add_value(value_of(*here, k, s, 0.0, t, stretched(*here, k, s)), sum);
  return sum;
}

ScalarLaw::Value MarginLaw::at_rest(double s, double t) const {
  Value sum;
  for (std::size_t g = 0; g < groups_.size(); ++g) add_value(at_rest(g, s, t), sum);
  return sum;
}

double MarginLaw::friction(std::size_t group, double s, double PathForces::Friction::*size) const {
  double sum = 0;
  for (const std::size_t k : groups_[group].sources)
    if (const PathForces::Friction* law = friction_of(k))
      sum += factors_[k] * law->*size * std::abs(table().at(forces().sources()[k].position, s).value);
  return sum;
}

double MarginLaw::hold(std::size_t group, double s) const {
  return friction(group, s, &PathForces::Friction::holding);
}

double MarginLaw::slip(std::size_t group, double s) const {
  return friction(group, s, &PathForces::Friction::kinetic);
}

double MarginLaw::hold(double s) const {
  double sum = jam_torque > 0 ? jam_torque * jam_turn(s).value : 0.0;
  for (std::size_t g = 0; g < groups_.size(); ++g) sum += hold(g, s);
  return sum;
}

}  // namespace unfurl
