// SPDX-License-Identifier: BSD-3-Clause
#include "app/verbs/plan.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <tuple>

#include "app/output/interrupt.hpp"
#include "app/verbs/film.hpp"
#include "app/verbs/frame_range.hpp"
#include "app/verbs/scene_run.hpp"
#include "core/scene/build.hpp"
#include "core/simulate/simulation.hpp"
#include "core/study/tolerance.hpp"
#include "render/image/mp4_pipe.hpp"
#include "render/image/png.hpp"
#include "render/plot/figures.hpp"
#include "render/scene/film_style.hpp"
#include "render/scene/renderer.hpp"
#include "render/scene/shutter.hpp"
#include "render/scene/still.hpp"

namespace unfurl {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double patience = 5;  // of the trial simulation [s]
// Of encoders and figures, about, on one core; encoders for a megapixel [s].
constexpr double webp_s = 0.028, gif_s = 0.010, mp4_s = 0.012, figure_s = 0.06;

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Plan {
  std::vector<std::string> files;
  std::size_t frames = 0;
  bool drawn = true;     // the frames; else films are made of those that are there
  bool at_most = false;  // the run may end earlier than its end_time
  int width = 0, height = 0;
  double simulate_s = 0, draw_s = 0, encode_s = 0, figures_s = 0;
  double seconds() const { return simulate_s + draw_s + encode_s + figures_s; }
};

// A run as far as it comes in some seconds, and how long all of it would take.
Simulation trial(const Scene& scene, std::shared_ptr<const Model> model, Plan& plan) {
  const auto start = Clock::now();
  double share = 0;
  SimulationHooks hooks;
  hooks.progress = [&](double fraction) { share = fraction; };
  hooks.cancelled = [&] { return interrupted() || since(start) > patience; };
  Simulation run = simulate_as_asked(std::move(model), scene.solver, hooks);
  plan.simulate_s = since(start);
  if (run.status != RunStatus::stopped) return run;
  plan.at_most = true;
  plan.simulate_s /= std::max(share, 1e-3);
  return run;
}

// How long it takes to draw them, from one.
void plan_frames(const Scene& scene, const Simulation& run, const Arguments& arguments, Plan& plan) {
  const RenderOptions& options = scene.render;
  const auto context = make_offscreen_context({arguments.threads, arguments.gpu});
  const Diagnostics diagnostics = diagnose(run);
  const FrameStyle style = film_style(scene, run, diagnostics);
  const FrameBuilder builder(run.trajectory, style);
  Renderer renderer(*context, style.width, style.height);
  const double end = run.trajectory.end_time();
  exposed(renderer, builder, {end, 1, 0}, options.depth_of_field);  // shaders are made
  const auto start = Clock::now();
  encode_png(exposed(renderer, builder, {0.5 * end, 0.5, 0, options.motion_blur / options.fps, false},
                     options.depth_of_field),
             false);
  plan.draw_s = since(start) * static_cast<double>(plan.frames);
}

void plan_animations(const RenderOptions& options, Plan& plan) {
  const double megapixels = 1e-6 * options.width * options.height * static_cast<double>(plan.frames);
  for (const auto& [wanted, name, cost] :
       {std::tuple(options.webp, "animation.webp", webp_s), std::tuple(options.gif, "animation.gif", gif_s),
        std::tuple(options.mp4 && ffmpeg_available(), "animation.mp4", mp4_s)}) {
    if (!wanted) continue;
    plan.files.emplace_back(name);
    plan.encode_s = std::max(plan.encode_s, cost * megapixels);  // side by side
  }
}

void plan_film(const Scene& scene, const Simulation& run, const Arguments& arguments, Plan& plan) {
  const RenderOptions& options = scene.render;
  plan.width = options.width, plan.height = options.height;
  plan.frames = plan.at_most ? static_cast<std::size_t>(std::ceil(most_shots(scene.solver.end_time, options)))
                             : film_shots(run.trajectory, options).size();
  const std::size_t film = plan.frames;
  const FrameRange range = frame_range(arguments.encode_only ? "" : arguments.frames, film);
  plan.frames = range.end - range.first;
  plan.drawn = !arguments.encode_only;
  if (plan.drawn) {
    plan_frames(scene, run, arguments, plan);
    char name[32];
    std::snprintf(name, sizeof name, "frames/frame_%05zu.png", range.first);
    plan.files.emplace_back(name);
  }
  if (plan.frames == film) plan_animations(options, plan);  // else there are others to be drawn
  plan.files.emplace_back("film.json");
  if (!plan.drawn) return;
  plan.files.emplace_back("figures/");
  if (plan.frames == film) plan.files.emplace_back("report.html");
  plan.figures_s = figure_s * static_cast<double>(figure_kinds().size());
}

void print(const Plan& plan, const Arguments& arguments) {
  const auto rounded = [](double x) { return std::round(10 * x) / 10; };
  if (arguments.json) {
    nlohmann::ordered_json json = {{"directory", arguments.output}, {"files", plan.files}};
    if (plan.frames > 0) {
      json["frames"] = plan.frames;
      json["frames_at_most"] = plan.at_most;
      json["size"] = {plan.width, plan.height};
    }
    json["expected_s"] = {{"simulate", rounded(plan.simulate_s)},
                          {"draw", rounded(plan.draw_s)},
                          {"encode", rounded(plan.encode_s)},
                          {"figures", rounded(plan.figures_s)},
                          {"all", rounded(plan.seconds())}};
    std::cout << json.dump(2) << "\n";
    return;
  }
  std::cout << "would write" << (arguments.output.empty() ? "" : " into " + arguments.output) << ":\n";
  for (const std::string& file : plan.files) std::cout << "  " << file << "\n";
  if (plan.frames > 0)
    std::cout << (plan.drawn ? "" : "films of ") << (plan.at_most ? "at most " : "") << plan.frames
              << (plan.frames == 1 ? " frame" : " frames") << " of " << plan.width << " x " << plan.height
              << "\n";
  std::cout << "expected time: " << rounded(plan.simulate_s) << " s to simulate";
  if (plan.frames > 0)
    std::cout << ", " << rounded(plan.draw_s) << " s to draw, " << rounded(plan.encode_s) << " s to encode, "
              << rounded(plan.figures_s) << " s for figures";
  std::cout << "; about " << rounded(plan.seconds()) << " s in all\n";
}

}  // namespace

int show_plan(const Scene& scene, const Arguments& arguments, bool film) {
  const InterruptGuard guard;
  Plan plan;
  plan.files = {"scene.toml", "series.csv", "trajectory.csv", "rod_forces.csv", "summary.json"};
  for (const ExportFormat* format : export_formats_of(arguments))
    plan.files.push_back("(export: " + std::string(format->name) + ")");
  const Simulation run = trial(scene, model_of(scene, arguments), plan);
  throw_if_interrupted();
  if (film && !run.trajectory.empty()) plan_film(fitted(scene, run), run, arguments, plan);
  print(plan, arguments);
  return exit_ok;
}

}  // namespace unfurl
