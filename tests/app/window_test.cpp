// SPDX-License-Identifier: BSD-3-Clause
// The real window, end to end: on an X server of its own, driven as a person would.
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "tests/app/panel/panel_driver.hpp"
#include "tests/app/run_program.hpp"
#include "tests/support/not_tested.hpp"

using namespace unfurl;

namespace window_test {

namespace {

pid_t start(const std::string& command) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::execl("/bin/sh", "sh", "-c", ("exec " + command).c_str(), nullptr);
    ::_exit(127);
  }
  return child;
}

int end_of(pid_t child, double seconds) {  // exit code; -1 where it does not end
  int status = 0;
  for (int i = 0; i < static_cast<int>(seconds * 100); ++i) {
    if (::waitpid(child, &status, WNOHANG) == child) return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ::kill(child, SIGKILL);
  ::waitpid(child, &status, 0);
  return -1;
}

// An X server on a display of its own, whose screen is a file that can be read.
class XServer {
 public:
  explicit XServer(int dpi = 96, int width = 1280, int height = 720) {
    name_ = ":" + std::to_string(200 + ::getpid() % 500);
    pid_ = start("Xvfb " + name_ + " -screen 0 " + std::to_string(width) + "x" + std::to_string(height) +
                 "x24 -dpi " + std::to_string(dpi) + " -fbdir " + (folder_ / "") +
                 " +extension GLX >/dev/null 2>&1");
    for (int i = 0; i < 500 && !std::filesystem::exists("/tmp/.X11-unix/X" + name_.substr(1)); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ~XServer() {
    ::kill(pid_, SIGTERM);
    ::waitpid(pid_, nullptr, 0);
  }
  XServer(const XServer&) = delete;
  XServer& operator=(const XServer&) = delete;

  int tool(const std::string& words) const {
    return std::system(("DISPLAY=" + name_ + " xdotool " + words + " >/dev/null 2>&1").c_str());
  }
  const std::string& name() const { return name_; }
  // What a person sees. The file is a window dump of X (XWDFile.h): a header of numbers with the largest byte
  // first, a table of colours, and here 32 bits a pixel, blue first.
  Image screen() const {
    const std::string dump = file_text(folder_ / "Xvfb_screen0");
    const auto number = [&](std::size_t i) {
      std::size_t value = 0;
      for (std::size_t k = 0; k < 4; ++k)
        value = value << 8U | static_cast<unsigned char>(dump.at(4 * i + k));
      return value;
    };
    const std::size_t header = number(0), width = number(4), height = number(5), line = number(12),
                      colours = number(19);
    Image image{static_cast<int>(width), static_cast<int>(height),
                std::vector<std::uint8_t>(4 * width * height)};
    for (std::size_t y = 0; y < height; ++y)
      for (std::size_t x = 0; x < width; ++x)
        for (std::size_t c = 0; c < 3; ++c)
          image.rgba[4 * (y * width + x) + c] =
              static_cast<unsigned char>(dump.at(header + 12 * colours + y * line + 4 * x + 2 - c));
    return image;
  }

 private:
  ScratchDirectory folder_;
  std::string name_;
  pid_t pid_ = 0;
};

bool appears(const std::string& file) {
  for (int i = 0; i < 2000 && !std::filesystem::exists(file); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return std::filesystem::exists(file);
}

std::string middle_of(const plot::Rect& r, double share = 0.5) {
  return std::to_string(static_cast<int>(r.x0 + share * r.width())) + " " +
         std::to_string(static_cast<int>(0.5 * (r.y0 + r.y1)));
}

bool same_pixel(const Image& a, const Image& b, int x, int y) {
  const auto at =
      4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(a.width) + static_cast<std::size_t>(x));
  return std::equal(a.rgba.begin() + static_cast<std::ptrdiff_t>(at),
                    a.rgba.begin() + static_cast<std::ptrdiff_t>(at) + 3,
                    b.rgba.begin() + static_cast<std::ptrdiff_t>(at));
}

// Share of the pixels of a rectangle that differ.
double differing(const Image& a, const Image& b, const plot::Rect& in) {
  long count = 0, all = 0;
  for (int y = static_cast<int>(in.y0); y < static_cast<int>(in.y1); ++y)
    for (int x = static_cast<int>(in.x0); x < static_cast<int>(in.x1); ++x, ++all)
      count += !same_pixel(a, b, x, y);
  return static_cast<double>(count) / static_cast<double>(all);
}

// Share of the pixels that differ clearly: OpenGL on a screen may round a shade otherwise than offscreen.
double clearly_differing(const Image& a, const Image& b, const plot::Rect& in) {
  long count = 0, all = 0;
  for (int y = static_cast<int>(in.y0); y < static_cast<int>(in.y1); ++y)
    for (int x = static_cast<int>(in.x0); x < static_cast<int>(in.x1); ++x, ++all) {
      const auto at =
          4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(a.width) + static_cast<std::size_t>(x));
      int most = 0;
      for (std::size_t c = 0; c < 3; ++c)
        most = std::max(most, std::abs(static_cast<int>(a.rgba[at + c]) - static_cast<int>(b.rgba[at + c])));
      count += most > 8;
    }
  return static_cast<double>(count) / static_cast<double>(all);
}

// The screen when `what` holds of it and it no longer changes there; the last one after a minute. Many tenths
// of a second on a busy machine: conditions, not times.
template <class Condition>
Image screen_when(const XServer& server, const plot::Rect& in, const Condition& what) {
  Image last = server.screen();
  int still = 0;
  for (int i = 0; i < 600 && still < 3; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    Image now = server.screen();
    still = what(now) && differing(last, now, in) == 0 ? still + 1 : 0;
    last = std::move(now);
  }
  return last;
}

// The program's window; what it prints is in the file "log".
pid_t open_window(const XServer& server, const ScratchDirectory& scratch, const std::string& arguments) {
  PanelSettings seen;  // as of somebody who has been here before, and looked at the cards of the twin
  seen.tour_seen = true;
  seen.open_figures = {"deployment", "trade", "constraint_error"};
  save_settings(scratch / "config/unfurl/window.json", seen);
  // A sanitizer would report what the display's GL driver leaks (240 bytes, from a module that is unloaded by
  // then); leaks of the panel are looked for where it is driven without a window.
  return start("sh -c 'cd " + (scratch / "") + " && exec env ASAN_OPTIONS=detect_leaks=0 DISPLAY=" +
               server.name() + " XDG_CONFIG_HOME=" + (scratch / "config") + " HOME=" + (scratch / "home") +
               " " + UNFURL_PROGRAM + " view " + arguments + " >" + (scratch / "log") + " 2>&1'");
}

bool tools_missing() {
  return testing::lacks(testing::installed("Xvfb") && testing::installed("xdotool"),
                        "the window (apt-get install xvfb xdotool)");
}

}  // namespace

TEST_CASE("without a display the window says so in one line and names what works") {
  const ProgramResult result =
      run_program({"view", "hoop6"}, {.environment = {"DISPLAY=", "WAYLAND_DISPLAY="}});
  CHECK(result.code == 6);
  CHECK(result.err.find("unfurl render") != std::string::npos);
  CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  CHECK(run_program({"view", "hoop6"}, {.environment = {"DISPLAY=:9876"}}).code == 6);
  CHECK(run_program({"view", "nosuchscene"}).code == 5);
  CHECK(run_program({"view", "hoop6", "--set", "structure.units=2"}).code == 3);
}

TEST_CASE("a person opens the window, drags a slider, scrubs, saves, and closes it") {
  if (tools_missing()) return;
  const XServer server;
  const ScratchDirectory scratch;
  // Where everything is: the same panel without a window.
  PanelOptions options;
  PanelDriver twin(options);
  twin.state().export_path = "hoop6.toml";
  const plot::Rect slider = twin.panel().place("structure.post_length"),
                   timeline = twin.panel().place("timeline"), view = twin.panel().place("view");
  const Image alike = twin.picture();
  twin.key(Key::e);
  twin.frame();
  const plot::Rect save = twin.panel().place("save");

  const pid_t window = open_window(server, scratch, "hoop6 --set solver.step=0.05");
  REQUIRE(server.tool("search --sync --name Unfurl") == 0);
  // While the motion is simulated the view is dimmed, its corner too; that is of one colour otherwise.
  const auto corner = [&](const Image& a, const Image& b) {
    return same_pixel(a, b, static_cast<int>(view.x1) - 4, static_cast<int>(view.y1) - 9);
  };
  // It shows what the panel without a window shows, but for the CPU time in the view's second line.
  const plot::Rect motion{view.x0, view.y0 + 80, view.x1, view.y1};
  const Image opened = screen_when(
      server, view, [&](const Image& now) { return clearly_differing(alike, now, motion) < 0.01; });
  REQUIRE(clearly_differing(alike, opened, motion) < 0.01);
  REQUIRE(clearly_differing(alike, opened, slider) < 0.01);
  server.tool("mousemove 600 400 key End");
  const Image deployed = screen_when(server, view, [&](const Image& now) {
    return differing(opened, now, view) > 0.01 && corner(opened, now);
  });
  CHECK(differing(opened, deployed, view) > 0.01);

  server.tool("mousemove " + middle_of(slider, 0.5) +
              " mousedown 1 mousemove_relative 20 0 mousemove_relative 30 0 mouseup 1 mousemove 600 400");
  // The mouse is seen to have left the slider when its frame has its own colour again.
  const Image longer = screen_when(server, view, [&](const Image& now) {
    return differing(deployed, now, view) > 0.01 && corner(deployed, now) &&
           same_pixel(deployed, now, static_cast<int>(slider.x0) + 6, static_cast<int>(slider.y0) + 4);
  });
  // The number: some digits of it and the slider's grab. The picture: longer posts.
  CHECK(differing(deployed, longer, slider) > 0.02);
  CHECK(differing(deployed, longer, view) > 0.01);
  CHECK(corner(deployed, longer));

  server.tool("mousemove " + middle_of(timeline, 0.9) +
              " mousedown 1 mousemove_relative -- -100 0 mousemove_relative -- -100 0 mouseup 1");
  const Image scrubbed =
      screen_when(server, view, [&](const Image& now) { return differing(longer, now, view) > 0.01; });
  CHECK(differing(longer, scrubbed, view) > 0.01);
  CHECK(differing(longer, scrubbed, slider) == 0);  // nothing but the time was changed
  server.tool("mousemove 600 400 key e");
  // The dialog opens when the window gets to it; asked again until it is there.
  for (int i = 0; i < 40 && !std::filesystem::exists(scratch / "hoop6.toml"); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    server.tool("mousemove " + middle_of(save) + " click 1");
  }
  REQUIRE(appears(scratch / "hoop6.toml"));
  const std::string saved = file_text(scratch / "hoop6.toml");
  // The slider's new value, with the file's comments around it.
  CHECK(saved.find("# Data of the example") != std::string::npos);
  CHECK(saved.find("post_length = 1.2 ") == std::string::npos);
  server.tool("key Escape key ctrl+q");
  CHECK(end_of(window, 10) == 0);
  CHECK(file_text(scratch / "log") == "");
}

TEST_CASE("the window is as large as the monitor's fine pixels ask for, or as the user says") {
  if (tools_missing()) return;
  // The top bar of panels of either scale, drawn without a window.
  const auto panel = [](float scale) {
    PanelOptions options;
    options.scale = scale;
    options.measure_errors = false;
    PanelDriver twin(options);
    twin.move(-1, -1);
    return std::pair(twin.picture(), plot::Rect{0, 0, 330, twin.panel().place("undo").y1 + 4});
  };
  const auto coarse = panel(1), fine = panel(2);
  const XServer server(192);
  for (const bool told : {false, true}) {
    const ScratchDirectory scratch;
    const pid_t window = open_window(
        server, scratch, std::string("hoop6 --set solver.step=0.05") + (told ? " --ui-scale 1" : ""));
    REQUIRE(server.tool("search --sync --name Unfurl") == 0);
    const auto& [fitting, top] = told ? coarse : fine;
    const auto& other = (told ? fine : coarse).first;
    const plot::Rect bar = top;
    const Image& expected = fitting;
    const Image seen = screen_when(
        server, bar, [&](const Image& now) { return clearly_differing(now, expected, bar) < 0.005; });
    INFO((told ? "--ui-scale 1" : "192 dpi"));
    CHECK(clearly_differing(seen, expected, bar) < 0.005);
    CHECK(clearly_differing(seen, other, bar) > 0.05);  // every letter is elsewhere
    server.tool("mousemove 600 400 key ctrl+q");
    CHECK(end_of(window, 10) == 0);
    CHECK(file_text(scratch / "log") == "");
  }
}

TEST_CASE("a session in a window is recorded, and has the same states without one") {
  if (tools_missing()) return;
  const ScratchDirectory scratch;
  const plot::Rect slider = [] {
    PanelDriver twin{PanelOptions()};
    return twin.panel().place("structure.post_length");
  }();
  const XServer server;
  const pid_t window =
      open_window(server, scratch, "hoop6 --set solver.step=0.05 --record " + (scratch / "session.jsonl"));
  REQUIRE(server.tool("search --sync --name Unfurl") == 0);
  const auto recorded = [&](const char* what) {  // within a minute
    for (int i = 0; i < 600; ++i) {
      if (file_text(scratch / "session.jsonl").find(what) != std::string::npos) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return false;
  };
  REQUIRE(recorded("\"shown\""));
  server.tool("mousemove 600 400 key End");
  server.tool("mousemove " + middle_of(slider, 0.5) +
              " mousedown 1 mousemove_relative 20 0 mousemove_relative 30 0 mouseup 1 mousemove 600 400");
  REQUIRE(recorded("structure.post_length="));
  server.tool("key ctrl+z");
  server.tool("key t");
  REQUIRE(recorded("\"dark\":true"));
  server.tool("key ctrl+q");
  CHECK(end_of(window, 20) == 0);
  const ProgramResult replay = run_program({"view", "--replay", scratch / "session.jsonl"});
  INFO(replay.out << replay.err);
  CHECK(replay.code == 0);
  CHECK(replay.out.find(": the same\n") != std::string::npos);
}

TEST_CASE("a signal ends the window with 130 and a word, and what it remembers is kept") {
  if (tools_missing()) return;
  const XServer server;
  for (const int signal : {SIGTERM, SIGINT}) {
    const ScratchDirectory scratch;
    const pid_t window = open_window(server, scratch, "pendulum --dark");
    REQUIRE(server.tool("search --sync --name Unfurl") == 0);
    // At rest it waits for events.
    std::this_thread::sleep_for(std::chrono::seconds(2));
    ::kill(window, signal);
    INFO(signal);
    CHECK(end_of(window, 10) == 130);
    CHECK(file_text(scratch / "log") == "unfurl: interrupted; what is finished is kept\n");
    CHECK(load_settings(scratch / "config/unfurl/window.json").dark);
  }
}

// Nothing but the program places it there: no window manager runs.
TEST_CASE("a screen smaller than the window holds it whole") {
  if (tools_missing()) return;
  const ScratchDirectory scratch;
  const XServer server(96, 800, 600);
  const pid_t window = open_window(server, scratch, "pendulum");
  REQUIRE(server.tool("search --sync --name Unfurl") == 0);
  const auto is = [&](const char* line) {  // within ten seconds
    const std::string asked =
        "search --name Unfurl getwindowgeometry --shell | grep -qx " + std::string(line);
    for (int i = 0; i < 100 && server.tool(asked) != 0; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    return server.tool(asked) == 0;
  };
  CHECK(is("WIDTH=800"));
  CHECK(is("X=0"));
  CHECK(is("Y=0"));
  ::kill(window, SIGTERM);
  CHECK(end_of(window, 10) == 130);
}

TEST_CASE("a display that goes away ends the window with its exit code, in one line") {
  if (tools_missing()) return;
  const ScratchDirectory scratch;
  auto server = std::make_unique<XServer>();
  const pid_t window = open_window(*server, scratch, "hoop6 --set solver.step=0.05");
  REQUIRE(server->tool("search --sync --name Unfurl") == 0);
  server.reset();
  CHECK(end_of(window, 10) == 6);
  CHECK(file_text(scratch / "log").find("unfurl: the display went away\n") != std::string::npos);
}

}  // namespace window_test
