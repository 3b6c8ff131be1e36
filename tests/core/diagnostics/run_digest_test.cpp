// SPDX-License-Identifier: BSD-3-Clause
// What a long run, seen window by window, says as a run does that is seen whole.
#include "core/diagnostics/run_digest.hpp"

#include <catch2/catch.hpp>

#include "core/diagnostics/books.hpp"
#include "core/scene/library.hpp"
#include "core/simulate/singular_poses.hpp"
#include "tests/support/coulomb_oscillator.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace run_digest_test {
namespace {

std::vector<std::string> names(const Diagnostics& d) {
  std::vector<std::string> out;
  for (const Series& column : d.columns) out.push_back(column.name);
  return out;
}

bool has_impacts(const Diagnostics& d) {
  return d.find("impact_loss_J") != nullptr;
}

// A mass that flies along x past a cable that is slack until x = 1.3, towards a stop at `limit`.
std::string flying(double limit, bool stop) {
  return "[structure]\nkind = 'custom'\n"
         "nodes = [{name = 'O', position = [0, 0, 0], fixed = true},\n"
         "         {name = 'A', position = [1, 0, 0], velocity = [0.7, 0, 0], mass = 1.9}]\n"
         "[[structure.constraints]]\nkind = 'plane'\nnodes = ['A']\nnormal = [0, 0, 1]\n"
         "[[forces]]\nkind = 'spring'\nname = 'cable'\nnodes = ['O', 'A']\nstiffness = 5\n"
         "free_length = 1.3\ntension_only = true\n" +
         (stop ? "[[structure.constraints]]\nkind = 'coordinate_stop'\nname = 'wall'\nnodes = ['A']\n"
                 "direction = [1, 0, 0]\nmax = " +
                     std::to_string(limit) + "\nrestitution = 0.4\n"
               : std::string()) +
         "[solver]\nstages = 4\nstep = 0.013\nend_time = 1\n";
}

struct Windows {
  std::vector<Stepper::Window> parts;
  Simulation rest;
  std::size_t first = 0;
};

Windows windows_of(const Scene& scene, std::size_t states) {
  const auto model = build_model(scene);
  Windows out{{}, Simulation{.trajectory = Trajectory(model)}};
  Parts parts{.states = states, .around = 9};
  parts.take = [&](Stepper::Window window, Stepper&) { out.parts.push_back(std::move(window)); };
  out.rest = simulate_in_parts(model, scene.solver, {}, parts, out.first);
  return out;
}

}  // namespace

TEST_CASE("energy lost in impacts is a column where impacts can happen, whether they do or not") {
  const auto column = [](const Simulation& run) { return diagnose(run).find("impact_loss_J") != nullptr; };
  CHECK(column(testing::run_scene(flying(1.2, true))));  // strikes
  CHECK(column(testing::run_scene(flying(99, true))));   // never gets there
  CHECK_FALSE(column(testing::run_scene(flying(0, false))));
  CHECK_FALSE(
      column(testing::run_scene(testing::coulomb_oscillator + "[solver]\nstep = 0.05\nend_time = 2\n")));
  const auto mast = [&](const std::vector<std::string>& changes) {
    std::vector<std::string> all{"structure.tip_force=30", "solver.stages=4", "solver.end_time=0.1"};
    all.insert(all.end(), changes.begin(), changes.end());
    const Scene scene = read_scene_file(find_scene("scissor_mast"), all);
    return has_impacts(diagnose(simulate(build_model(scene), scene.solver)));
  };
  CHECK_FALSE(mast({"solver.at_deployed=stop"}));
  CHECK(mast({"solver.at_deployed=latch"}));  // ends before
  CHECK_FALSE(mast({"solver.at_deployed=latch", "forces[0]={kind=\"latch\", stiffness=4000}"}));
}

TEST_CASE("windows of a long run have the columns of a short one, and no event that did not happen") {
  for (const std::string& text : {flying(1.2, true), flying(99, true), flying(0, false)}) {
    const Scene scene = read_scene_text(text, "s.toml", {});
    const std::vector<std::string> expected = names(diagnose(simulate(build_model(scene), scene.solver)));
    Windows w = windows_of(scene, 30);
    REQUIRE(w.parts.size() >= 2);
    RunDigest digest(build_model(scene), scene.solver);
    for (Stepper::Window& part : w.parts) {
      const std::size_t events = part.run.events.size();
      CHECK(names(digest.add(part.run, part.first, part.last)) == expected);
      CHECK(part.run.events.size() == events);
      digest.settle();
    }
    CHECK(names(digest.add(w.rest, w.first, w.rest.trajectory.size())) == expected);
    for (const Event& event : digest.whole(w.rest).run.events) CHECK_FALSE(event.name.empty());
  }
}

TEST_CASE("what forces are unique is found once for a long run, and is what every part of it says") {
  const std::vector<std::pair<const char*, std::vector<std::string>>> runs{
      {"hoop6", {"solver.step=0.03"}},
      {"hoop6", {"solver.step=0.03", "solver.at_deployed=latch"}},
      {"hoop6", {"structure.youngs_modulus=7e10", "solver.step=0.03"}},
      {"four_bar", {"solver.end_time=2"}},
      {"scissor_mast", {"solver.step=0.004"}}};
  for (const auto& [name, changes] : runs) {
    const Scene scene = read_scene_file(find_scene(name), changes);
    Windows w = windows_of(scene, 40);
    INFO(name << ", " << w.parts.size() << " parts");
    REQUIRE(w.parts.size() >= 2);
    KnownUniqueness known;
    std::size_t examined = 0, events = 0, models = 1;
    const auto look = [&](Simulation& window, bool goes_on) {
      record_singular_poses(window);
      for (const Event& event : window.events) events += std::isnan(event.singular_value) ? 0 : 1;
      for (std::size_t i = 1; i < window.trajectory.size(); ++i)
        models += &window.trajectory.model(i) != &window.trajectory.model(i - 1) ? 1 : 0;
      examined += ForceUniqueness(window, known, goes_on).examined();
      const Diagnostics apart = diagnose(window), carried = diagnose_window(window, goes_on, known);
      CHECK((apart.force_unique == carried.force_unique).all());
      CHECK(apart.rod_unique == carried.rod_unique);
      CHECK(apart.axial_force == carried.axial_force);
    };
    for (Stepper::Window& part : w.parts) look(part.run, true);
    look(w.rest, false);
    // Five states of every model, one at the end of each, two beside every singular pose.
    CHECK(examined <= 6 * models + 2 * events);
  }
}

TEST_CASE("the answer that a long run carries is of its checkpoint, to the byte") {
  KnownUniqueness known{{1, 0, 1}, {1, 1, 1}}, read;
  Archive out;
  out(known);
  Archive in(out.bytes());
  in(read);
  CHECK(read.rigidly == known.rigidly);
  CHECK(read.usual == known.usual);
}

}  // namespace run_digest_test
