// A moment of a run becomes a picture as data, by what the run and the structure say; no solver is asked.
#pragma once

#include <string>
#include <vector>

#include "core/simulate/trajectory.hpp"
#include "render/scene/appearance.hpp"
#include "render/scene/draw_list.hpp"
#include "render/scene/framing.hpp"
#include "render/scene/look.hpp"

namespace unfurl {

struct FrameStyle {
  int width = 1280, height = 720;  // [pixels]
  std::string title;               // top left; empty: none
  bool labels = true;              // title, time, deployed fraction, legend
  bool loads = true;               // arrows
  std::string look = "studio";     // of looks()
  bool transparent = false;        // no background, whatever the look
};

// All pictures of a run share one still camera that sees the whole motion. Gravity, where there is some,
// points down in the picture; else the scene's z axis points up.
class FrameBuilder {
 public:
  // The trajectory must outlive the builder and have at least one state, and the look must be known (else
  // std::invalid_argument).
  FrameBuilder(const Trajectory& trajectory, FrameStyle style);

  // At any time [s]; outside the run its nearest end.
  DrawList build(double t) const;
  const Camera& camera() const { return still_.camera; }
  // The scene's coordinates to the picture's (a rotation; z is up in the picture).
  const Mat3& upright() const { return upright_; }

 private:
  Vec3 node(const VectorXd& whole, int i) const { return upright_ * whole.segment<3>(3 * i); }
  VectorXd solved(const VectorXd& whole) const;
  void prepare_still();
  void add_rods(const VectorXd& whole, DrawList& list) const;
  void add_joints(const VectorXd& whole, DrawList& list) const;
  void add_loads(const VectorXd& whole, DrawList& list) const;
  void add_labels(double t, const VectorXd& whole, DrawList& list) const;

  const Trajectory& trajectory_;
  FrameStyle style_;
  Mat3 upright_ = Mat3::Identity();
  const Look* look_;
  Appearance looks_;
  DrawList still_;  // what all pictures share: camera, floor, light
};

// The times of a film's frames [s]: k * speed / fps from the start of the run, and its end as the last one.
// speed: seconds of motion per second of film.
std::vector<double> frame_times(const Trajectory& trajectory, double fps, double speed);

}  // namespace unfurl
