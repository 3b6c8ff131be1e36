// Energy that goes in and out without a potential: what closes the energy balance of loads that vary,
// dampers, drives and impacts.
#pragma once

#include <vector>

#include "core/simulate/simulation.hpp"

namespace unfurl {

// Since the start, at every state [J]; zeros where a scene has no such thing.
struct EnergyFlow {
  std::vector<double> load_work, dissipated, drive_work, impact_loss;
};

// Powers are integrated over each step with three Gauss points (order 6) on the quintic that has the
// coordinates, rates and accelerations of the states at both ends: an independent quadrature, whatever the
// method, of order 6 where the forces are smooth within steps. A drive's power -l lambda f' takes its
// multiplier from the index-1 equations at those points.
EnergyFlow energy_flow(const Simulation& run);

}  // namespace unfurl
