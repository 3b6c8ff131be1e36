// SPDX-License-Identifier: BSD-3-Clause
// Rods, joints, supports and payloads of a pose as bodies: tubes with end fittings, hinges with lugs and
// pins, scissor arms side by side, plates under what is held, cables, springs and pulleys, telescopes,
// motors.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/render_options.hpp"
#include "core/structure/structure.hpp"
#include "render/scene/appearance.hpp"
#include "render/scene/draw_list.hpp"
#include "render/scene/joints.hpp"
#include "render/scene/look.hpp"

namespace unfurl {

// What a rod's surface looks like, and its fittings.
struct RodCoat {
  Color rod, fitting;
  Finish rod_finish = Finish::anodised, fitting_finish = Finish::metal;
};

// By its name in scenes; transparent: the group's own colour.
std::pair<Color, Finish> coat_of_material(const std::string& name);
// The name of the material that a group of rods is of.
std::string material_for(const RenderOptions& options, const std::string& group);

class Hardware {
 public:
  // Everything given but the poses must outlive this. poses: of the copied nodes over the motion. upright:
  // the scene's coordinates to the picture's. detailed: with lugs and pins, and rods side by side; else rods
  // meet in balls.
  Hardware(const Structure& structure, const Appearance& looks, const Look& look,
           const RenderOptions& options, std::unique_ptr<const Joints> joints,
           const std::vector<std::vector<Vec3>>& poses, const Mat3& upright, bool detailed);

  // The bodies at a time; `at`: the copied nodes' places, z up. rod_colors: per copied rod; empty: by group.
  // spring_colors: per force of the structure, transparent: metal; empty: all are.
  void add(double t, const std::vector<Vec3>& at, const std::vector<Color>& rod_colors,
           const std::vector<Color>& spring_colors, DrawList& list) const;
  // Of a group in the picture and in its legend.
  Color group_color(std::size_t group) const;
  // How far below the lowest node a support reaches [m].
  double support_depth() const { return support_depth_; }

 private:
  using Triple = std::array<int, 3>;  // copied nodes
  using Poses = std::vector<std::vector<Vec3>>;
  struct Motored {  // a hinge: between nodes, the second is the hinge; axis: zero where it has no sign
    Triple nodes;
    Vec3 axis;
    RodEnd end = {-1, 0};  // that turns there; rod -1: none does
    double side = 0;       // of that rod's axis, where the motor sits: -1 or 1; 0: where it is seen from
  };
  void find_drives(const Poses& poses);
  void add_drive(const Measure& measure, const Poses& poses);
  void add_fold_drive(const Poses& poses);
  void add_drives(double t, const std::vector<Vec3>& at, DrawList& list) const;
  void add_pulley(const Triple& nodes, const std::vector<Vec3>& at, DrawList& list) const;
  void add_telescope(const std::vector<int>& nodes, const std::vector<Vec3>& at, DrawList& list) const;
  void add_motor(const Motored& motor, double t, const std::vector<Vec3>& at, DrawList& list) const;
  double outer_side(const Motored& motor, const Poses& poses) const;
  Vec3 motor_axis(const Motored& motor, double t, const std::vector<Vec3>& at) const;
  int copy(int node) const;              // of a solved node
  int far_end(const RodEnd& end) const;  // the node at its rod's other end
  double thickest() const;               // radius of the rods as drawn [m]
  void find_supports(const Poses& poses);
  Vec3 free_side(int node, const Vec3& wanted, const Poses& poses) const;
  RodCoat coat(int group, const Color* field) const;
  Vec3 offset(std::size_t rod, double t) const;
  void add_rod(std::size_t i, double t, const std::vector<Vec3>& at, const Color* field,
               DrawList& list) const;
  void add_end(const RodEnd& end, double t, const Vec3& node, const Vec3& along, double length,
               const RodCoat& coat, DrawList& list) const;
  double trimmed(const RodEnd& end, double length) const;
  void add_joint(std::size_t node, double t, const std::vector<Vec3>& at, DrawList& list) const;
  void add_pin(const Vec3& at, const Vec3& axis, double radius, double half_length, DrawList& list) const;
  void add_pins(std::size_t node, double t, const Vec3& at, DrawList& list) const;
  void add_crossings(double t, const std::vector<Vec3>& at, DrawList& list) const;
  void add_support(std::size_t node, const Vec3& at, DrawList& list) const;
  void add_payload(std::size_t node, const Vec3& at, DrawList& list) const;
  void add_forces(const std::vector<Vec3>& at, const std::vector<Color>& colors, DrawList& list) const;
  bool cable(std::size_t rod) const { return cables_[rod]; }
  bool pulley(std::size_t node) const;                        // a cable runs over it
  bool seam(const RodEnd& end) const;                         // of two parts of one rod, which goes on there
  double whole_length(std::size_t rod, double length) const;  // of the rod that it is a part of [m]
  double radius(std::size_t rod) const;                       // as drawn [m]
  Vec3 axis_of(const RodEnd& end, double t, const Vec3& along) const;

  const Structure& structure_;
  const Appearance& looks_;
  const Look& look_;
  const RenderOptions& options_;
  std::unique_ptr<const Joints> joints_;
  Mat3 upright_;
  bool detailed_;
  std::vector<bool> cables_;            // per copied rod
  std::vector<bool> seams_;             // per copied node
  std::vector<std::string> materials_;  // per group
  std::vector<Vec3> support_;           // per copied node: from it to its plate [m]; zero: none
  std::vector<int> copy_of_;            // a copy of each solved node
  double support_depth_ = 0;
  bool solved_whole_ = true;  // each node is shown as it is solved
  std::vector<Triple> pulleys_;
  std::vector<std::vector<int>> telescopes_;  // ends of their stages
  std::vector<Motored> motors_;
};

}  // namespace unfurl
