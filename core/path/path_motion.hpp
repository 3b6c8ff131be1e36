// SPDX-License-Identifier: BSD-3-Clause
// s(t) of a run, between events.
#pragma once

#include <vector>

#include "core/path/path_forces.hpp"
#include "core/path/scalar_motion.hpp"
#include "core/structure/time_edges.hpp"

namespace unfurl {

// Everything that acts, tabulated along the path, and the law of motion that follows.
class PathLaw : public ScalarLaw {
 public:
  // separately: as PathForces has it.
  PathLaw(const Path& path, const Structure& structure, bool separately = false);

  Value at(double s, double v, double t) const override;
  PathForces& forces() { return forces_; }
  const PathForces& forces() const { return forces_; }
  PathTable& table() const { return *table_; }
  void tabulate();  // once every measure has been added
  void set_pulling(std::size_t cable, bool pulls) { pulling_[cable] = pulls; }
  // All, as the equations have them that know both of their modes. False where rounding decides, at the
  // length from which on a damper pulls.
  bool pull_where_taut(double s, double v);
  // The sense in which friction slips, 0: it does not.
  void set_slip(std::size_t friction, int slip) { slips_[friction] = slip; }
  // The most that friction can hold, along the path.
  double holding(double s) const;
  bool timed() const;  // a load changes with time
  double unit() const { return path_.unit(); }
  // Trial steps from s see no further than the pieces next to that of s, so that none is traced in vain.
  void look_from(double s);
  // x in [-1, 1] of the first piece, or nearer to its begin where it leads on to a pose that nothing can be
  // tabulated to.
  double known_place(const PathPiece& piece, double x) const;

 protected:
  const PathTable::Segment* in_reach(double s) const {
    return s >= low_ && s <= high_ ? table_->segment_within_reach(s) : nullptr;
  }
  bool pulls(std::size_t cable) const { return pulling_[cable] != 0; }

 private:
  const Path& path_;
  PathForces forces_;
  std::vector<char> pulling_;
  std::vector<int> slips_;
  double low_ = 0, high_ = 0;  // where it may be asked
  mutable std::optional<PathTable> table_;
};

// What prescribes the motion: s follows from measure(s) = target(t).
struct PathDrive {
  TimeFunction target;
  Index column = -1;
  bool there() const { return column >= 0; }
};

// s(t) as far as it is known, from a start at one time to the last.
class PathMotion {
 public:
  void begin(double t, double s, double v) { t_ = t, s_ = s, v_ = v; }
  void prescribe(const PathLaw& law, const PathDrive& drive) { law_ = &law, drive_ = drive; }

  // On to `latest` or less. Throws PathRefused where no step can be solved.
  void advance(PathLaw& law, double latest);
  void cut(double t);                   // what lies behind is forgotten
  void set_speed(double v) { v_ = v; }  // an impulse, now
  void rest(double t);                  // stood still until then
  void at(double t, double& s, double& v) const;
  // Times between two without which the quintic through their coordinates, rates and accelerations is not
  // this motion: what dampers stop at once.
  std::vector<double> unseen_between(const PathLaw& law, double from, double to) const;

  double t() const { return t_; }
  double s() const { return s_; }
  double v() const { return v_; }
  double step_start() const { return from_; }  // of the last step
  long iterations() const { return iterations_; }

 private:
  void on_drive(double t, double& s, double& v) const;
  void refuse_turn_at_dead_centre(double latest) const;

  double t_ = 0, s_ = 0, v_ = 0, from_ = 0, h_ = 0;
  std::vector<ScalarStep> steps_;
  const PathLaw* law_ = nullptr;
  PathDrive drive_;
  long iterations_ = 0;
};

}  // namespace unfurl
