// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/skins.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace unfurl {
namespace {

constexpr int rings = 10, around = 48;  // of a fan: parts from its middle to its edge, and along its edge
constexpr int quad_parts = 8;           // of a panel, each way

struct Coat {
  Weave weave;
  Color front, back;
  float opacity;
};

Coat coat_of(const SceneSurface& s) {
  constexpr Color gold{0.86f, 0.70f, 0.42f, 1};
  if (s.kind == "net") return {Weave::net, gold, gold, 0.0f};
  if (s.kind == "membrane") return {Weave::film, {0.86f, 0.87f, 0.88f, 1}, {0.90f, 0.68f, 0.26f, 1}, 0.97f};
  if (s.kind == "solar_panel")
    return {Weave::cells, {0.07f, 0.11f, 0.26f, 1}, {0.86f, 0.86f, 0.84f, 1}, 1.0f};
  return {Weave::mesh, gold, gold, 0.34f};
}

Vec3 middle_of(const std::vector<Vec3>& edge) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : edge) middle += p / static_cast<double>(edge.size());
  return middle;
}

double diameter_of(const std::vector<Vec3>& edge, const Vec3& middle) {
  double diameter = 0;
  for (const Vec3& p : edge) diameter += 2 * (p - middle).norm() / static_cast<double>(edge.size());
  return diameter;
}

// Area vector of a polygon around its middle.
Vec3 area_of(const std::vector<Vec3>& edge, const Vec3& middle) {
  Vec3 area = Vec3::Zero();
  for (std::size_t i = 0; i < edge.size(); ++i)
    area += 0.5 * (edge[i] - middle).cross(edge[(i + 1) % edge.size()] - middle);
  return area;
}

void add(Skin& skin, const Vec3& at, double u, double v) {
  skin.vertices.push_back({at.cast<float>(), Vec3f::Zero(), {static_cast<float>(u), static_cast<float>(v)}});
}

// Two triangles; the corners go around.
void add_quad(Skin& skin, int a, int b, int c, int d) {
  for (const int i : {a, b, c, a, c, d}) skin.triangles.push_back(static_cast<std::uint32_t>(i));
}

void fan(Skin& skin, const std::vector<Vec3>& edge, const Vec3& middle, const Vec3& down, int cells) {
  const int n = static_cast<int>(edge.size()), parts = std::max(1, around / n), turn = n * parts;
  for (int r = 0; r <= rings; ++r)
    for (int k = 0; k < turn; ++k) {
      const double s = static_cast<double>(r) / rings, u = static_cast<double>(k % parts) / parts;
      const auto i = static_cast<std::size_t>(k / parts), j = (i + 1) % edge.size();
      const Vec3 rim = (1 - u) * edge[i] + u * edge[j];
      // Its place on a regular polygon: where the net was laid out.
      const double p = 2 * pi * static_cast<double>(i) / n, q = 2 * pi * static_cast<double>(i + 1) / n;
      const double x = (1 - u) * std::cos(p) + u * std::cos(q), y = (1 - u) * std::sin(p) + u * std::sin(q);
      add(skin, middle + s * (rim - middle) + (1 - s * s) * down, 0.5 * cells * s * x, 0.5 * cells * s * y);
    }
  for (int r = 0; r < rings; ++r)
    for (int k = 0; k < turn; ++k) {
      const int a = r * turn + k, b = r * turn + (k + 1) % turn;
      add_quad(skin, a, a + turn, b + turn, b);
    }
}

// As many whole cells along the shorter side as make them about square.
void quad(Skin& skin, const std::vector<Vec3>& e, int cells) {
  const double along = 0.5 * ((e[1] - e[0]).norm() + (e[2] - e[3]).norm()),
               across = 0.5 * ((e[3] - e[0]).norm() + (e[2] - e[1]).norm()),
               longest = std::max(along, across);
  const double cells_u = longest > 0 ? std::max(1.0, std::round(cells * along / longest)) : cells,
               cells_v = longest > 0 ? std::max(1.0, std::round(cells * across / longest)) : cells;
  for (int i = 0; i <= quad_parts; ++i)
    for (int k = 0; k <= quad_parts; ++k) {
      const double v = static_cast<double>(i) / quad_parts, u = static_cast<double>(k) / quad_parts;
      add(skin, (1 - v) * ((1 - u) * e[0] + u * e[1]) + v * ((1 - u) * e[3] + u * e[2]), u * cells_u,
          v * cells_v);
    }
  for (int i = 0; i < quad_parts; ++i)
    for (int k = 0; k < quad_parts; ++k) {
      const int a = i * (quad_parts + 1) + k;
      add_quad(skin, a, a + 1, a + quad_parts + 2, a + quad_parts + 1);
    }
}

double turn_at(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& up) {
  return up.dot((b - a).cross(c - a));
}

// Whether lines from the middle to the edge leave what is within it: it is about flat (what is folded up
// has no inside), and some of its edge goes around the middle the other way.
bool has_notch(const std::vector<Vec3>& edge, const Vec3& middle, const Vec3& area, double diameter) {
  constexpr double flat = 0.05, round_off = 1e-9;
  if (!(area.norm() > round_off * diameter * diameter)) return false;
  const Vec3 up = area.normalized();
  bool back = false;
  for (std::size_t i = 0; i < edge.size(); ++i) {
    const Vec3 &p = edge[i], &q = edge[(i + 1) % edge.size()], &next = edge[(i + 2) % edge.size()];
    if (std::abs(up.dot(p - middle)) > flat * diameter) return false;
    // Of four nodes opposite edges are joined instead, which a corner to within is enough to spoil.
    const double turn = edge.size() == 4 ? turn_at(p, q, next, up) : turn_at(middle, p, q, up);
    back = back || turn < -round_off * diameter * diameter;
  }
  return back;
}

// Triangles between its nodes alone, each cut from the edge that is left (G. H. Meisters, Amer. Math. Monthly
// 82, 1975): of all corners without a node in them that whose least angle is widest. Empty: it crosses
// itself.
std::vector<int> clipped_ears(const std::vector<Vec3>& edge, const Vec3& up) {
  constexpr double in_line = 1e-9, no_ear = -1;
  std::vector<int> left(edge.size()), triangles;
  for (std::size_t i = 0; i < edge.size(); ++i) left[i] = static_cast<int>(i);
  const auto at = [&](int i) -> const Vec3& { return edge[static_cast<std::size_t>(i)]; };
  const auto quality = [&](int a, int b, int c) {
    const double turn = turn_at(at(a), at(b), at(c), up), sides = (at(b) - at(a)).squaredNorm() +
                                                                  (at(c) - at(b)).squaredNorm() +
                                                                  (at(a) - at(c)).squaredNorm();
    if (std::abs(turn) <= in_line * sides) return 0.0;
    if (turn < 0) return no_ear;
    for (const int i : left)
      if (i != a && i != b && i != c && turn_at(at(a), at(b), at(i), up) >= 0 &&
          turn_at(at(b), at(c), at(i), up) >= 0 && turn_at(at(c), at(a), at(i), up) >= 0)
        return no_ear;
    return turn / sides;
  };
  // What keeps a corner from being an ear is a node with more than half a turn, which no cut takes away, or
  // one on its triangle's edge: both neighbours of what is cut off are judged anew, and all where none is
  // left.
  std::vector<double> found(left.size());
  const auto judge = [&](std::size_t k) {
    const std::size_t n = left.size();
    found[k % n] = quality(left[(k + n - 1) % n], left[k % n], left[(k + 1) % n]);
  };
  const auto judge_all = [&] {
    for (std::size_t k = 0; k < left.size(); ++k) judge(k);
  };
  const auto most = [&] { return static_cast<std::size_t>(std::ranges::max_element(found) - found.begin()); };
  judge_all();
  while (left.size() >= 3) {
    const std::size_t n = left.size();
    std::size_t best = most();
    if (!(found[best] > no_ear)) {
      judge_all();
      best = most();
      if (!(found[best] > no_ear)) return {};
    }
    for (const std::size_t k : {best + n - 1, best, best + 1}) triangles.push_back(left[k % n]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
    found.erase(found.begin() + static_cast<std::ptrdiff_t>(best));
    judge(best + left.size() - 1);
    judge(best);
  }
  return triangles;
}

// Cells are squares of the plane, so many along the diameter.
void cut_up(Skin& skin, const std::vector<int>& cut, const std::vector<Vec3>& edge, const Vec3& middle,
            const Vec3& area, double diameter, int cells) {
  const Vec3 across = (edge[1] - edge[0]).stableNormalized(), along = area.cross(across).stableNormalized();
  const double cell = diameter > 0 ? diameter / cells : 1.0;
  for (const Vec3& p : edge) add(skin, p, across.dot(p - middle) / cell, along.dot(p - middle) / cell);
  for (const int i : cut) skin.triangles.push_back(static_cast<std::uint32_t>(i));
}

// The mean of the triangles around each vertex.
void find_normals(Skin& skin) {
  for (std::size_t i = 0; i + 2 < skin.triangles.size(); i += 3) {
    auto &a = skin.vertices[skin.triangles[i]], &b = skin.vertices[skin.triangles[i + 1]],
         &c = skin.vertices[skin.triangles[i + 2]];
    const Vec3f area = (b.at - a.at).cross(c.at - a.at);
    a.normal += area, b.normal += area, c.normal += area;
  }
  for (SkinVertex& v : skin.vertices)
    v.normal = v.normal.norm() > 0 ? Vec3f(v.normal.normalized()) : Vec3f(0, 0, 1);
}

}  // namespace

SkinPlan plan_of(const SceneSurface& surface, const std::vector<Vec3>& first, const std::vector<Vec3>& last) {
  const bool folded = area_of(last, middle_of(last)).norm() < 0.5 * area_of(first, middle_of(first)).norm();
  std::vector<Vec3> edge = folded ? first : last;
  const Vec3 middle = middle_of(edge), seen = area_of(edge, middle);
  SkinPlan plan;
  plan.turned = seen.z() < -0.05 * seen.norm();
  if (plan.turned) std::ranges::reverse(edge);
  const Vec3 area = area_of(edge, middle);
  if (surface.shape == "flat" && has_notch(edge, middle, area, diameter_of(edge, middle)))
    plan.cut = clipped_ears(edge, area.normalized());
  return plan;
}

Skin skin_of(const SceneSurface& surface, const std::vector<Vec3>& given, const SkinPlan& plan) {
  Skin skin;
  const Coat coat = coat_of(surface);
  skin.weave = coat.weave, skin.front = coat.front, skin.back = coat.back;
  skin.opacity = surface.opacity > 0 ? static_cast<float>(surface.opacity) : coat.opacity;
  if (given.size() < 3) return skin;
  std::vector<Vec3> edge = given;
  if (plan.turned) std::ranges::reverse(edge);
  const Vec3 middle = middle_of(edge), area = area_of(edge, middle);
  const double diameter = diameter_of(edge, middle);
  Vec3 down = Vec3::Zero();
  if (surface.shape == "paraboloid" && area.norm() > 0)
    down = -diameter / (16 * surface.focal_ratio) * area.normalized();
  skin.square = edge.size() == 4 || !plan.cut.empty();
  if (!plan.cut.empty())
    cut_up(skin, plan.cut, edge, middle, area, diameter, surface.cells);
  else if (edge.size() == 4 && surface.shape == "flat")
    quad(skin, edge, surface.cells);
  else
    fan(skin, edge, middle, down, surface.cells);
  find_normals(skin);
  return skin;
}

}  // namespace unfurl
