// SPDX-License-Identifier: BSD-3-Clause
// unfurl view [SCENE]: the interactive window.
#include <algorithm>
#include <cstdio>
#include <memory>

#include "app/command.hpp"
#include "app/output/output_directory.hpp"
#include "app/output/receipt.hpp"
#include "app/panel/control_panel.hpp"
#include "app/panel/panel_bench.hpp"
#include "app/panel/session_log.hpp"
#include "app/window/window.hpp"
#include "core/math/largest.hpp"
#include "core/scene/write.hpp"
#include "core/study/table.hpp"
#include "core/text/nearest_name.hpp"
#include "render/gl/context.hpp"
#include "render/image/png.hpp"

namespace unfurl {

namespace {

// Where the motion stands at first [s].
double start_of(const Arguments& arguments) {
  if (arguments.at.empty()) return 0.0;
  const double t = number_of(arguments.at);
  if (!(t >= 0 && t <= 1e9))
    throw UsageError("--at: must be a number from 0 to 1e+09; got " + in_quotes(arguments.at));
  return t;
}

// The panel without a window; what was left open the last time is not looked at.
struct OffscreenPanel {
  OffscreenPanel(SceneDocument document, const Arguments& arguments, int width, int height)
      : context(make_offscreen_context({arguments.threads, arguments.gpu})),
        panel(*context, std::move(document), options_of(arguments, width, height)) {}

  static PanelOptions options_of(const Arguments& arguments, int width, int height) {
    PanelOptions options;
    options.width = width;
    options.height = height;
    options.scale = arguments.ui_scale > 0 ? static_cast<float>(arguments.ui_scale) : 1.0f;
    options.settings.dark = arguments.view.dark;
    options.settings.tour_seen = true;
    options.at = start_of(arguments);
    options.measured = arguments.view.bench;
    return options;
  }

  std::unique_ptr<GlContext> context;
  ControlPanel panel;
};

// Beyond the end of the run the window would stand at its end.
void require_time_of_run(double t, const LiveRun* run) {
  if (!run || t <= run->simulation.trajectory.end_time() ||
      short_number(t, 6) == short_number(run->simulation.trajectory.end_time(), 6))
    return;
  throw UsageError("--at takes a time from 0 to " + short_number(run->simulation.trajectory.end_time(), 6) +
                   " s; got " + short_number(t, 6));
}

int draw_picture(SceneDocument document, const Scene& scene, const Arguments& arguments) {
  require_writable_png(arguments.view.picture, "a picture of the window");
  receipt_scene(scene.name, scene_text(scene));
  OffscreenPanel offscreen(std::move(document), arguments, scene.render.width, scene.render.height);
  offscreen.panel.settle();
  const LiveRun* run = offscreen.panel.state().shown.get();
  require_time_of_run(start_of(arguments), run);
  if (run) {
    const Diagnostics& d = run->diagnostics;
    receipt_errors({{"constraint_error_m", largest_magnitude(d.at("constraint_max_m").values)},
                    {"energy_balance_J", largest_magnitude(d.at("energy_balance_J").values)}});
  }
  write_png(arguments.view.picture, offscreen.panel.picture().read());
  return exit_ok;
}

// Says what was compared; what differs is a line each.
int replay(const Arguments& arguments) {
  if (!arguments.names.empty() || !arguments.overrides.empty())
    throw UsageError("--replay plays the scene that was recorded: give no other and no --set");
  if (!arguments.view.picture.empty())
    require_writable_png(arguments.view.picture, "a picture of the window");
  const auto context = make_offscreen_context({arguments.threads, arguments.gpu});
  const Replay played = replay_session(*context, arguments.view.replay);
  if (!arguments.view.picture.empty()) write_png(arguments.view.picture, played.last);
  std::printf("%ld frames, %ld states and %ld pictures compared%s: %s\n", played.frames, played.states,
              played.pictures, played.same_graphics ? "" : " (pictures to a shade: drawn by other graphics)",
              played.differences.empty() ? "the same" : "not the same");
  for (const std::string& difference : played.differences) std::printf("%s\n", difference.c_str());
  return played.differences.empty() ? exit_ok : exit_verification_failed;
}

int bench_offscreen(SceneDocument document, const Arguments& arguments) {
  OffscreenPanel offscreen(std::move(document), arguments, 1280, 720);
  std::printf("no display: %s, 1280 x 720 pixels\n", offscreen.context->description().c_str());
  measure_panel(offscreen.panel, [] {});
  return exit_ok;
}

// What one way to use the window has no use for.
void refuse_contradictions(const Arguments& arguments) {
  const ViewArguments& view = arguments.view;
  const auto refuse = [](const char* option, const char* beside, const char* why) {
    throw UsageError(std::string(option) + " beside " + beside + ": " + why + "; leave one of them out");
  };
  if (!view.record.empty() && !view.picture.empty())
    refuse("--record", "--picture", "there is no window whose session could be recorded");
  if (!view.record.empty() && view.bench)
    refuse("--record", "--bench", "nobody acts in the window that is measured");
  if (!view.record.empty() && !view.replay.empty())
    refuse("--record", "--replay", "what is played is a record already");
  if (view.bench && !view.picture.empty()) refuse("--bench", "--picture", "a picture is not measured");
  if (view.bench && !view.replay.empty()) refuse("--bench", "--replay", "what is played is not measured");
  if (!arguments.at.empty() && !view.replay.empty())
    refuse("--at", "--replay", "a session begins where it was recorded");
  if (view.dark && !view.replay.empty()) refuse("--dark", "--replay", "a session looks as it was recorded");
  if (arguments.ui_scale > 0 && !view.replay.empty())
    refuse("--ui-scale", "--replay", "a session is played at the scale it was recorded at");
}

}  // namespace

int cmd_view(const Arguments& arguments) {
  refuse_contradictions(arguments);
  if (!arguments.view.replay.empty()) return replay(arguments);
  const std::string name = arguments.names.empty() ? scene_of_the_window : arguments.names.front();
  SceneDocument document = open_document(name, arguments.overrides);
  // What is wrong with the scene is said here, before a window opens.
  const Scene scene = read_document(document);
  if (!arguments.view.picture.empty()) return draw_picture(std::move(document), scene, arguments);
  if (arguments.view.bench && !display_named()) return bench_offscreen(std::move(document), arguments);
  WindowOptions options;
  options.ui_scale = static_cast<float>(arguments.ui_scale);
  options.dark = arguments.view.dark;
  options.at = start_of(arguments);
  options.bench = arguments.view.bench;
  options.record = arguments.view.record;
  if (!options.record.empty()) require_recordable(options.record);  // likewise
  return show_window(std::move(document), options);
}

}  // namespace unfurl
