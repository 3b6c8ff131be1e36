// SPDX-License-Identifier: BSD-3-Clause
// Where the camera is at every moment of a film.
#pragma once

#include <string>
#include <vector>

#include "core/scene/render_options.hpp"
#include "core/simulate/trajectory.hpp"
#include "render/scene/framing.hpp"

namespace unfurl {

// A picture of a film: which moment of the motion, and how far the film has come.
struct Shot {
  double t = 0;         // [s]
  double progress = 0;  // of the motion part of the film, 0..1
  double turn = 0;      // of the turntable, 0..1
  double open = 0;      // from t on the shutter is open for so long [s of motion]
  bool card = false;    // the title alone

  bool operator==(const Shot&) const = default;
};

// The pictures of a film: the title's card, the first picture held, the motion, its end, a turntable and the
// last picture held, those that the options have. The motion lasts (end - start) / speed of film time; a
// pace "time" shows the moments k speed / fps from the start, "even" those at which the structure has
// deployed by equal shares (without a measure of that: its nodes have gone equal ways). Easing e makes it
// e longer: p' rises from 0 to 1 as x^2 (3 - 2 x), x = film time / e, and falls again before the end.
std::vector<Shot> film_shots(const Trajectory& trajectory, const RenderOptions& options);

// The picture of the motion at a time [s]: the film's own where it has one of that time, else how far the
// film has come by shares between those around it.
Shot shot_at(const Trajectory& trajectory, const RenderOptions& options, double t);

// How many there would be at most for a run to this end time [s].
double most_shots(double end_time, const RenderOptions& options);

// Does it stand elsewhere in one picture of a film than in another?
bool moves_camera(const RenderOptions& options);

// From where a film begins to look.
ViewAngles first_angles(const RenderOptions& options, const MotionBounds& bounds);

// With RenderOptions::follow: the radius of what the camera has room for at once, where that is largest [m].
double followed_radius(const std::vector<std::vector<Vec3>>& poses, const std::vector<double>& times);

class CameraPath {
 public:
  // poses: the points of the motion, z up, of each state; times of the states [s], ascending.
  CameraPath(std::vector<std::vector<Vec3>> poses, std::vector<double> times, MotionBounds bounds,
             Framing framing, const RenderOptions& options);

  Camera at(const Shot& shot) const;
  ViewAngles first_view() const { return angles({}); }

 private:
  ViewAngles angles(const Shot& shot) const;
  double elevation(double t) const;  // of the keys [rad]
  std::vector<double> elevations(double from,
                                 double to) const;  // to be tried for what is seen between two times
  void prepare_follow();
  Camera following(double t) const;
  void prepare_turning_follow();
  std::size_t first_before(double t) const;

  std::vector<std::vector<Vec3>> poses_;
  std::vector<double> times_;
  MotionBounds bounds_;
  Framing framing_;
  ViewAngles start_;
  double orbit_ = 0;  // [rad]
  bool turntable_ = false, follow_ = false;
  std::vector<CameraKey> keys_;
  Camera still_;
  double distance_ = 0;              // of the moving cameras from the centre [m]
  std::vector<Camera> follow_path_;  // at equal steps of the time
  struct Place {                     // of what a camera that turns follows
    Vec3 center = Vec3::Zero();
    double distance = 0;
  };
  std::vector<Place> follow_places_;
};

}  // namespace unfurl
