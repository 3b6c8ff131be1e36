// Speed against accuracy, as the settings are changed: a point for every run of the session.
#pragma once

#include <string>
#include <vector>

#include "app/panel/simulator.hpp"
#include "render/plot/figure.hpp"

namespace unfurl {

struct TradePoint {
  std::string method;
  double cpu_s = 0;
  double error = 0;  // largest error of the energy balance, as a share of the energy turned over
};
TradePoint trade_point(const LiveRun& run);

// CPU time across, error up, both logarithmic; the last point is the present one, in the foreground.
Figure trade_figure(const std::vector<TradePoint>& points);

}  // namespace unfurl
