// [[constraints]] of a scene into a structure.
#include <Eigen/Geometry>
#include <cmath>
#include <sstream>

#include "core/scene/element_members.hpp"

namespace unfurl {

namespace {

class ConstraintAdder {
 public:
  explicit ConstraintAdder(Structure& structure) : structure_(structure), find_(structure) {}

  void add(const SceneElement& e) {
    if (e.kind == "plane" || e.kind == "line" || e.kind == "fixed") return add_each(e);
    if (e.kind == "angle" || e.kind == "angle_stop") return add_angle(e);
    const auto nodes = find_.nodes(e, e.kind == "equal" || e.kind == "coplanar" || e.kind == "collinear");
    if (nodes.empty()) return;
    if (e.kind == "equal") add_equal(e, nodes);
    if (e.kind == "mirror") add_mirror(e, nodes);
    if (e.kind == "relation") add_relation(e, nodes);
    if (e.kind == "collinear") add_aligned(e, nodes, 2);
    if (e.kind == "coplanar") add_aligned(e, nodes, 3);
    if (e.kind == "length" || e.kind == "length_stop") add_length(e, nodes);
    if (e.kind == "coordinate" || e.kind == "coordinate_stop") add_coordinate(e, nodes);
  }
  void finish() { find_.throw_problems(); }

 private:
  const Vec3& position(int node) const { return structure_.nodes[static_cast<std::size_t>(node)].position; }
  const std::string& name(int node) const { return structure_.nodes[static_cast<std::size_t>(node)].name; }

  // A direction of length 1; zero after a problem was noted.
  Vec3 direction(const SceneElement& e, std::string_view key) {
    const Vec3 d = vec3(e.values, key);
    if (d.stableNorm() > 0) return d.stableNormalized();
    find_.problem(e, std::string(key), "must not be zero");
    return Vec3::Zero();
  }

  void push(const SceneElement& e, const char* kind, std::vector<int> nodes, std::vector<Vec3> vectors,
            double value, const std::string& suffix = "") {
    structure_.constraints.push_back(
        {kind, e.name + suffix, std::move(nodes), std::move(vectors), value, {}, {}});
  }

  void add_each(const SceneElement& e) {
    const char* key = e.kind == "plane" ? "normal" : e.kind == "line" ? "direction" : nullptr;
    const Vec3 d = key ? direction(e, key) : Vec3::Zero();
    for (const int node : find_.nodes(e, true)) {
      std::vector<Vec3> vectors;
      if (key) vectors.push_back(d);
      structure_.constraints.push_back({e.kind,
                                        e.kind + " of " + name(node),
                                        {node},
                                        vectors,
                                        e.kind == "plane" ? d.dot(position(node)) : 0.0,
                                        {},
                                        {}});
    }
  }

  void add_equal(const SceneElement& e, const std::vector<int>& nodes) {
    if (nodes.size() < 2) return find_.problem(e, "nodes", "must be at least two");
    const Vec3 d = direction(e, "direction");
    for (std::size_t i = 1; i < nodes.size(); ++i)
      push(e, "relation", {nodes[0], nodes[i]}, {-d, d}, 0.0,
           " (" + name(nodes[0]) + ", " + name(nodes[i]) + ")");
  }

  // x_B = p + (I - 2 n n^T)(x_A - p)
  void add_mirror(const SceneElement& e, const std::vector<int>& nodes) {
    const Vec3 n = direction(e, "normal"), offset = 2 * n.dot(vec3(e.values, "point")) * n;
    const Mat3 reflect = Mat3::Identity() - 2 * n * n.transpose();
    for (Index k = 0; k < 3; ++k)
      push(e, "relation", nodes, {-reflect.row(k).transpose(), Vec3::Unit(k)}, offset[k],
           std::string(" ") + "xyz"[k]);
  }

  void add_relation(const SceneElement& e, const std::vector<int>& nodes) {
    const auto& c = e.values.vector("coefficients");
    if (c.size() != 3 * nodes.size())
      return find_.problem(e, "coefficients",
                           "must be " + std::to_string(3 * nodes.size()) +
                               " numbers, three for each node; got " + std::to_string(c.size()));
    std::vector<Vec3> vectors;
    double sum = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      vectors.push_back({c[3 * i], c[3 * i + 1], c[3 * i + 2]});
      sum += vectors.back().dot(position(nodes[i]));
    }
    const double value = e.values.real("value");
    push(e, "relation", nodes, std::move(vectors), std::isnan(value) ? sum : value);
  }

  void add_aligned(const SceneElement& e, const std::vector<int>& nodes, std::size_t base) {
    if (nodes.size() <= base)
      return find_.problem(e, "nodes", "must be at least " + std::to_string(base + 1));
    for (std::size_t i = base; i < nodes.size(); ++i) {
      std::vector<int> group(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(base));
      group.push_back(nodes[i]);
      push(e, base == 2 ? "collinear" : "coplanar", std::move(group), {}, 0.0,
           nodes.size() > base + 1 ? " (" + name(nodes[i]) + ")" : "");
    }
  }

  void add_length(const SceneElement& e, const std::vector<int>& nodes) {
    if (nodes[0] == nodes[1]) return find_.problem(e, "nodes", "a length from a node to itself");
    Measure measure;
    measure.nodes = nodes;
    if (find_.initial(measure) == 0.0)
      return find_.problem(e, "nodes", "must not be at the same place at t = 0");
    push_measure(e, measure, 1.0);
  }

  void add_coordinate(const SceneElement& e, const std::vector<int>& nodes) {
    if (nodes.size() > 2) return find_.problem(e, "nodes", "must be one or two");
    Measure measure;
    measure.kind = MeasureKind::coordinate;
    measure.nodes = nodes;
    measure.axis = direction(e, "direction");
    push_measure(e, measure, 1.0);
  }

  void add_angle(const SceneElement& e) {
    Measure measure;
    if (!find_.angle(e, vec3(e.values, "axis"), measure)) return;
    measure.reference = find_.initial(measure);
    const bool is_signed = !measure.axis.isZero(0.0) || measure.kind == MeasureKind::fold;
    if (!is_signed && std::abs(std::sin(measure.reference)) < 1e-6)
      return find_.problem(e, "axis",
                           "is missing: the rods are in line at t = 0, where an angle without an "
                           "axis has no direction to grow in");
    push_measure(e, measure, radians_per_degree);
  }

  // `unit`: of the scene's numbers in those of the measure.
  void push_measure(const SceneElement& e, const Measure& measure, double unit) {
    if (e.values.has("restitution")) return push_stop(e, measure, unit);
    const double initial = find_.initial(measure);
    const ParamSet& v = e.values;
    const std::string& motion = v.text("motion");
    TimeFunction f;
    f.offset = initial;
    f.start = v.real("start");
    if (motion == "rate") {
      f.kind = TimeFunction::Kind::rate;
      f.rate = unit * v.real("rate");
      f.ramp = v.real("ramp");
    } else if (motion == "smooth") {
      f.kind = TimeFunction::Kind::smooth;
      f.rise = unit * v.real("to") - initial;
      f.duration = v.real("duration");
    } else if (motion == "table") {
      std::vector<double> values = v.vector("values");
      for (double& x : values) x *= unit;
      f = make_spline(v.vector("times"), std::move(values));
      check_begin(e, f(0.0), initial, unit);
    }
    structure_.constraints.push_back({"measure", e.name, measure.nodes, {}, 0.0, measure, std::move(f)});
  }

  void push_stop(const SceneElement& e, const Measure& measure, double unit) {
    const double initial = find_.initial(measure), round_off = 1e-9 * std::max(1.0, std::abs(initial));
    Stop stop{.name = e.name, .measure = measure};
    bool given = false;
    for (const int side : {0, 1}) {
      const char* key = side == 0 ? "min" : "max";
      const double limit = unit * e.values.real(key);
      if (std::isnan(limit)) continue;
      given = true;
      (side == 0 ? stop.min : stop.max) = limit;
      if (side == 0 ? initial >= limit - round_off : initial <= limit + round_off) continue;
      std::ostringstream text;
      text << "is passed already at t = 0, where the value is " << initial / unit;
      find_.problem(e, key, text.str());
    }
    if (!given) return find_.problem(e, "min", "is missing, and so is max: a stop needs a limit");
    stop.restitution = e.values.real("restitution");
    stop.rest_speed = unit * e.values.real("rest_speed");
    structure_.stops.push_back(std::move(stop));
  }

  void check_begin(const SceneElement& e, double begin, double initial, double unit) {
    if (std::abs(begin - initial) <= 1e-9 * std::max(1.0, std::abs(initial))) return;
    std::ostringstream text;
    text.precision(15);
    text << "the table is at " << begin / unit << " when t = 0, the structure at " << initial / unit
         << ": they must agree";
    find_.problem(e, "values", text.str());
  }

  Structure& structure_;
  MemberFinder find_;
};

}  // namespace

void add_constraints(const std::vector<SceneElement>& elements, Structure& structure) {
  if (elements.empty()) return;
  ConstraintAdder adder(structure);
  for (const SceneElement& element : elements)
    if (element.enabled) adder.add(element);
  adder.finish();
}

}  // namespace unfurl
