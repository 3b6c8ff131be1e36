// SPDX-License-Identifier: BSD-3-Clause
// A moment of a run becomes a picture as data, by what the run and the structure say; no solver is asked.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"
#include "core/scene/render_options.hpp"
#include "render/scene/appearance.hpp"
#include "render/scene/camera_path.hpp"
#include "render/scene/draw_list.hpp"
#include "render/scene/framing.hpp"
#include "render/scene/hardware.hpp"
#include "render/scene/look.hpp"
#include "render/scene/pose_times.hpp"
#include "render/scene/rod_field.hpp"
#include "render/scene/skins.hpp"

namespace unfurl {

struct FrameStyle {
  int width = 1280, height = 720;  // [pixels]
  std::string title;               // top left; empty: none
  bool labels = true;              // title, time, deployed fraction, legend and all else that is written
  bool loads = true;               // arrows
  float words = 1;                 // times the least size of what is written
  bool measures = true;            // scale bar and axes of the options; false: their room is empty
  CornerRoom covered = {};         // top left, by something that lies over the picture
  RenderOptions options = {};      // look, colours, overlays, camera; its size is not used
  // What colours by a quantity, errors, method and inset are read from; without them those are left out.
  const Simulation* run = nullptr;
  const Diagnostics* diagnostics = nullptr;
  std::vector<int> trails = {};  // the copied nodes that leave one (options.trails is their pattern)
  std::vector<ShownSurface> surfaces = {};
  // Where pictures have their zero [m of the scene]; where the motion is far away from it, a point beside
  // that.
  Vec3 origin = Vec3::Zero();
};

class FrameOverlay;

// Pictures of a run. Gravity, where there is some, points down in the picture; else the scene's z axis points
// up. The camera sees the whole motion and stands still unless the options move it.
class FrameBuilder {
 public:
  // The trajectory (and what the style points to) must outlive the builder and have at least one state, and
  // the options must be known names (else std::invalid_argument).
  FrameBuilder(const Trajectory& trajectory, FrameStyle style);
  ~FrameBuilder();
  FrameBuilder(FrameBuilder&&) noexcept;

  // Another camera than the film's, which the picture has that it is given.
  using Led = std::function<Camera(const DrawList&)>;
  // At any time [s]; outside the run its nearest end.
  DrawList build(double t, const Led& led = {}) const;
  DrawList build(const Shot& shot, const Led& led = {}) const;
  bool writes_by_camera() const;  // names, lengths, axes: what stands elsewhere when the camera does
  // What colours and signs of the picture at a time stand for, alone: for a place beside pictures without.
  DrawList key(double t) const;
  // A strip of that width above such pictures: the style's title, how thick rods are drawn, and what a key
  // tells without its bar of colours.
  struct Banner {
    int height = 0;  // 0: nothing is written [pixels]
    DrawList list;
  };
  Banner banner(double t, bool title, bool thickness, bool legend, int width) const;
  const Camera& camera() const { return still_.camera; }  // of the first picture
  // Width over height of the picture that the whole motion fills, within reason: 2/5 to 5/2.
  double fitting_aspect() const { return fitting_aspect_; }
  // The scene's coordinates x to the picture's: upright() (x - origin()), a rotation (z is up in the
  // picture).
  const Mat3& upright() const { return upright_; }
  const Vec3& origin() const { return style_.origin; }
  const std::vector<ShownSurface>& surfaces() const { return style_.surfaces; }  // with their fronts

 private:
  VectorXd placed(VectorXd whole) const;  // counted from the origin, as is what functions below are given
  Vec3 node(const VectorXd& whole, int i) const { return upright_ * whole.segment<3>(3 * i); }
  DrawList key_ground(double t) const;  // without bodies; the arrows tell that there are some
  void add_card(DrawList& list) const;
  void choose_origin(const std::vector<VectorXd>& poses);
  void bound(const std::vector<std::vector<Vec3>>& poses, const std::vector<double>& times);
  double prepare_camera(PosedMoments moments);  // returns the radius of the thickest joint [m]
  // Margins for what is written in a picture of these points.
  void make_room(const PointSource& points, const ViewAngles& view, bool dimensions, Framing& framing) const;
  // Of a sphere around what is drawn of nodes in one of that radius [m].
  double drawn_radius(double of_nodes, double thickest) const;
  void prepare_still(double thickest);
  void aim(const std::vector<Vec3>& at, DrawList& list) const;
  void prepare_ghosts(const PosedMoments& moments);
  void prepare_trails(const PosedMoments& moments);
  void thin_trails();
  Color rod_color(double t, const RodCopy& rod) const;
  Color line_color(double t, std::size_t line) const;
  void prepare_hardware(const std::vector<std::vector<Vec3>>& poses, const std::vector<double>& times);
  void add_bodies(double t, const std::vector<Vec3>& at, DrawList& list) const;
  void add_lines(double t, const VectorXd& whole, DrawList& list) const;
  void add_loads(const VectorXd& whole, DrawList& list) const;
  void add_ghosts(double t, DrawList& list) const;
  void add_trails(double t, const VectorXd& whole, DrawList& list) const;

  struct Ghost {
    double t;
    VectorXd whole;
  };
  struct Trail {
    int node;
    std::vector<double> t;
    std::vector<Vec3> points;
  };

  const Trajectory& trajectory_;
  FrameStyle style_;
  Mat3 upright_ = Mat3::Identity();
  const Look* look_;
  Appearance looks_;
  MotionBounds bounds_;
  double shown_radius_ = 1;  // of what the camera has room for at once [m]
  double fitting_aspect_ = 1;
  std::unique_ptr<Hardware> hardware_;
  std::unique_ptr<RodField> field_;  // null: coloured by group
  std::unique_ptr<CameraPath> path_;
  std::unique_ptr<FrameOverlay> overlay_;
  std::vector<Ghost> ghosts_;
  std::vector<Trail> trails_;
  DrawList still_;  // what all pictures share: floor, light, colours
};

// The times of a film's frames [s]: k * speed / fps from the start of the run, and its end as the last one.
// speed: seconds of motion per second of film.
std::vector<double> frame_times(const Trajectory& trajectory, double fps, double speed);

}  // namespace unfurl
