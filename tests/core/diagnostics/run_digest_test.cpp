// SPDX-License-Identifier: BSD-3-Clause
// What a long run, seen window by window, says as a run does that is seen whole.
#include "core/diagnostics/run_digest.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <tuple>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/books.hpp"
#include "core/diagnostics/measures.hpp"
#include "core/diagnostics/peaks.hpp"
#include "core/diagnostics/rod_peaks.hpp"
#include "core/export/summary.hpp"
#include "core/scene/library.hpp"
#include "core/simulate/singular_poses.hpp"
#include "tests/support/coulomb_oscillator.hpp"
#include "tests/support/scene_run.hpp"
#include "tests/support/windows_of_run.hpp"

using namespace unfurl;
using testing::behind_checkpoint, testing::from_checkpoint_to_checkpoint, testing::Windows,
    testing::windows_of;

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

namespace {

// What differs where two runs differ by rounding.
bool is_rounding(const std::string& name) {
  return name == "newton_iterations" || name == "factorisations" || name.find("constraint_") == 0 ||
         name == "rod" || name == "peak_rod";  // one of several that bear the same
}

// Of several peaks that are the same but for rounding.
bool is_peak_time(const std::string& name) {
  return name == "t_s" || name == "peak_t_s";
}

// The same but for rounding: sums that go on from window to window, and peaks on parabolas through states.
void same(const nlohmann::json& a, const nlohmann::json& b, const std::string& where) {
  INFO(where);
  REQUIRE(a.type_name() == std::string(b.type_name()));
  if (a.is_object()) {
    REQUIRE(a.size() == b.size());
    for (const auto& [key, value] : a.items()) {
      REQUIRE(b.contains(key));
      if (key != "cpu_s" && !is_rounding(key) && !is_peak_time(key)) same(value, b[key], where + "." + key);
    }
  } else if (a.is_array()) {
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) same(a[i], b[i], where + "[" + std::to_string(i) + "]");
  } else if (a.is_number()) {
    CHECK(a.get<double>() == Approx(b.get<double>()).epsilon(1e-6).margin(1e-11));
  } else {
    CHECK(a == b);
  }
}

nlohmann::json summary_of(const Simulation& run, const Diagnostics& d) {
  const Model& model = run.trajectory.model();
  return nlohmann::json::parse(
      summary_json("it", run, d, analyse_mobility(model.system, run.trajectory.node_positions(0))));
}

}  // namespace

TEST_CASE("a long run's rows and summary are those of the same run seen whole, also behind a checkpoint") {
  const std::string swing = testing::coulomb_oscillator + "[solver]\nstep = 0.02\nend_time = 3\n";
  // Runge-Kutta is unstable at h w = 3.9: the run cannot be trusted from its seventh state or so on.
  const std::string wild =
      "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0.4, 0.1, -0.3], fixed = true},\n"
      "{name = 'P', position = [1.6, 0.1, -0.3], mass = 1.3}]\n[[forces]]\nkind = 'spring'\nnodes = ['O', "
      "'P']\nstiffness = 5e4\nfree_length = 1.0\n[solver]\nmethod = 'rk4'\nstep = 0.02\nend_time = 1.2\n";
  // Beside it a weight of 7 kg swings on a quasi-static rod, which is shown longer than it is.
  std::string hung = wild;
  hung.replace(
      hung.find("nodes = ["), 9,
      "rod_model = 'quasi-static'\nrods = [{nodes = ['Q', 'R'], mass = 0, area = 1e-6, youngs_modulus "
      "= 2e11}]\nnodes = [{name = 'Q', position = [0, 5, 0], fixed = true}, {name = 'R', position = "
      "[0.8, 5, -0.6], mass = 7}, ");
  hung += "[gravity]\nacceleration = [0, 0, -9.81]\n";
  const std::vector<Scene> scenes = {
      read_scene_text(flying(1.2, true), "s.toml", {}),
      read_scene_text(hung, "s.toml", {}),
      read_scene_text(swing, "s.toml", {}),
      read_scene_text(wild, "s.toml", {}),
      read_scene_file(find_scene("hoop6_motor"), {"solver.step=0.03", "structure.youngs_modulus=7e10"}),
      read_scene_file(find_scene("four_bar"), {"solver.end_time=2"}),
      read_scene_file(find_scene("hoop6"), {"solver.step=0.03", "solver.at_deployed=latch"})};
  for (const Scene& scene : scenes) {
    const auto model = build_model(scene);
    Simulation run = simulate(model, scene.solver);
    record_singular_poses(run);
    const Diagnostics rows = diagnose(run), judged = judge(run);
    Windows w = windows_of(scene, 20);
    INFO(scene.name << " " << w.parts.size());
    REQUIRE(w.parts.size() >= 2);
    RunDigest digest(model, scene.solver);
    std::size_t row = 0;
    const auto as_whole = [&](const Diagnostics& d, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i, ++row) {
        REQUIRE(row < rows.t.size());
        CHECK(d.t[i] == Approx(rows.t[row]).epsilon(1e-9));
        for (std::size_t c = 0; c < rows.columns.size(); ++c) {
          if (is_rounding(rows.columns[c].name)) continue;
          const double x = d.columns[c].values[i], y = rows.columns[c].values[row];
          const double size = rows.columns[c].unit == "J" ? energy_turned_over(rows) : 1.0;
          // Multipliers next to a singular pose magnify rounding.
          const bool force = rows.columns[c].unit == "N" || rows.columns[c].unit == "Pa";
          if (!(std::isnan(x) && std::isnan(y)) &&
              !(std::abs(x - y) <= (force ? 1e-7 : 1e-11) * (size + std::abs(y))) && x != y)
            FAIL(rows.columns[c].name << " at t = " << rows.t[row] << ": " << x << " and " << y);
        }
      }
    };
    for (std::size_t k = 0; k < w.parts.size(); ++k) {
      Stepper::Window& part = w.parts[k];
      as_whole(digest.add(part.run, part.first, part.last), part.first, part.last);
      digest.settle();
      if (k % 2) continue;
      digest = behind_checkpoint(digest, scene);
    }
    as_whole(digest.add(w.rest, w.first, w.rest.trajectory.size()), w.first, w.rest.trajectory.size());
    CHECK(row == rows.t.size());
    const Digest whole = digest.whole(w.rest);
    CHECK(digest.all_trusted() == (run.status != RunStatus::failed));
    same(summary_of(whole.run, whole.diagnostics), summary_of(run, judged), "");
  }
}

// A pendulum of 1 m and 1 kg that starts level under 10 m/s^2 passes below after T/4 = K(1/sqrt 2) / sqrt 10
// s with sqrt(20) m/s and a tension of 30 N, between two states: those of one part, or of two.
TEST_CASE("a peak between two parts of a long run is found as within one") {
  constexpr double quarter = 1.8540746773013719 / 3.1622776601683795;
  for (const double states_before : {17.5, 18.5, 19.3, 19.5, 19.7, 20.5, 21.5})
    for (const double end : {1.0, 1.6}) {  // one part and the rest, two parts and the rest
      const Scene scene = read_scene_text(
          "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0, 0, 0], fixed = true},\n"
          "{name = 'P', position = [1, 0, 0], mass = 1}]\nrods = [{nodes = ['O', 'P'], mass = 0}]\n"
          "[gravity]\nacceleration = [0, 0, -10]\n[solver]\nstages = 5\nstep = " +
              std::to_string(quarter / states_before) + "\nend_time = " + std::to_string(end) + "\n",
          "s.toml", {});
      const auto model = build_model(scene);
      Windows w = windows_of(scene, 20);
      INFO(states_before << " " << w.parts.size());
      REQUIRE(w.parts.size() == (end > 1 ? 2 : 1));
      RunDigest digest(model, scene.solver);
      for (Stepper::Window& part : w.parts) {
        digest.add(part.run, part.first, part.last);
        digest.settle();
      }
      digest.add(w.rest, w.first, w.rest.trajectory.size());
      const Digest whole = digest.whole(w.rest);
      // The states beside the peak miss it by 4 in 10^4 or more; the quintic between them by some 1e-8.
      CHECK(find_measure("peak_tension").value(whole.run, whole.diagnostics) == Approx(30).epsilon(1e-6));
      CHECK(find_measure("peak_speed").value(whole.run, whole.diagnostics) ==
            Approx(std::sqrt(20)).epsilon(1e-6));
      // 1e-6 of the tension is 0.3 ms beside its top; the states are 9 ms or more beside it.
      const PeakForce peak = peak_rod_force(whole.run, whole.diagnostics);
      CHECK(peak.t == Approx(quarter).epsilon(0).margin(2e-3));
      CHECK((peak.rod == 0 && peak.unique));
    }
}

// Under gravity rods in line would have to bear it across; the ring rests there, latched, for many parts
// more.
TEST_CASE("that forces have no bound in the deployed pose is told of a long run as of a short one") {
  const Scene scene = read_scene_file(find_scene("hoop6"),
                                      {"structure.fold_angle=60", "gravity.acceleration=[0,0,-1]",
                                       "solver.at_deployed=latch", "solver.step=0.01", "solver.end_time=3"});
  const auto model = build_model(scene);
  const Simulation run = simulate(model, scene.solver);
  const std::vector<std::string> expected = accuracy_warnings(run, diagnose(run));
  REQUIRE(expected.size() == 1);
  CHECK(expected[0].find("grow without bound towards the deployed pose") != std::string::npos);
  Windows w = windows_of(scene, 40);
  REQUIRE(w.parts.size() >= 4);
  const Digest whole = from_checkpoint_to_checkpoint(w, model, scene);
  CHECK(accuracy_warnings(whole.run, whole.diagnostics) == expected);
}

// What is told of states that no column and no rod's force leads to: a light rod, spun up for two steps
// beside a heavy one whose spring pulls harder, and a strip's tip far out while a bar bears more.
TEST_CASE("how fast rods turn and how far they give is told of a long run as of a short one") {
  const std::string fixed =
      "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0, 0, 0], fixed = true}, ";
  const std::string spun = R"(loads = [{nodes = ['W'], force = [1, 0, 0]}]
constraints = [{kind = 'line', nodes = ['W'], direction = [1, 0, 0]}]
forces = [{kind = 'spring', nodes = ['F', 'C'], stiffness = 1000}, {kind = 'drag', nodes = ['P', 'Q'], damping = 0.001},
  {kind = 'load_over_time', nodes = ['P'], force = [0, -0.03, 0], times = [10, 10.01, 10.02], values = [0, 1, 0]},
  {kind = 'load_over_time', nodes = ['Q'], force = [0, 0.03, 0], times = [10, 10.01, 10.02], values = [0, 1, 0]}]
)" + fixed + R"({name = 'F', position = [0, -200, 0], fixed = true},
  {name = 'A', position = [100, 0, 0], velocity = [0, 200, 0]},
  {name = 'C', position = [100, 50, 0], velocity = [20, 200, 0]}, {name = 'W', position = [0, 50, 0], mass = 10},
  {name = 'P', position = [0, 0, 3]}, {name = 'Q', position = [0.01, 0, 3]}]
rods = [{nodes = ['O', 'A'], mass = 100}, {nodes = ['A', 'C'], mass = 100}, {nodes = ['P', 'Q'], mass = 0.001}]
[solver]
step = 0.01
end_time = 20
)";
  const std::string hung =
      R"(loads = [{nodes = ['R'], force = [0, 0, -100]}, {nodes = ['T'], force = [0, 0.01, 0]}]
forces = [
  {kind = 'load_over_time', nodes = ['P'], force = [0, 0, -1], times = [0.5, 0.8, 1], values = [0.1, 8, 0.1]},
  {kind = 'load_over_time', nodes = ['O'], force = [0, 0, -1], times = [0.5, 0.8, 1], values = [8, 0.1, 8]}]
)" + fixed +
      R"({name = 'P', position = [0, 0, -1]},
  {name = 'Q', position = [4, 0, 0], fixed = true}, {name = 'R', position = [4, 0, -1], velocity = [0.3, 0, 0]},
  {name = 'S', position = [0, 0, 2], fixed = true}, {name = 'T', position = [0, 1, 2]}]
rod_model = 'quasi-static'
rods = [{nodes = ['O', 'P'], mass = 1, area = 1e-6, youngs_modulus = 1e7},
  {nodes = ['Q', 'R'], mass = 1, area = 1e-6, youngs_modulus = 1e9},
  {nodes = ['S', 'T'], mass = 1, area = 1e-6, youngs_modulus = 1e7}]
[solver]
step = 0.01
end_time = 2
)";
  for (const auto& [text, words, states] : {std::tuple{spun, "rods turn by up to", 500u},
                                            std::tuple{hung, "rods move nodes by up to 0.8 m", 60u}}) {
    const Scene scene = read_scene_text(text, "s.toml", {});
    const auto model = build_model(scene);
    const Simulation run = simulate(model, scene.solver);
    const std::vector<std::string> expected = accuracy_warnings(run, diagnose(run));
    REQUIRE(expected.size() == 1);
    CHECK(expected[0].find(words) != std::string::npos);
    Windows w = windows_of(scene, states);
    REQUIRE(w.parts.size() >= 2);
    const Digest whole = from_checkpoint_to_checkpoint(w, model, scene);
    CHECK(accuracy_warnings(whole.run, whole.diagnostics) == expected);
  }
}

// Beside the poses in which its windows are in line the ladder's rods bear 0.10 to 0.12 N s over the time to
// them (unbounded_peak_test.cpp). Behind them nothing leads from one row that is kept to the next.
TEST_CASE("that a force has no bound on the way is told of a long run as of a short one") {
  for (const char* method : {"dvm", "generalized_alpha", "rk4_projected"}) {
    INFO(method);
    const Scene scene = read_scene_file(find_scene("ladder"), {std::string("solver.method=") + method,
                                                               "solver.step=0.004", "solver.end_time=2"});
    const auto model = build_model(scene);
    Windows w = windows_of(scene, 60);
    REQUIRE(w.parts.size() >= 4);
    RunDigest digest(model, scene.solver);
    std::size_t told = 0;
    for (Stepper::Window& part : w.parts) {
      digest.add(part.run, part.first, part.last);
      for (const std::string& text :
           warnings_of(digest.whole(part.run).run, digest.whole(part.run).diagnostics))
        told += text.find("grows without bound towards a singular pose") != std::string::npos ? 1 : 0;
      digest.settle();
      digest = behind_checkpoint(digest, scene);
    }
    digest.add(w.rest, w.first, w.rest.trajectory.size());
    CHECK(told >= w.parts.size() / 2);  // from the first such pose on
    const Digest whole = digest.whole(w.rest);
    const std::vector<std::string> warnings = warnings_of(whole.run, whole.diagnostics);
    CHECK(std::ranges::count_if(warnings, [](const std::string& text) {
            return text.find("grows without bound towards a singular pose") != std::string::npos;
          }) == 1);
    const PeakForce peak = peak_rod_force(whole.run, whole.diagnostics);
    CHECK_FALSE(peak.unique);
    double nearest = 1;
    for (const Event& e : whole.run.events)
      if (e.kind == "singular_pose") nearest = std::min(nearest, std::abs(e.t - peak.t));
    // The time is that of the state beside it: within a step.
    CHECK(nearest < 0.0041);
    CHECK(std::abs(peak.force_N) > 0.08 / 0.004);
  }
}

// By rk4 the ladder's balance is lost at 3.171 s, beside the second of three poses in which windows are in
// line; the steepest rise is in what is left out.
TEST_CASE("what a long run that is cut says of forces without bound is of what is kept") {
  const Scene scene = read_scene_file(find_scene("ladder"),
                                      {"solver.method=rk4", "solver.step=0.003", "solver.end_time=6.3"});
  const auto model = build_model(scene);
  Simulation run = simulate(model, scene.solver);
  record_singular_poses(run);
  const Diagnostics judged = judge(run);
  REQUIRE(run.status == RunStatus::failed);
  const std::vector<std::string> expected = warnings_of(run, judged);
  REQUIRE(std::ranges::count_if(expected, [](const std::string& text) {
            return text.find("grows without bound towards a singular pose") != std::string::npos;
          }) == 1);
  for (const std::size_t states : {400UL, 900UL, 1300UL}) {
    INFO(states);
    Windows w = windows_of(scene, states);
    const Digest whole = from_checkpoint_to_checkpoint(w, model, scene);
    CHECK(whole.run.trajectory.end_time() == Approx(run.trajectory.end_time()).epsilon(0).margin(1e-9));
    CHECK(warnings_of(whole.run, whole.diagnostics) == expected);
  }
}

// An interrupt comes while the second part is judged: its first states have the rows that they have without
// one, to the bit, the others none, and the time between the two is what the run is said to be judged to.
TEST_CASE("of a long run that is interrupted what was judged is kept, and how far that is is said") {
  const Scene scene = read_scene_file(find_scene("four_bar"), {"solver.end_time=1", "solver.step=0.01"});
  const auto model = build_model(scene);
  Windows w = windows_of(scene, 30), same = windows_of(scene, 30);
  REQUIRE(w.parts.size() >= 3);
  RunDigest digest(model, scene.solver), whole(model, scene.solver);
  constexpr int left_out =
      25;  // of the 48 states that a window shows: each is asked for once, the last thing
  int asked = 0, more = std::numeric_limits<int>::max();
  const auto counts = [&] { return ++asked, false; };
  const auto cancelled = [&] { return --more < 0; };
  double until = -1;
  for (std::size_t k = 0; k < w.parts.size(); ++k) {
    Stepper::Window &part = w.parts[k], &other = same.parts[k];
    asked = 0;
    const Diagnostics all = whole.add(other.run, other.first, other.last, counts);
    if (k == 1) more = asked - left_out;
    const Diagnostics d = digest.add(part.run, part.first, part.last, cancelled);
    const std::size_t judged = d.t.size() - d.left_open;
    CHECK(digest.cut() == (k > 0));
    if (k < 2) CHECK((judged > part.first && judged > 0));
    if (k == 1) {
      CHECK(judged < part.last);
      until = d.t[judged - 1];
    }
    if (k > 1) CHECK(judged == 0);
    for (std::size_t i = part.first; i < part.last; ++i)
      for (const char* const column : {"kinetic_energy_J", "axial_force_max_N"}) {
        const double x = d.at(column).values[i];
        CHECK((i < judged ? x == all.at(column).values[i] : std::isnan(x)));
      }
    digest.settle(), whole.settle();
    CHECK(digest.cut() == (k > 0));
    CHECK(!whole.cut());
  }
  digest.add(w.rest, w.first, w.rest.trajectory.size(), cancelled);
  w.rest.status = RunStatus::stopped;
  const Digest left = digest.whole(w.rest);
  CHECK(left.diagnostics.left_open > 0);
  CHECK(left.diagnostics.t.size() - left.diagnostics.left_open > 1);
  CHECK(left.diagnostics.t[left.diagnostics.t.size() - left.diagnostics.left_open - 1] == until);
  CHECK(left.run.trajectory.end_time() == Approx(1));
  CHECK(std::isnan(find_measure("peak_rod_force").value(left.run, left.diagnostics)));
}

TEST_CASE("a part whose peaks within steps are not looked for to the end is nothing to go on from") {
  const Scene scene = read_scene_file(find_scene("four_bar"), {"solver.end_time=1", "solver.step=0.01"});
  for (const bool ends : {false, true}) {
    Windows w = windows_of(scene, 40);
    RunDigest digest(build_model(scene), scene.solver);
    Stepper::Window& part = w.parts.at(0);
    digest.add(part.run, part.first, part.last);
    const LooksUntil end(ends ? +[] { return true; } : +[] { return false; });
    digest.settle();
    CHECK(digest.cut() == ends);
  }
}

}  // namespace run_digest_test
