// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/element_members.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/scene/scene.hpp"
#include "core/structure/measure.hpp"
#include "core/structure/node_positions.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

std::vector<bool> nodes_within_rods(const Structure& structure) {
  std::vector<bool> within(structure.nodes.size(), false);
  for (std::size_t r = 1; r < structure.rods.size(); ++r)
    if (const Rod& rod = structure.rods[r], &before = structure.rods[r - 1];
        !rod.whole.empty() && rod.whole == before.whole && rod.a == before.b)
      within[static_cast<std::size_t>(rod.a)] = true;
  return within;
}

void leave_nodes_within_rods(const std::string& pattern, const std::vector<bool>& within,
                             std::vector<int>& found) {
  if (pattern.find('.') == std::string::npos)
    std::erase_if(found, [&](int node) { return within[static_cast<std::size_t>(node)]; });
}

std::vector<int> matching_copies(const Structure& structure, const NameIndex& names,
                                 const std::string& pattern) {
  std::vector<int> found = names.matching(pattern);
  if (pattern.find('.') != std::string::npos) return found;
  const std::vector<bool> within = nodes_within_rods(structure);
  std::erase_if(found, [&](int copy) {
    return within[static_cast<std::size_t>(structure.node_copies[static_cast<std::size_t>(copy)].source)];
  });
  return found;
}

std::string only_within_rods(const std::string& pattern) {
  return in_quotes(pattern) +
         " matches nodes within cut rods only: give their names with the point, as ROD.1";
}

MemberFinder::MemberFinder(const Structure& structure)
    : structure_(structure), start_(node_positions(structure)) {
  for (const Node& node : structure.nodes) {
    if (node.ghost) break;  // they come last, and no scene names them
    node_names_.add(node.name);
  }
  for (const Rod& rod : structure.rods) rod_names_.add(rod.name);
  for (std::size_t r = 0; r < structure.rods.size(); ++r)
    if (const Rod& rod = structure.rods[r]; !rod.whole.empty()) {
      if (parts_.empty() || parts_.back().whole != rod.whole)
        parts_.push_back({rod.whole, static_cast<int>(r), static_cast<int>(r)});
      parts_.back().last = static_cast<int>(r);
    }
}

// Rods by their own names, and all parts of those that were cut.
std::vector<int> MemberFinder::rods_matching(const std::string& pattern) const {
  std::vector<int> found = rod_names_.matching(pattern);
  for (const CutRod& cut : parts_) {
    if (!glob_match(pattern, cut.whole)) continue;
    for (int r = cut.first; r <= cut.last; ++r)
      if (std::ranges::find(found, r) == found.end()) found.push_back(r);
  }
  return found;
}

// Of rods as the scene has them, not of parts that it does not know.
std::string MemberFinder::similar_rod(const std::string& name) const {
  std::vector<std::string_view> known;
  for (std::size_t r = 0; r < structure_.rods.size(); ++r)
    if (structure_.rods[r].whole.empty()) known.push_back(rod_names_.names()[r]);
  for (const CutRod& cut : parts_) known.push_back(cut.whole);
  return did_you_mean(name, known);
}

void MemberFinder::problem(const SceneElement& element, const std::string& key, std::string message) {
  const auto place = element.places.find(key);
  problems_.push_back({place == element.places.end() ? element.where : place->second,
                       key.empty() ? element.key : element.key + "." + key, std::move(message)});
}

void MemberFinder::throw_problems() {
  if (!problems_.empty()) throw SceneError(std::move(problems_));
}

std::vector<int> MemberFinder::nodes_outside_rods(const SceneElement& element) {
  const std::vector<bool> within = nodes_within_rods(structure_);
  std::vector<int> all = nodes(element, true), found;
  for (const std::string& pattern : element.nodes) {
    std::vector<int> matches = node_names_.matching(pattern);
    const bool known = !matches.empty();
    leave_nodes_within_rods(pattern, within, matches);
    if (known && matches.empty()) problem(element, "nodes", only_within_rods(pattern));
    found.insert(found.end(), matches.begin(), matches.end());
  }
  return all.empty() ? all : found;
}

std::vector<int> MemberFinder::nodes(const SceneElement& element, bool globs) {
  std::vector<int> found;
  bool good = true;
  for (const auto& name : element.nodes) {
    const int one = node_names_.find(name);
    const auto matches = globs ? node_names_.matching(name) : one < 0 ? std::vector<int>{} : std::vector{one};
    for (const int node : matches) {
      if (std::ranges::find(found, node) == found.end()) {
        found.push_back(node);
        continue;
      }
      problem(element, "nodes", "names " + in_quotes(name_of(node)) + " more than once");
      return {};
    }
    if (!matches.empty()) continue;
    problem(element, "nodes",
            "there is no node " + in_quotes(name) + did_you_mean(name, node_names_.names()));
    good = false;
  }
  return good ? found : std::vector<int>{};
}

bool MemberFinder::is_part_of_name(const std::string& word) const {
  if (node_names_.find(word) >= 0) return false;
  return std::ranges::any_of(structure_.nodes, [&](const Node& node) {
    const std::string padded = " " + node.name + " ";
    return node.name != word && padded.find(" " + word + " ") != std::string::npos;
  });
}

int MemberFinder::node(const SceneElement& element, const std::string& key, const std::string& name) {
  const int found = node_names_.find(name);
  if (found < 0)
    problem(element, key, "there is no node " + in_quotes(name) + did_you_mean(name, node_names_.names()));
  return found;
}

std::vector<int> MemberFinder::path(const SceneElement& element) {
  std::vector<int> found;
  bool good = true;
  for (const auto& name : element.nodes) {
    found.push_back(node(element, "nodes", name));
    good = good && found.back() >= 0;
  }
  return good ? found : std::vector<int>{};
}

MemberFinder::RodParts MemberFinder::rod(const SceneElement& element, std::size_t index) {
  const std::string& name = element.rods[index];
  const auto at = [&](int r) { return &structure_.rods[static_cast<std::size_t>(r)]; };
  if (const int found = rod_names_.find(name); found >= 0) return {at(found), at(found)};
  for (const CutRod& cut : parts_)
    if (cut.whole == name) return {at(cut.first), at(cut.last)};
  problem(element, element.rods.size() == 1 ? "rod" : "rods",
          "there is no rod " + in_quotes(name) + similar_rod(name));
  return {};
}

std::vector<int> MemberFinder::rods(const SceneElement& element) {
  std::vector<int> found;
  for (const auto& name : element.rods) {
    std::vector<int> matches = rods_matching(name);
    if (matches.empty())
      for (std::size_t r = 0; r < structure_.rods.size(); ++r)
        if (glob_match(name, structure_.rods[r].group)) matches.push_back(static_cast<int>(r));
    if (matches.empty())
      problem(element, "rods", "there is no rod and no group " + in_quotes(name) + similar_rod(name));
    for (const int rod : matches)
      if (std::ranges::find(found, rod) == found.end()) found.push_back(rod);
  }
  return found;
}

// In (-180, 180] degrees where it has a sign: round-off of a position does not decide on which side of the
// cut it lies.
double MemberFinder::initial(const Measure& measure) const {
  const double value = MeasureFunction(measure, structure_.deployment).value(start_.data(), 0.0);
  return counts_turns(measure) && value < -pi + 1e-9 ? value + 2 * pi : value;
}

double MemberFinder::same(const Measure& measure, double value) const {
  constexpr double digits = 1e-9;
  if (is_angle(measure)) return digits * std::max(1.0, std::abs(value));
  // Of the scene's nodes; rotors and drums behind them are at the origin, wherever it stands.
  const auto own = start_.head(3 * static_cast<Eigen::Index>(node_names_.names().size()));
  double size = std::abs(value);
  for (Eigen::Index i = 3; i < own.size(); ++i) size = std::max(size, std::abs(own[i] - own[i % 3]));
  return digits * size + 4e-16 * own.lpNorm<Eigen::Infinity>();  // and what coordinates far away round to
}

// Two rods that share a node open at it; others are taken from their first node to their second. Of rods that
// were cut to bend the parts at the shared node count.
bool MemberFinder::angle(const SceneElement& element, const Vec3& axis, Measure& measure) {
  measure.kind = MeasureKind::angle;
  measure.axis = axis.isZero(0.0) ? axis : Vec3(axis.stableNormalized());
  if (element.fold_angle) {
    measure.kind = MeasureKind::fold;
    measure.axis.setZero();
    if (structure_.deployment.folds()) return true;
    problem(element, "fold_angle", "this structure has no fold angle; name rods or nodes");
    return false;
  }
  if (!element.nodes.empty()) {
    const auto found = nodes(element, false);
    if (found.size() != 3) return false;
    measure.nodes = {found[1], found[0], found[1], found[2]};
  } else {
    const RodParts r = rod(element, 0), s = rod(element, 1);
    if (!r.first || !s.first) return false;
    const int ra = r.first->a, rb = r.last->b, sa = s.first->a, sb = s.last->b;
    measure.nodes = {ra, rb, sa, sb};
    const bool from_end = rb == sa || rb == sb;
    const int shared = from_end ? rb : ra;
    const bool to_end = shared == sb;
    if (from_end) measure.nodes[0] = rb, measure.nodes[1] = r.last->a;
    if (to_end) measure.nodes[2] = sb, measure.nodes[3] = s.last->a;
    if (!from_end && (to_end || shared == sa)) measure.nodes[1] = r.first->b;
    if (!to_end && shared == sa) measure.nodes[3] = s.first->b;
  }
  if (measure.nodes[0] == measure.nodes[1] || measure.nodes[2] == measure.nodes[3]) {
    problem(element, "nodes", "an angle needs three different nodes");
    return false;
  }
  follow_bends(measure);
  if (measure.nodes[0] == measure.nodes[2] && measure.nodes[1] == measure.nodes[3]) {
    problem(
        element, element.nodes.empty() ? "rods" : "nodes",
        "an angle between a line and itself is 0 whatever moves; name two rods, or three different nodes");
    return false;
  }
  return angle_is_defined(element, measure);
}

// A rod is named by its other end or by the first node within it.
void MemberFinder::follow_bends(Measure& angle) const {
  std::vector<int> n = angle.nodes;
  if (n[0] != n[2]) return;
  n.push_back(n[1]), n.push_back(n[3]);
  for (const CutRod& cut : parts_) {
    const auto part = [&](int r) { return &structure_.rods[static_cast<std::size_t>(r)]; };
    const Rod *first = part(cut.first), *last = part(cut.last);
    if (first == last) continue;
    for (const std::size_t line : {0U, 1U}) {
      int& to = n[2 * line + 1];
      const auto leave = [&](int end, int other, int next, int second) {
        if (n[0] == end && (to == other || to == next)) to = next, n[4 + line] = second;
      };
      leave(first->a, last->b, first->b, part(cut.first + 1)->b);
      leave(last->b, first->a, last->a, part(cut.last - 1)->a);
    }
  }
  if (n[1] != n[3] && (n[4] != n[1] || n[5] != n[3])) angle.nodes = n;
}

// What coordinates are rounded by is no distance.
bool MemberFinder::apart(const SceneElement& element, const std::string& key, int a, int b) {
  const Vec3 from = start_of(a), to = start_of(b);
  const double rounded = 4 * std::numeric_limits<double>::epsilon() * std::max(from.norm(), to.norm());
  if ((to - from).norm() > rounded) return true;
  problem(element, key,
          in_quotes(name_of(a)) + " and " + in_quotes(name_of(b)) +
              " must not be at the same place at t = 0: there is no line through them");
  return false;
}

// What is measured between held nodes, and lengths of rigid rods, along which what acts is idle only until
// they give or are warmed.
bool MemberFinder::stays(const Measure& term, bool acts) const {
  const auto& n = term.nodes;
  const auto is_held = [&](int node) {
    return std::ranges::any_of(structure_.constraints, [&](const Constraint& c) {
      return c.kind == "fixed" && c.nodes == std::vector{node};
    });
  };
  if (!n.empty() && std::ranges::all_of(n, is_held)) return true;
  return !acts && term.kind == MeasureKind::length &&
         std::ranges::any_of(structure_.rods, [&](const Rod& rod) {
           const bool ends = (rod.a == n[0] && rod.b == n[1]) || (rod.a == n[1] && rod.b == n[0]);
           return ends && !rod.gives && rod.expansion == 0;
         });
}

// In poses without any order all derivatives are those of round-off.
bool MemberFinder::cancels(const Measure& sum) const {
  const MeasureFunction function(sum, structure_.deployment);
  const std::vector<int>& at = function.stencil();
  std::vector<double> gradient(at.size());
  for (const double seed : {0.6180339887498949, 0.41421356237309515}) {
    VectorXd q(start_.size());
    for (const int i : at) q[i] = std::fmod(seed * (i + 1.0) * (i + 1.0), 1.0);  // no four of a plane
    function.value_and_gradient(q.data(), gradient.data());
    std::map<int, std::pair<double, double>> by_coordinate;  // sum, and of what size its parts are
    for (std::size_t k = 0; k < at.size(); ++k) {
      auto& [total, size] = by_coordinate[at[k]];
      total += gradient[k], size += std::abs(gradient[k]);
    }
    for (const auto& [coordinate, found] : by_coordinate)
      if (!(std::abs(found.first) <= 1e-12 * found.second)) return false;
  }
  return true;
}

bool MemberFinder::varies(const SceneElement& element, const std::string& key, const Measure& sum) {
  Measure rest = sum;
  const bool acts = key == "terms";
  std::erase_if(rest.terms, [&](const MeasureTerm& term) { return stays(term.measure, acts); });
  if (!rest.terms.empty() && !cancels(rest)) return true;
  problem(element, key,
          std::string("is the same whatever moves: ") +
              (rest.terms.empty() ? "rigid rods keep their lengths, and held nodes their places"
                                  : "its terms cancel"));
  return false;
}

// An angle about an axis is that of the projections across it: a rod along the axis has none.
bool MemberFinder::angle_is_defined(const SceneElement& element, const Measure& measure,
                                    const std::string& key) {
  const std::string members = !key.empty() ? key : element.nodes.empty() ? "rods" : "nodes";
  for (const std::size_t first : {0U, 2U}) {
    const int from = measure.nodes[first], to = measure.nodes[first + 1];
    if (!apart(element, members, from, to)) return false;
    const Vec3 d = start_of(to) - start_of(from);
    if (measure.axis.isZero(0.0) || measure.axis.cross(d).norm() > 1e-9 * d.norm()) continue;
    problem(element, key.empty() ? "axis" : key,
            std::string(key.empty() ? "" : "an axis ") + "is along the line from " +
                in_quotes(name_of(from)) + " to " + in_quotes(name_of(to)) +
                " at t = 0: there is no angle about it; give the axis of the hinge");
    return false;
  }
  return true;
}

namespace {

// Of the free length 0, without a damper: it pulls with k d, which needs no direction.
bool pulls_in_proportion(const SceneElement& e) {
  return e.kind == "spring" && e.values.real("free_length") == 0 && e.values.real("damping") == 0 &&
         !e.values.boolean("tension_only");
}

}  // namespace

std::optional<Measure> length_of(const SceneElement& element, MemberFinder& find) {
  Measure measure;
  measure.nodes = find.nodes(element, false);
  if (measure.nodes.size() != 2) return {};
  if (pulls_in_proportion(element)) return measure;
  if (!find.apart(element, "nodes", measure.nodes[0], measure.nodes[1])) return {};
  return measure;
}

std::optional<Measure> angle_of(const SceneElement& element, MemberFinder& find) {
  const Vec3 axis = element.values.has("axis") ? vec3(element.values, "axis") : Vec3::Zero();
  Measure measure;
  if (!find.angle(element, axis, measure)) return {};
  measure.reference = find.initial(measure);
  return measure;
}

std::optional<Measure> coordinate_of(const SceneElement& e, MemberFinder& find) {
  Measure measure;
  measure.kind = MeasureKind::coordinate;
  measure.nodes = find.nodes(e, false);
  measure.axis = vec3(e.values, "direction");
  if (measure.nodes.empty()) return {};
  if (measure.nodes.size() > 2) {
    find.problem(e, "nodes", "must be one or two");
    return {};
  }
  if (!(measure.axis.stableNorm() > 0)) {
    find.problem(e, "direction", "must not be zero");
    return {};
  }
  measure.axis.stableNormalize();
  return measure;
}

std::optional<Measure> driven_angle(const SceneElement& e, MemberFinder& find) {
  const auto measure = angle_of(e, find);
  if (!measure || measure->kind == MeasureKind::fold || counts_turns(*measure) ||
      std::abs(std::sin(measure->reference)) >= 1e-6)
    return measure;
  find.problem(e, "axis",
               "is missing: the rods are in line at t = 0, where an angle without an axis has no direction "
               "to grow in");
  return {};
}

std::optional<Measure> measure_of(const SceneElement& element, MemberFinder& find) {
  if (element.fold_angle || !element.rods.empty() || element.nodes.size() == 3)
    return driven_angle(element, find);
  if (!vec3(element.values, "direction").isZero(0.0)) return coordinate_of(element, find);
  if (element.nodes.size() == 2) return length_of(element, find);
  find.problem(element, "direction", "is missing: one node has a coordinate along a direction");
  return {};
}

double start_value(const SceneElement& element, const Structure& structure) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const bool force = element.key.starts_with("forces");
  const ElementKind* kind = find_kind(force ? scene_forces() : scene_constraints(), element.kind);
  if (!kind || !kind->measure) return unknown;
  MemberFinder find(structure);
  const std::optional<Measure> measure = kind->measure(element, find);
  if (!measure) return unknown;
  return find.initial(*measure) / (is_angle(*measure) ? radians_per_degree : 1.0);
}

ParamSpec direction_param(std::string_view name, std::string_view help) {
  return required(vector_param(name, "", {0, 0, 0}, help));
}

Vec3 ElementAdder::direction(const SceneElement& element, const std::string& key) {
  const Vec3 d = vec3(element.values, key);
  if (d.stableNorm() > 0) return d.stableNormalized();
  find.problem(element, key, "must not be zero");
  return Vec3::Zero();
}

void add_elements(const std::vector<SceneElement>& elements, const std::vector<ElementKind>& kinds,
                  double end_time, bool ends_deployed, Structure& structure) {
  if (elements.empty()) return;
  ElementAdder adder{structure, end_time, MemberFinder(structure),
                     ends_deployed || !structure.deployment.empty()};
  for (const SceneElement& element : elements)
    if (element.enabled) find_kind(kinds, element.kind)->add(element, adder);
  adder.find.throw_problems();
}

void refuse_warm_start(const Scene& scene, const Structure& structure) {
  MemberFinder find(structure);
  for (const SceneElement& e : scene.forces) {
    if (e.kind != "temperature" || !e.enabled) continue;
    for (const int r : find.rods(e)) {
      const Rod& rod = structure.rods[static_cast<std::size_t>(r)];
      const double warmed = rod.warmed(0.0),
                   apart = (structure.nodes[static_cast<std::size_t>(rod.b)].position -
                            structure.nodes[static_cast<std::size_t>(rod.a)].position)
                               .norm();
      // It fits better as if it were not warm.
      if (rod.gives || std::abs(apart - rod.length) >= std::abs(apart - rod.length * (1 + warmed))) continue;
      find.problem(e, e.values.vector("times").empty() ? "change" : "values",
                   "warms the rigid rod " + in_quotes(rod.name) +
                       " at t = 0 already, where its nodes stand as they are given: give times and values "
                       "that begin with 0, or let the rod give (elastic = true)");
      break;
    }
  }
  find.throw_problems();
}

}  // namespace unfurl
