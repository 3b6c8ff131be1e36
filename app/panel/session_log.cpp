// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/session_log.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/export/checksum.hpp"
#include "core/text/nearest_name.hpp"
#include "core/text/version.hpp"

namespace unfurl {

namespace {

using nlohmann::json;
using Kind = InputEvent::Kind;

json json_of(const InputEvent& e) {
  switch (e.kind) {
    case Kind::move:
      return {"move", e.x, e.y};
    case Kind::button:
      return e.time < 0 ? json{"button", e.button, e.down} : json{"button", e.button, e.down, e.time};
    case Kind::wheel:
      return {"wheel", e.x, e.y};
    case Kind::key: {
      json words = {"key", name_of(e.key), e.down};
      if (e.control) words.push_back("control");
      if (e.shift) words.push_back("shift");
      if (e.alt) words.push_back("alt");
      return words;
    }
    case Kind::text:
      return {"text", e.text};
    case Kind::drop:
      return {"drop", e.text};
    case Kind::focus_lost:
      return {"focus_lost"};
    case Kind::close:
      return {"close"};
  }
  return {};
}

json json_of(const RunError& e) {  // a number that is not there becomes null
  return {{"run", e.run}, {"error", e.error}, {"uncertainty", e.uncertainty},
          {"end", e.end}, {"cpu_s", e.cpu_s}, {"why", e.why}};
}

json json_of(const JobState& job) {
  return {job.running, job.progress, job.doing, job.late};
}

std::string dumped(const json& line) {
  return line.dump(-1, ' ', false, json::error_handler_t::replace);
}

// Positions and velocities of a run, to the last bit.
std::string checksum_of_run(const LiveRun& run) {
  Checksum sum;
  const Trajectory& trajectory = run.simulation.trajectory;
  for (const std::size_t i : {std::size_t{0}, trajectory.size() / 2, trajectory.size() - 1}) {
    const VectorXd q = trajectory.positions(i);
    sum.add(std::as_bytes(std::span(q.data(), static_cast<std::size_t>(q.size()))));
  }
  return sum.text();
}

std::string checksum_of_picture(const Image& image) {
  Checksum sum;
  sum.add(std::as_bytes(std::span(image.rgba)));
  return sum.text();
}

// Mean colours of 16 x 9 parts of the picture: for machines that round a shade otherwise.
std::vector<int> shades_of(const Image& image) {
  constexpr int across = 16, down = 9;
  std::vector<int> shades;
  for (int row = 0; row < down; ++row)
    for (int column = 0; column < across; ++column) {
      std::array<long, 3> sum{};
      long count = 0;
      for (int y = row * image.height / down; y < (row + 1) * image.height / down; ++y)
        for (int x = column * image.width / across; x < (column + 1) * image.width / across; ++x, ++count)
          for (std::size_t c = 0; c < 3; ++c)
            sum[c] += image.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                      static_cast<std::size_t>(x)) +
                                 c];
      for (const long part : sum) shades.push_back(static_cast<int>(part / std::max(1L, count)));
    }
  return shades;
}

}  // namespace

json described_state(const PanelState& s) {
  json out = {{"scene", s.history.now().name},
              {"set", overrides_of(s.history.now())},
              {"undo", s.history.can_undo()},
              {"time", s.playback.t},
              {"playing", s.playback.playing},
              {"selected", s.selected.name},
              {"message", s.message},
              {"dark", s.dark},
              {"panes", {s.left_open, s.right_open, s.studies_open}},
              {"boxes", {s.help_open, s.export_open, s.files_open, s.palette_open, s.tour, s.question.text}},
              {"tool", static_cast<int>(s.tool)},
              {"running", s.simulation.running},
              {"runs", s.trade.size()}};
  if (s.orbit)
    out["camera"] = {s.orbit->azimuth,    s.orbit->elevation,  s.orbit->distance,
                     s.orbit->target.x(), s.orbit->target.y(), s.orbit->target.z()};
  for (const SceneProblem& problem : s.problems) out["problems"].push_back(problem_text(problem));
  for (const SceneProblem& problem : s.picture_problems) out["problems"].push_back(problem_text(problem));
  if (s.shown)
    out["shown"] = {{"run", s.shown->id},
                    {"status", to_string(s.shown->simulation.status)},
                    {"end_s", s.shown->simulation.trajectory.end_time()},
                    {"steps", s.shown->simulation.steps},
                    {"bits", checksum_of_run(*s.shown)}};
  if (s.pinned) out["pinned"] = s.pinned->id;
  if (!s.trade.empty() && std::isfinite(s.trade.back().position_error))
    out["position_error"] = s.trade.back().position_error;
  return out;
}

void require_recordable(const std::string& path) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown) || std::filesystem::file_size(path, unknown) == 0)
    return;
  std::ifstream file(path, std::ios::binary);
  std::string line;
  if (file.peek() == '{') std::getline(file, line);
  const json first = json::parse(line, nullptr, false);
  if (!first.is_object() || !first.contains("unfurl_session"))
    throw FileError(path, "is there and no session: --record would replace it; name another file");
}

SessionRecorder::SessionRecorder(const std::string& path, const SessionStart& start)
    : path_((require_recordable(path), path)),
      file_(path, std::ios::binary | std::ios::trunc),
      line_(std::make_unique<json>(json::object())),
      state_(std::make_unique<json>()) {
  if (!file_) throw FileError(path, errno);
  const SceneDocument& d = start.document;
  write({{"unfurl_session", 1},
         {"unfurl", version()},
         {"scene", {{"path", d.path}, {"name", d.name}, {"folder", d.folder}, {"text", *d.text}}},
         {"overrides", d.overrides},
         {"size", {start.width, start.height}},
         {"scale", start.scale},
         {"at", start.at},
         {"measure_errors", start.measure_errors},
         {"graphics", start.graphics},
         {"settings", json::parse(settings_text(start.settings))}});
}

SessionRecorder::~SessionRecorder() = default;

void SessionRecorder::write(const json& line) {
  file_ << dumped(line) << "\n" << std::flush;
  if (!file_) throw FileError(path_, "the session cannot be recorded any further");
}

void SessionRecorder::note(const InputEvent& event) {
  (*line_)["events"].push_back(json_of(event));
}

void SessionRecorder::note_size(int width, int height) {
  (*line_)["events"].push_back({"size", width, height});
}

void SessionRecorder::note_clipboard(const std::string& text) {
  (*line_)["clipboard"] = text;
}

void SessionRecorder::frame(double seconds, bool visible, const LiveSession& session,
                            const std::optional<Image>& picture) {
  json& line = *line_;
  line["frame"] = seconds;
  if (!visible) line["hidden"] = true;
  const Arrivals& now = session.arrived();
  if (now.run) line["run"] = now.run_cpu_s;
  if (now.coarse) line["coarse"] = true;
  if (now.study) line["study"] = true;
  if (!now.report.empty()) line["report"] = now.report;
  for (const RunError& error : now.errors) line["errors"].push_back(json_of(error));
  if (now.simulation != before_.simulation) line["simulation"] = json_of(now.simulation);
  if (now.studying != before_.studying) line["studying"] = json_of(now.studying);
  if (now.exporting != before_.exporting) line["exporting"] = json_of(now.exporting);
  if (now.own_file != before_.own_file) line["own_file"] = static_cast<int>(now.own_file);
  before_ = now;
  json state = described_state(session.state());
  if (state != *state_) line["state"] = *state_ = std::move(state);
  if (picture) {
    const std::string sum = checksum_of_picture(*picture);
    if (sum != picture_) line["picture"] = {{"checksum", sum}, {"shades", shades_of(*picture)}};
    picture_ = sum;
  }
  write(line);
  line = json::object();
}

InputEvent event_of(const json& words) {
  InputEvent e;
  const std::string kind = words.at(0);
  if (kind == "move" || kind == "wheel") {
    e.kind = kind == "move" ? Kind::move : Kind::wheel;
    e.x = words.at(1);
    e.y = words.at(2);
  } else if (kind == "button") {
    e.kind = Kind::button;
    e.button = words.at(1);
    e.down = words.at(2);
    if (words.size() > 3) e.time = words[3];
  } else if (kind == "key") {
    e.kind = Kind::key;
    const std::string name = words.at(1);
    e.key = key_named(name);
    if (e.key == Key::none && name != name_of(Key::none))
      throw std::out_of_range("no key is called " + in_quotes(name));
    e.down = words.at(2);
    for (std::size_t i = 3; i < words.size(); ++i) {
      if (words[i] == "control") e.control = true;
      if (words[i] == "shift") e.shift = true;
      if (words[i] == "alt") e.alt = true;
    }
  } else if (kind == "text" || kind == "drop") {
    e.kind = kind == "text" ? Kind::text : Kind::drop;
    e.text = words.at(1);
  } else if (kind == "focus_lost") {
    e.kind = Kind::focus_lost;
  } else if (kind == "close") {
    e.kind = Kind::close;
  } else {
    throw std::out_of_range("no event is called " + in_quotes(kind));
  }
  return e;
}

namespace {

double number_of_json(const json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

void read_job(const json& line, const char* key, JobState& job) {
  if (const auto it = line.find(key); it != line.end())
    job = {it->at(0).get<bool>(), it->at(1).get<double>(), it->at(2).get<std::string>(),
           it->size() > 3 && it->at(3).get<bool>()};
}

}  // namespace

SessionStart session_start(const json& line) {
  SessionStart start;
  const json& scene = line.at("scene");
  start.document.path = scene.at("path");
  start.document.name = scene.at("name");
  start.document.folder = scene.at("folder");
  start.document.text = std::make_shared<const std::string>(scene.at("text").get<std::string>());
  start.document.overrides = line.at("overrides").get<std::vector<std::string>>();
  start.width = line.at("size").at(0);
  start.height = line.at("size").at(1);
  start.scale = line.at("scale");
  if (!(start.scale >= 0.25f && start.scale <= 16)) throw std::out_of_range("scale: must be in [0.25, 16]");
  start.at = line.at("at");
  start.measure_errors = line.at("measure_errors");
  start.graphics = line.at("graphics");
  start.settings = settings_of(line.at("settings").dump());
  return start;
}

Arrivals arrivals_of(const json& line, const Arrivals& before) {
  Arrivals now;
  now.simulation = before.simulation;
  now.studying = before.studying;
  now.exporting = before.exporting;
  const int file = line.value("own_file", static_cast<int>(before.own_file));
  now.own_file = static_cast<OwnFile>(std::clamp(file, 0, static_cast<int>(OwnFile::changed)));
  read_job(line, "simulation", now.simulation);
  read_job(line, "studying", now.studying);
  read_job(line, "exporting", now.exporting);
  now.run = line.contains("run");
  if (now.run) now.run_cpu_s = number_of_json(line["run"]);
  now.coarse = line.contains("coarse");
  now.study = line.contains("study");
  now.report = line.value("report", "");
  for (const json& e : line.value("errors", json::array()))
    now.errors.push_back({.run = e.at("run"),
                          .error = number_of_json(e.at("error")),
                          .uncertainty = number_of_json(e.at("uncertainty")),
                          .end = e.at("end"),
                          .cpu_s = e.at("cpu_s"),
                          .why = e.at("why")});
  return now;
}

std::string state_difference(const json& was, const json& is) {
  for (const auto& [key, value] : was.items())
    if (!is.contains(key) || dumped(is[key]) != dumped(value))
      return key + " was " + dumped(value) + ", is " + (is.contains(key) ? dumped(is[key]) : "missing");
  for (const auto& [key, value] : is.items())
    if (!was.contains(key)) return key + " was missing, is " + dumped(value);
  return "";
}

std::string picture_difference(const json& was, const Image& is, bool same_graphics) {
  if (was.at("checksum") == checksum_of_picture(is)) return "";
  constexpr int shade = 3;  // of 255: the mean of a part, where edges are smoothed otherwise
  const std::vector<int> shades = shades_of(is);
  int most = 0;
  for (std::size_t i = 0; i < shades.size(); ++i)
    most = std::max(most, std::abs(shades[i] - was.at("shades").at(i).get<int>()));
  if (same_graphics) return "the picture has other pixels";
  return most <= shade ? "" : "the picture differs by " + std::to_string(most) + " of 255 in a part of it";
}

}  // namespace unfurl
