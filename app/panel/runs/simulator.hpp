// SPDX-License-Identifier: BSD-3-Clause
// Simulates beside the window: the newest request only.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/panel/document/scene_document.hpp"
#include "app/panel/runs/motion.hpp"
#include "app/panel/runs/worker.hpp"
#include "core/diagnostics/diagnostics.hpp"

namespace unfurl {

// A finished run and what belongs to it; immutable.
struct LiveRun {
  long id = 0;  // of the request that asked for it
  SceneDocument document;
  Scene scene;
  MotionKey motion;  // what it is a solution of
  Simulation simulation;
  Diagnostics diagnostics;
  std::vector<std::string> warnings;
  bool coarse = false;  // of a large structure something quick, until its own run is there
};

// How the run ended, what it cost, and which model was solved and why: "deployed at 4.92 s, ...".
std::string state_sentence(const LiveRun& run);
// "2 warnings: ", and the first of them; empty: none.
std::string warning_sentence(const LiveRun& run);

struct SimulationOutcome {
  long id = 0;                         // of the request
  std::shared_ptr<const LiveRun> run;  // null: the scene is at fault, and why follows
  std::vector<SceneProblem> problems;
  std::string message;  // of other failures
};

class Simulator : public Worker<SceneDocument, SimulationOutcome> {
 public:
  explicit Simulator(std::function<void()> wake = {});
};

}  // namespace unfurl
