// SPDX-License-Identifier: BSD-3-Clause
// What drives a structure, by name: rows that prescribe motions, cables that are reeled, and motors.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"
#include "core/simulate/trajectory.hpp"
#include "core/structure/measure.hpp"

namespace unfurl {

struct DriveSample {
  double value = 0.0;   // of the measure, or of what is prescribed [m] or [rad]
  double effort = 0.0;  // along the measure [N] or [N m]
  double power = 0.0;   // that goes into the structure [W]
};

class DriveChannel {
  enum class Kind { row, reel, motor, winch };

 public:
  const std::string& name() const { return name_; }  // unique
  int cable() const { return cable_; }  // that is reeled, by its side among the stops; -1: none is
  bool angle() const { return angle_; }
  bool by_row() const { return kind_ == Kind::row || kind_ == Kind::reel; }  // multipliers tell its effort
  // At the node coordinates and velocities of a time; lambda: multipliers of the model's rows.
  DriveSample sample(const Model& model, const System& system, double t, const VectorXd& q, const VectorXd& v,
                     const VectorXd& lambda) const;
  // What an impulse of the rows and of reeled cables, by side, puts in at that time [J].
  double work(const Model& model, double t, const VectorXd& lambda,
              const std::function<double(int)>& of_reel) const;
  // Whether the effort is: `rows` says it of the multipliers of the model's rows.
  bool unique(const Model& model, const std::vector<char>& rows) const;

 private:
  friend std::vector<DriveChannel> drive_channels(const Model& model);
  int row(const Model& model) const;  // -1: slack
  DriveSample of_row(const Model& model, double t, const VectorXd& lambda) const;

  Kind kind_ = Kind::row;
  std::string name_;
  int cable_ = -1;
  bool angle_ = false;
  std::size_t index_ = 0;  // of the constraint, stop or force
  double scale_ = 1.0;     // of a row
  int followed_ = -1;
  TimeFunction target_;
  std::vector<MeasureFunction> measure_;  // of a motor or winch
};

// Of the model that a run begins with: later ones have the same and more. Names are unique.
std::vector<DriveChannel> drive_channels(const Model& model);

// Columns of each drive: what it prescribes or turns, what it gives for it, the power, the energy so far,
// whether the effort is unique, and an angle in degrees.
class DriveColumns {
 public:
  DriveColumns(const Model& model, std::vector<Series>& columns);
  // `model`: that of the state, whose rows may be others than at the start. energy: of a drive, so far [J].
  void append(const Model& model, const System& system, double t, const VectorXd& q, const VectorXd& v,
              const VectorXd& lambda, const std::function<double(std::size_t)>& energy);

 private:
  std::vector<Series>& columns_;
  std::size_t first_;
  std::vector<DriveChannel> drives_;
};

}  // namespace unfurl
