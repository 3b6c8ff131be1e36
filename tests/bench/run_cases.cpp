// SPDX-License-Identifier: BSD-3-Clause
// What `unfurl run` costs beside its stepping: reading, building, singular poses, diagnostics, tables.
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "core/diagnostics/accuracy.hpp"
#include "core/export/csv.hpp"
#include "core/export/summary.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/singular_poses.hpp"
#include "tests/bench/cases.hpp"

namespace unfurl::bench {
namespace {

// All that the verb does but for starting the program; the CPU time of the time loop in it [s].
double run_into(const std::filesystem::path& folder, const char* name,
                const std::vector<std::string>& changes) {
  const Scene scene = read_scene_file(find_scene(name), changes);
  const auto model = build_model(scene);
  Simulation run = simulate(model, scene.solver);
  record_singular_poses(run);
  const Diagnostics diagnostics = judge(run);
  const Mobility mobility = analyse_mobility(model->system, run.trajectory.node_positions(0));
  summary_json(scene.name, run, diagnostics, mobility);
  write_series_csv(folder / "series.csv", diagnostics);
  write_trajectory_csv(folder / "trajectory.csv", run.trajectory);
  write_rod_forces_csv(folder / "rod_forces.csv", run.trajectory, diagnostics);
  return run.cpu_s;
}

}  // namespace

void run_cases(Report& report) {
  report.begin("`unfurl run`: CPU time of all of it over that of its time loop");
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("unfurl_bench_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const struct {
    const char *label, *scene, *target;
    std::vector<std::string> changes;
    int repeats;
  } cases[] = {{"hoop6", "hoop6", "<= 1.5", {}, 9},
               {"hoop6_sector", "hoop6_sector", "", {}, 9},
               {"ladder", "ladder", "", {}, 9},
               {"1000 units, 0.2 s", "hoop6", "<= 1.5", {"structure.units=1000", "solver.end_time=0.2"}, 1}};
  for (const auto& c : cases) {
    double all = 1e300, stepping = 1e300;
    for (int i = 0; i < c.repeats; ++i) {
      const double begin = cpu_seconds();
      stepping = std::min(stepping, run_into(folder, c.scene, c.changes));
      all = std::min(all, cpu_seconds() - begin);
    }
    report.add({"run", std::string(c.label) + ": the whole run", all, "s"});
    report.add({"run", std::string(c.label) + ": over its stepping", all / stepping, "ratio", c.target});
  }
  std::filesystem::remove_all(folder);
}

}  // namespace unfurl::bench
