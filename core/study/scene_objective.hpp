// SPDX-License-Identifier: BSD-3-Clause
// A measure of a scene's run as a function of one of its keys.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnostics/measures.hpp"
#include "core/simulate/simulation.hpp"
#include "core/study/scene_variation.hpp"

namespace unfurl {

// Solved for, searched, plotted: each value is a run of its own, judged as `run` does it.
class SceneObjective {
 public:
  SceneObjective(SceneSource source, std::string key, RunMeasure measure, SimulationHooks hooks);

  // NaN where x is no valid value of the key or the run failed. Throws Cancelled.
  double at(double x);
  std::string why_none(double x) const;  // empty: there is a run
  // Of the run at an x that was asked for: what it is warned of, and that its force is not unique.
  std::vector<std::string> warnings(double x) const;
  std::optional<bool> unique(double x) const;  // none: not a force, or no run
  std::string note(double x) const;            // how far it got where it ended before it was deployed

 private:
  struct Told {
    std::vector<std::string> warnings;
    std::optional<bool> unique;
    std::string note;
  };
  SceneSource source_;
  std::string key_;
  RunMeasure measure_;
  SimulationHooks hooks_;
  std::map<double, Told> told_;
  std::map<double, std::string> none_;
};

}  // namespace unfurl
