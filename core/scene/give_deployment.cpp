// SPDX-License-Identifier: BSD-3-Clause
// [deployment]: what is measured of a structure without a fold angle, and when it is deployed.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/scene/element_members.hpp"
#include "core/scene/scene.hpp"
#include "core/structure/measure.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

// What is wrong with a name in [deployment] of which nothing is measured; empty: terms were meant.
std::string wrong_name(const Scene& scene) {
  std::vector<std::string_view> names;
  for (const auto* list : {&scene.forces, &scene.constraints})
    for (const SceneElement& element : *list) names.push_back(element.name);
  const auto& terms = scene.deployment.terms;
  for (const std::string& term : terms) {
    if (begins_as_term(term)) continue;
    if (std::ranges::find(names, term) != names.end())
      return in_quotes(term) + (terms.size() > 1 ? " is an entry, which is measured by itself, in no sum"
                                                 : " is switched off: enabled = false");
    const std::string_view near = nearest_name(term, names);
    if (!near.empty())
      return "there is no force and no constraint " + in_quotes(term) + "; did you mean " + in_quotes(near) +
             "?";
  }
  return "";
}

// Of the entry that [deployment] names, where it names one.
std::optional<Measure> measure_of_entry(const Scene& scene, MemberFinder& find, bool& named) {
  const auto& terms = scene.deployment.terms;
  for (const bool force : {true, false})
    for (const SceneElement& element : force ? scene.forces : scene.constraints) {
      if (terms.size() != 1 || element.name != terms.front() || !element.enabled) continue;
      named = true;
      const ElementKind* kind = find_kind(force ? scene_forces() : scene_constraints(), element.kind);
      if (kind && kind->measure) return kind->measure(element, find);
      find.problem(scene.deployment, "measure", in_quotes(element.name) + " measures nothing");
    }
  return {};
}

}  // namespace

void give_deployment(const Scene& scene, Structure& structure) {
  MemberFinder find(structure);
  const SceneElement& e = scene.deployment;
  bool named = false;
  std::optional<Measure> measure = measure_of_entry(scene, find, named);
  if (const std::string wrong = named ? "" : wrong_name(scene); !wrong.empty())
    find.problem(e, "measure", wrong);
  else if (!named)
    measure = sum_of_terms(e, find, "measure");
  find.throw_problems();
  if (measure->kind == MeasureKind::combination && measure->terms.size() == 1 &&
      measure->terms[0].coefficient == 1.0) {
    const Measure only = measure->terms[0].measure;
    measure = only;
  }
  const double unit = is_angle(*measure) ? radians_per_degree : 1.0;
  double initial = find.initial(*measure);
  Deployment& d = structure.deployment;
  d.measured = true;
  d.deployed = unit * e.values.real("deployed");
  d.stowed = unit * e.values.real("stowed");
  if (std::isnan(d.stowed))
    d.stowed = initial;
  else if (counts_turns(*measure))  // the turn on which it begins is that of the values given
    measure->reference = initial -= 2 * pi * std::round((initial - 0.5 * (d.stowed + d.deployed)) / (2 * pi));
  d.measure = *measure;
  // Where it turns back a measure can be reached, but nothing holds it there.
  const MeasureRange range = range_of(*measure);
  const double same = find.same(*measure, d.deployed);
  if (d.deployed < range.low - same || d.deployed > range.high + same)
    find.problem(e, "deployed", "is never reached: " + values_within(*measure));
  else if (scene.solver.at_deployed == "latch" &&
           (d.deployed <= range.low + same || d.deployed >= range.high - same))
    find.problem(e, "deployed",
                 "cannot be held by a latch, as the measure turns back there: " + values_within(*measure));
  const double way = d.deployed - d.stowed;
  double factors = measure->kind == MeasureKind::combination ? 0.0 : 1.0;
  for (const MeasureTerm& term : measure->terms) factors += std::abs(term.coefficient);
  if (!(std::abs(way) > find.same(*measure, d.stowed)))
    find.problem(e, "deployed", "is the value when stowed, too: nothing deploys");
  else if (is_angle(*measure) && std::abs(way) >= 2 * pi * factors)
    find.problem(e, "deployed", "must be less than a turn away from stowed");
  else if (!((d.deployed - initial) / way > 1e-9)) {
    std::ostringstream text;
    text.precision(15);
    text << "is reached already at t = 0, where the measure is " << initial / unit;
    find.problem(e, "deployed", text.str());
  }
  find.throw_problems();
  note_long_way(e, "deployed", d.measure, initial, d.deployed, structure);
}

}  // namespace unfurl
