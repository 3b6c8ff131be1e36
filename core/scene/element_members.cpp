#include "core/scene/element_members.hpp"

#include <limits>

#include "core/model/measure.hpp"
#include "core/model/nearest_name.hpp"

namespace unfurl {

MemberFinder::MemberFinder(const Structure& structure)
    : structure_(structure), start_(3 * static_cast<Index>(structure.nodes.size())) {
  for (const Node& node : structure.nodes) node_names_.add(node.name);
  for (const Rod& rod : structure.rods) rod_names_.add(rod.name);
  for (std::size_t i = 0; i < structure.nodes.size(); ++i)
    start_.segment<3>(3 * static_cast<Index>(i)) = structure.nodes[i].position;
}

void MemberFinder::problem(const SceneElement& element, const std::string& key, std::string message) {
  problems_.push_back(
      {element.where, key.empty() ? element.key : element.key + "." + key, std::move(message)});
}

void MemberFinder::throw_problems() {
  if (!problems_.empty()) throw SceneError(std::move(problems_));
}

std::vector<int> MemberFinder::nodes(const SceneElement& element, bool globs) {
  std::vector<int> found;
  bool good = true;
  for (const auto& name : element.nodes) {
    const int one = node_names_.find(name);
    const auto matches = globs ? node_names_.matching(name) : one < 0 ? std::vector<int>{} : std::vector{one};
    found.insert(found.end(), matches.begin(), matches.end());
    if (!matches.empty()) continue;
    problem(element, "nodes",
            "there is no node " + in_quotes(name) + did_you_mean(name, node_names_.names()));
    good = false;
  }
  return good ? found : std::vector<int>{};
}

const Rod* MemberFinder::rod(const SceneElement& element, std::size_t index) {
  const std::string& name = element.rods[index];
  const int found = rod_names_.find(name);
  if (found >= 0) return &structure_.rods[static_cast<std::size_t>(found)];
  problem(element, "rods", "there is no rod " + in_quotes(name) + did_you_mean(name, rod_names_.names()));
  return nullptr;
}

double MemberFinder::initial(const Measure& measure) const {
  return MeasureFunction(measure, structure_.deployment).value(start_.data());
}

// Two rods that share a node open at it; others are taken from their first node to their second.
bool MemberFinder::angle(const SceneElement& element, const Vec3& axis, Measure& measure) {
  measure.kind = MeasureKind::angle;
  measure.axis = axis.isZero(0.0) ? axis : Vec3(axis.stableNormalized());
  if (element.fold_angle) {
    measure.kind = MeasureKind::fold;
    if (!structure_.deployment.empty()) return true;
    problem(element, "fold_angle", "this structure has no fold angle; name rods or nodes");
    return false;
  }
  if (!element.nodes.empty()) {
    const auto found = nodes(element, false);
    if (found.size() != 3) return false;
    measure.nodes = {found[1], found[0], found[1], found[2]};
  } else {
    const Rod *r = rod(element, 0), *s = rod(element, 1);
    if (!r || !s) return false;
    measure.nodes = {r->a, r->b, s->a, s->b};
    const bool from_end = r->b == s->a || r->b == s->b;
    if (from_end) std::swap(measure.nodes[0], measure.nodes[1]);
    if (measure.nodes[0] == s->b) std::swap(measure.nodes[2], measure.nodes[3]);
  }
  if (measure.nodes[0] == measure.nodes[1] || measure.nodes[2] == measure.nodes[3]) {
    problem(element, "nodes", "an angle needs three different nodes");
    return false;
  }
  return true;
}

double start_value(const SceneElement& element, const Structure& structure) {
  const auto of = [&](const Measure& measure) {
    const double value = MemberFinder(structure).initial(measure);
    return measure.kind == MeasureKind::angle || measure.kind == MeasureKind::fold
               ? value / radians_per_degree
               : value;
  };
  if (element.key.starts_with("forces")) {
    for (const Force& f : structure.forces)
      if (f.name == element.name && (f.kind == "spring" || f.kind == "torsion_spring")) return of(f.measure);
  } else {
    for (const Constraint& c : structure.constraints)
      if (c.name == element.name && c.kind == "measure") return of(c.measure);
    for (const Stop& stop : structure.stops)
      if (stop.name == element.name) return of(stop.measure);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace unfurl
