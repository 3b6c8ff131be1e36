// [[forces]] of a scene into a structure.
#include <cmath>

#include "core/scene/element_members.hpp"

namespace unfurl {

namespace {

// The factor over time, 1 where no table is given.
TimeFunction factor(const ParamSet& values, double size) {
  TimeFunction f;
  f.offset = size;
  if (values.vector("times").empty()) return f;
  f.kind = TimeFunction::Kind::linear;
  f.offset = 0;
  f.times = values.vector("times");
  f.values = values.vector("values");
  for (double& x : f.values) x *= size;
  return f;
}

class ForceAdder {
 public:
  explicit ForceAdder(Structure& structure) : structure_(structure), find_(structure) {}

  void add(const SceneElement& e) {
    if (e.kind == "load_over_time")
      add_loads(e);
    else if (e.kind == "follower")
      add_follower(e);
    else if (e.kind == "spring" || e.kind == "torsion_spring")
      add_spring(e);
    else
      for (const int node : find_.nodes(e, true)) {
        Force& f = append(e);
        f.nodes = {node};
        f.damping = e.values.real("damping");
      }
  }
  void finish() { find_.throw_problems(); }

 private:
  Force& append(const SceneElement& e) {
    structure_.forces.push_back({});
    structure_.forces.back().kind = e.kind;
    structure_.forces.back().name = e.name;
    return structure_.forces.back();
  }

  void add_loads(const SceneElement& e) {
    for (const int node : find_.nodes(e, true)) {
      Force& f = append(e);
      f.nodes = {node};
      f.direction = vec3(e.values, "force");
      f.size = factor(e.values, 1.0);
    }
  }

  void add_follower(const SceneElement& e) {
    const Rod* rod = find_.rod(e, 0);
    if (!rod) return;
    Force& f = append(e);
    f.nodes = {rod->a, rod->b};
    f.size = factor(e.values, e.values.real("force"));
  }

  void add_spring(const SceneElement& e) {
    const bool axial = e.kind == "spring";
    Measure measure;
    if (axial) {
      measure.nodes = find_.nodes(e, false);
      if (measure.nodes.size() != 2) return;
      if (measure.nodes[0] == measure.nodes[1])
        return find_.problem(e, "nodes", "a spring from a node to itself");
    } else if (!find_.angle(e, vec3(e.values, "axis"), measure)) {
      return;
    }
    double rest = e.values.real(axial ? "free_length" : "free_angle");
    if (!axial) rest *= radians_per_degree;
    if (!std::isnan(rest)) measure.reference = rest;
    if (std::isnan(rest)) rest = measure.reference = find_.initial(measure);
    Force& f = append(e);
    f.stiffness = e.values.real("stiffness");
    f.damping = e.values.real("damping");
    f.rest = rest;
    f.one_sided = axial && e.values.boolean("tension_only");
    f.measure = std::move(measure);
  }

  Structure& structure_;
  MemberFinder find_;
};

}  // namespace

void add_forces(const std::vector<SceneElement>& elements, Structure& structure) {
  if (elements.empty()) return;
  ForceAdder adder(structure);
  for (const SceneElement& element : elements)
    if (element.enabled) adder.add(element);
  adder.finish();
}

}  // namespace unfurl
