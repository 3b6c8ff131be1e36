// SPDX-License-Identifier: BSD-3-Clause
// What is in a file of another program (import_scene.hpp): nodes, rods, and plates that rods hold rigid.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/scene/scene_error.hpp"
#include "core/structures/custom.hpp"

namespace unfurl {

// Where something stands: "edges_vertices[3]" of a file, or a line of it.
struct ImportPlace {
  SourceLocation where;
  std::string key;

  [[noreturn]] void fail(const std::string& message) const;  // throws SceneError
};

// A rod along an edge of two plates.
struct ImportedCrease {
  std::size_t rod;
  std::array<int, 2> ends;
  int left, right;   // nodes of both plates, off the edge; the left one goes around from end 0 to end 1
  int further = -1;  // the plate, where two meet there already
};

struct ImportedShape {
  std::string file;
  CustomSpec spec;
  std::vector<std::vector<int>> plates;  // nodes around the edge, the first three not in one line
  // Lines of nodes and rods, where they have some.
  std::vector<SourceLocation> node_places, rod_places;
  std::vector<std::string> notes;  // what a person should know of how it was read

  // These fail where the place holds what nothing can be built of.
  void add_node(CustomNode node, const ImportPlace& place);
  // The rod between two nodes that are there: a new one of the group, or that which joins them already.
  std::size_t add_rod(int a, int b, const std::string& group, const ImportPlace& place);
  // A rigid plate of n nodes: rods along its edges, of `group` where they are new, and n - 3 diagonals from
  // one of the nodes; with n - 3 times "in one plane" that is 3 n - 6, as many as a rigid body's shape takes.
  void add_plate(const std::vector<int>& nodes, const std::string& group, const ImportPlace& place);
  // Moves nodes as little as puts those of every plate into one plane, and notes how far; fails at the plate
  // that is least flat where that takes more than small moves. For once all plates are there.
  void flatten();
  // Of every rod between two plates; where more meet, of the first one with each of the others.
  std::vector<ImportedCrease> creases() const;

  const Vec3& at(int node) const { return spec.nodes[static_cast<std::size_t>(node)].position; }

 private:
  std::vector<ImportPlace> plate_places_;
  std::map<std::array<double, 3>, std::size_t> places_;
  std::unordered_map<std::uint64_t, std::size_t> rods_;  // by both ends, the lower one first
  std::vector<std::array<int, 2>> ends_;
};

// The readers. They throw SceneError, with the place and what is allowed there.
ImportedShape read_fold(const std::string& text, const std::string& file);
ImportedShape read_obj(const std::string& text, const std::string& file);
struct TextFile;
ImportedShape read_csv_lists(const TextFile& nodes, const TextFile& rods);

}  // namespace unfurl
