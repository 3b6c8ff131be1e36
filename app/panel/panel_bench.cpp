// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/panel_bench.hpp"

#include <chrono>
#include <cstdio>
#include <ctime>
#include <thread>
#include <tuple>
#include <utility>

namespace unfurl {

namespace {

struct Sums {
  int frames = 0;
  double wall = 0, cpu = 0, showing = 0;
  FrameTimes times;
};

Sums run_frames(ControlPanel& panel, const std::function<void()>& show, double seconds, bool turns,
                bool plays) {
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point t) {
    return std::chrono::duration<double>(Clock::now() - t).count();
  };
  PanelState& state = panel.state();
  Sums sums;
  const std::clock_t cpu = std::clock();  // of all threads: software OpenGL draws with several
  const auto start = Clock::now();
  double last = 0;
  while (last < seconds) {
    ++sums.frames;
    const double now = since(start);
    if (turns) state.orbit->azimuth += 0.03f;
    state.playback.playing = plays;
    panel.frame(now - std::exchange(last, now));
    const auto drawn = Clock::now();
    show();
    sums.showing += since(drawn);
    const FrameTimes& t = panel.frame_times();
    sums.times.scene += t.scene;
    sums.times.figures += t.figures;
    sums.times.widgets += t.widgets;
    sums.times.painting += t.painting;
  }
  sums.wall = since(start);
  sums.cpu = static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
  state.playback.playing = false;
  return sums;
}

// From a change to the first frame that shows what came of it, and to the one that is exact. As in a window a
// frame is drawn where there is a reason for it.
void time_change(ControlPanel& panel) {
  using Clock = std::chrono::steady_clock;
  PanelState& state = panel.state();
  if (!state.shown) return;
  SceneDocument changed = state.history.now();
  changed.edits["solver.step"] = 0.99 * state.shown->scene.solver.step;
  state.history.replace(changed);
  const auto start = Clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  const std::clock_t cpu_start = std::clock();  // other work on the machine counts in the time alone
  const auto cpu = [&] { return static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC; };
  double first = 0, first_cpu = 0, exactly = 0;
  int frames = 0;
  const double painted = panel.painted();
  do {
    const bool more = panel.frame(0);
    frames += first == 0;
    if (first == 0 && state.shown->document == changed) first = seconds(), first_cpu = cpu();
    exactly = seconds();
    for (int ms = 0; !more && ms < 50 && !panel.session().has_results(); ++ms)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  } while (seconds() < 600 && (first == 0 || state.simulation.running));
  const double whole = static_cast<double>(panel.picture().width()) * panel.picture().height();
  std::printf(
      "a change is shown after %.0f ms (CPU: %.0f ms, %d frames, %.2f pictures painted), exactly after "
      "%.0f ms\n",
      1e3 * first, 1e3 * first_cpu, frames, (panel.painted() - painted) / whole, 1e3 * exactly);
  state.history.undo();
  panel.settle();
}

}  // namespace

void measure_panel(ControlPanel& panel, const std::function<void()>& show, double seconds) {
  panel.settle();
  std::printf("%-17s %9s %8s %8s | %6s %8s %8s %9s %8s\n", "", "frames/s", "wall", "CPU", "scene", "figures",
              "widgets", "painting", "showing");
  panel.state().orbit = panel.framed();
  for (const auto& [name, turns, plays] :
       {std::tuple("the view turns", true, false), std::tuple("the motion plays", false, true),
        std::tuple("both", true, true)}) {
    run_frames(panel, show, 0.2, turns, plays);  // shaders are compiled, buffers made
    const Sums s = run_frames(panel, show, seconds, turns, plays);
    const double ms = 1000.0 / s.frames;
    std::printf("%-17s %9.1f %8.2f %8.2f | %6.2f %8.2f %8.2f %9.2f %8.2f  ms a frame\n", name,
                s.frames / s.wall, ms * s.wall, ms * s.cpu, ms * s.times.scene, ms * s.times.figures,
                ms * s.times.widgets, ms * s.times.painting, ms * s.showing);
    std::fflush(stdout);
  }
  time_change(panel);
}

}  // namespace unfurl
