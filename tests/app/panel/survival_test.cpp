// SPDX-License-Identifier: BSD-3-Clause
// What goes wrong inside a frame is said, and the panel with its changes stays.
#include <catch2/catch.hpp>
#include <filesystem>
#include <stdexcept>

#include "tests/app/panel/panel_driver.hpp"
#include "tests/app/run_program.hpp"

namespace unfurl::survival_test {

namespace fs = std::filesystem;

TEST_CASE(
    "an exception in the middle of a frame is a message, and the next frames are as if there had been none") {
  PanelOptions options = PanelDriver::small();
  options.measure_errors = false;
  options.clipboard.set = [](const char*) { throw std::runtime_error("no clipboard here"); };
  PanelDriver driver(options);
  driver.drag("structure.post_length", 0.5, 0.6);
  driver.settle();
  const std::string edited = driver.state().history.now().edits.empty() ? "" : "edited";
  driver.move(-1, -1);
  driver.settle();
  const Image before = driver.picture();
  driver.state().export_open = true;
  driver.frame();
  driver.frame();
  CHECK_NOTHROW(driver.click("copy"));  // inside the export box, with colours and sizes set for it
  CHECK(driver.state().message == "no clipboard here");
  CHECK(edited == "edited");
  CHECK_FALSE(driver.state().history.now().edits.empty());
  driver.state().export_open = false;
  driver.state().message.clear();
  driver.move(-1, -1);
  driver.settle();
  CHECK(driver.picture().rgba == before.rgba);
}

TEST_CASE("no name that is typed ends the panel") {
  PanelDriver driver;
  driver.state().export_open = true;
  for (const std::string& name :
       {std::string(300, 'n'), std::string(5000, '/'), std::string("/proc/1/fd/x/y")}) {
    driver.state().export_path = name;
    CHECK_NOTHROW(driver.frame());
    CHECK(driver.panel().has_place("save"));  // the box came to its end
    CHECK(driver.panel().has_place("close export"));
  }
}

TEST_CASE("the figures show the present time as a line, and it moves with the time") {
  PanelDriver driver;
  driver.frame();
  std::string key;
  for (const char* name : {"figure deployment 0", "figure energy 0", "figure constraint_error 0"})
    if (key.empty() && driver.panel().has_place(name)) key = name;
  REQUIRE_FALSE(key.empty());
  const plot::Rect frame = driver.panel().place(key);
  const Trajectory& run = driver.state().shown->simulation.trajectory;
  const auto picture_at = [&](double share) {
    driver.state().playback.t = share * run.end_time();
    driver.move(-1, -1);
    driver.frame();
    return driver.picture();
  };
  const Image early = picture_at(0.3), late = picture_at(0.6);
  // In every row of the frame: where the line was, and where it is now.
  int rows = 0;
  for (int y = static_cast<int>(frame.y0) + 2; y < static_cast<int>(frame.y1) - 2; ++y) {
    int differing = 0;
    for (int x = static_cast<int>(frame.x0); x < static_cast<int>(frame.x1); ++x) {
      const auto at = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(early.width) +
                           static_cast<std::size_t>(x));
      differing += early.rgba[at] != late.rgba[at] || early.rgba[at + 1] != late.rgba[at + 1];
    }
    rows += differing >= 2;
  }
  CHECK(rows >= static_cast<int>(frame.height()) - 6);
}

TEST_CASE("an export of a scene that is in no file replaces none") {
  const ScratchDirectory scratch;
  const std::string mine = scratch.write("out.toml", "# my own scene\n");
  SceneDocument document = document_of_family("pendulum");
  document.path.clear();
  const auto words = export_words(document, export_kinds()[2], scratch / "out");
  CHECK(file_text(mine) == "# my own scene\n");
  CHECK(words[1] == scratch / "out-2.toml");
  CHECK(export_words(document, export_kinds()[2], scratch / "out")[1] == words[1]);  // the same text
}

TEST_CASE("a message goes when some more was done, and what is still so is still said") {
  PanelOptions options = PanelDriver::small();
  options.measure_errors = false;
  PanelDriver driver(options, "pendulum");
  driver.key(Key::v);
  const std::string message = driver.state().message;
  REQUIRE_FALSE(message.empty());
  driver.key(Key::end);
  CHECK(driver.state().message == message);  // it can be read
  driver.key(Key::home);
  driver.click("view");
  driver.click("view");
  CHECK(driver.state().message.empty());
  for (int i = 0; i < 4; ++i) driver.key(Key::v);  // said again
  CHECK(driver.state().message == message);

  LiveSession session(open_document("pendulum", {}),
                      {.at = 0, .measure_errors = false, .wake = {}, .picture = {}});
  session.state().message = "exporting";
  session.state().exporting.running = true;
  for (int i = 0; i < 9; ++i) session.note_press();
  CHECK(session.state().message == "exporting");
  session.state().exporting.running = false;
  for (int i = 0; i < 9; ++i) session.note_press();
  CHECK(session.state().message.empty());
}

}  // namespace unfurl::survival_test
