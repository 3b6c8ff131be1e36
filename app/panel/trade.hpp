// Speed against accuracy, as the settings are changed: a point for every run of the session.
#pragma once

#include <string>
#include <vector>

#include "app/panel/simulator.hpp"
#include "render/plot/figure.hpp"
#include "render/plot/layout.hpp"

namespace unfurl {

struct TradePoint {
  std::string method;
  std::string setting;  // "dvm, 3 stages, step 0.01 s"
  double cpu_s = 0;
  double error = 0;             // largest error of the energy balance, as a share of the energy turned over
  double constraint_error = 0;  // largest [m]
  double position_error = 0;    // of nodes, as estimated by a run with solver.tolerance [m]; NaN: it was not
};
TradePoint trade_point(const LiveRun& run);
// What of the solver matters for speed and accuracy.
std::string setting_caption(const SolverOptions& options);

// CPU time across, error up, both logarithmic; a thin line along the latest points leads to the present one,
// which is in the foreground.
Figure trade_figure(const std::vector<TradePoint>& points);
inline constexpr std::size_t trail_length = 8;  // how many points that line joins

// "dvm, 3 stages, step 0.01 s" and the numbers, a line each: what is said of a point under the pointer.
std::string point_caption(const TradePoint& point);
// The point whose mark is nearest to a place on the page and within `reach` [points]; points.size(): none.
std::size_t nearest_point(const std::vector<TradePoint>& points, const plot::PanelLayout& panel,
                          const plot::Point& at, double reach);
// Where a point's mark is on the page: a zero error is at the bottom edge.
plot::Point mark_of(const TradePoint& point, const plot::PanelLayout& panel);

}  // namespace unfurl
