// SPDX-License-Identifier: BSD-3-Clause
// Everything that the panel knows; plain data that tests may look at and change.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "app/panel/document/build_edits.hpp"
#include "app/panel/document/edit_history.hpp"
#include "app/panel/document/own_file.hpp"
#include "app/panel/document/param_rows.hpp"
#include "app/panel/runs/simulator.hpp"
#include "app/panel/runs/study_job.hpp"
#include "app/panel/runs/trade.hpp"
#include "app/panel/view/orbit_camera.hpp"
#include "app/panel/view/picking.hpp"
#include "app/panel/view/playback.hpp"
#include "render/scene/framing.hpp"

namespace unfurl {

class LiveSession;
// What a person asked for while a frame was drawn, done when it is.
using Intent = std::function<void(LiveSession&)>;

struct ViewOptions {
  bool labels = false;  // the film's own title and time
  bool loads = true;    // arrows
  bool ghost = true;    // the pinned run behind the present one

  bool operator==(const ViewOptions&) const = default;
};

// The place of the view in the window.
struct ViewPlace {
  int width = 1280, height = 720;  // [pixels]
  float words = 1;                 // times the least size of what is written
  CornerRoom heading = {};         // what says which run it is, over the view

  bool operator==(const ViewPlace&) const = default;
};

// Work beside the window, as it stands.
struct JobState {
  bool running = false;
  double progress = 0;  // 0..1
  std::string doing = {};
  bool late = false;  // it takes long enough for a person to be told

  bool operator==(const JobState&) const = default;
};

// What the mouse does in the view beside turning it.
enum class Tool { read, pull, build };

// A person is asked before something is lost; each answer with what it does.
struct Question {
  std::string text;  // empty: there is none
  std::vector<std::pair<std::string, Intent>> answers;
};

struct PanelState {
  explicit PanelState(SceneDocument document) : history(std::move(document)) {}

  EditHistory history;
  OwnFile own_file = OwnFile::same;    // of the document
  Scene base;                          // the scene without edits
  Selection described;                 // what sections were made for
  std::vector<ParamSection> sections;  // of the scene without edits
  ParamRow title_row;                  // likewise
  std::vector<Intent> intents;         // of the frame that is drawn

  std::shared_ptr<const LiveRun> shown;        // the latest run that finished; null at first
  std::shared_ptr<const LiveRun> pinned;       // A of the comparison; null: none
  JobState simulation, studying, exporting;    // a newer run, a study, an export that is being made
  std::vector<SceneProblem> problems;          // of the scene as edited; empty: it is sound
  RenderOptions picture;                       // how the view looks, as edited
  std::vector<SceneProblem> picture_problems;  // of that: names that this run does not know
  std::vector<TradePoint> trade;               // of every run so far
  long trade_news = 0;                         // counts what happened to those
  std::string message;                         // other trouble, or what was done, in a line

  Playback playback;
  double frames_per_second = 0;  // while it plays, smoothed
  ViewOptions view;
  ViewPlace view_place;
  std::optional<OrbitCamera> orbit;       // none: the camera that frames the motion
  std::optional<OrbitCamera> build_view;  // that Build began with, which frames the start
  Selection selected, hovered;

  bool dark = false;
  bool help_open = false, export_open = false, files_open = false, palette_open = false;
  std::string export_path;            // of the scene's file; empty: not thought of yet
  std::string export_output = "out";  // directory of film and figures
  std::size_t export_kind = 0;        // of export_kinds()
  std::string exported;               // the directory of the last export that came to its end
  std::string file_path;              // typed in the box of files
  std::vector<std::string> recent;    // scene files, the latest first
  std::string palette_query;
  int palette_row = 0;
  std::string reveal;            // a parameter's key: scrolled to and given the keyboard, once
  std::set<std::string> folded;  // entries of lists whose rows are not shown, by key
  Question question;
  int tour = 0;  // step of the guided tour; 0: none
  Tool tool = Tool::read;
  std::string grabbed;            // the node that the mouse holds; empty: none
  std::optional<VectorXd> pose;   // that a hand leads the whole structure to [3 N]
  int wiggled = -1, motions = 0;  // the free motion that is shown, of how many
  BuildGrid grid;
  bool left_open = true, right_open = true;
  bool studies_open = false;                    // on the right, instead of figures
  StudyRequest study;                           // to be started
  std::shared_ptr<const StudyOutcome> studied;  // the last that finished
  bool closed = false;                          // the window is to go
};

}  // namespace unfurl
