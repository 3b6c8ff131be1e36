// SPDX-License-Identifier: BSD-3-Clause
// Speed against accuracy, as the settings are changed: a point for every run of the session.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "app/panel/runs/error_meter.hpp"
#include "app/panel/runs/simulator.hpp"
#include "core/study/study.hpp"
#include "render/plot/figure.hpp"
#include "render/plot/layout.hpp"

namespace unfurl {

// What is known of a run's position error.
enum class Accuracy {
  waiting,      // it is being measured
  known,        // position_error
  no_answer,    // the run did not get through
  no_reference  // nothing to measure it by, and why
};

struct TradePoint {
  std::string method;
  std::string setting;          // "dvm, 3 stages, step 0.01 s"
  double cpu_s = 0;             // of the run; where its position error is known, up to where that is judged
  double whole_cpu_s = 0;       // of the run
  double error = 0;             // largest error of the energy balance, as a share of the energy turned over
  double constraint_error = 0;  // largest [m]
  double estimate = 0;  // of the position error, by a run with solver.tolerance [m]; NaN: it made none
  long run = 0;         // LiveRun::id
  MotionKey motion = nullptr;
  Accuracy accuracy = Accuracy::waiting;
  double position_error = std::numeric_limits<double>::quiet_NaN(), uncertainty = position_error;  // [m]
  double end = 0;        // up to when it was judged [s]
  std::string why = {};  // there is no reference
};
TradePoint trade_point(const LiveRun& run);
// What of the solver matters for speed and accuracy.
std::string setting_caption(const SolverOptions& options);
// Writes into the point of that run what was measured.
void note_error(std::vector<TradePoint>& points, const RunError& error);
// The point of a run; null: it is not among these.
const TradePoint* point_of(const std::vector<TradePoint>& points, const LiveRun& run);

// Position errors are shown, the present one's or, while that is measured, the last one's; else energy
// errors.
bool shows_positions(const std::vector<TradePoint>& points);
// A position error smaller than what is known of its reference: all that is known is that it is below that.
bool below_uncertainty(const TradePoint& point);
// The error that a point is drawn at, no lower than it is known; NaN: it is not drawn.
double shown_error(const TradePoint& point, bool positions);

// CPU time across, error up, both logarithmic; a thin line along the latest points of the present motion
// leads to the present one, a diamond in the foreground. Where positions are shown, runs of other motions are
// grey, and a present run that is not measured yet is a line at its CPU time. `study`: of the present motion,
// its curves as thin lines; null: none.
Figure trade_figure(const std::vector<TradePoint>& points, const Study* study = nullptr);
inline constexpr std::size_t trail_length = 8;  // how many points that line joins

// A study's figure of position errors over CPU time with the trail and the present point on it.
Figure with_present(Figure study, const std::vector<TradePoint>& points);

// "dvm, 3 stages, step 0.01 s" and the numbers, a line each: what is said of a point under the pointer.
std::string point_caption(const TradePoint& point);
// The present run's error and CPU time in a line; why there is none may take more.
std::string present_sentence(const TradePoint& point);
// The point whose mark is nearest to a place on the page and within `reach` [points]; points.size(): none.
std::size_t nearest_point(const std::vector<TradePoint>& points, const plot::PanelLayout& panel,
                          const plot::Point& at, double reach);
// Where a point's mark is on the page: a zero error is at the bottom edge; NaN: it has none.
plot::Point mark_of(const TradePoint& point, bool positions, const plot::PanelLayout& panel);

}  // namespace unfurl
