// SPDX-License-Identifier: BSD-3-Clause
// Binary glTF 2.0 (.glb): every rod an instance of one cylinder per group with a fitting at each end, every
// joint of one sphere, every load of one arrow, moved by translation and rotation keys; surfaces of the scene
// morph from pose to pose. At rest in the last pose, which a camera sees. A parent node turns what is up (z
// without gravity) to glTF's y.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "core/export/atomic_file.hpp"
#include "core/export/formats.hpp"
#include "core/export/glb_file.hpp"
#include "core/export/motion_keys.hpp"
#include "core/export/unit_shapes.hpp"
#include "core/export/upright.hpp"
#include "core/math/drawing_origin.hpp"
#include "core/structure/seams.hpp"
#include "core/structure/shown_lines.hpp"

namespace unfurl {
namespace {

using Json = nlohmann::ordered_json;
constexpr int float_type = 5126, ushort_type = 5123, uint_type = 5125, vertex_target = 34962,
              index_target = 34963;

std::vector<float> floats(std::initializer_list<double> values) {
  std::vector<float> out;
  for (const double x : values) out.push_back(static_cast<float>(x));
  return out;
}

// 200 MB of numbers, and what a program that plays it bears.
constexpr std::size_t most_animated = 50'000'000, most_keys = 20'000, fewest_keys = 400;

class GltfWriter {
 public:
  explicit GltfWriter(const ExportJob& job)
      : job_(job),
        trajectory_(job.run.trajectory),
        structure_(job.run.trajectory.structure()),
        upright_(upright_rotation(structure_.gravity)),
        seams_(seams(structure_)) {
    const std::size_t numbers = 7 * structure_.rod_copies.size() + 3 * structure_.node_copies.size();
    MotionKeys keys = motion_keys(
        trajectory_, job.frame_interval,
        std::clamp<std::size_t>(most_animated / std::max<std::size_t>(numbers, 1), fewest_keys, most_keys),
        job.between);
    if (const std::string warning = too_few_keys(keys, "animation.glb"); !warning.empty() && job.said)
      job.said->push_back(warning);
    times_ = std::move(keys.times);
    poses_ = std::move(keys.poses);
    find_origin();
  }

  std::string file() {
    if (job_.looks && job_.looks->surfaces) find_surfaces();
    add_root();
    add_meshes();
    for (const RodCopy& rod : structure_.rod_copies) add_rod(rod);
    for (std::size_t n = 0; n < structure_.node_copies.size(); ++n) add_joint(n);
    for (std::size_t r = 0; r < structure_.rod_copies.size(); ++r) add_fittings(r);
    for (const LoadCopy& load : structure_.load_copies) add_arrow(load);
    add_lines();
    for (std::size_t i = 0; i < surfaces_.size(); ++i) add_surface(i);
    add_camera();
    if (times_.size() > 1) animate();
    return glb_.file();
  }

 private:
  // Keys are in single precision: they count from a place near by, to which the parent node moves them.
  void find_origin() {
    if (poses_.front().size() == 0) return;
    Vec3 low = point(poses_.front(), 0), high = low;
    for (const VectorXd& pose : poses_)
      for (Index n = 0; n < pose.size() / 3; ++n) {
        low = low.cwiseMin(pose.segment<3>(3 * n));
        high = high.cwiseMax(pose.segment<3>(3 * n));
      }
    origin_ = drawing_origin(0.5 * (low + high), 0.5 * (high - low).norm());
    for (VectorXd& pose : poses_)
      for (Index n = 0; n < pose.size() / 3; ++n) pose.segment<3>(3 * n) -= origin_;
  }

  void add_root() {
    glb_.json["scenes"].push_back({{"name", std::string(job_.name)}, {"nodes", {0}}});
    const Eigen::Quaterniond z_to_y(std::sqrt(0.5), -std::sqrt(0.5), 0, 0),
        turn = z_to_y * Eigen::Quaterniond(upright_);
    glb_.json["nodes"].push_back({{"name", std::string(job_.name)},
                                  {"rotation", {turn.x(), turn.y(), turn.z(), turn.w()}},
                                  {"children", Json::array()}});
    if (origin_.isZero()) return;
    const Vec3 at = upright_ * origin_;
    glb_.json["nodes"].back()["translation"] = {at.x(), at.z(), -at.y()};
  }

  void add_meshes() {
    const ShapeMesh cylinder = unit_cylinder(16), sphere = unit_sphere(16);
    const Json rod_shape = primitive(cylinder), joint_shape = primitive(sphere);
    for (const Rod& rod : structure_.rods) {
      if (group_index(rod.group) < groups_.size()) continue;
      groups_.push_back(rod.group);
      const ExportedMaterial m = material(rod.group);
      const bool own = m.red < 0;
      add_mesh(rod.group, rod_shape,
               own ? color(groups_.size() - 1) : std::vector<double>{m.red, m.green, m.blue, 1}, m.metal,
               m.roughness);
    }
    add_mesh("fitting", rod_shape, {0.34, 0.37, 0.41, 1.0}, 0.85, 0.3);
    add_mesh("joint", joint_shape, {0.075, 0.09, 0.112, 1.0}, 0.85, 0.3);
    for (const LoadCopy& load : structure_.load_copies)
      if (!job_.looks || job_.looks->loads) largest_force_ = std::max(largest_force_, load.force.norm());
    if (!(largest_force_ > 0)) return;
    // Red as in pictures. A shaft and a head in a mesh each: their shares of an arrow vary.
    arrow_mesh_ = glb_.json["meshes"].size();
    add_mesh("load", rod_shape, {0.579, 0.004, 0.036, 1}, 0.0, 0.45);
    add_mesh("load's head", primitive(unit_cone(16)), {0.579, 0.004, 0.036, 1}, 0.0, 0.45);
  }

  ExportedMaterial material(const std::string& group) const {
    if (job_.looks)
      for (const ExportedMaterial& m : job_.looks->materials)
        if (m.group == group) return m;
    return {};
  }

  Json primitive(const ShapeMesh& mesh) {
    const std::size_t position = glb_.add(mesh.positions, 3, float_type, vertex_target, true);
    const std::size_t normal = glb_.add(mesh.normals, 3, float_type, vertex_target, false);
    const std::size_t indices = glb_.add(mesh.triangles, 1, ushort_type, index_target, false);
    return {{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}, {"indices", indices}};
  }

  // Blue, orange, green, purple, sky blue, vermilion: distinct for every kind of colour vision, those of the
  // pictures on a pale ground; linear RGB.
  static std::vector<double> color(std::size_t group) {
    static const std::vector<std::vector<double>> palette = {
        {0.0, 0.113, 0.394, 1},   {0.75, 0.214, 0.002, 1},  {0.0, 0.265, 0.133, 1},
        {0.479, 0.119, 0.297, 1}, {0.051, 0.343, 0.694, 1}, {0.604, 0.073, 0.0, 1}};
    std::vector<double> shade = palette[group % palette.size()];
    // Beyond the sixth the same again, darker and paler.
    const std::size_t round = group / palette.size();
    for (std::size_t k = 0; k < 3 && round > 0; ++k)
      shade[k] = round % 2 == 1 ? 0.25 * shade[k] : 0.4 * shade[k] + 0.6 * 0.7;
    return shade;
  }

  void add_mesh(const std::string& name, Json shape, const std::vector<double>& base, double metal = 0.35,
                double roughness = 0.32) {
    shape["material"] = glb_.json["materials"].size();
    glb_.json["materials"].push_back(
        {{"name", name},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", base}, {"metallicFactor", metal}, {"roughnessFactor", roughness}}}});
    glb_.json["meshes"].push_back({{"name", name}, {"primitives", Json::array({shape})}});
  }

  std::size_t group_index(const std::string& group) const {
    return static_cast<std::size_t>(std::find(groups_.begin(), groups_.end(), group) - groups_.begin());
  }

  // A rod's own radius where it has one, a sixtieth of its length where not.
  static double radius(const Rod& rod) { return rod.radius > 0 ? rod.radius : rod.pinned_length() / 60; }

  // Of a node at which no rod ends, a payload or a pin: the middle one of all joints, else a hundredth of the
  // motion's size.
  double point_radius() const {
    std::vector<double> known;
    for (const double r : joint_radius_)
      if (r > 0.0) known.push_back(r);
    if (!known.empty()) {
      const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
      std::nth_element(known.begin(), middle, known.end());
      return *middle;
    }
    const double size = motion_size();
    return size > 0.0 ? 0.01 * size : 0.01;
  }

  double motion_size() const {
    Vec3 low = point(poses_.front(), 0), high = low;
    for (const VectorXd& pose : poses_)
      for (int n = 0; n < static_cast<int>(structure_.node_copies.size()); ++n) {
        low = low.cwiseMin(point(pose, n));
        high = high.cwiseMax(point(pose, n));
      }
    return (high - low).norm();
  }

  static Vec3 point(const VectorXd& pose, int node) { return pose.segment<3>(3 * node); }

  void add_node(const std::string& name, std::size_t mesh, const Json& place) {
    Json node = {{"name", name}, {"mesh", mesh}};
    node.update(place);
    glb_.json["nodes"][0]["children"].push_back(glb_.json["nodes"].size());
    glb_.json["nodes"].push_back(std::move(node));
  }

  struct Motion {
    std::size_t node;
    std::vector<float> translation, rotation, scale;
  };

  // A straight member between two nodes at all keys. The shortest turn from each key to the next: no spin
  // about its own axis between them.
  void follow(int a_node, int b_node, double radius, Motion& motion) const {
    job_.next();
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
    Vec3 axis = Vec3::UnitY();
    for (const VectorXd& pose : poses_) {
      const Vec3 a = point(pose, a_node), b = point(pose, b_node), middle = 0.5 * (a + b);
      const double length = (b - a).norm();
      const Vec3 direction = length > 0 ? Vec3((b - a) / length) : axis;
      turn = (shortest_turn(axis, direction) * turn).normalized();
      axis = direction;
      append(motion.translation, {middle[0], middle[1], middle[2]});
      append(motion.rotation, {turn.x(), turn.y(), turn.z(), turn.w()});
      append(motion.scale, {radius, length, radius});
    }
  }

  void add_rod(const RodCopy& copy) {
    const Rod& rod = structure_.rods[static_cast<std::size_t>(copy.source)];
    Motion motion{glb_.json["nodes"].size(), {}, {}, {}};
    follow(copy.a, copy.b, radius(rod), motion);
    bool stretches = false;
    for (std::size_t k = 1; k < motion.scale.size(); k += 3)
      stretches =
          stretches || std::abs(static_cast<double>(motion.scale[k]) - rod.length) > 1e-3 * rod.length;
    add_node(copy.name, group_index(rod.group),
             {{"translation", last(motion.translation, 3)},
              {"rotation", last(motion.rotation, 4)},
              {"scale", last(motion.scale, 3)}});
    if (!stretches) motion.scale.clear();
    motions_.push_back(std::move(motion));
    for (const int end : {copy.a, copy.b}) {
      joint_radius_.resize(structure_.node_copies.size(), 0.0);
      double& joint = joint_radius_[static_cast<std::size_t>(end)];
      joint = std::max(joint, 1.5 * radius(rod));
    }
  }

  // Cables, nets and springs: as long as they are at each key.
  void add_lines() {
    const double thick = shown_line_radius(structure_, motion_size());
    std::map<std::string, std::size_t> meshes;
    for (const ShownLine& line : lines_between_nodes(structure_)) {
      if (!meshes.contains(line.group)) {
        meshes[line.group] = glb_.json["meshes"].size();
        const std::vector<double> tint = line.group == "cable" ? std::vector{0.579, 0.004, 0.036, 1.0}
                                         : line.group == "net" ? std::vector{0.073, 0.09, 0.112, 1.0}
                                                               : std::vector{0.147, 0.17, 0.214, 1.0};
        add_mesh(line.group, primitive(unit_cylinder(8)), tint, 0.0, 0.5);
      }
      const double radius = (line.group == "net" ? 0.5 : 1) * thick;
      Motion motion{glb_.json["nodes"].size(), {}, {}, {}};
      const auto name = [&](int n) { return structure_.node_copies[static_cast<std::size_t>(n)].name; };
      follow(line.a, line.b, radius, motion);
      add_node(line.group + " " + name(line.a) + " " + name(line.b), meshes[line.group],
               {{"translation", last(motion.translation, 3)},
                {"rotation", last(motion.rotation, 4)},
                {"scale", last(motion.scale, 3)}});
      motions_.push_back(std::move(motion));
    }
  }

  void add_joint(std::size_t n) {
    Motion motion{glb_.json["nodes"].size(), {}, {}, {}};
    for (const VectorXd& pose : poses_) {
      const Vec3 p = point(pose, static_cast<int>(n));
      append(motion.translation, {p[0], p[1], p[2]});
    }
    double r = n < joint_radius_.size() && joint_radius_[n] > 0.0 ? joint_radius_[n] : point_radius();
    if (seams_[n]) r *= 0.95 / 1.5;  // a point of a rod, inside of it: fills the bend
    add_node(structure_.node_copies[n].name, groups_.size() + 1,
             {{"translation", last(motion.translation, 3)}, {"scale", {r, r, r}}});
    motions_.push_back(std::move(motion));
  }

  // In the frame of the rod, which is as wide as its radius and from -1/2 to 1/2 long.
  void add_fittings(std::size_t r) {
    const Rod& rod = structure_.rods[static_cast<std::size_t>(structure_.rod_copies[r].source)];
    const double share =
        rod.length > 0 ? std::min({6.5 * radius(rod) / rod.length, 0.2 * rod.parts, 1.0}) : 0.2;
    for (const double sign : {-1.0, 1.0}) {
      const RodCopy& copy = structure_.rod_copies[r];
      if (seams_[static_cast<std::size_t>(sign < 0 ? copy.a : copy.b)]) continue;
      Json& children = glb_.json["nodes"][1 + r]["children"];
      children.push_back(glb_.json["nodes"].size());
      glb_.json["nodes"].push_back({{"name", structure_.rod_copies[r].name + " fitting"},
                                    {"mesh", groups_.size()},
                                    {"translation", {0.0, sign * 0.5 * (1 - share), 0.0}},
                                    {"scale", {1.3, share, 1.3}}});
    }
  }

  // From its node, as long as the force is large: the largest a thirteenth of the motion's size. A node that
  // moves with the joint, turned to the force; in it a shaft and a head of 6.5 and 2.4 shaft radii.
  void add_arrow(const LoadCopy& load) {
    if (load.force.isZero() || !(largest_force_ > 0)) return;
    Motion motion{glb_.json["nodes"].size(), {}, {}, {}};
    for (const VectorXd& pose : poses_) {
      const Vec3 p = point(pose, load.node);
      append(motion.translation, {p[0], p[1], p[2]});
    }
    const double longest = motion_size() / 13, thick = longest / 25;
    const double length = longest * load.force.norm() / largest_force_,
                 head = std::min(6.5 * thick, 0.6 * length);
    const Eigen::Quaterniond turn = shortest_turn(Vec3::UnitY(), load.force);
    const std::string name = "load at " + structure_.node_copies[static_cast<std::size_t>(load.node)].name;
    glb_.json["nodes"][0]["children"].push_back(motion.node);
    glb_.json["nodes"].push_back({{"name", name},
                                  {"translation", last(motion.translation, 3)},
                                  {"rotation", floats({turn.x(), turn.y(), turn.z(), turn.w()})},
                                  {"children", {motion.node + 1, motion.node + 2}}});
    glb_.json["nodes"].push_back({{"name", name + ", shaft"},
                                  {"mesh", arrow_mesh_},
                                  {"translation", {0.0, 0.5 * (length - head), 0.0}},
                                  {"scale", {thick, length - head, thick}}});
    glb_.json["nodes"].push_back({{"name", name + ", head"},
                                  {"mesh", arrow_mesh_ + 1},
                                  {"translation", {0.0, length - 0.5 * head, 0.0}},
                                  {"scale", {2.4 * thick, head, 2.4 * thick}}});
    motions_.push_back(std::move(motion));
  }

  // At the poses that surfaces have keys at, the last of all among them.
  void find_surfaces() {
    constexpr std::size_t most_shapes = 25;
    const std::size_t ends = times_.size() - 1, keys = std::min(most_shapes, times_.size());
    for (std::size_t k = 0; k < keys; ++k) {
      const std::size_t at = keys > 1 ? ends * k / (keys - 1) : ends;
      surface_times_.push_back(times_[at]);
      const std::vector<ExportedSurface> shown = job_.looks->surfaces(poses_[at]);
      surfaces_.resize(shown.size());
      for (std::size_t i = 0; i < shown.size(); ++i) surfaces_[i].push_back(shown[i]);
    }
  }

  // As it is in the last pose; every other key is a morph target, the way from there.
  void add_surface(std::size_t i) {
    const std::vector<ExportedSurface>& keys = surfaces_[i];
    const ExportedSurface& rest = keys.back();
    if (rest.triangles.empty()) return;
    const auto vectors = [&](const std::vector<float>& values, bool bounds) {
      return glb_.add(values, 3, float_type, vertex_target, bounds);
    };
    Json shape = {{"attributes",
                   {{"POSITION", vectors(rest.positions, true)}, {"NORMAL", vectors(rest.normals, false)}}},
                  {"indices", glb_.add(rest.triangles, 1, uint_type, index_target, false)}};
    const auto way = [](std::vector<float> to, const std::vector<float>& from) {
      for (std::size_t k = 0; k < to.size(); ++k) to[k] -= from[k];
      return to;
    };
    for (std::size_t k = 0; k + 1 < keys.size(); ++k)
      shape["targets"].push_back({{"POSITION", vectors(way(keys[k].positions, rest.positions), true)},
                                  {"NORMAL", vectors(way(keys[k].normals, rest.normals), false)}});
    const std::size_t mesh = glb_.json["meshes"].size();
    add_mesh(rest.name, shape, {rest.red, rest.green, rest.blue, rest.opacity}, rest.metal, rest.roughness);
    Json& coat = glb_.json["materials"].back();
    coat["doubleSided"] = true;
    if (rest.opacity < 1) coat["alphaMode"] = "BLEND";
    morphs_.push_back(glb_.json["nodes"].size());
    if (keys.size() > 1) glb_.json["meshes"][mesh]["weights"] = std::vector<double>(keys.size() - 1, 0.0);
    add_node(rest.name, mesh, Json::object());
  }

  // As the pictures look by default, from where the last pose fills the view.
  void add_camera() {
    const VectorXd& pose = poses_.back();
    if (pose.size() == 0) return;
    const int count = static_cast<int>(structure_.node_copies.size());
    const auto at = [&](int n) { return Vec3(upright_ * point(pose, n)); };
    Vec3 low = at(0), high = low;
    for (int n = 0; n < count; ++n) low = low.cwiseMin(at(n)), high = high.cwiseMax(at(n));
    constexpr double azimuth = -62 * radians_per_degree, elevation = 24 * radians_per_degree,
                     field = 28 * radians_per_degree, aspect = 16.0 / 9.0, filled = 0.85;
    const Vec3 back(std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
                    std::sin(elevation));
    const Vec3 middle = 0.5 * (low + high), right = Vec3::UnitZ().cross(back).normalized();
    Mat3 axes;
    axes << right, back.cross(right), back;  // it looks along its -z
    // A point at (x, y, z) in these axes is seen where |y| and |x| / aspect <= (distance - z) tan(field / 2).
    double distance = 8 * point_radius();  // of one point
    for (int n = 0; n < count; ++n) {
      const Vec3 seen = axes.transpose() * (at(n) - middle);
      const double across = std::max(std::abs(seen.y()), std::abs(seen.x()) / aspect);
      distance = std::max(distance, seen.z() + across / (filled * std::tan(0.5 * field)));
    }
    const Vec3 eye = upright_.transpose() * (middle + distance * back);
    const Eigen::Quaterniond turn(Mat3(upright_.transpose() * axes));
    glb_.json["cameras"] = Json::array({{{"type", "perspective"},
                                         {"perspective",
                                          {{"yfov", field},
                                           {"aspectRatio", aspect},
                                           {"znear", 0.01 * distance},
                                           {"zfar", 10 * distance}}}}});
    glb_.json["nodes"][0]["children"].push_back(glb_.json["nodes"].size());
    glb_.json["nodes"].push_back({{"name", "camera"},
                                  {"camera", 0},
                                  {"translation", {eye[0], eye[1], eye[2]}},
                                  {"rotation", {turn.x(), turn.y(), turn.z(), turn.w()}}});
  }

  void animate() {
    std::vector<float> seconds;
    for (const double t : times_) seconds.push_back(static_cast<float>((t - times_.front()) / job_.speed));
    Json animation = {{"name", "deployment"}, {"channels", Json::array()}, {"samplers", Json::array()}};
    const std::size_t input = glb_.add(seconds, 1, float_type, 0, true);
    const auto channel = [&](std::size_t node, const char* path, const std::vector<float>& keys,
                             std::size_t width) {
      if (keys.empty()) return;
      const std::size_t output = glb_.add(keys, width, float_type, 0, false);
      animation["channels"].push_back(
          {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
      animation["samplers"].push_back({{"input", input}, {"output", output}, {"interpolation", "LINEAR"}});
    };
    for (const Motion& motion : motions_) {
      job_.next();
      channel(motion.node, "translation", motion.translation, 3);
      channel(motion.node, "rotation", motion.rotation, 4);
      channel(motion.node, "scale", motion.scale, 3);
    }
    if (!morphs_.empty() && surface_times_.size() > 1) {
      // One target at a time, the next one coming as it goes; the last pose is none.
      const std::size_t keys = surface_times_.size();
      std::vector<float> when, weights(keys * (keys - 1), 0.0f);
      for (const double t : surface_times_)
        when.push_back(static_cast<float>((t - times_.front()) / job_.speed));
      for (std::size_t k = 0; k + 1 < keys; ++k) weights[k * (keys - 1) + k] = 1;
      const std::size_t at = glb_.add(when, 1, float_type, 0, true),
                        values = glb_.add(weights, 1, float_type, 0, false);
      for (const std::size_t node : morphs_) {
        animation["channels"].push_back(
            {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", "weights"}}}});
        animation["samplers"].push_back({{"input", at}, {"output", values}, {"interpolation", "LINEAR"}});
      }
    }
    glb_.json["animations"] = Json::array({std::move(animation)});
  }

  static void append(std::vector<float>& keys, std::initializer_list<double> values) {
    const auto more = floats(values);
    keys.insert(keys.end(), more.begin(), more.end());
  }
  static std::vector<float> last(const std::vector<float>& keys, std::ptrdiff_t width) {
    return {keys.end() - width, keys.end()};
  }

  const ExportJob& job_;
  const Trajectory& trajectory_;
  const Structure& structure_;
  Mat3 upright_;  // gravity points down
  std::vector<double> times_;
  std::vector<VectorXd> poses_;  // counted from the origin
  Vec3 origin_ = Vec3::Zero();   // in the scene [m]
  GlbFile glb_;
  std::vector<std::string> groups_;
  std::vector<double> joint_radius_;
  std::vector<bool> seams_;  // per copied node
  std::vector<Motion> motions_;
  double largest_force_ = 0;    // [N]
  std::size_t arrow_mesh_ = 0;  // the shaft's; the next one is the head's
  std::vector<double> surface_times_;
  std::vector<std::vector<ExportedSurface>> surfaces_;  // each at those times
  std::vector<std::size_t> morphs_;                     // their nodes
};

}  // namespace

void export_gltf(const ExportJob& job) {
  const std::string file = GltfWriter(job).file();
  job.next();
  write_file_atomically(job.directory / "animation.glb", file);
}

}  // namespace unfurl
