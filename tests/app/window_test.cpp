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

using namespace unfurl;

namespace window_test {

namespace {

bool installed(const char* program) {
  return std::system(("command -v " + std::string(program) + " >/dev/null 2>&1").c_str()) == 0;
}

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

// An X server on a display of its own.
class XServer {
 public:
  XServer() {
    name_ = ":" + std::to_string(200 + ::getpid() % 500);
    pid_ = start("Xvfb " + name_ + " -screen 0 1280x720x24 +extension GLX >/dev/null 2>&1");
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

 private:
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
  for (const char* program : {"Xvfb", "xdotool"}) {
    if (installed(program)) continue;
    WARN("not tested: " << program << " is not installed (apt-get install xvfb xdotool)");
    return;
  }
  const XServer server;
  const ScratchDirectory scratch;
  // Where everything is: the same panel without a window.
  PanelOptions options;
  PanelDriver twin(options);
  twin.state().export_path = "hoop6.toml";
  const plot::Rect slider = twin.panel().place("structure.post_length"),
                   timeline = twin.panel().place("timeline");
  twin.key(Key::e);
  twin.frame();
  const plot::Rect save = twin.panel().place("save");

  // A sanitizer would report what the display's GL driver leaks (240 bytes, from a module that is unloaded by
  // then); leaks of the panel are looked for where it is driven without a window.
  const std::string unfurl = std::string("env ASAN_OPTIONS=detect_leaks=0 DISPLAY=") + server.name() +
                             " XDG_CONFIG_HOME=" + (scratch / "config") + " HOME=" + (scratch / "home") +
                             " " + UNFURL_PROGRAM + " view hoop6 --ui-scale 1 --set solver.step=0.05 >" +
                             (scratch / "log") + " 2>&1";
  const pid_t window = start("sh -c 'cd " + (scratch / "") + " && exec " + unfurl + "'");
  REQUIRE(server.tool("search --sync --name Unfurl") == 0);
  // A screenshot by its key tells that the window answers; asked again until it does.
  for (int i = 0; i < 40 && !std::filesystem::exists(scratch / "unfurl.png"); ++i) {
    server.tool("mousemove 600 400 key s");
    std::this_thread::sleep_for(std::chrono::milliseconds(250));
  }
  REQUIRE(appears(scratch / "unfurl.png"));

  server.tool("key End mousemove " + middle_of(slider, 0.5) +
              " mousedown 1 mousemove_relative 20 0 mousemove_relative 30 0 mouseup 1");
  server.tool("mousemove " + middle_of(timeline, 0.2) + " mousedown 1 mousemove_relative 100 0 mouseup 1");
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

}  // namespace window_test
