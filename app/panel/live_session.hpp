// SPDX-License-Identifier: BSD-3-Clause
// The heart of the panel: the document that is edited, the runs that follow it, their errors, studies and
// exports. Knows nothing of how any of it is shown.
#pragma once

#include "app/panel/document/element_menu.hpp"
#include "app/panel/panel_state.hpp"
#include "app/panel/runs/error_meter.hpp"
#include "app/panel/runs/export_process.hpp"
#include "app/panel/runs/hand.hpp"
#include "render/image/child_process.hpp"
#include "render/image/image.hpp"

namespace unfurl {

struct SessionOptions {
  double at = 0;                        // of the motion, at first [s]
  bool measure_errors = true;           // of positions, against references
  std::function<void()> wake;           // called by threads beside when there is news
  std::function<Image()> picture = {};  // as it is on the screen
  double moment = Simulator::moment;    // a run that takes longer is told of while it lasts [s]
  bool replayed = false;                // what arrives is told (tell()), and nothing is written or opened
};

// What came from the work beside in one frame, and how that stands.
struct Arrivals {
  bool run = false, coarse = false;
  double run_cpu_s = 0;
  std::vector<RunError> errors;
  bool study = false;
  std::string report;  // of an export
  OwnFile own_file = OwnFile::same;
  JobState simulation, studying, exporting;
};

// What is done with files in the folder of an export.
enum class FilesThere { asked, go_on, replaced };

class LiveSession {
 public:
  // Asks for the first run. Throws SceneError where the scene is not sound.
  LiveSession(SceneDocument document, SessionOptions options);

  PanelState& state() { return state_; }
  const PanelState& state() const { return state_; }
  // The parts of a frame; each returns whether there is something new to show. What finished beside; what was
  // asked for; what the document now asks for.
  bool take_results();
  const Arrivals& arrived() const { return arrived_; }
  void tell(Arrivals arrivals) { arrived_ = std::move(arrivals); }  // of a replay, before take_results()
  bool act();
  bool follow_document();
  void advance(double seconds);  // the motion plays, a hand wiggles
  void note_press();             // of a key or button: what was said long ago is taken away

  bool busy() const { return state_.simulation.running || simulator_.busy() || errors_.busy(); }
  // Whether its own file, or one that it names, was changed since the last frame.
  bool files_changed();
  bool has_results() const { return simulator_.ready() || errors_.ready(); }  // take_results() has some
  const Simulator& simulator() const { return simulator_; }
  const ErrorMeter& errors() const { return errors_; }

  // What intents do.
  void stop_simulation() { simulator_.cancel(); }
  void start_study();
  void stop_study() { study_.stop(); }
  // Asks where something would be replaced, or can be gone on with, and where the scene's file is no longer
  // what is shown.
  void start_export(FilesThere there = FilesThere::asked, bool as_shown = false);
  void stop_export() { export_.stop(); }
  void open_folder();                  // of the last export, in the desktop's own way
  void save(const std::string& path);  // asks likewise, and where others changed the scene's own file
  // Asks where that file would lose comments and the like; `losing`: it may.
  void save_now(const std::string& path, bool losing = false);
  void save_as();
  void save_or_ask();  // into its own file, or where to
  void add_entry(const ElementOffer& offer);
  void open(const SceneDocument& document);
  void open_file(const std::string& path);
  void build_from_nothing();
  void use_view(bool only);  // the camera as a key of the film at the present time; `only`: for all of it
  void ask_to_close();
  void take_tool(Tool tool);                               // again: put it away
  void pull(const std::string& node, const Vec3& target);  // of the whole structure [m]
  void wiggle();
  void let_go();
  // Building: nodes where nothing is, moved, joined by a rod, taken away.
  void add_node(const Vec3& place);
  void move_node(const std::string& node, const Vec3& place);
  void connect(const std::string& a, const std::string& b);
  void remove_selected();
  void screenshot();  // a PNG in the current directory

 private:
  void collect();
  void take_run(const SimulationOutcome& outcome);
  void judge_run();  // a point of speed against accuracy
  void remember(const std::string& path);
  const SceneDocument* last_saved() const { return saved_ ? &*saved_ : nullptr; }
  OwnFile own_file_now() const;
  bool named_files_changed() const;
  bool has_unsaved() const;
  void close_or_ask();  // of changes
  void ask_for_left();  // of those of scenes that were open before
  void show_hand();
  void begin_build(const std::vector<Vec3>& places);
  void build(const std::string& gesture, SceneDocument document);
  void describe();
  void watch_files();
  void update_picture();

  SessionOptions options_;
  PanelState state_;
  std::optional<SceneDocument> submitted_;
  Arrivals arrived_;
  std::optional<SimulationOutcome> outcome_;
  std::string exporting_to_;
  std::string told_, failure_;  // the message that presses are counted since; that of the present run
  int presses_ = 0;
  std::optional<SceneDocument> saved_;  // the last one that was
  OwnFileWatch own_file_;
  std::map<std::string, std::filesystem::file_time_type>
      named_files_;  // CSV files of the scene, as they were read
  ChildProcess folder_;
  Hand hand_;
  ExportProcess export_;
  StudyJob study_;
  ErrorMeter errors_;
  Simulator simulator_;  // last: ends before what it wakes
};

}  // namespace unfurl
