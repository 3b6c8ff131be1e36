// SPDX-License-Identifier: BSD-3-Clause
// Builds a ring of your own size, steps it through its events, reads its rods' forces.
#include <cstdio>
#include <unfurl/diagnostics/diagnostics.hpp>
#include <unfurl/scene/build.hpp>
#include <unfurl/scene/library.hpp>
#include <unfurl/scene/reader.hpp>
#include <unfurl/simulate/stepper.hpp>
#include <unfurl/text/error.hpp>
#include <unfurl/text/version.hpp>

int main() try {
  // A scene is a file, or one that comes with Unfurl, with keys changed as `--set` does.
  const unfurl::Scene scene = unfurl::read_scene_file(
      unfurl::find_scene("hoop6"),
      {"structure.units=8", "solver.stages=4", "solver.step=0.02", "solver.end_time=20"});
  unfurl::Stepper stepper(unfurl::build_model(scene), scene.solver);
  while (stepper.step()) {
    const unfurl::Trajectory& so_far = stepper.run().trajectory;
    if (so_far.size() % 100 == 0)
      std::printf("t = %.2f s: first node at x = %.6f m\n", stepper.time(),
                  so_far.positions(so_far.size() - 1)[0]);
  }

  const unfurl::Simulation run = stepper.take();
  for (const unfurl::Event& event : run.events) std::printf("%s at %.6f s\n", event.name.c_str(), event.t);
  const unfurl::Diagnostics diagnostics = unfurl::diagnose(run);
  std::printf("constraint error %.1e m\n", diagnostics.at("constraint_max_m").values.back());
  std::printf("force of the first rod at the start %.3f N%s\n", diagnostics.axial_force(0, 0),
              diagnostics.force_unique(0, 0) ? "" : " (one choice of many)");
  std::printf("unfurl %s\n", unfurl::version().c_str());
  return 0;
} catch (const unfurl::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
