// SPDX-License-Identifier: BSD-3-Clause
// What a person did, played again: the same states and the same pixels.
#include "app/panel/session_log.hpp"

#include <signal.h>
#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/export/atomic_file.hpp"
#include "tests/app/panel/panel_driver.hpp"
#include "tests/app/run_program.hpp"

using namespace unfurl;

namespace session_log_test {

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

// A session of everything that one does: sliders, time, view, keys, a mistake, a box, text.
void record(const std::string& path) {
  PanelOptions options = PanelDriver::small();
  options.record = path;
  PanelDriver driver(options);
  driver.drag("structure.post_length", 0.5, 0.7);
  driver.settle();
  driver.drag("timeline", 0.2, 0.6);
  driver.drag("view", 0.3, 0.5);
  driver.key(Key::p);
  driver.key(Key::f1);
  driver.key(Key::escape);
  driver.click("structure.density", 1);
  driver.key(Key::escape);
  driver.key(Key::p, true);
  driver.type("light");
  driver.key(Key::enter);
  driver.panel().resize(900, 500);
  driver.settle();
  driver.key(Key::space);
  for (int i = 0; i < 5; ++i) driver.frame(0.03);
  driver.key(Key::space);
  driver.settle();
}

}  // namespace

TEST_CASE("a recorded session has the same states and pixels when it is played again") {
  const ScratchDirectory scratch;
  record(scratch / "session.jsonl");
  const auto context = make_offscreen_context();
  const Replay replay = replay_session(*context, scratch / "session.jsonl");
  for (const std::string& difference : replay.differences) FAIL_CHECK(difference);
  CHECK(replay.same_graphics);
  CHECK(replay.frames > 40);
  CHECK(replay.states > 15);
  CHECK(replay.pictures > 5);
  CHECK(replay.last.width == 900);
  const ProgramResult program =
      run_program({"view", "--replay", scratch / "session.jsonl", "--picture", scratch / "last.png"});
  CHECK(program.code == 0);
  CHECK_FALSE(file_text(scratch / "last.png").empty());

  // What differs is said, with the frame and what it should have been.
  auto lines = lines_of(file_text(scratch / "session.jsonl"));
  for (std::string& line : lines) {
    nlohmann::json parsed = nlohmann::json::parse(line);
    if (!parsed.contains("state") || !parsed["state"].contains("shown")) continue;
    parsed["state"]["time"] = 123.5;
    line = parsed.dump();
    break;
  }
  const std::string other = scratch.write("other.jsonl", joined(lines));
  const ProgramResult differing = run_program({"view", "--replay", other});
  CHECK(differing.code == 7);
  CHECK(differing.out.find("time was 123.5, is 0") != std::string::npos);
}

TEST_CASE("a session that is written by hand names the widgets that it touches") {
  const ScratchDirectory scratch;
  record(scratch / "session.jsonl");
  auto lines = lines_of(file_text(scratch / "session.jsonl"));
  // Up to where the first run is shown, then by hand.
  std::size_t count = 0;
  while (count < lines.size() && lines[count].find("\"shown\"") == std::string::npos) ++count;
  lines.resize(count + 1);
  lines.emplace_back(R"({"frame": 0.01})");
  lines.emplace_back(R"({"frame": 0.01, "events": [["at", "theme", 0.5, 0.5]]})");
  lines.emplace_back(R"({"frame": 0.01, "events": [["button", 0, true]]})");
  lines.emplace_back(R"({"frame": 0.01, "events": [["button", 0, false]]})");
  lines.emplace_back(R"({"frame": 0.01, "state": {"dark": true}})");
  const auto context = make_offscreen_context();
  const Replay replay = replay_session(*context, scratch.write("by_hand.jsonl", joined(lines)));
  REQUIRE(replay.differences.size() == 1);  // of a state that is not said whole
  CHECK(replay.differences[0].find("dark") == std::string::npos);
  // What is unknown is said, and in which line.
  const std::string line = "line " + std::to_string(lines.size() + 1);
  for (const auto& [event, name] :
       {std::pair{R"(["at", "no such widget", 0.5, 0.5])", "'no such widget'"},
        std::pair{R"(["key", "any", true])", "'any'"}, std::pair{R"(["wave"])", "'wave'"}}) {
    lines.emplace_back(std::string(R"({"frame": 0.01, "events": [)") + event + "]}");
    const std::string file = scratch.write("wrong.jsonl", joined(lines));
    CHECK_THROWS_WITH(replay_session(*context, file), Catch::Contains(line) && Catch::Contains(name));
    CHECK_THROWS_AS(replay_session(*context, file), FileError);
    lines.pop_back();
  }
}

TEST_CASE("a session of a scale that no window has is refused in a line") {
  const ScratchDirectory scratch;
  record(scratch / "session.jsonl");
  auto lines = lines_of(file_text(scratch / "session.jsonl"));
  nlohmann::json first = nlohmann::json::parse(lines[0]);
  REQUIRE(first.at("scale") == 0.75);
  for (const double scale : {0.0, -1.0, 1e6}) {
    INFO(scale);
    first["scale"] = scale;
    lines[0] = first.dump();
    const ProgramResult result =
        run_program({"view", "--replay", scratch.write("scaled.jsonl", joined(lines))});
    CHECK(result.code == 5);
    CHECK(result.err.find("scale") != std::string::npos);
  }
}

TEST_CASE("a file that is no session is refused in a line") {
  const ScratchDirectory scratch;
  for (const char* text :
       {"", "{}\n", "no json\n", "{\"unfurl_session\": 1}\n", "[1, 2]\n", "{\"unfurl_session\": 2}"}) {
    INFO(text);
    const ProgramResult result = run_program({"view", "--replay", scratch.write("s.jsonl", text)});
    CHECK(result.code == 5);
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    CHECK(result.err.find("json.exception") == std::string::npos);
  }
  CHECK(run_program({"view", "--replay", scratch / "missing.jsonl"}).code == 5);
  CHECK(run_program({"view", "hoop6", "--replay", scratch / "missing.jsonl"}).code == 2);
}

TEST_CASE("a record replaces a session that is there, and nothing else") {
  const ScratchDirectory scratch;
  SessionStart start;
  start.document = blank_document();
  for (const char* text :
       {"title = \"Mine\"\n", "mine\n", "{}\n", "{\"a\": 1}\n", "\n", "[1, 2]\n", "{\"unfurl_se"}) {
    INFO(text);
    const std::string file = scratch.write("mine.toml", text);
    CHECK_THROWS_AS(SessionRecorder(file, start), FileError);
    const ProgramResult result =
        run_program({"view", "hoop6", "--record", file}, {.environment = {"DISPLAY="}});
    CHECK(result.code == 5);  // before a display is looked for
    CHECK(result.err.find("--record would replace it") != std::string::npos);
    CHECK(file_text(file) == text);
  }
  for (const char* name : {"new.jsonl", "new.jsonl", "empty.jsonl"}) {
    INFO(name);
    if (std::string(name) == "empty.jsonl") scratch.write(name, "");
    { const SessionRecorder recorder(scratch / name, start); }
    CHECK(lines_of(file_text(scratch / name)).size() == 1);
  }
}

TEST_CASE("every key has a name of its own") {
  for (int i = 0; i < static_cast<int>(Key::count); ++i)
    CHECK(key_named(name_of(static_cast<Key>(i))) == static_cast<Key>(i));
  CHECK(key_named("nonsense") == Key::none);
}

TEST_CASE("a session that cannot be recorded any further goes on and says so") {
  const ScratchDirectory scratch;
  const std::string file = scratch / "session.jsonl";
  PanelOptions options = PanelDriver::small();
  options.record = file;
  PanelDriver driver(options);
  driver.panel().throw_if_not_recorded();
  // A limit on files as long as this one, in place of a disk that is full.
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const auto handled = ::signal(SIGXFSZ, SIG_IGN);
  const rlimit full{std::filesystem::file_size(file), before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &full);
  driver.frame();
  CHECK(driver.state().message.find("cannot be recorded any further") != std::string::npos);
  driver.drag("structure.post_length", 0.5, 0.7);
  driver.settle();
  ::setrlimit(RLIMIT_FSIZE, &before);
  ::signal(SIGXFSZ, handled);
  CHECK(is_edited(driver.state().history.now()));
  CHECK_THROWS_AS(driver.panel().throw_if_not_recorded(), FileError);
}

}  // namespace session_log_test
