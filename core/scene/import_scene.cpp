// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/import_scene.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <string_view>
#include <utility>

#include "core/scene/build.hpp"
#include "core/scene/imported_shape.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/title.hpp"
#include "core/scene/write.hpp"
#include "core/structure/dihedral.hpp"
#include "core/text/name_index.hpp"
#include "core/text/nearest_name.hpp"
#include "core/text/wrapped.hpp"

namespace unfurl {

namespace {

constexpr double assumed_density = 1000.0;  // [kg/m^3]
constexpr double assumed_time = 1.0;        // [s], in which creases fold
constexpr double flat_fold = 1e-3;          // [rad], below which the side of a fold is round-off

std::string remark(std::string_view text) {
  return wrapped(text, 100, "# ", "# ");
}

// Braces are expressions in a scene with variables.
std::string unbraced(std::string text) {
  for (std::size_t at = 0; (at = text.find_first_of("{}", at)) != text.npos; at += 2)
    text.insert(at, 1, text[at]);
  return text;
}

double one_digit(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)));
  return std::round(x / unit) * unit;
}

std::string entry_lines(std::string_view table, std::string_view kind, const std::string& name,
                        const std::string& keys) {
  return "\n[[" + std::string(table) + "]]\nkind = " + toml_string(kind) + "\n" +
         (name.empty() ? "" : "name = " + toml_string(name) + "\n") + keys;
}

std::string digits(double x) {
  return toml_value(x);
}

class SceneOfShape {
 public:
  explicit SceneOfShape(ImportedShape& shape) : shape_(shape), used_(shape.spec.nodes.size()) {
    NameIndex names;
    for (const CustomNode& node : shape_.spec.nodes) names.add(node.name);
    for (const CustomRod& rod : shape_.spec.rods) {
      const auto a = static_cast<std::size_t>(names.find(rod.nodes[0])),
                 b = static_cast<std::size_t>(names.find(rod.nodes[1]));
      used_[a] = used_[b] = true;
      lengths_.push_back((shape_.spec.nodes[b].position - shape_.spec.nodes[a].position).norm());
      weightless_ = weightless_ || is_weightless(rod);
    }
    note_bare_nodes();
    folds_ = folds();
  }

  // The node of the shape that is entry i of the scene.
  std::size_t given_node(std::size_t i) const {
    for (std::size_t node = 0; node < used_.size(); ++node)
      if (kept(node) && i-- == 0) return node;
    return std::string::npos;
  }

  std::string text(bool held) const {
    const std::string body = lists() + plates() + (held ? hold() : "") + folds_;
    const std::string given = variables();
    return head() + given + (given.empty() ? body : unbraced(body)) + "\n[solver]\nend_time = 1.0  # s\n";
  }

 private:
  static bool is_weightless(const CustomRod& rod) {
    return !rod.mass && rod.density == 0.0 && rod.area == 0.0;
  }

  bool kept(std::size_t i) const {
    const CustomNode& node = shape_.spec.nodes[i];
    return used_[i] || node.mass > 0.0 || node.fixed;
  }

  std::string name(int node) const { return shape_.spec.nodes[static_cast<std::size_t>(node)].name; }

  std::string names(const std::vector<int>& nodes) const {
    std::vector<std::string> list;
    for (const int node : nodes) list.push_back(name(node));
    return "nodes = " + toml_value(list) + "\n";
  }

  std::size_t nodes_kept() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < used_.size(); ++i) count += kept(i) ? 1 : 0;
    return count;
  }

  void note_bare_nodes() {
    const std::size_t count = used_.size() - nodes_kept();
    if (count > 0)
      shape_.notes.push_back(std::to_string(count) + " vertices at which no rod ends are left out");
  }

  double mean_length() const {
    return std::reduce(lengths_.begin(), lengths_.end()) / static_cast<double>(lengths_.size());
  }

  std::string head() const {
    const CustomSpec& spec = shape_.spec;
    std::string text = remark(
        "Made by `unfurl import` of " + file_name() + ": " + std::to_string(nodes_kept()) + " nodes, " +
        std::to_string(spec.rods.size()) + " rods, " + std::to_string(shape_.plates.size()) +
        " plates. Units are SI, coordinates in metres; `unfurl list keys` has every key.");
    for (const std::string& note : shape_.notes) text += remark("Note: " + note + ".");
    return text +
           "title = " + toml_string(title_that_says(std::filesystem::path(shape_.file).stem().string())) +
           "\n";
  }

  // A name may hold what a comment may not.
  std::string file_name() const { return in_quotes(std::filesystem::path(shape_.file).filename().string()); }

  std::string variables() const {
    std::string text;
    if (weightless_)
      text +=
          remark("Assumed, for the file does not say what the rods weigh: their density and cross section.") +
          "density = " + digits(assumed_density) + "  # kg/m^3\nsection_area = " + digits(area()) +
          "  # m^2\n";
    if (crease_length_ > 0.0) {
      const double mass = assumed_density * area() * mean_length() * static_cast<double>(lengths_.size());
      const double stiffness = mass * std::pow(mean_length() / assumed_time, 2) / crease_length_;
      text +=
          remark("Assumed: the springs that fold the creases on, and their damping over their stiffness.") +
          "crease_stiffness = " + digits(one_digit(stiffness)) + "  # N m/rad for each metre of a crease\n" +
          "crease_time = " + digits(2 * assumed_time) + "  # s\n";
    }
    return text.empty() ? "" : "\n[variables]\n" + text;
  }

  // Of a rod a hundredth as thick as it is long.
  double area() const { return one_digit(std::pow(0.01 * mean_length(), 2)); }

  std::string lists() const {
    std::string text = "\n[structure]\nkind = \"custom\"\n";
    for (std::size_t i = 0; i < used_.size(); ++i)
      if (kept(i)) text += custom_node_text(shape_.spec.nodes[i]);
    for (const CustomRod& rod : shape_.spec.rods)
      text += custom_rod_text(rod) +
              (is_weightless(rod) ? "density = \"=density\"\narea = \"=section_area\"\n" : "");
    return text;
  }

  std::string plates() const {
    std::string text;
    if (!shape_.plates.empty())
      text +=
          "\n" +
          remark(
              "Every face is a rigid plate: rods along its edges and diagonals from one of its nodes, and "
              "all of its nodes in one plane. Surfaces are for pictures.");
    for (std::size_t p = 0; p < shape_.plates.size(); ++p) {
      const std::string nodes = names(shape_.plates[p]);
      if (shape_.plates[p].size() > 3)
        text += entry_lines("constraints", "coplanar", "plate " + std::to_string(p), nodes);
      text += entry_lines("surfaces", "membrane", "", nodes);
    }
    return text;
  }

  // Three nodes that are not in one line, or two, or one.
  std::vector<int> held_nodes() const {
    if (!shape_.plates.empty()) return {shape_.plates[0].begin(), shape_.plates[0].begin() + 3};
    std::vector<int> found;
    for (std::size_t i = 0; i < used_.size() && found.size() < 3; ++i) {
      const int node = static_cast<int>(i);
      if (!used_[i]) continue;
      if (found.size() == 2) {
        const Vec3 u = shape_.at(found[1]) - shape_.at(found[0]), v = shape_.at(node) - shape_.at(found[0]);
        if (!(u.cross(v).norm() > 1e-6 * u.norm() * v.norm())) continue;
      }
      found.push_back(node);
    }
    return found;
  }

  std::string hold() const {
    if (std::ranges::any_of(shape_.spec.nodes, &CustomNode::fixed)) return "";
    const std::vector<int> held = held_nodes();
    const Vec3 u = (shape_.at(held[1]) - shape_.at(held[0])).normalized();
    const auto vector = [](const Vec3& v) {
      return toml_value(std::vector<double>{v[0], v[1], v[2]}) + "\n";
    };
    std::string text =
        "\n" +
        remark(std::string(shape_.plates.empty() ? "Three nodes are" : "The first face is") +
               " held in space: one node in a point, one on a line, one in a plane, which puts no force "
               "into the structure.") +
        entry_lines("constraints", "fixed", "held point", names({held[0]})).substr(1) +
        entry_lines("constraints", "line", "held line", names({held[1]}) + "direction = " + vector(u));
    if (held.size() < 3) return text;
    const Vec3 normal = u.cross(shape_.at(held[2]) - shape_.at(held[0])).normalized();
    return text +
           entry_lines("constraints", "plane", "held plane", names({held[2]}) + "normal = " + vector(normal));
  }

  // From the half-plane of the first node to that of the last, about the edge [rad].
  double angle_between(const std::vector<int>& nodes) const {
    std::array<double, 12> q{}, gradient{};
    std::vector<int> stencil(12);
    std::iota(stencil.begin(), stencil.end(), 0);
    for (std::size_t k = 0; k < 12; ++k) q[k] = shape_.at(nodes[k / 3])[static_cast<Eigen::Index>(k % 3)];
    return dihedral(q.data(), stencil, gradient.data());
  }

  // Mountains and valleys are springs that fold on, flat edges are held; the others turn freely.
  std::string folds() {
    std::string welded, folded;
    std::size_t flat = 0, contrary = 0, count = 0, further = 0;
    for (const ImportedCrease& crease : shape_.creases()) {
      const std::string& group = shape_.spec.rods[crease.rod].group;
      const bool mountain = group == "mountain";
      const std::string edge = name(crease.ends[0]) + "-" + name(crease.ends[1]);
      const std::vector<int> nodes{crease.left, crease.ends[0], crease.ends[1], crease.right};
      std::string term = "1 dihedral";
      for (const int node : nodes) term += " " + name(node);
      term = "terms = [" + toml_string(term) + "]\n";
      if (group == "flat" || group == "join")
        welded += entry_lines(
            "constraints", "combination",
            group + " " + edge + (crease.further < 0 ? "" : " plate " + std::to_string(crease.further)),
            term);
      if (!mountain && group != "valley") continue;
      further += crease.further < 0 ? 0 : 1;
      if (crease.further >= 0) continue;
      const double angle = angle_between(nodes);
      const bool is_flat = pi - std::abs(angle) < flat_fold;
      ++count;
      flat += is_flat ? 1 : 0;
      contrary += !is_flat && mountain == (angle > 0.0) ? 1 : 0;
      // Folded together is 0. A flat one is half a turn away, on either side: one degree less.
      const double target = !is_flat || mountain != (angle > 0.0) ? 0.0 : mountain ? 359.0 : -359.0;
      const std::string length = digits(lengths_[crease.rod]);
      folded += entry_lines("forces", "combination", group + " " + edge,
                            term + "stiffness = \"=crease_stiffness*" + length +
                                "\"  # N m/rad\ndamping = \"=crease_time*crease_stiffness*" + length +
                                "\"  # N m s/rad\nfree_value = " + digits(target) + "  # deg\n");
      crease_length_ += lengths_[crease.rod];
    }
    note_folds(count, flat, contrary);
    if (further > 0)
      shape_.notes.push_back(
          std::to_string(further) +
          " times a plate is the third or a further one at a mountain or valley, where it turns freely: the "
          "spring is between the first two");
    if (!welded.empty()) welded = "\n" + remark("Edges that do not fold.") + welded.substr(1);
    if (!folded.empty())
      folded = "\n" +
               remark(
                   "Mountains and valleys fold on, towards 0 degrees between their plates. "
                   "Without these springs they are hinges that turn freely.") +
               folded.substr(1);
    return welded + folded;
  }

  void note_folds(std::size_t count, std::size_t flat, std::size_t contrary) {
    if (count > 0 && flat == count)
      shape_.notes.emplace_back(
          "all mountains and valleys are flat, where a pattern can begin to fold in several ways: give it a "
          "little "
          "folded");
    if (contrary > 0)
      shape_.notes.push_back(
          std::to_string(contrary) +
          " mountains or valleys are folded the other way already (faces go counterclockwise, "
          "seen from above): they fold on as they are");
  }

  ImportedShape& shape_;
  std::vector<bool> used_;       // nodes at which rods end
  std::vector<double> lengths_;  // of the rods [m]
  bool weightless_ = false;      // a rod has no mass
  double crease_length_ = 0.0;   // of all with a spring [m]
  std::string folds_;
};

ImportedShape shape_of(const std::vector<TextFile>& files) {
  const TextFile& first = files.front();
  const std::string format = import_format(first.path);
  if (format == "fold") return read_fold(first.text, first.path);
  if (format == "obj") return read_obj(first.text, first.path);
  return read_csv_lists(first, files.back());
}

// Where the entry of "structure.nodes[3]..." of the scene comes from. Nodes that are left out have no entry.
SourceLocation origin_of(const std::string& key, const ImportedShape& shape, const SceneOfShape& scene) {
  const auto entry = [&](std::string_view list) -> std::size_t {
    std::size_t i = std::string::npos;
    if (key.starts_with(list)) std::from_chars(key.data() + list.size(), key.data() + key.size(), i);
    return i;
  };
  if (const std::size_t rod = entry("structure.rods["); rod < shape.rod_places.size())
    return shape.rod_places[rod];
  if (const std::size_t node = scene.given_node(entry("structure.nodes[")); node < shape.node_places.size())
    return shape.node_places[node];
  return {shape.file, 0, 0};
}

// What only the whole tells is said of where it came from; empty: it can be run.
std::vector<SceneProblem> problems_of(const ImportedShape& shape, const SceneOfShape& scene,
                                      const std::string& text) {
  const SourceLocation file{shape.file, 0, 0};
  if (text.size() > max_text_file_bytes)
    return {
        {file, "", "its scene would be larger than " + std::to_string(max_text_file_bytes >> 20U) + " MB"}};
  try {
    build_model(read_scene_text(text, shape.file));
  } catch (const SceneError& error) {
    std::vector<SceneProblem> problems = error.problems();
    for (SceneProblem& problem : problems) problem.where = origin_of(problem.key, shape, scene);
    return problems;
  }
  return {};
}

}  // namespace

std::string import_format(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  for (const char* known : {"fold", "obj", "csv"})
    if (ending == "." + std::string(known)) return known;
  return "";
}

ImportedScene import_scene(const std::vector<TextFile>& files) {
  ImportedShape shape = shape_of(files);
  shape.flatten();
  SceneOfShape scene(shape);
  std::string text = scene.text(true);
  if (const auto problems = problems_of(shape, scene, text); !problems.empty()) {
    shape.notes.emplace_back("held in space nothing of it could move, so that it floats");
    text = scene.text(false);
    if (!problems_of(shape, scene, text).empty()) throw SceneError(problems);
  }
  return {std::move(text), std::move(shape.notes)};
}

}  // namespace unfurl
