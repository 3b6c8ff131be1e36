// SPDX-License-Identifier: BSD-3-Clause
#include "app/verbs/mode_film.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <iostream>
#include <optional>

#include "app/output/interrupt.hpp"
#include "app/output/output_directory.hpp"
#include "app/verbs/film.hpp"
#include "app/verbs/frame_range.hpp"
#include "app/verbs/modal_pose.hpp"
#include "app/verbs/run_figures.hpp"
#include "app/verbs/scene_run.hpp"
#include "app/verbs/unfinished_run.hpp"
#include "core/export/atomic_file.hpp"
#include "core/scene/write.hpp"
#include "core/system/free_poses.hpp"
#include "render/plot/figure_data.hpp"
#include "render/plot/figures/mode_shapes.hpp"
#include "render/plot/ticks.hpp"
#include "render/scene/still.hpp"

namespace unfurl {

namespace {

constexpr double period_s = 2.0;  // of film
constexpr int periods = 3;        // at render.fps, 1000 at most, not too many frames
constexpr double swing = 0.09;    // largest displacement, of the structure's size

// What is asked for and a mode has not.
void refuse_what_modes_lack(const Arguments& arguments) {
  const auto refuse = [](bool given, const char* option) {
    if (given) throw UsageError(std::string(option) + " is not for films of a mode (--mode)");
  };
  refuse(arguments.plan, "--plan");
  refuse(arguments.join, "--join");
  refuse(arguments.json, "--json");
  refuse(!arguments.exports.empty(), "--export");
}

const VibrationMode& mode_asked_for(const Vibration& vibration, int number) {
  const std::size_t count = vibration.modes.size();
  if (count == 0) throw UsageError("--mode: the structure has no free motion and no elastic rod");
  if (number > static_cast<int>(count))
    throw UsageError("--mode takes 1 to " + std::to_string(count) +
                     ", the modes of this pose (unfurl modes)");
  return vibration.modes[static_cast<std::size_t>(number) - 1];
}

std::string title_of(const Scene& scene, const Vibration& vibration, const VibrationMode& mode, int number) {
  std::string text = scene.title.empty() ? "" : scene.title + ", ";
  text += "mode " + std::to_string(number) + " at " + plot::format_number(vibration.t, 4) + " s: ";
  if (mode.growth > 0) return text + "unstable, " + plot::format_number(mode.growth, 3) + " 1/s";
  if (mode.frequency > 0) return text + plot::format_number(mode.frequency, 4) + " Hz";
  return text + "free motion";
}

// The scene of the pictures: nothing in them tells of a time, forces or other columns of a run.
Scene shown_scene(const Scene& scene, std::string title, const Arguments& arguments) {
  Scene shown = scene;
  shown.title = std::move(title);
  RenderOptions& render = shown.render;
  if (!arguments.quiet && (!render.inset.empty() || render.colour_by != "group"))
    std::cerr << "unfurl: a mode has no columns; render.inset and render.colour_by are left out\n";
  render.inset.clear(), render.colour_by = "group", render.trails.clear();
  render.time = render.errors = render.method = render.follow = false;
  render.ghosts = 0;
  render.pace = "time", render.speed = 1, render.easing = render.hold = render.motion_blur = 0;
  return shown;
}

// The displacements of the solved nodes [3 n] along a mode, for shares from -1 to 1 of its swing.
class Swing {
 public:
  Swing(const ModalPose& pose, const VibrationMode& mode)
      : rest_(positions(pose)),
        poses_(pose.model->structure, rest_, pose.state.angles),
        mechanism_(mode.mechanism) {
    const auto& copies = pose.model->structure.node_copies;
    shape_ = VectorXd::Zero(rest_.size());
    for (std::size_t i = copies.size(); i-- > 0;)  // backwards: the first copy has the last word
      shape_.segment<3>(3 * copies[i].source) =
          copies[i].map.transpose() * mode.shape.segment<3>(3 * static_cast<Index>(i));
    reach_ = swing * poses_.size();
    // Near a singular pose a mechanism may go less far.
    for (int i = 0; mechanism_ && i < 20 && (at(1).isZero() || at(-1).isZero()); ++i) reach_ *= 0.5;
  }
  VectorXd at(double share) const {
    if (!mechanism_) return share * reach_ * shape_;
    return poses_.moved(rest_, shape_, share * reach_) - rest_;
  }

 private:
  static VectorXd positions(const ModalPose& pose) {
    VectorXd q(pose.model->system.coordinates());
    pose.model->system.expand(pose.state.z, q);
    return q;
  }

  VectorXd rest_;
  FreePoses poses_;
  bool mechanism_;
  VectorXd shape_;
  double reach_ = 0;
};

// make_room: called when the tables are on the disk, before they have their names.
void write_mode_tables(const std::filesystem::path& directory, const Scene& scene, const Vibration& vibration,
                       const std::function<void()>& make_room) {
  PendingFile text(directory / "scene.toml"), modes(directory / "modes.csv");
  text.write(scene_text(scene));
  modes.write(csv_text(modes_table(vibration)));
  for (PendingFile* file : {&text, &modes}) file->complete();
  make_room();
  commit_together(std::array{&text, &modes});
}

void write_figure_of_modes(const std::filesystem::path& directory, const Scene& scene, const ModalPose& pose,
                           const Vibration& vibration, GlContext& context, const FigureOptions& style) {
  const Structure& structure = pose.model->structure;
  VectorXd q(pose.model->system.coordinates());
  pose.model->system.expand(pose.state.z, q);
  const Figure figure = mode_shapes_figure(structure, whole_positions(structure, q), vibration, scene.title);
  const std::filesystem::path folder = directory / "figures";
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw FileError(folder, error.value());
  FigureWriter writer(context, style);
  for (const char* extension : {".svg", ".pdf", ".png"})
    writer.write(figure, folder / (figure.name + extension));
  write_figure_data(figure, folder / (figure.name + ".png"));
}

}  // namespace

Simulation swinging(const ModalPose& pose, const VibrationMode& mode, const RenderOptions& render) {
  Simulation run{.trajectory = Trajectory(pose.drawn)};
  run.trajectory.change_model(pose.model);
  const auto of_period = std::max(4L, std::lround(period_s * render.fps));
  const Swing shape(pose, mode);
  std::vector<VectorXd> displaced;
  for (long k = 0; k < periods * of_period; ++k) {
    State state = pose.state;
    state.t = static_cast<double>(k) * (render.speed / render.fps);  // as in film_shots()
    state.w.setZero();
    run.trajectory.append(std::move(state), {});
    const double turn = static_cast<double>(k % of_period) / static_cast<double>(of_period);
    displaced.push_back(k < of_period ? shape.at(std::sin(2 * pi * turn))
                                      : displaced[static_cast<std::size_t>(k - of_period)]);
  }
  for (std::size_t k = 0; k < displaced.size(); ++k) run.trajectory.add_stretch(k, displaced[k]);
  return run;
}

int render_mode(const Arguments& arguments) {
  refuse_what_modes_lack(arguments);
  const FigureOptions style = figure_options(arguments);
  if (!arguments.frames.empty()) frame_range(arguments.frames, 100000);
  const Scene scene = scene_of(arguments);
  const InterruptGuard guard;
  const ModalPose pose = modal_pose(scene, arguments);
  if (interrupted()) return exit_interrupted;
  const Vibration vibration = vibration_of(pose);
  const VibrationMode& mode = mode_asked_for(vibration, arguments.mode);
  const Scene shown = shown_scene(scene, title_of(scene, vibration, mode, arguments.mode), arguments);

  OwnDirectory output(arguments.output, arguments.force, "run", DirectoryLock::Use::shareable);
  output.require_scene(scene_text(scene), arguments.force);
  const std::string which = "mode " + std::to_string(arguments.mode) + " at " + exact_number(vibration.t);
  if (!arguments.force) UnfinishedRun::refuse_in(output.path(), "a film");
  FilmFolder folder(output.path(), shown, arguments.gpu, which);
  folder.refuse_to_encode_another(arguments.encode_only);
  if (!folder.holds_this() && !folder.fresh() && !arguments.force)
    throw FileError(output.path(),
                    "holds frames of another film or other results; use --force to start "
                    "over, or another -o");
  const auto context = make_offscreen_context({arguments.threads, arguments.gpu});
  write_mode_tables(output.path(), scene, vibration, [&] {
    if (!folder.holds_this()) FilmFolder::clear(output.written());
  });
  folder.claim();
  output.lock().share();
  const Simulation run = swinging(pose, mode, shown.render);
  const Scene framed = fitted(shown, run);
  folder.fit(framed);
  write_figure_of_modes(output.path(), scene, pose, vibration, *context, style);
  FrameMemory memory;
  if (arguments.encode_only)
    require_all_frames(folder, framed, run, arguments);
  else if (!draw_frames(folder, framed, run, {}, *context, arguments, memory))
    return exit_interrupted;
  return encode_films(output.path(), folder, framed, run, arguments, memory) ? pose.code : exit_interrupted;
}

}  // namespace unfurl
