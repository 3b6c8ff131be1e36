// SPDX-License-Identifier: BSD-3-Clause
// The window: events in, finished pictures out, redrawn only when something changes.
#include <dlfcn.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <thread>
#include <tuple>

#include "app/output/exit_code.hpp"
#include "app/output/interrupt.hpp"
#include "app/panel/control_panel.hpp"
#include "app/panel/panel_bench.hpp"
#include "app/window/desktop_scale.hpp"
#include "app/window/sdl_events.hpp"
#include "app/window/sdl_library.hpp"
#include "app/window/window.hpp"
#include "render/gl/functions.hpp"
#include "render/gl/graphics_error.hpp"
#include "render/image/child_process.hpp"

namespace unfurl {

namespace {

class SdlWindow final : public GlContext {
 public:
  SdlWindow(int width, int height);
  ~SdlWindow() override;
  SdlWindow(const SdlWindow&) = delete;
  SdlWindow& operator=(const SdlWindow&) = delete;

  void make_current() override {
    if (sdl().GL_MakeCurrent(window_, context_) != 0) fail(sdl().GetError());
    if (loaded_) return;
    const auto find = [](const char* name) {
      return reinterpret_cast<gl::AnyFunction>(sdl().GL_GetProcAddress(name));
    };
    if (gl::load(find) > 0) fail("its OpenGL is older than 3.3");
    loaded_ = true;
  }
  std::string description() const override {
    return std::string("SDL2, OpenGL ") + reinterpret_cast<const char*>(gl::GetString(GL_VERSION));
  }
  std::pair<int, int> pixels() const {
    int width = 0, height = 0;
    sdl().GL_GetDrawableSize(window_, &width, &height);
    return {width, height};
  }
  std::pair<int, int> units() const {  // of the desktop
    int width = 0, height = 0;
    sdl().GetWindowSize(window_, &width, &height);
    return {width, height};
  }
  float pixels_per_unit() const {
    const int width = units().first;
    return width > 0 ? static_cast<float>(pixels().first) / static_cast<float>(width) : 1.0f;
  }
  // On X11 what the desktop's user chose, else by the monitor's size, else by what the X server knows.
  float scale() const {
    X11Dpi x11;
    if (std::string_view(sdl().GetCurrentVideoDriver()) == "x11") x11 = x11_dpi();
    float own = 0;
    const int index = sdl().GetWindowDisplayIndex(window_);
    if (index < 0 || sdl().GetDisplayDPI(index, nullptr, &own, nullptr) != 0) own = 0;
    return scale_for(x11.chosen > 0 ? x11.chosen : own > 0 ? own : x11.screen, pixels_per_unit());
  }
  // So many units times `factor`, and no larger than the desktop has room for.
  void grow(int width, int height, float factor) {
    SDL_Rect room{0, 0, width, height};
    const int index = sdl().GetWindowDisplayIndex(window_);
    if (index < 0 || sdl().GetDisplayUsableBounds(index, &room) != 0) return;
    const auto side = [&](int wanted, int most) {
      return std::min(most, static_cast<int>(std::lround(static_cast<float>(wanted) * factor)));
    };
    sdl().SetWindowSize(window_, side(width, room.w), side(height, room.h));
    if (width <= room.w && height <= room.h) return;
    const int centre = static_cast<int>(SDL_WINDOWPOS_CENTERED);  // it hung over the edges
    sdl().SetWindowPosition(window_, centre, centre);
  }
  bool visible() const {
    return (sdl().GetWindowFlags(window_) & (SDL_WINDOW_MINIMIZED | SDL_WINDOW_HIDDEN)) == 0;
  }
  void show(const Framebuffer& picture) {
    picture.copy_to_window(pixels().second);
    sdl().GL_SwapWindow(window_);
  }

 private:
  [[noreturn]] static void fail(const std::string& cause) { throw GraphicsError(no_window_message(cause)); }

  SDL_Window* window_ = nullptr;
  SDL_GLContext context_ = nullptr;
  bool loaded_ = false;
};

bool variable_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

// SDL takes an invisible window where there is no display, which nobody wants to wait for.
bool has_display() {
  const char* driver = sdl().GetCurrentVideoDriver();
  return driver != nullptr && std::strcmp(driver, "offscreen") != 0 && std::strcmp(driver, "dummy") != 0 &&
         std::strcmp(driver, "evdev") != 0;
}

// The X library ends the program when its server does; with what code and words is ours to say. SDL has
// loaded it where it is used.
void end_in_words_without_display() {
  void* x11 = dlopen("libX11.so.6", RTLD_NOW | RTLD_NOLOAD);
  using Handler = int (*)(void*);
  if (x11 == nullptr) return;
  const auto set = reinterpret_cast<Handler (*)(Handler)>(dlsym(x11, "XSetIOErrorHandler"));
  if (set == nullptr) return;
  set([](void*) -> int {
    constexpr std::string_view line = "unfurl: the display went away\n";
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, line.data(), line.size());
    end_children();
    ::_exit(exit_no_graphics);
  });
}

SdlWindow::SdlWindow(int width, int height) {
  const std::string nowhere = "there is no display (neither DISPLAY nor WAYLAND_DISPLAY is set)";
  const bool x11 = variable_set("DISPLAY"), wayland = variable_set("WAYLAND_DISPLAY");
  if (!x11 && !wayland) fail(nowhere);
  // Only what the environment names: the libraries of the other would complain on their own.
  sdl().SetHint(SDL_HINT_VIDEODRIVER, x11 && wayland ? "x11,wayland" : x11 ? "x11" : "wayland");
  sdl().SetHint("SDL_WINDOWS_DPI_AWARENESS", "permonitorv2");
  if (sdl().Init(SDL_INIT_VIDEO) != 0 || !has_display()) {
    const std::string cause = std::string("the display does not answer: ") + sdl().GetError();
    sdl().Quit();
    fail(cause);
  }
  end_in_words_without_display();
  sdl().GL_SetAttribute(SDL_GL_CONTEXT_MAJOR_VERSION, 3);
  sdl().GL_SetAttribute(SDL_GL_CONTEXT_MINOR_VERSION, 3);
  sdl().GL_SetAttribute(SDL_GL_CONTEXT_PROFILE_MASK, SDL_GL_CONTEXT_PROFILE_CORE);
  sdl().GL_SetAttribute(SDL_GL_DEPTH_SIZE, 0);
  constexpr int anywhere = static_cast<int>(SDL_WINDOWPOS_UNDEFINED);
  window_ = sdl().CreateWindow("Unfurl", anywhere, anywhere, width, height,
                               SDL_WINDOW_OPENGL | SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI);
  if (window_ != nullptr) context_ = sdl().GL_CreateContext(window_);
  if (context_ == nullptr) {
    const std::string cause = sdl().GetError();
    if (window_ != nullptr) sdl().DestroyWindow(window_);
    sdl().Quit();
    fail("no OpenGL 3.3 there: " + cause);
  }
  sdl().SetWindowMinimumSize(window_, 640, 400);
  sdl().GL_SetSwapInterval(1);
  sdl().StartTextInput();
  make_current();
}

SdlWindow::~SdlWindow() {
  sdl().GL_DeleteContext(context_);
  sdl().DestroyWindow(window_);
  sdl().Quit();
}

// The loop of one window.
class Host {
 public:
  Host(SceneDocument document, const WindowOptions& options)
      : remembered_(load_settings(settings_file())),
        window_(options.bench ? 1280 : remembered_.width, options.bench ? 720 : remembered_.height),
        wake_event_(sdl().RegisterEvents(1)) {
    const float scale = options.ui_scale > 0 ? options.ui_scale : window_.scale();
    // The first time, room for as much as on a coarse screen.
    if (const PanelSettings fresh;
        !options.bench && remembered_.width == fresh.width && remembered_.height == fresh.height)
      window_.grow(fresh.width, fresh.height, scale / window_.pixels_per_unit());
    const auto [width, height] = window_.pixels();
    PanelOptions panel;
    panel.settings = remembered_;
    if (options.dark) panel.settings.dark = true;
    if (options.bench) panel.settings.tour_seen = true;
    panel.at = options.at;
    panel.measured = options.bench;
    panel.record = options.record;
    panel.width = width;
    panel.height = height;
    panel.scale = scale;
    panel.wake = [type = wake_event_] {
      SDL_Event event{};
      event.type = type;
      sdl().PushEvent(&event);
    };
    panel.clipboard.set = [](const char* text) { sdl().SetClipboardText(text); };
    panel.clipboard.get = [] {
      char* text = sdl().GetClipboardText();
      std::string copy = text != nullptr ? text : "";
      sdl().free(text);
      return copy;
    };
    panel_ = std::make_unique<ControlPanel>(window_, std::move(document), std::move(panel));
  }

  int run() {
    auto last = Clock::now();
    bool more = true;
    while (!panel_->state().closed && !interrupted()) {
      wait(more);
      const auto now = Clock::now();
      const double seconds = std::chrono::duration<double>(now - last).count();
      last = now;
      more = panel_->frame(more ? seconds : 0.0, window_.visible());
      if (window_.visible())
        window_.show(panel_->picture());
      else
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    remember();
    throw_if_interrupted();
    panel_->throw_if_not_recorded();
    return exit_ok;
  }

  int bench() {
    sdl().GL_SetSwapInterval(0);
    std::printf("%s, %d x %d pixels\n", window_.description().c_str(), panel_->picture().width(),
                panel_->picture().height());
    measure_panel(*panel_, [this] { window_.show(panel_->picture()); });
    panel_->settle();
    constexpr double idle = 10;  // [s]
    SDL_Event event;
    const auto start = Clock::now();
    const std::clock_t cpu = std::clock();
    int frames = 0;
    while (std::chrono::duration<double>(Clock::now() - start).count() < idle && !interrupted()) {
      if (sdl().WaitEventTimeout(&event, 500) == 0) continue;
      ++frames;
      take(event);
      while (panel_->frame(0)) window_.show(panel_->picture());
    }
    const double used = static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
    std::printf("idle for %.0f s: %.3f s of CPU time (%.2f %%), %d frames\n", idle, used, 100 * used / idle,
                frames);
    throw_if_interrupted();
    return exit_ok;
  }

 private:
  using Clock = std::chrono::steady_clock;

  void remember() const {
    PanelSettings now = panel_->settings();
    std::tie(now.width, now.height) = window_.units();
    if (!(now == remembered_)) save_settings(settings_file(), now);
  }

  // Until there is a reason to draw.
  void wait(bool more) {
    SDL_Event event;
    while (!more && !interrupted()) {
      if (sdl().WaitEventTimeout(&event, 500) ==
          0) {  // Ctrl-C is looked for twice a second, and what comes without a word
        more = panel_->state().simulation.running || panel_->session().files_changed();
        continue;
      }
      more = true;
      take(event);
    }
    while (sdl().PollEvent(&event) != 0) take(event);
  }

  void take(const SDL_Event& event) {
    if (event.type == SDL_WINDOWEVENT && event.window.event == SDL_WINDOWEVENT_SIZE_CHANGED) {
      const auto [width, height] = window_.pixels();
      panel_->resize(width, height);
    }
    if (const auto input = input_event(event, window_.pixels_per_unit())) panel_->handle(*input);
  }

  PanelSettings remembered_;
  SdlWindow window_;
  Uint32 wake_event_;
  std::unique_ptr<ControlPanel> panel_;
};

}  // namespace

bool display_named() {
  return variable_set("DISPLAY") || variable_set("WAYLAND_DISPLAY");
}

int show_window(SceneDocument document, const WindowOptions& options) {
  const InterruptGuard guard;
  Host host(std::move(document), options);
  const FinishedWork keeping;  // what the window remembers
  return options.bench ? host.bench() : host.run();
}

}  // namespace unfurl
