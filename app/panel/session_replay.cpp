// SPDX-License-Identifier: BSD-3-Clause
// Plays what session_log.cpp wrote.
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "app/panel/control_panel.hpp"
#include "app/panel/session_log.hpp"
#include "core/scene/text_file.hpp"

namespace unfurl {

using nlohmann::json;

namespace {

constexpr std::size_t most_differences = 10;  // that are told

class Player {
 public:
  Player(GlContext& context, const json& start)
      : panel_(context, session_start(start).document, options_of(session_start(start))) {
    replay_.same_graphics = session_start(start).graphics == context.description();
  }

  void play(const json& line) {
    clipboard_ = line.value("clipboard", clipboard_);
    for (const json& words : line.value("events", json::array())) handle(words);
    arrivals_ = arrivals_of(line, arrivals_);
    panel_.tell(arrivals_);
    panel_.frame(line.at("frame"), !line.value("hidden", false));
    ++replay_.frames;
    if (line.contains("state")) {
      ++replay_.states;
      differs(state_difference(line["state"], described_state(panel_.state())));
    }
    if (line.contains("picture")) {
      ++replay_.pictures;
      differs(picture_difference(line["picture"], panel_.picture().read(), replay_.same_graphics));
    }
  }
  Replay end() {
    replay_.last = panel_.picture().read();
    return std::move(replay_);
  }

 private:
  PanelOptions options_of(const SessionStart& start) {
    PanelOptions options;
    options.width = start.width;
    options.height = start.height;
    options.scale = start.scale;
    options.settings = start.settings;
    options.at = start.at;
    options.measure_errors = start.measure_errors;
    options.replayed = true;
    options.clipboard.get = [this] { return clipboard_; };
    return options;
  }
  void handle(const json& words) {
    if (words.at(0) == "size") return panel_.resize(words.at(1), words.at(2));
    if (words.at(0) != "at") return panel_.handle(event_of(words));
    const plot::Rect& place = panel_.place(words.at(1));
    InputEvent event;
    event.x = static_cast<float>(place.x0 + words.at(2).get<double>() * place.width());
    event.y = static_cast<float>(place.y0 + words.at(3).get<double>() * place.height());
    panel_.handle(event);
  }
  void differs(const std::string& how) {
    if (!how.empty() && replay_.differences.size() < most_differences)
      replay_.differences.push_back("frame " + std::to_string(replay_.frames) + ": " + how);
  }

  std::string clipboard_;
  Arrivals arrivals_;
  Replay replay_;
  ControlPanel panel_;
};

}  // namespace

Replay replay_session(GlContext& context, const std::string& path) {
  const TextFile file = read_text_file(path);
  if (!file.error.empty()) throw FileError(path, file.error);
  std::unique_ptr<Player> player;
  long number = 0;
  try {
    for (std::size_t at = 0; at < file.text.size();) {
      const std::size_t end = std::min(file.text.find('\n', at), file.text.size());
      ++number;
      const json line = json::parse(file.text.substr(at, end - at));
      at = end + 1;
      if (player)
        player->play(line);
      else if (line.value("unfurl_session", 0) == 1)
        player = std::make_unique<Player>(context, line);
      else
        throw FileError(path, "is no session that this unfurl can play");
    }
  } catch (const json::exception&) {
    throw FileError(path, player ? "line " + std::to_string(number) + " is damaged or cut short"
                                 : "is no session; unfurl view --record FILE writes one");
  } catch (const std::out_of_range& error) {  // a widget that is not there, an unknown word
    throw FileError(path, "line " + std::to_string(number) + ": " + error.what());
  }
  if (!player) throw FileError(path, "is empty");
  return player->end();
}

}  // namespace unfurl
