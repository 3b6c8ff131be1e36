// SPDX-License-Identifier: BSD-3-Clause
// Sums of measures as engineers name them, each a row of its own over one kind of constraint and one of
// force: a cable over pulleys, gears, a rack, a telescope, and what a scene sums up itself.
//
//   cable        S = sum of spans                <= L(t), or with E A a spring on S
//   gear         r_1 th_1 + r_2 th_2             = its value at t = 0, divided by r_1
//   rack         x - r th                        = its value at t = 0
//   telescope    (s_i - s_i(0)) / u_i equal for all stages i, and their sum held or driven
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "core/scene/element_members.hpp"
#include "core/scene/scene.hpp"
#include "core/structure/measure.hpp"
#include "core/structure/motion_params.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {
namespace {

constexpr double endless_value = std::numeric_limits<double>::infinity();

const std::vector<ParamSpec>& cable_row_params() {
  for (const ForceKind& row : force_kinds())
    if (row.kind == "cable") return row.params();
  throw std::logic_error("no force kind cable");
}

ParamSpec axis_of(std::string_view name, std::string_view help) {
  return vector_param(name, "", {0, 0, 0}, help);
}

const std::vector<ParamSpec>& gear_params() {
  static const std::vector<ParamSpec> params = [] {
    return std::vector<ParamSpec>{
        required(vector_param("radii", "m", {1, 1}, "of both wheels; one is negative in an inner gear")),
        axis_of("axis", "of both shafts: their angles then have a sign and count turns; none: in [0, 180]"),
        axis_of("second_axis", "of the second shaft; none: as the first")};
  }();
  return params;
}

const std::vector<ParamSpec>& rack_params() {
  static const std::vector<ParamSpec> params = [] {
    return std::vector<ParamSpec>{
        required(real_param("radius", "m", 0.0, -endless_value, endless_value,
                            "of the pinion; negative: it drives the rack the other way")),
        direction_param("direction", "in which the rack moves"),
        axis_of("axis", "of the pinion: its angle then has a sign and counts turns; none: in [0, 180]")};
  }();
  return params;
}

const std::vector<ParamSpec>& telescope_params() {
  static const std::vector<ParamSpec> params = [] {
    std::vector<ParamSpec> all = {
        vector_param("shares", "", {},
                     "of the extension that the stages take, one for each; by default they share it equally"),
        boolean_param("straight", true, "its nodes stay on the line through its ends")};
    for (ParamSpec& spec : motion_params("m", {"free"})) all.push_back(std::move(spec));
    return all;
  }();
  return params;
}

const std::vector<ParamSpec>& driven_sum_params() {
  static const std::vector<ParamSpec> params = motion_params("");
  return params;
}

MeasureTerm length_term(double coefficient, int a, int b) {
  MeasureTerm term{coefficient, {}};
  term.measure.kind = MeasureKind::length;
  term.measure.nodes = {a, b};
  return term;
}

Measure sum_of(std::vector<MeasureTerm> terms) {
  Measure measure;
  measure.kind = MeasureKind::combination;
  measure.terms = std::move(terms);
  return measure;
}

Vec3 unit_of(const Vec3& v) {
  return v.isZero(0.0) ? v : Vec3(v.stableNormalized());
}

// The angle A, HINGE, B of three nodes; none where it is no angle, which is noted.
std::optional<Measure> angle_at(const SceneElement& e, MemberFinder& find, const std::vector<int>& nodes,
                                const Vec3& axis, const std::string& key) {
  Measure measure;
  measure.kind = MeasureKind::angle;
  measure.nodes = {nodes[1], nodes[0], nodes[1], nodes[2]};
  measure.axis = unit_of(axis);
  if (nodes[0] == nodes[1] || nodes[1] == nodes[2]) {
    find.problem(e, key, "an angle needs three different nodes");
    return {};
  }
  find.follow_bends(measure);
  if (!find.angle_is_defined(e, measure, key == "nodes" ? "" : key)) return {};
  measure.reference = find.initial(measure);
  return measure;
}

// One word of a term after the other.
class Words {
 public:
  explicit Words(const std::string& text) : in_(text) {}
  std::string word() {
    std::string next;
    in_ >> next;
    return next;
  }
  bool number(double& x) {
    const std::string text = word();
    char* end = nullptr;
    x = std::strtod(text.c_str(), &end);
    return !text.empty() && *end == '\0' && std::isfinite(x);
  }
  bool direction(Vec3& v) { return number(v[0]) && number(v[1]) && number(v[2]) && v.stableNorm() > 0; }

 private:
  std::istringstream in_;
};

struct TermKind {
  std::string_view name;
  MeasureKind kind;
  std::size_t least, most;  // nodes
  std::string_view ending;  // the word before three numbers
};
constexpr std::array term_kinds{TermKind{"length", MeasureKind::length, 2, 2, ""},
                                TermKind{"coordinate", MeasureKind::coordinate, 1, 2, "along"},
                                TermKind{"angle", MeasureKind::angle, 3, 3, "about"},
                                TermKind{"dihedral", MeasureKind::dihedral, 4, 4, ""}};

std::optional<MeasureTerm> bad_term(const SceneElement& e, MemberFinder& find, const std::string& key,
                                    const std::string& text, const std::string& why) {
  find.problem(e, key,
               "\"" + text + "\" " + why +
                   "; a term is a number and \"length A B\", \"coordinate A along X Y Z\", "
                   "\"angle A HINGE B\" (also: about X Y Z) or \"dihedral A B C D\"");
  return {};
}

std::string near_kind(const std::string& word) {
  const std::array known{term_kinds[0].name, term_kinds[1].name, term_kinds[2].name, term_kinds[3].name};
  const std::string_view near = nearest_name(word, {known.begin(), known.end()});
  return near.empty() ? "" : " (did you mean " + in_quotes(near) + "?)";
}

}  // namespace

bool begins_as_term(const std::string& text) {
  double coefficient = 0;
  return Words(text).number(coefficient) ||
         std::ranges::any_of(
             term_kinds, [first = Words(text).word()](const TermKind& kind) { return first == kind.name; });
}

namespace {

// False, a problem noted: a line that it is measured from has no direction. A deployment may begin at the
// length 0, which acts on nothing.
bool term_is_defined(const SceneElement& e, MemberFinder& find, const std::string& key, MeasureKind kind,
                     const std::vector<int>& nodes) {
  if (kind == MeasureKind::length) return key != "terms" || find.apart(e, key, nodes[0], nodes[1]);
  if (kind != MeasureKind::dihedral) return true;
  for (const auto& [a, b] : {std::pair(0U, 1U), {0U, 2U}, {1U, 2U}, {1U, 3U}, {2U, 3U}})
    if (!find.apart(e, key, nodes[a], nodes[b])) return false;
  return true;
}

std::optional<MeasureTerm> term_of(const SceneElement& e, MemberFinder& find, const std::string& given,
                                   const std::string& key) {
  const bool bare = std::any_of(term_kinds.begin(), term_kinds.end(),
                                [&](const TermKind& k) { return given.starts_with(k.name); });
  const std::string text = (bare ? "1 " : "") + given;
  Words words(text);
  MeasureTerm term;
  if (!words.number(term.coefficient)) {
    const std::string first = Words(given).word(), near = near_kind(first);
    return bad_term(e, find, key, given,
                    near.empty() ? "does not begin with a number" : "measures nothing that is known" + near);
  }
  if (term.coefficient == 0.0)
    return bad_term(e, find, key, given, "has the coefficient 0, which says nothing");
  const std::string name = words.word();
  const auto* const kind =
      std::find_if(term_kinds.begin(), term_kinds.end(), [&](const TermKind& k) { return k.name == name; });
  if (kind == term_kinds.end())
    return bad_term(e, find, key, given, "measures nothing that is known" + near_kind(name));
  std::vector<int> nodes;
  Vec3 direction = Vec3::Zero();
  for (std::string word = words.word(); !word.empty(); word = words.word()) {
    if (word == kind->ending) {
      if (!words.direction(direction) || !words.word().empty())
        return bad_term(e, find, key, given, "must end in three numbers of a direction");
      break;
    }
    if (find.is_part_of_name(word))
      return bad_term(e, find, key, given,
                      "has " + in_quotes(word) +
                          ", a part of a name with a space, which cannot stand in a term: rename that node");
    nodes.push_back(find.node(e, key, word));
    if (nodes.back() < 0) return {};
  }
  if (nodes.size() < kind->least || nodes.size() > kind->most)
    return bad_term(e, find, key, given, "names " + std::to_string(nodes.size()) + " nodes");
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i)
    if (nodes[i] == nodes[i + 1]) return bad_term(e, find, key, given, "names a node twice");
  if (kind->kind == MeasureKind::angle) {
    const auto angle = angle_at(e, find, nodes, direction, key);
    if (!angle) return {};
    term.measure = *angle;
    return term;
  }
  if (kind->kind == MeasureKind::coordinate && direction.isZero(0.0))
    return bad_term(e, find, key, given, "has no direction");
  if (!term_is_defined(e, find, key, kind->kind, nodes)) return {};
  term.measure = {kind->kind, std::move(nodes), unit_of(direction), 0.0, {}};
  if (kind->kind == MeasureKind::dihedral) term.measure.reference = find.initial(term.measure);
  return term;
}

void hold_sum(const SceneElement& e, ElementAdder& to, Measure measure, TimeFunction target,
              const std::string& suffix = "") {
  for (const MeasureTerm& term : measure.terms)
    if (term.measure.kind == MeasureKind::angle && !counts_turns(term.measure) &&
        std::abs(std::sin(to.find.initial(term.measure))) < 1e-6)
      to.find.problem(e, e.kind == "combination" ? "terms" : "axis",
                      "needs an axis: rods are in line at t = 0, where an angle without one has no direction "
                      "to grow in");
  to.structure.constraints.push_back(
      {"measure", e.name + suffix, measure.nodes, {}, 0.0, std::move(measure), std::move(target)});
}

void hold_initial(const SceneElement& e, ElementAdder& to, const Measure& measure,
                  const std::string& suffix = "") {
  TimeFunction value;
  value.offset = to.find.initial(measure);
  hold_sum(e, to, measure, value, suffix);
}

std::optional<Measure> gear_of(const SceneElement& e, MemberFinder& find) {
  const std::vector<int> nodes = find.path(e);
  if (nodes.empty()) return {};
  if (nodes.size() != 6) {
    find.problem(e, "nodes", "must be six: A, HINGE, B of the first wheel, then of the second");
    return {};
  }
  const auto& radii = e.values.vector("radii");
  if (radii[0] == 0.0 || radii[1] == 0.0) {
    find.problem(e, "radii", "must not be 0: a wheel of no radius turns nothing");
    return {};
  }
  const Vec3 axis = vec3(e.values, "axis"), other = vec3(e.values, "second_axis");
  const auto first = angle_at(e, find, {nodes[0], nodes[1], nodes[2]}, axis, "nodes");
  const auto second =
      angle_at(e, find, {nodes[3], nodes[4], nodes[5]}, other.isZero(0.0) ? axis : other, "nodes");
  if (!first || !second) return {};
  return sum_of({{1.0, *first}, {radii[1] / radii[0], *second}});
}

void add_gear(const SceneElement& e, ElementAdder& to) {
  if (const auto measure = gear_of(e, to.find)) hold_initial(e, to, *measure);
}

std::optional<Measure> rack_of(const SceneElement& e, MemberFinder& find) {
  const std::vector<int> nodes = find.path(e);
  if (nodes.empty()) return {};
  if (nodes.size() < 4 || nodes.size() > 5) {
    find.problem(e, "nodes", "must be A, HINGE, B of the pinion and the rack's node (or two: FROM, RACK)");
    return {};
  }
  const double radius = e.values.real("radius");
  const Vec3 direction = vec3(e.values, "direction");
  if (radius == 0.0) find.problem(e, "radius", "must not be 0: such a pinion drives no rack");
  if (!(direction.stableNorm() > 0)) find.problem(e, "direction", "must not be zero");
  const auto angle = angle_at(e, find, {nodes[0], nodes[1], nodes[2]}, vec3(e.values, "axis"), "nodes");
  if (!angle || radius == 0.0 || !(direction.stableNorm() > 0)) return {};
  MeasureTerm x{1.0, {}};
  x.measure = {MeasureKind::coordinate, {nodes.begin() + 3, nodes.end()}, unit_of(direction), 0.0, {}};
  return sum_of({x, {-radius, *angle}});
}

void add_rack(const SceneElement& e, ElementAdder& to) {
  if (const auto measure = rack_of(e, to.find)) hold_initial(e, to, *measure);
}

// Shares of the extension; empty: a problem was noted.
std::vector<double> telescope_shares(const SceneElement& e, MemberFinder& find, std::size_t stages) {
  std::vector<double> shares = e.values.vector("shares");
  if (shares.empty()) shares.assign(stages, 1.0);
  if (shares.size() != stages) {
    find.problem(
        e, "shares",
        "must be " + std::to_string(stages) + ", one for each stage; got " + std::to_string(shares.size()));
    return {};
  }
  for (const double share : shares)
    if (!(share > 0)) {
      find.problem(e, "shares", "must be > 0: a stage without a share of the extension is a rod");
      return {};
    }
  return shares;
}

void add_telescope(const SceneElement& e, ElementAdder& to) {
  const auto measure = path_of(e, to.find);
  if (!measure) return;
  const std::size_t stages = measure->terms.size();
  const std::vector<double> shares = telescope_shares(e, to.find, stages);
  if (shares.empty()) return;
  const auto stage = [&](std::size_t i) { return measure->terms[i].measure.nodes; };
  const int first = stage(0)[0], last = stage(stages - 1)[1];
  if (e.values.boolean("straight") && !to.find.apart(e, "nodes", first, last)) return;
  for (std::size_t i = 0; i + 1 < stages; ++i) {
    const auto a = stage(i), b = stage(i + 1);
    hold_initial(e, to,
                 sum_of({length_term(1.0, a[0], a[1]), length_term(-shares[i] / shares[i + 1], b[0], b[1])}),
                 " (stages " + std::to_string(i + 1) + ", " + std::to_string(i + 2) + ")");
    if (e.values.boolean("straight"))
      to.structure.constraints.push_back({"collinear",
                                          e.name + " is straight (" + to.node(a[1]).name + ")",
                                          {first, last, a[1]},
                                          {},
                                          0.0,
                                          {},
                                          {}});
  }
  if (e.values.text("motion") == "free") return;
  hold_sum(e, to, *measure, motion_of(e, to, *measure, to.find.initial(*measure)));
}

void add_combination(const SceneElement& e, ElementAdder& to) {
  const auto measure = terms_of(e, to.find);
  if (!measure) return;
  const double initial = to.find.initial(*measure);
  TimeFunction motion = motion_of(e, to, *measure, initial);
  if (motion.kind == TimeFunction::Kind::smooth)
    note_long_way(e, "to", *measure, initial, initial + motion.rise, to.structure);
  hold_sum(e, to, *measure, std::move(motion));
}

}  // namespace

void note_long_way(const SceneElement& e, const std::string& key, const Measure& measure, double initial,
                   double target, Structure& structure) {
  const bool sum = measure.kind == MeasureKind::combination;
  if (sum && measure.terms.size() != 1) return;
  const Measure& dihedral = sum ? measure.terms[0].measure : measure;
  const double factor = sum ? measure.terms[0].coefficient : 1.0, begin = initial / factor,
               end = target / factor;
  if (dihedral.kind != MeasureKind::dihedral || !(std::abs(end - begin) > pi * (1 + 1e-9))) return;
  std::ostringstream text;
  text.precision(4);
  text << "takes the dihedral from " << begin / radians_per_degree << " to " << end / radians_per_degree
       << " deg, more than half a turn: dihedral A B C D is right-handed about the edge from B to C; name A "
          "and "
          "D the other way round to change its sign";
  const auto place = e.places.find(key);
  structure.notes.push_back(
      problem_text({place == e.places.end() ? e.where : place->second, e.key + "." + key, text.str()}));
}

std::optional<Measure> path_of(const SceneElement& e, MemberFinder& find) {
  const std::vector<int> nodes = find.path(e);
  if (nodes.empty()) return {};
  if (nodes.size() < 2) {
    find.problem(e, "nodes", "must be at least two: a path has two ends");
    return {};
  }
  std::vector<MeasureTerm> spans;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    if (!find.apart(e, "nodes", nodes[i], nodes[i + 1])) return {};
    spans.push_back(length_term(1.0, nodes[i], nodes[i + 1]));
  }
  return sum_of(std::move(spans));
}

std::optional<Measure> terms_of(const SceneElement& e, MemberFinder& find) {
  return sum_of_terms(e, find, "terms");
}

std::optional<Measure> sum_of_terms(const SceneElement& e, MemberFinder& find, const std::string& key) {
  std::vector<MeasureTerm> terms;
  for (const std::string& text : e.terms) {
    auto term = term_of(e, find, text, key);
    if (!term) return {};
    terms.push_back(std::move(*term));
  }
  if (terms.empty()) return {};
  Measure sum = sum_of(std::move(terms));
  if (!find.varies(e, key, sum)) return {};
  return sum;
}

const std::vector<ElementKind>& combined_kinds() {
  static const std::vector<ElementKind> kinds = {
      {"cable", "a cable over nodes in order, which runs freely: elastic, or paid out and drawn in",
       Members::path, cable_row_params, add_cable, path_of, true},
      {"gear", "two wheels that mesh: r1 th1 + r2 th2 stays as it is", Members::path, gear_params, add_gear,
       gear_of},
      {"rack", "a pinion that drives a rack: x - r th stays as it is", Members::path, rack_params, add_rack,
       rack_of},
      {"telescope", "stages that share an extension, which is free, held or driven", Members::path,
       telescope_params, add_telescope, path_of},
      {"combination", "a sum of lengths, coordinates and angles is held or driven", Members::terms,
       driven_sum_params, add_combination, terms_of},
  };
  return kinds;
}

}  // namespace unfurl
