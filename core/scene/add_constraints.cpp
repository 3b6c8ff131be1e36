// SPDX-License-Identifier: BSD-3-Clause
// The kinds of [[constraints]]: relations between nodes, with their parameters and what each adds to a
// structure.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/scene/element_members.hpp"

namespace unfurl {

namespace {

template <class Make>
const std::vector<ParamSpec>& once(Make make) {
  static const std::vector<ParamSpec> params = make();
  return params;
}

const std::vector<ParamSpec>& no_params() {
  return once([] { return std::vector<ParamSpec>{}; });
}
const std::vector<ParamSpec>& plane_params() {
  return once([] { return std::vector{direction_param("normal", "of the plane")}; });
}
const std::vector<ParamSpec>& line_params() {
  return once([] { return std::vector{direction_param("direction", "of the line")}; });
}
const std::vector<ParamSpec>& equal_params() {
  return once(
      [] { return std::vector{direction_param("direction", "along which the coordinates are equal")}; });
}
const std::vector<ParamSpec>& mirror_params() {
  return once([] {
    return std::vector{direction_param("normal", "of the mirror plane"),
                       vector_param("point", "m", {0, 0, 0}, "in the mirror plane")};
  });
}
ParamSpec coefficients_param() {
  return required(vector_param("coefficients", "", {}, "three for each node: sum of c . x = value"));
}
const std::vector<ParamSpec>& relation_params() {
  return once([] {
    return std::vector{coefficients_param(),
                       real_param("value", "m", std::numeric_limits<double>::quiet_NaN(),
                                  -std::numeric_limits<double>::infinity(),
                                  std::numeric_limits<double>::infinity(), "by default that at t = 0")};
  });
}

void push(const SceneElement& e, ElementAdder& to, const char* kind, std::vector<int> nodes,
          std::vector<Vec3> vectors, double value, const std::string& suffix = "") {
  to.structure.constraints.push_back(
      {kind, e.name + suffix, std::move(nodes), std::move(vectors), value, {}, {}});
}

// The constraint of the kind's name on every node.
void add_each(const SceneElement& e, ElementAdder& to, const char* key) {
  std::vector<Vec3> vectors;
  if (key) vectors.push_back(to.direction(e, key));
  for (const int node : to.find.nodes(e, true)) {
    const double value = e.kind == "plane" ? vectors[0].dot(to.node(node).position) : 0.0;
    to.structure.constraints.push_back(
        {e.kind, e.kind + " of " + to.node(node).name, {node}, vectors, value, {}, {}});
  }
}
void add_plane(const SceneElement& e, ElementAdder& to) {
  add_each(e, to, "normal");
}
void add_line(const SceneElement& e, ElementAdder& to) {
  add_each(e, to, "direction");
}
void add_fixed(const SceneElement& e, ElementAdder& to) {
  add_each(e, to, nullptr);
}

void add_equal(const SceneElement& e, ElementAdder& to) {
  const auto nodes = to.find.nodes(e, true);
  if (nodes.empty()) return;
  if (nodes.size() < 2) return to.find.problem(e, "nodes", "must be at least two");
  const Vec3 d = to.direction(e, "direction");
  for (std::size_t i = 1; i < nodes.size(); ++i)
    push(e, to, "relation", {nodes[0], nodes[i]}, {-d, d}, 0.0,
         " (" + to.node(nodes[0]).name + ", " + to.node(nodes[i]).name + ")");
}

// x_B = p + (I - 2 n n^T)(x_A - p)
void add_mirror(const SceneElement& e, ElementAdder& to) {
  const auto nodes = to.find.nodes(e, false);
  if (nodes.empty()) return;
  const Vec3 n = to.direction(e, "normal"), offset = 2 * n.dot(vec3(e.values, "point")) * n;
  const Mat3 reflect = Mat3::Identity() - 2 * n * n.transpose();
  for (Index k = 0; k < 3; ++k)
    push(e, to, "relation", nodes, {-reflect.row(k).transpose(), Vec3::Unit(k)}, offset[k],
         std::string(" ") + "xyz"[k]);
}

void add_relation(const SceneElement& e, ElementAdder& to) {
  const auto nodes = to.find.nodes(e, false);
  if (nodes.empty()) return;
  const auto& c = e.values.vector("coefficients");
  if (c.size() != 3 * nodes.size())
    return to.find.problem(e, "coefficients",
                           "must be " + std::to_string(3 * nodes.size()) +
                               " numbers, three for each node; got " + std::to_string(c.size()));
  if (std::ranges::all_of(c, [](double x) { return x == 0.0; }))
    return to.find.problem(e, "coefficients", "must not all be zero: the relation would say nothing");
  std::vector<Vec3> vectors;
  double sum = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    vectors.push_back({c[3 * i], c[3 * i + 1], c[3 * i + 2]});
    sum += vectors.back().dot(to.node(nodes[i]).position);
  }
  const double value = e.values.real("value");
  push(e, to, "relation", nodes, std::move(vectors), std::isnan(value) ? sum : value);
}

void add_aligned(const SceneElement& e, ElementAdder& to, const char* kind, std::size_t base) {
  const auto nodes = to.find.nodes(e, true);
  if (nodes.empty()) return;
  if (nodes.size() <= base)
    return to.find.problem(e, "nodes", "must be at least " + std::to_string(base + 1));
  for (std::size_t i = 0; i < base; ++i)  // of which the line or plane is made
    for (std::size_t k = 0; k < i; ++k)
      if (!to.find.apart(e, "nodes", nodes[k], nodes[i])) return;
  for (std::size_t i = base; i < nodes.size(); ++i) {
    std::vector<int> group(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(base));
    group.push_back(nodes[i]);
    push(e, to, kind, std::move(group), {}, 0.0,
         nodes.size() > base + 1 ? " (" + to.node(nodes[i]).name + ")" : "");
  }
}
void add_collinear(const SceneElement& e, ElementAdder& to) {
  add_aligned(e, to, "collinear", 2);
}
void add_coplanar(const SceneElement& e, ElementAdder& to) {
  add_aligned(e, to, "coplanar", 3);
}

}  // namespace

const std::vector<ElementKind>& scene_constraints() {
  static const std::vector<ElementKind> kinds = [] {
    std::vector<ElementKind> found = {
        {"plane", "keeps nodes in the planes through their positions at t = 0", Members::each_node,
         plane_params, add_plane},
        {"line", "keeps nodes on the lines through their positions at t = 0", Members::each_node, line_params,
         add_line},
        {"fixed", "keeps nodes where they are at t = 0", Members::each_node, no_params, add_fixed},
        {"equal", "nodes share one coordinate", Members::node_list, equal_params, add_equal},
        {"mirror", "the second node is the mirror image of the first", Members::two_nodes, mirror_params,
         add_mirror},
        {"relation", "a linear relation between nodes", Members::node_list, relation_params, add_relation},
        {"collinear", "the third and further nodes stay on the line through the first two",
         Members::node_list, no_params, add_collinear},
        {"coplanar", "the fourth and further nodes stay in the plane through the first three",
         Members::node_list, no_params, add_coplanar},
    };
    for (const auto* more : {&measured_kinds(), &combined_kinds()})
      for (const ElementKind& kind : *more) found.push_back(kind);
    return found;
  }();
  return kinds;
}

}  // namespace unfurl
