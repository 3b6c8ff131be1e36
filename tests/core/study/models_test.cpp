// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/study/models.hpp"

using namespace unfurl;

namespace models_test {

// Its heap does not say how much of it is in use. GCC has a macro for it; headers may define clang's, too.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool sanitized = true;
#elif defined(__clang__)
constexpr bool sanitized = __has_feature(address_sanitizer);
#else
constexpr bool sanitized = false;
#endif

TEST_CASE("modelling choices that promise the same answer give it") {
  const SceneSource source{find_scene("hoop6"), {"solver.end_time=1", "structure.units=4"}};
  const auto models = compare_models(source, 1, {});
  const auto named = [&](std::string_view start) {
    for (const MeasuredModel& m : models)
      if (m.choice.name.starts_with(start)) return m;
    FAIL("no choice " << start);
    throw std::logic_error("unreachable");
  };
  // Steps are solved to round-off; the folded ring's smallest singular value, 2e-3, and 100 steps amplify the
  // differences of 1e-16 that another order of sums makes.
  for (const char* same : {"sector", "linear constraints kept", "dense matrices"}) {
    INFO(same);
    const MeasuredModel m = named(same);
    CHECK(m.outcome == "completed");
    CHECK(m.difference <= 1e-10);
  }
  CHECK(named("lumped mass").difference > 1e-3);
  const MeasuredModel shared = named("forces shared by stiffness");
  CHECK(shared.difference == 0.0);  // the motion is that of rigid rods, to the last bit
  CHECK(shared.peak_unique);
  CHECK(shared.cpu_forces > 0.0);
  CHECK(named("sector").peak_unique);
  // The ring is symmetric: what its rods share by stiffness is what the sector's carry.
  CHECK(shared.peak_force == Approx(named("sector").peak_force).epsilon(1e-6));
  // Chords of 9e-4 m^2 and 70 GPa under some 600 N give way by 3e-5 m, and twice that where a wave adds.
  for (const char* rods : {"quasi-static rods", "elastic rods", "bending rods"}) {
    const MeasuredModel m = named(rods);
    INFO(rods << ": " << m.outcome);
    CHECK(m.outcome == "completed");
    CHECK(m.difference > 1e-8);
    CHECK(m.difference < 1e-2);
    CHECK(m.tip_difference <= m.difference);
    CHECK(m.peak_unique ==
          (rods == std::string("quasi-static rods")));  // others have waves that steps do not follow
    if (!sanitized) CHECK(m.memory > 0);
  }
  // Coordinates up to 6 m in single precision: half a unit in the last place of [4, 8) is 2.4e-7.
  const double rounding = named("single precision").difference;
  CHECK(rounding <= 3 * 2.4e-7);
  CHECK(rounding >= 1e-8);
}

TEST_CASE("gears and nets are switched off one by one") {
  const std::string text =
      "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [1, 0, 0], mass = 1}, {name = 'H', "
      "position = "
      "[0, 0, 0], fixed = true}, {name = 'B', position = [0, 1, 0], mass = 2}, {name = 'C', position = [0, "
      "0, 1], mass "
      "= 1}]\n[[constraints]]\nkind = 'gear'\nname = 'wheels'\nnodes = ['A', 'H', 'B', 'B', 'H', 'C']\nradii "
      "= [1, "
      "2]\n[[forces]]\nkind = 'cable'\nname = 'net'\nnodes = ['A', 'C']\naxial_stiffness = 10\nsmoothing = "
      "0.01\n";
  const SceneSource wheels{"s.toml", {}, std::make_shared<const std::string>(text)};
  std::vector<std::string> names, changes;
  for (const ModelChoice& choice : model_choices(wheels))
    for (const std::string& change : choice.changes) names.push_back(choice.name), changes.push_back(change);
  CHECK(std::find(names.begin(), names.end(), "without wheels") != names.end());
  CHECK(std::find(changes.begin(), changes.end(), "constraints[0].enabled=false") != changes.end());
  CHECK(std::find(changes.begin(), changes.end(), "forces[0].enabled=false") != changes.end());
  const SceneSource reflector{
      "r.toml", {}, std::make_shared<const std::string>("[structure]\nkind = 'mesh_reflector'\n")};
  names.clear();
  for (const ModelChoice& choice : model_choices(reflector)) names.push_back(choice.name);
  CHECK(std::find(names.begin(), names.end(), "without nets") != names.end());
  CHECK(std::find(names.begin(), names.end(), "without synchronising gears") != names.end());
}

TEST_CASE("dense matrices are refused where they would not fit") {
  const SceneSource source{find_scene("hoop6"), {"solver.sparse=false", "structure.units=2000"}};
  CHECK_THROWS_WITH(build_model(source.read()),
                    Catch::Contains("solver.sparse") && Catch::Contains("3000 at most"));
}

TEST_CASE("what friction and a test rig add is measured beside the scene") {
  const auto named = [](const std::vector<MeasuredModel>& models, std::string_view name) {
    for (const MeasuredModel& m : models)
      if (m.choice.name == name) return m;
    FAIL("no choice " << name);
    throw std::logic_error("unreachable");
  };
  const SceneSource rig{
      find_scene("hoop6"),
      {"structure.units=4", "structure.fold_angle=60", "gravity.acceleration=[0,0,-9.81]",
       "solver.end_time=6", "forces[0]={kind=\"offload\", nodes=[\"*\"], trolley=\"following\"}",
       "forces[1]={kind=\"friction\", fold_angle=true, kinetic=20, static=25}"}};
  const auto models = compare_models(rig, 1, {});
  // Ropes that follow carry the weight and nothing else; hinges with friction deploy later.
  const MeasuredModel flight = named(models, "0 g flight: neither weight nor offload"),
                      smooth = named(models, "without friction"), test = models.front();
  CHECK(flight.outcome == "deployed");
  CHECK(flight.deployment_time == Approx(test.deployment_time).epsilon(1e-9));
  // The largest rod force is that of a state 1e-4 s before the singular pose, at 6e-4 rad: one of those that
  // the rigid model leaves open, where round-off of 1e-16 over the third power of the angle is some 1e-4 of
  // it.
  CHECK(flight.peak_force == Approx(test.peak_force).epsilon(1e-3));
  CHECK(smooth.deployment_time < test.deployment_time - 1e-3);
  // From trolleys that stay the ring is pulled back.
  const SceneSource fixed{find_scene("hoop6"),
                          {"structure.units=4", "structure.fold_angle=60", "gravity.acceleration=[0,0,-9.81]",
                           "solver.end_time=9", "forces[0]={kind=\"offload\", nodes=[\"*\"], length=40}"}};
  const auto pulled = compare_models(fixed, 1, {});
  CHECK(pulled.front().deployment_time >
        named(pulled, "0 g flight: neither weight nor offload").deployment_time + 1e-3);
}

namespace {

MeasuredModel without_damping(const std::string& text) {
  const SceneSource source{"s.toml", {}, std::make_shared<const std::string>(text)};
  for (const MeasuredModel& m : compare_models(source, 1, {}))
    if (m.choice.name == "without damping") return m;
  FAIL("no row without damping");
  throw std::logic_error("unreachable");
}

}  // namespace

TEST_CASE("what only damps is switched off where the price of damping is measured") {
  // A free mass of m = 2 kg at v = 3 m/s against a drag of c = 5 N s/m: x = v m/c (1 - exp(-c t/m)); without
  // it v t. Steps of 0.01 s keep order 4 at least: 1e-8 of the way.
  const std::string coasting =
      "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], velocity = [3, 0, 0], mass "
      "= "
      "2}]\n[[forces]]\nkind = 'drag'\nnodes = ['A']\ndamping = 7\nenabled = false\n[[forces]]\nkind = "
      "'drag'\nnodes = ['A']\ndamping = 5\n[solver]\nstep = 0.01\nend_time = 0.5\n";
  const MeasuredModel free = without_damping(coasting);
  CHECK(free.choice.changes == std::vector<std::string>{"forces[1].enabled=false"});
  CHECK(free.outcome == "completed");
  CHECK(free.difference == Approx(1.5 - 1.2 * (1 - std::exp(-1.25))).epsilon(1e-7));
  // Torques at a pin against one another: a rod that turns beside one that is held. 1/3 m L^2 of 3 kg and 1 m
  // is 1 kg m^2: the angle is w/c (1 - exp(-c t)), without damping w t.
  const MeasuredModel swung = without_damping(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'H', position = [0, 0, 0], fixed = true}, {name = 'F', "
      "position = [-1, 0, 0], fixed = true}, {name = 'A', position = [1, 0, 0], velocity = [0, 0, "
      "0.5]}]\nrods "
      "= [{nodes = ['F', 'H'], mass = 1}, {nodes = ['H', 'A'], mass = 3}]\n[[structure.constraints]]\nkind = "
      "'plane'\nnodes = ['A']\nnormal = [0, 1, 0]\n[[forces]]\nkind = 'joint_damping'\nnodes = ['H']\n"
      "damping = 2\n[[forces]]\nkind = 'spring'\nnodes = ['F', 'A']\ndamping = 0\nstiffness = 1e-9\n"
      "[solver]\nstep = 0.01\nend_time = 1\n");
  const double angle = 0.5 - 0.25 * (1 - std::exp(-2.0));
  CHECK(swung.outcome == "completed");
  CHECK(swung.difference == Approx(2 * std::sin(angle / 2)).epsilon(1e-7));
}

TEST_CASE("models are compared at equal times however short the steps are") {
  // A rod of 1 um whose end goes round at 100 m/s, 1e-10 s a step: dense and sparse factorisations differ by
  // round-off, some 1e-16 of its length a step. One step beside is 1e-8 m.
  const std::string tiny =
      "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'B', "
      "position = [1e-6, 0, 0], velocity = [0, 0, 100], mass = 1e-12}]\nrods = [{nodes = ['A', 'B'], mass = "
      "1e-13}]\n[solver]\nstep = 1e-10\nend_time = 1e-8\n";
  const SceneSource source{"s.toml", {}, std::make_shared<const std::string>(tiny)};
  int compared = 0;
  for (const MeasuredModel& m : compare_models(source, 1, {})) {
    if (m.choice.name != "dense matrices" && m.choice.name != "sparse matrices" &&
        !m.choice.name.starts_with("linear constraints"))
      continue;
    INFO(m.choice.name);
    CHECK(m.outcome == "completed");
    CHECK(m.difference <= 1e-17);
    ++compared;
  }
  CHECK(compared >= 2);
}

// Steps that follow the motion end at times of their own.
TEST_CASE("models are compared over the whole motion whatever their steps are") {
  const auto lumped = [](const char* adaptive) {
    for (const MeasuredModel& m : compare_models({find_scene("four_bar"), {adaptive}}, 1, {}))
      if (m.choice.name.starts_with("lumped mass")) return m;
    FAIL("no such model");
    throw std::logic_error("unreachable");
  };
  const MeasuredModel equal = lumped("solver.adaptive=false"), own = lumped("solver.adaptive=true");
  CHECK(own.difference >= own.tip_difference);
  // The largest of smooth distances at times that are a step apart at most.
  CHECK(own.difference == Approx(equal.difference).epsilon(0.02));
}

// The rim is in both; what hangs slack in it moves it by its mass: little in 0.02 s of a drive that begins
// over 2 s.
TEST_CASE("a model without some of the nodes is compared by those that it has") {
  const SceneSource reflector{find_scene("mesh_reflector"), {"solver.end_time=0.02"}};
  for (const MeasuredModel& m : compare_models(reflector, 1, {}))
    if (m.choice.name == "without nets" || m.choice.name == "without synchronising gears") {
      INFO(m.choice.name);
      CHECK(m.outcome == "completed");
      CHECK(m.difference >= m.tip_difference);
      CHECK(m.difference > 0);
      CHECK(m.difference < 1e-3);
    }
}

// A row has numbers of what was solved or none at all, but the mesh's what it is there for.
TEST_CASE("a model that is not possible has no numbers in the table") {
  const auto file = std::filesystem::temp_directory_path() / "unfurl_impossible_models_test.csv";
  std::filesystem::remove(file);
  Table tables[2];  // as it is compared, and from the rows that it kept
  for (Table& table : tables) {
    Journal journal(file, models_columns(), 1, models_number_columns(), is_measured_model);
    table = models_table(compare_models({find_scene("pendulum"), {"solver.end_time=0.1"}}, 1, journal, {}));
    CHECK(journal.damage().empty());
  }
  CHECK(tables[0].rows == tables[1].rows);
  int impossible = 0;
  for (const auto& row : tables[0].rows) {
    INFO(row[0] << ": " << row[1]);
    const bool refused = row[1].starts_with("not possible: "), mesh = row[1].empty();
    impossible += refused;
    CHECK((row[2] == "nan") == (refused || mesh));
    if (row[2] == "nan") CHECK(std::count(row.begin() + 2, row.end(), "nan") == (mesh ? 11 : 12));
  }
  CHECK(impossible > 0);
  std::filesystem::remove(file);
}

// Rows that were kept are taken as they are: their times tell. The rest is compared with the same first run,
// so that differences are those of a comparison in one go, to the last bit.
TEST_CASE("a comparison of models goes on from the rows that are kept") {
  const SceneSource source{find_scene("four_bar"), {"solver.end_time=0.2"}};
  const auto file = std::filesystem::temp_directory_path() / "unfurl_models_test.csv";
  std::filesystem::remove(file);
  const auto compared = [&](const StudyHooks& hooks) {
    Journal journal(file, models_columns(), 1, models_number_columns(), is_measured_model);
    return models_table(compare_models(source, 1, journal, hooks)).rows;
  };
  StudyHooks until_some;
  until_some.cancelled = [&] {  // when three rows are there, below their heading
    std::ifstream in(file);
    return std::count(std::istreambuf_iterator<char>(in), {}, '\n') >= 4;
  };
  CHECK_THROWS_AS(compared(until_some), Cancelled);
  Journal kept(file, models_columns(), 1, models_number_columns(), is_measured_model);
  REQUIRE(kept.size() == 3);
  const auto whole = models_table(compare_models(source, 1, {})).rows;
  for (const char* outcome :
       {"completed", "deployed", "not possible: no modulus", "banana", "failed", "stopped"}) {
    std::vector<std::string> row = whole.front();
    row[1] = outcome;
    INFO(outcome);
    CHECK(is_measured_model(row) == (std::string("cdn").find(outcome[0]) != std::string::npos));
  }
  const auto all = [&] {
    Journal more({}, models_columns(), 1);
    more.take_in(file);
    return models_table(compare_models(source, 1, more, {})).rows;
  }();
  REQUIRE(all.size() == whole.size());
  const std::size_t difference = 8, tip = 13;
  for (std::size_t r = 0; r < all.size(); ++r) {
    INFO(all[r][0]);
    CHECK(all[r][0] == whole[r][0]);
    CHECK(all[r][difference] == whole[r][difference]);
    CHECK(all[r][tip] == whole[r][tip]);
    if (const auto* row = kept.find({all[r][0]})) CHECK(*row == all[r]);
  }
  std::filesystem::remove(file);
}

TEST_CASE("a model that failed says why in its row and in the summary") {
  MeasuredModel failed;
  failed.choice.name = "stiff";
  failed.outcome = "failed";
  failed.message = "at t = 0.5 s: no step, however short, converges";
  failed.solved_coordinates = 6;
  failed.cpu_median = 1;
  CHECK(models_table({failed}).rows.front()[1] == "failed: " + failed.message);
  CHECK(models_summary({failed}).rows.front()[0] == "stiff (failed: " + failed.message + ")");
  MeasuredModel completed = failed;
  completed.outcome = "completed";
  completed.message.clear();
  CHECK(models_table({completed}).rows.front()[1] == "completed");
  CHECK(models_summary({completed}).rows.front()[0] == "stiff");
}

}  // namespace models_test
