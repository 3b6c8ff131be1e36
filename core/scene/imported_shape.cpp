// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/imported_shape.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/scene/size_limits.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

constexpr std::size_t most_plate_nodes = 100;
constexpr double least_length = 1e-100;  // [m]: squares of shorter and much longer ones are 0 or infinite
// Sine of an angle below which three nodes count as in one line, and share of a plate's size by which its
// nodes may be out of one plane (flatten() moves them into it).
constexpr double in_line = 1e-6, out_of_plane = 0.01;

double sine(const Vec3& u, const Vec3& v) {
  const double product = u.norm() * v.norm();
  return product > 0.0 ? u.cross(v).norm() / product : 0.0;
}

// The nodes, begun at that one from which diagonals make the least pointed triangles.
std::vector<int> from_best_apex(const ImportedShape& shape, const std::vector<int>& nodes, double& worst) {
  std::size_t best = 0;
  worst = -1.0;
  const std::size_t n = nodes.size();
  for (std::size_t i = 0; i < n; ++i) {
    double least = 1.0;
    const Vec3& apex = shape.at(nodes[i]);
    for (std::size_t k = 1; k + 1 < n; ++k)
      least =
          std::min(least, sine(shape.at(nodes[(i + k) % n]) - apex, shape.at(nodes[(i + k + 1) % n]) - apex));
    if (least <= worst) continue;
    worst = least;
    best = i;
  }
  std::vector<int> turned = nodes;
  std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(best), turned.end());
  return turned;
}

void require_flat(const ImportedShape& shape, const std::vector<int>& plate, const ImportPlace& place) {
  const Vec3& a = shape.at(plate[0]);
  const Vec3 normal = (shape.at(plate[1]) - a).cross(shape.at(plate[2]) - a).normalized();
  double size = 0.0, off = 0.0;
  for (const int node : plate) {
    size = std::max(size, (shape.at(node) - a).norm());
    off = std::max(off, std::abs(normal.dot(shape.at(node) - a)));
  }
  if (off > out_of_plane * size)
    place.fail("its vertices are " + std::to_string(100 * off / size) +
               " % of its size out of one plane, and a plate is flat (to 1 %); split it into triangles");
}

// Seen along the normal of its first corner with an area: two sides that do not meet at a node have points in
// common.
void require_simple(const ImportedShape& shape, const std::vector<int>& plate, const ImportPlace& place) {
  const std::size_t n = plate.size();
  const auto corner = [&](std::size_t i) -> const Vec3& { return shape.at(plate[i % n]); };
  const Vec3 normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).stableNormalized();
  const auto side = [&](std::size_t i, const Vec3& p) {  // of the line from i to i + 1
    return normal.dot((corner(i + 1) - corner(i)).cross(p - corner(i)));
  };
  const auto parts = [&](std::size_t i, std::size_t k) {  // the ends of k
    const double a = side(i, corner(k)), b = side(i, corner(k + 1));
    return (a > 0 && b < 0) || (a < 0 && b > 0);
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = i + 2; k < n && (k + 1) % n != i; ++k)
      if (parts(i, k) && parts(k, i))
        place.fail("its sides cross each other; name its vertices in the order that goes around it");
}

// Of a plate that goes around from a to b, the node that is furthest from the line of both on the side where
// the plate is: at a notch others lie beyond it.
int furthest(const ImportedShape& shape, const std::vector<int>& plate, int a, int b) {
  const Vec3& from = shape.at(a);
  Vec3 area = Vec3::Zero();
  for (std::size_t i = 0; i < plate.size(); ++i)
    area += (shape.at(plate[i]) - from).cross(shape.at(plate[(i + 1) % plate.size()]) - from);
  const Vec3 inward = area.stableNormalized().cross((shape.at(b) - from).stableNormalized());
  return *std::ranges::max_element(plate, {}, [&](int node) { return inward.dot(shape.at(node) - from); });
}

}  // namespace

void ImportPlace::fail(const std::string& message) const {
  throw SceneError({{where, key, message}});
}

void ImportedShape::add_node(CustomNode node, const ImportPlace& place) {
  if (spec.nodes.size() >= static_cast<std::size_t>(most_custom_nodes))
    place.fail("there are more than " + std::to_string(most_custom_nodes) +
               " vertices, the most that is built");
  const Vec3& x = node.position;
  if (!(x.lpNorm<Eigen::Infinity>() < 1.0 / least_length))
    place.fail("a coordinate must be less than 1e+100 m in size");
  const auto [same, is_new] = places_.try_emplace({x[0], x[1], x[2]}, spec.nodes.size());
  if (!is_new)
    place.fail("lies where " + in_quotes(spec.nodes[same->second].name) +
               " lies already; join the two vertices to one, or move one of them");
  spec.nodes.push_back(std::move(node));
}

std::size_t ImportedShape::add_rod(int a, int b, const std::string& group, const ImportPlace& place) {
  if (a == b)
    place.fail("goes from " + in_quotes(spec.nodes[static_cast<std::size_t>(a)].name) + " to itself");
  const auto low = static_cast<std::uint64_t>(std::min(a, b)),
             high = static_cast<std::uint64_t>(std::max(a, b));
  const auto [found, is_new] = rods_.try_emplace(low << 32U | high, spec.rods.size());
  if (!is_new) return found->second;
  if (!((at(a) - at(b)).stableNorm() > least_length)) place.fail("is shorter than 1e-100 m");
  if (spec.rods.size() >= static_cast<std::size_t>(most_custom_rods))
    place.fail("there are more than " + std::to_string(most_custom_rods) + " edges, the most that is built");
  CustomRod rod;
  for (const int end : {a, b}) rod.nodes.push_back(spec.nodes[static_cast<std::size_t>(end)].name);
  rod.group = group;
  spec.rods.push_back(std::move(rod));
  ends_.push_back({a, b});
  return found->second;
}

void ImportedShape::add_plate(const std::vector<int>& nodes, const std::string& group,
                              const ImportPlace& place) {
  const std::size_t n = nodes.size();
  if (n < 3 || n > most_plate_nodes)
    place.fail("a face has 3 to " + std::to_string(most_plate_nodes) + " vertices; got " + std::to_string(n));
  std::vector<int> sorted = nodes;
  std::ranges::sort(sorted);
  if (std::ranges::adjacent_find(sorted) != sorted.end()) place.fail("names a vertex twice");
  double worst = 0.0;
  plates.push_back(from_best_apex(*this, nodes, worst));
  const std::vector<int>& plate = plates.back();
  if (!(worst > in_line))
    place.fail(
        "has too many vertices in one line for diagonals from one of them to hold it; leave out those " +
        std::string("in the middle of its sides, or split it into triangles"));
  require_flat(*this, plate, place);
  require_simple(*this, plate, place);
  plate_places_.push_back(place);
  for (std::size_t i = 0; i < n; ++i) add_rod(nodes[i], nodes[(i + 1) % n], group, place);
  for (std::size_t i = 2; i + 1 < n; ++i) add_rod(plate[0], plate[i], "diagonal", place);
}

std::vector<ImportedCrease> ImportedShape::creases() const {
  struct Side {
    int plate = -1;
    bool along = false;  // it goes around from the rod's first node to its second
  };
  std::vector<std::vector<Side>> sides(spec.rods.size());
  for (std::size_t p = 0; p < plates.size(); ++p)
    for (std::size_t i = 0; i < plates[p].size(); ++i) {
      const int a = plates[p][i], b = plates[p][(i + 1) % plates[p].size()];
      const auto low = static_cast<std::uint64_t>(std::min(a, b)),
                 high = static_cast<std::uint64_t>(std::max(a, b));
      const std::size_t rod = rods_.at(low << 32U | high);
      sides[rod].push_back({static_cast<int>(p), ends_[rod][0] == a});
    }
  std::vector<ImportedCrease> found;
  for (std::size_t rod = 0; rod < sides.size(); ++rod)
    for (std::size_t k = 1; k < sides[rod].size(); ++k) {
      Side left = sides[rod][0], right = sides[rod][k];
      if (!left.along) std::swap(left, right);
      const std::array<int, 2>& ends = ends_[rod];
      const auto off = [&](const Side& side) {
        return furthest(*this, plates[static_cast<std::size_t>(side.plate)], ends[side.along ? 0 : 1],
                        ends[side.along ? 1 : 0]);
      };
      found.push_back({rod, ends, off(left), off(right), k > 1 ? sides[rod][k].plate : -1});
    }
  return found;
}

}  // namespace unfurl
