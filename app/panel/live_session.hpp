// SPDX-License-Identifier: BSD-3-Clause
// The heart of the panel: the document that is edited, the runs that follow it, their errors, studies and
// exports. Knows nothing of how any of it is shown.
#pragma once

#include "app/panel/panel_state.hpp"
#include "app/panel/runs/error_meter.hpp"
#include "app/panel/runs/export_process.hpp"
#include "render/image/image.hpp"

namespace unfurl {

struct SessionOptions {
  double at = 0;                        // of the motion, at first [s]
  bool measure_errors = true;           // of positions, against references
  std::function<void()> wake;           // called by threads beside when there is news
  std::function<Image()> picture = {};  // as it is on the screen
};

class LiveSession {
 public:
  // Asks for the first run. Throws SceneError where the scene is not sound.
  LiveSession(SceneDocument document, SessionOptions options);

  PanelState& state() { return state_; }
  const PanelState& state() const { return state_; }
  // The parts of a frame; each returns whether there is something new to show. What finished beside; what was
  // asked for; what the document now asks for.
  bool take_results();
  bool act();
  bool follow_document();

  bool busy() const { return state_.simulation.running || simulator_.busy() || errors_.busy(); }
  const Simulator& simulator() const { return simulator_; }
  const ErrorMeter& errors() const { return errors_; }

  // What intents do.
  void stop_simulation() { simulator_.cancel(); }
  void start_study();
  void stop_study() { study_.stop(); }
  void start_export(const std::string& verb);
  void save(const std::string& path);
  void add_entry(const std::string& table, std::string_view kind);
  void open(const SceneDocument& document);
  void screenshot();  // a PNG in the current directory

 private:
  void take_run(const SimulationOutcome& outcome);
  void describe();
  void update_picture();

  SessionOptions options_;
  PanelState state_;
  std::optional<SceneDocument> submitted_;
  ExportProcess export_;
  StudyJob study_;
  ErrorMeter errors_;
  Simulator simulator_;  // last: ends before what it wakes
};

}  // namespace unfurl
