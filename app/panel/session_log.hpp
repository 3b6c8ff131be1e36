// SPDX-License-Identifier: BSD-3-Clause
// A session of the panel as a file: what was done, frame by frame, and what came of it. Played again it has
// the same states and pixels, without a window. JSON, a line each: first how it began, then the frames.
//
//   {"frame": 0.016, "events": [["move", 512, 303], ["button", 0, true]], "run": 0.0123, ...}
//
// seconds since the frame before, what was done (["at", "timeline", 0.5, 0.5] moves the pointer onto a
// widget: for sessions written by hand), and what arrived from the work beside: CPU time of a run, errors,
// progress. "state" and "picture" are there where they are new: what a replay compares.
#pragma once

#include <fstream>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/panel/input_event.hpp"
#include "app/panel/live_session.hpp"
#include "app/panel/settings.hpp"
#include "core/export/atomic_file.hpp"
#include "render/gl/context.hpp"

namespace unfurl {

// How a session begins.
struct SessionStart {
  SceneDocument document;
  PanelSettings settings;
  int width = 0, height = 0;  // [pixels]
  float scale = 1;
  double at = 0;
  bool measure_errors = true;
  std::string graphics;  // GlContext::description()
};

// What a person can see and has decided, as JSON: equal for equal sessions.
nlohmann::json described_state(const PanelState& state);

// Throws FileError where the file holds something else than a session, which a record would destroy.
void require_recordable(const std::string& path);

class SessionRecorder {
 public:
  // Replaces a session that is there, and nothing else. Throws FileError, also later where it can no longer
  // be written.
  SessionRecorder(const std::string& path, const SessionStart& start);
  ~SessionRecorder();

  void note(const InputEvent& event);
  void note_size(int width, int height);
  void note_clipboard(const std::string& text);
  // The frame that was drawn; `picture` where nothing more is to come by itself.
  void frame(double seconds, bool visible, const LiveSession& session, const std::optional<Image>& picture);

 private:
  void write(const nlohmann::json& line);

  std::string path_;
  std::ofstream file_;
  std::unique_ptr<nlohmann::json> line_, state_;
  Arrivals before_;
  std::string picture_;
};

struct Replay {
  long frames = 0, states = 0, pictures = 0;  // states and pictures that were compared
  std::vector<std::string> differences;       // "frame 12: state.time was 0.5, is 0.4"
  bool same_graphics = true;                  // else pictures are compared to a shade
  Image last;
};

// Plays a session in that context. Throws FileError where it cannot be read or is none.
Replay replay_session(GlContext& context, const std::string& path);

// Of the lines of such a file; these throw nlohmann::json::exception, std::out_of_range.
SessionStart session_start(const nlohmann::json& line);
Arrivals arrivals_of(const nlohmann::json& line, const Arrivals& before);
InputEvent event_of(const nlohmann::json& words);
// "camera was [..], is [..]": the first member that differs; empty: none does.
std::string state_difference(const nlohmann::json& was, const nlohmann::json& is);
// Empty: the same picture, or, on other graphics, the same to a shade.
std::string picture_difference(const nlohmann::json& was, const Image& is, bool same_graphics);

}  // namespace unfurl
