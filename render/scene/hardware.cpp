// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/hardware.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <string>
#include <string_view>

#include "core/structure/seams.hpp"
#include "core/text/name_index.hpp"

namespace unfurl {
namespace {

// Lengths in radii of the rod.
constexpr double fitting_reach = 6.5, lug_reach = 3.6, lug_width = 1.18, lug_thickness = 0.32,
                 layer_gap = 0.82;
constexpr double fitting_radius = 1.30, pin_radius = 0.62, side_gap = 1.12, support_height = 4.2;

Vec3f f(const Vec3& v) {
  return v.cast<float>();
}

// Rods that stand for what pulls only are drawn as what they stand for: a word of the group's name, or the
// end of one ("frontnet"; of "properties" it means nothing), says so.
bool is_cable(const std::string& group) {
  constexpr std::string_view ends[] = {"cable", "cord", "net"};
  constexpr std::string_view others[] = {"magnet",  "cabinet", "planet", "bonnet",
                                         "bayonet", "garnet",  "record"};
  std::string word;
  const auto is_one = [&] {
    if (word.ends_with('s')) word.pop_back();
    const auto ends_as = [&](std::string_view end) { return word.ends_with(end); };
    return word == "tie" || (std::ranges::any_of(ends, ends_as) && std::ranges::none_of(others, ends_as));
  };
  for (const char c : group) {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      continue;
    }
    if (is_one()) return true;
    word.clear();
  }
  return is_one();
}

struct Material {
  std::string_view name;
  Color color;  // transparent: the group's
  Finish finish;
};
constexpr Material materials[] = {{"anodised", {0, 0, 0, 0}, Finish::anodised},
                                  {"paint", {0, 0, 0, 0}, Finish::paint},
                                  {"cfrp", {0.115f, 0.12f, 0.13f, 1}, Finish::carbon},
                                  {"aluminium", {0.80f, 0.81f, 0.83f, 1}, Finish::metal},
                                  {"steel", {0.52f, 0.54f, 0.57f, 1}, Finish::metal},
                                  {"gold", {0.95f, 0.72f, 0.26f, 1}, Finish::foil}};

}  // namespace

std::pair<Color, Finish> coat_of_material(const std::string& name) {
  const auto* found = std::ranges::find(materials, name, &Material::name);
  const Material& material = found == std::end(materials) ? materials[0] : *found;
  return {material.color, material.finish};
}

std::string material_for(const RenderOptions& options, const std::string& group) {
  std::string material = options.material;
  for (const GroupMaterial& entry : options.materials)
    if (glob_match(entry.group, group)) material = entry.material;
  return material;
}

Hardware::Hardware(const Structure& structure, const Appearance& looks, const Look& look,
                   const RenderOptions& options, std::unique_ptr<const Joints> joints,
                   const std::vector<std::vector<Vec3>>& poses, const Mat3& upright, bool detailed)
    : structure_(structure),
      looks_(looks),
      look_(look),
      options_(options),
      joints_(std::move(joints)),
      upright_(upright),
      detailed_(detailed),
      seams_(seams(structure)),
      support_(structure.node_copies.size(), Vec3::Zero()),
      copy_of_(structure.nodes.size(), -1) {
  for (const RodCopy& rod : structure_.rod_copies)
    cables_.push_back(is_cable(structure_.rods[static_cast<std::size_t>(rod.source)].group));
  for (const std::string& group : looks_.groups) materials_.push_back(material_for(options_, group));
  for (std::size_t i = structure_.node_copies.size(); i-- > 0;)
    copy_of_[static_cast<std::size_t>(structure_.node_copies[i].source)] = static_cast<int>(i);
  find_drives(poses);
  if (detailed_) find_supports(poses);
}

// The side of a node towards which no rod ever points: the wanted one, or the other end of that line, or
// along the axis that a rod turns around, first away from where cameras stand. Unit vectors.
Vec3 Hardware::free_side(int node, const Vec3& wanted, const Poses& poses) const {
  constexpr double plate_half_angle = 0.69;  // cosine: as wide as the plate is seen from the node
  const Vec3 away(-0.47, 0.88, 0);
  const auto& ends = joints_->ends(node);
  const auto along = [&](const RodEnd& end, const std::vector<Vec3>& pose) {
    const RodCopy& rod = structure_.rod_copies[static_cast<std::size_t>(end.rod)];
    const Vec3 d = pose[static_cast<std::size_t>(rod.b)] - pose[static_cast<std::size_t>(rod.a)];
    return d.norm() > 0 ? Vec3((end.end == 0 ? 1.0 : -1.0) * d.normalized()) : Vec3(Vec3::Zero());
  };
  std::vector<Vec3> sides{wanted, -wanted};
  Vec3 axis = Vec3::Zero();
  for (std::size_t k = 1; !ends.empty() && k < poses.size(); ++k) {
    const Vec3 turn = along(ends.front(), poses[k - 1]).cross(along(ends.front(), poses[k]));
    axis += axis.dot(turn) < 0 ? Vec3(-turn) : turn;
  }
  if (axis.norm() > 1e-6) {
    axis *= (axis.dot(away) < 0 ? -1.0 : 1.0) / axis.norm();
    sides.insert(sides.end(), {axis, -axis});
  }
  Vec3 best = wanted;
  double least = 2;
  for (const Vec3& side : sides) {
    double nearest = -1;  // largest cosine to a rod
    for (const auto& pose : poses)
      for (const RodEnd& end : ends) nearest = std::max(nearest, side.dot(along(end, pose)));
    if (nearest < plate_half_angle) return side;
    if (nearest < least) least = nearest, best = side;
  }
  return best;
}

// Below what is held, or above it where the structure begins to hang from there; where its rods pass both, on
// a bracket beside it.
void Hardware::find_supports(const Poses& poses) {
  std::vector<double> height;
  for (const NodeCopy& copy : structure_.node_copies) {
    const Vec3& x = structure_.nodes[static_cast<std::size_t>(copy.source)].position;
    height.push_back((upright_ * (copy.map * x + copy.offset)).z());
  }
  if (height.empty()) return;
  const auto [low, high] = std::ranges::minmax(height);
  double middle = 0;
  for (const double z : height) middle += z / static_cast<double>(height.size());
  const double size = std::max(high - low, 1e-9);
  const double hangs_above = structure_.gravity.isZero() ? middle + 0.3 * size : middle - 0.02 * size;
  for (std::size_t n = 0; n < support_.size(); ++n) {
    if (!looks_.fixed[n] || looks_.joint_radius[n] <= 0 || (looks_.bare[n] && pulley(n))) continue;
    const double reach = support_height / 1.75 * looks_.joint_radius[n];
    const Vec3 wanted = (height[n] >= hangs_above ? 1.0 : -1.0) * Vec3::UnitZ();
    support_[n] = reach * free_side(static_cast<int>(n), wanted, poses);
    if (support_[n].z() < 0.5 * reach) support_depth_ = std::max(support_depth_, 1.2 * reach);
  }
}

double Hardware::radius(std::size_t rod) const {
  return looks_.rod_radius[static_cast<std::size_t>(structure_.rod_copies[rod].source)] *
         (cables_[rod] ? 0.4 : 1.0);
}

Color Hardware::group_color(std::size_t group) const {
  return look_.group(group);
}

RodCoat Hardware::coat(int group, const Color* field) const {
  const auto index = static_cast<std::size_t>(group);
  const Color own = look_.group(index);
  // What a colour stands for must not be tinted by metal's reflections, nor be left out of a line drawing.
  if (field) return {*field, look_.fitting, Finish::paint, Finish::metal};
  const auto [color, finish] = coat_of_material(materials_.empty() ? options_.material : materials_[index]);
  if (color.a == 0) return {own, look_.fitting, finish, Finish::metal};
  return {color, own, finish, Finish::anodised};  // the fittings tell the group
}

bool Hardware::pulley(std::size_t node) const {
  return std::ranges::any_of(pulleys_, [node](const Triple& p) { return p[1] == static_cast<int>(node); });
}

bool Hardware::seam(const RodEnd& end) const {
  const RodCopy& rod = structure_.rod_copies[static_cast<std::size_t>(end.rod)];
  return seams_[static_cast<std::size_t>(end.end == 0 ? rod.a : rod.b)];
}

double Hardware::whole_length(std::size_t rod, double length) const {
  return length * structure_.rods[static_cast<std::size_t>(structure_.rod_copies[rod].source)].parts;
}

Vec3 Hardware::offset(std::size_t rod, double t) const {
  if (!detailed_) return Vec3::Zero();
  return side_gap * radius(rod) * joints_->side(static_cast<int>(rod), t);
}

Vec3 Hardware::axis_of(const RodEnd& end, double t, const Vec3& along) const {
  const Vec3 axis = joints_->axis(end, t), rest = axis - along * along.dot(axis);
  return rest.norm() > 1e-6 ? Vec3(rest.normalized()) : Vec3(Vec3::Zero());
}

// How far from its joint a tube begins: inside its fitting, off the lug.
double Hardware::trimmed(const RodEnd& end, double length) const {
  const auto i = static_cast<std::size_t>(end.rod);
  const RodCopy& rod = structure_.rod_copies[i];
  const JointKind kind = joints_->kind(end.end == 0 ? rod.a : rod.b);
  if (!detailed_ || kind == JointKind::ball || cable(i) || seam(end)) return 0;
  return std::min({0.8 * lug_reach * radius(i), 0.11 * whole_length(i, length), 0.9 * length});
}

void Hardware::add_end(const RodEnd& end, double t, const Vec3& node, const Vec3& along, double length,
                       const RodCoat& coat, DrawList& list) const {
  const auto i = static_cast<std::size_t>(end.rod);
  const double r = radius(i), fitted = std::min(fitting_reach * r, 0.2 * whole_length(i, length)),
               cut = trimmed(end, length);
  list.sleeves.push_back({f(node + 0.7 * cut * along), f(node + fitted * along),
                          static_cast<float>(fitting_radius * r), coat.fitting, coat.fitting_finish});
  if (cut <= 0) return;
  const Vec3 axis = axis_of(end, t, along);
  if (axis.isZero()) return;
  const int layer = joints_->layer(end);
  const auto lug = [&](double shift) {
    const Vec3 p = node + shift * axis;
    list.plates.push_back({f(p), f(p + cut * along), f(axis), static_cast<float>(lug_width * r),
                           static_cast<float>(lug_thickness * r), coat.fitting, coat.fitting_finish});
  };
  if (layer == 0) return lug(0);
  for (const double sign : {-1.0, 1.0}) lug(sign * layer * layer_gap * r);
}

void Hardware::add_rod(std::size_t i, double t, const std::vector<Vec3>& at, const Color* field,
                       DrawList& list) const {
  const RodCopy& rod = structure_.rod_copies[i];
  const Vec3 aside = offset(i, t), a = at[static_cast<std::size_t>(rod.a)] + aside,
             b = at[static_cast<std::size_t>(rod.b)] + aside;
  const double length = (b - a).norm();
  const RodCoat coat = this->coat(looks_.rod_group[static_cast<std::size_t>(rod.source)], field);
  const auto thick = static_cast<float>(radius(i));
  if (length <= 0) {
    list.tubes.push_back({f(a), f(b), thick, coat.rod, coat.rod_finish});
    return;
  }
  const Vec3 along = (b - a) / length;
  const RodEnd ends[] = {{static_cast<int>(i), 0}, {static_cast<int>(i), 1}};
  list.tubes.push_back({f(a + trimmed(ends[0], length) * along), f(b - trimmed(ends[1], length) * along),
                        thick, coat.rod, coat.rod_finish});
  if (cable(i)) return;
  if (!seam(ends[0])) add_end(ends[0], t, a, along, length, coat, list);
  if (seam(ends[1]))  // fills the bend
    list.balls.push_back({f(b), thick, coat.rod, coat.rod_finish});
  else
    add_end(ends[1], t, b, -along, length, coat, list);
}

// A bolt.
void Hardware::add_pin(const Vec3& at, const Vec3& axis, double r, double half, DrawList& list) const {
  const Vec3 end = (half + 0.3 * r) * axis;
  list.sleeves.push_back({f(at - end), f(at + end), static_cast<float>(pin_radius * r), look_.joint});
}

void Hardware::add_pins(std::size_t node, double t, const Vec3& at, DrawList& list) const {
  std::vector<Vec3> done;
  for (const RodEnd& end : joints_->ends(static_cast<int>(node))) {
    const Vec3 axis = joints_->axis(end, t);
    if (axis.isZero()) continue;
    if (std::ranges::any_of(done, [&](const Vec3& d) { return std::abs(d.dot(axis)) > 0.97; })) continue;
    done.push_back(axis);
    double high = 0, low = 0, thickest = 0;
    for (const RodEnd& other : joints_->ends(static_cast<int>(node))) {
      const auto i = static_cast<std::size_t>(other.rod);
      if (std::abs(joints_->axis(other, t).dot(axis)) < 0.97) continue;
      const double r = radius(i), shift = offset(i, t).dot(axis),
                   reach = (joints_->layer(other) * layer_gap + lug_thickness) * r;
      high = std::max(high, shift + reach), low = std::min(low, shift - reach);
      thickest = std::max(thickest, r);
    }
    add_pin(at + 0.5 * (high + low) * axis, axis, thickest, 0.5 * (high - low) + 0.2 * thickest, list);
  }
}

void Hardware::add_joint(std::size_t n, double t, const std::vector<Vec3>& at, DrawList& list) const {
  const double r = looks_.joint_radius[n];
  if (r <= 0) return;
  const JointKind kind = joints_->kind(static_cast<int>(n));
  const bool held = looks_.fixed[n],
             pinned = detailed_ && (kind == JointKind::hinge || kind == JointKind::hub);
  const bool payload = structure_.nodes[static_cast<std::size_t>(structure_.node_copies[n].source)].mass > 0;
  if (seams_[n] && !held && !payload) return;
  if (pinned) add_pins(n, t, at[n], list);
  if (!support_[n].isZero()) add_support(n, at[n], list);
  // A pulley stands for what its node weighs, and for a node without rods.
  if (looks_.bare[n] && pulley(n)) return;
  if (payload && !held && (pinned || (detailed_ && looks_.bare[n])) && !pulley(n))
    return add_payload(n, at[n], list);
  if (detailed_ && (kind == JointKind::hinge || (kind == JointKind::none && !looks_.bare[n]))) return;
  const double scale = held && !detailed_ ? 1.5 : kind == JointKind::hub && detailed_ ? 0.86 : 1.0;
  list.balls.push_back({f(at[n]), static_cast<float>(scale * r), held ? look_.anchor : look_.joint,
                        held ? Finish::paint : Finish::metal});
}

void Hardware::add_crossings(double t, const std::vector<Vec3>& at, DrawList& list) const {
  if (!detailed_) return;
  for (const RodCrossing& c : joints_->crossings()) {
    if (c.pin < 0) continue;
    const auto i = static_cast<std::size_t>(c.rod);
    const Vec3 side = joints_->side(c.rod, t);
    if (side.isZero()) continue;
    const double r = radius(i);
    add_pin(at[static_cast<std::size_t>(c.pin)], side, r, (side_gap + 1.15) * r, list);
    // A collar around each arm where the pin goes through it.
    for (const int rod : {c.rod, c.other}) {
      const RodCopy& copy = structure_.rod_copies[static_cast<std::size_t>(rod)];
      const Vec3 along =
          (at[static_cast<std::size_t>(copy.b)] - at[static_cast<std::size_t>(copy.a)]).normalized();
      const Vec3 p = at[static_cast<std::size_t>(c.pin)] + offset(static_cast<std::size_t>(rod), t);
      list.sleeves.push_back(
          {f(p - 1.9 * r * along), f(p + 1.9 * r * along), static_cast<float>(1.22 * r), look_.fitting});
    }
  }
}

// A stand from a plate to the joint.
void Hardware::add_support(std::size_t n, const Vec3& at, DrawList& list) const {
  const double r = looks_.joint_radius[n] / 1.75;
  const Vec3 down = support_[n], foot = at + down, up = -down.normalized();
  list.sleeves.push_back(
      {f(foot - 0.55 * r * up), f(foot), static_cast<float>(4.4 * r), look_.anchor, Finish::anodised});
  list.sleeves.push_back(
      {f(foot), f(foot + 0.5 * r * up), static_cast<float>(2.3 * r), look_.fitting, Finish::metal});
  list.sleeves.push_back(
      {f(foot), f(at - 0.6 * r * up), static_cast<float>(1.25 * r), look_.anchor, Finish::anodised});
}

// A canister wrapped in foil.
void Hardware::add_payload(std::size_t n, const Vec3& at, DrawList& list) const {
  constexpr Color foil{0.93f, 0.70f, 0.28f, 1};
  const double r = looks_.joint_radius[n];
  const Vec3 up = 0.85 * r * Vec3::UnitZ();
  list.sleeves.push_back({f(at - up), f(at + up), static_cast<float>(r), foil, Finish::foil});
  list.sleeves.push_back({f(at + up), f(at + 1.2 * up), static_cast<float>(0.7 * r), look_.fitting});
}

// What pulls only is thin and straight; springs are wound.
void Hardware::add_forces(const std::vector<Vec3>& at, const std::vector<Color>& colors,
                          DrawList& list) const {
  if (!solved_whole_) return;
  const double thick = thickest();
  for (std::size_t i = 0; i < structure_.forces.size(); ++i) {
    const Force& force = structure_.forces[i];
    if (force.kind != "spring" || force.measure.kind != MeasureKind::length ||
        force.measure.nodes.size() != 2)
      continue;
    const Vec3 a = at[static_cast<std::size_t>(copy_of_[static_cast<std::size_t>(force.measure.nodes[0])])],
               b = at[static_cast<std::size_t>(copy_of_[static_cast<std::size_t>(force.measure.nodes[1])])];
    const double length = (b - a).norm();
    const auto thin = static_cast<float>(0.26 * thick);
    if (length <= 0) continue;
    const bool own = !colors.empty() && colors[i].a > 0;
    const auto add = [&](const Vec3& from, const Vec3& to, const Color& metal) {
      list.tubes.push_back(
          {f(from), f(to), thin, own ? colors[i] : metal, own ? Finish::paint : Finish::metal});
    };
    if (force.one_sided || length < 12 * thick) {
      add(a, b, look_.joint);
      continue;
    }
    constexpr int turns = 12, parts = 10;
    const Vec3 z = (b - a) / length, x = z.unitOrthogonal(), y = z.cross(x);
    Vec3 last = a;
    for (int k = 0; k <= turns * parts + 1; ++k) {
      const double u = 0.15 + 0.7 * k / (turns * parts), angle = 2 * pi * k / parts;
      const Vec3 next =
          k > turns * parts
              ? b
              : Vec3(a + u * length * z + 1.6 * thick * (std::cos(angle) * x + std::sin(angle) * y));
      add(last, next, look_.fitting);
      last = next;
    }
  }
}

void Hardware::add(double t, const std::vector<Vec3>& at, const std::vector<Color>& rod_colors,
                   const std::vector<Color>& spring_colors, DrawList& list) const {
  for (std::size_t i = 0; i < structure_.rod_copies.size(); ++i)
    add_rod(i, t, at, rod_colors.empty() ? nullptr : &rod_colors[i], list);
  for (std::size_t n = 0; n < looks_.joint_radius.size(); ++n) add_joint(n, t, at, list);
  add_crossings(t, at, list);
  add_forces(at, spring_colors, list);
  add_drives(t, at, list);
}

}  // namespace unfurl
