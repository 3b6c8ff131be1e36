// SPDX-License-Identifier: BSD-3-Clause
// What studies, sweeps and solve do not take: it is told, and nothing of it is left.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "tests/app/run_program.hpp"

using namespace unfurl;

namespace refused_studies_test {

// As a kill leaves it: the list says that it grows.
TEST_CASE("damaged rows of an unfinished sweep are told of and computed anew") {
  const ScratchDirectory dir;
  const std::vector<std::string> sweep = {"sweep",     "pendulum", "--vary", "structure.angle=10,20,30",
                                          "--measure", "energy",   "--set",  "solver.end_time=0.3",
                                          "-o",        dir / "out"};
  REQUIRE(run_program(sweep).code == 0);
  const std::string right = file_text(dir / "out/sweep.csv");
  const std::size_t begin = right.find("\n20,") + 1, end = right.find('\n', begin);
  REQUIRE(begin > 1);
  for (const char* row : {"20,banana,0.12", "20,completed,nan", "20,completed,inf", "20,completed,-1"}) {
    INFO(row);
    std::ofstream(dir / "out/sweep.csv") << right.substr(0, begin) << row << right.substr(end);
    std::ofstream(dir / "out/.unfurl", std::ios::app) << "---------------- sweep sweep.csv\n";
    const ProgramResult again = run_program(sweep);
    CHECK(again.code == 0);
    CHECK(again.err.find("sweep.csv: line 3 is no finished result and was not taken") != std::string::npos);
    CHECK(file_text(dir / "out/sweep.csv") == right);
  }
  CHECK(run_program(sweep).err.find("no finished result") == std::string::npos);
}

TEST_CASE("a comparison of models takes no options of studies") {
  const ScratchDirectory dir;
  const std::vector<std::string> models = {"study", "hoop6", "--models", "-o", dir / "out"};
  const std::vector<std::vector<std::string>> idle = {{"--methods", "dvm"}, {"--steps", "0.02:0.01"},
                                                      {"--join"},           {"--style", "slide"},
                                                      {"--font", "dejavu"}, {"--dpi", "60"}};
  for (const auto& option : idle) {
    auto words = models;
    words.insert(words.end(), option.begin(), option.end());
    const ProgramResult r = run_program(words);
    CHECK(r.code == 2);
    CHECK(r.err == "unfurl: " + option.front() + " is not for --models; leave it out\n");
  }
  CHECK_FALSE(std::filesystem::exists(dir / "out"));
}

// Ten runs of each of twelve models, of 5 ms each and more, are longer than half a second. Times are those of
// the rows that were kept, to the last digit.
TEST_CASE("a comparison of models that is interrupted keeps its rows and goes on") {
  const ScratchDirectory dir;
  const std::vector<std::string> models = {"study",   "hoop6", "--models",          "--repeats", "10",
                                           "--quiet", "--set", "solver.end_time=1", "-o",        dir / "out"};
  const ProgramResult r =
      run_program(models, {.interrupt_after_s = 0.5, .first_wait_for = dir / "out/models.csv"});
  CHECK(r.code == 130);
  const std::string kept = file_text(dir / "out/models.csv");
  CHECK(kept.starts_with("model,outcome,"));
  CHECK(run_program({"verify", dir / "out"}).code == 0);
  const ProgramResult rest = run_program(models);
  INFO(rest.err);
  CHECK(rest.code == 0);
  const std::string whole = file_text(dir / "out/models.csv");
  CHECK(whole.starts_with(kept));
  CHECK(whole.size() > kept.size());
  REQUIRE(run_program(models).code == 0);  // all is known
  CHECK(file_text(dir / "out/models.csv") == whole);
}

TEST_CASE("a scene that does not run is no fault of the command line") {
  const ScratchDirectory dir;
  // A rod of no strength of its own that two drives pull apart: no step goes past that, however small.
  const std::string scene = dir.write("torn.toml", R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [0.6, 0, 0.8]}]
rods = [{nodes = ["A", "B"], mass = 1}]
[[constraints]]
kind = "coordinate"
nodes = ["B"]
direction = [1, 0, 0]
motion = "rate"
rate = 1
[solver]
end_time = 1
)");
  const ProgramResult study = run_program({"study", scene, "-o", dir / "out", "--quiet"});
  INFO(study.err);
  CHECK(study.code == run_program({"run", scene, "-o", dir / "run", "--quiet"}).code);
  CHECK(study.code == 4);
  CHECK(study.err.find("unfurl: the scene as it stands does not run (at t = 0.4") == 0);
}

TEST_CASE("a sweep that draws no figure says so") {
  const ScratchDirectory dir;
  const std::vector<std::string> sweep = {"sweep", "pendulum", "--measure", "max:kinetic_energy_J",
                                          "--dpi", "40",       "--set",     "solver.end_time=0.1",
                                          "--vary"};
  const auto with = [&](const std::vector<std::string>& more) {
    auto words = sweep;
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words);
  };
  const std::string said = "no figure: it takes one or two --vary; words of up to 30 values";
  const ProgramResult words = with({"solver.method=dvm,rk4", "-o", dir / "words"}),
                      numbers = with({"structure.angle=10,20", "-o", dir / "numbers"}),
                      three = with({"structure.angle=10,20", "--vary", "structure.length=1,2", "--vary",
                                    "structure.bob_mass=1,2", "-o", dir / "three"});
  CHECK(words.err.find("no figure") == std::string::npos);
  CHECK(std::filesystem::exists(dir / "words/figures/sweep_max_kinetic_energy_J.png"));
  CHECK(three.err.find(said) != std::string::npos);
  CHECK(file_text(dir / "three/sweep.md").find("No figure: it takes") != std::string::npos);
  CHECK(numbers.err.find("no figure") == std::string::npos);
}

// Thirty words stand below each other, thirty-one do not.
TEST_CASE("pictures and reports of fewer points do not stay beside more") {
  const ScratchDirectory dir;
  const std::string scene = dir.write(
      "s.toml",
      "[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true}, {name = 'B', "
      "position = [0.1, 0, -1], mass = 1}]\nrods = [{nodes = ['A', 'B'], mass = 0.1}]\n[gravity]\n"
      "acceleration = [0, 0, -9.81]\n[solver]\nstep = 0.05\nend_time = 0.2\n");
  std::string titles = "\"a1\"";
  for (int i = 2; i <= 30; ++i) titles += ",\"a" + std::to_string(i) + "\"";
  const auto sweep = [&](const std::string& words) {
    return run_program({"sweep", scene, "--vary", "structure.nodes.B.mass=1:2:2", "--vary", "title=" + words,
                        "--measure", "peak_speed", "--dpi", "40", "-o", dir / "out"})
        .code;
  };
  const std::filesystem::path out = dir / "out", picture = out / "figures/sweep_peak_speed.png";
  REQUIRE(sweep(titles) == 0);
  REQUIRE(std::filesystem::exists(picture));
  REQUIRE(sweep(titles) == 0);  // the same once more
  CHECK(std::filesystem::exists(picture));
  REQUIRE(sweep(titles + ",\"b\"") == 0);
  CHECK(!std::filesystem::exists(out / "figures"));
  CHECK(file_text(out / "sweep.md").find("62 points") != std::string::npos);
  CHECK(run_program({"verify", out.string()}).code == 0);
}

TEST_CASE("results that are not asked for again are not written over") {
  const ScratchDirectory dir;
  struct Case {
    const char* file;
    std::vector<std::string> words, more, fewer, again;
  };
  const Case cases[] = {{"sweep.csv",
                         {"sweep", "pendulum", "--measure", "energy", "--set", "solver.end_time=0.3"},
                         {"--vary", "structure.angle=10:30:3"},
                         {"--vary", "structure.angle=10,30"},
                         {"--vary", "structure.angle=5:30:6"}},
                        {"study.csv",
                         {"study", "pendulum", "--steps", "0.05:0.02", "--set", "solver.end_time=0.3"},
                         {"--methods", "rk4,rk4_projected"},
                         {"--methods", "rk4"},
                         {"--methods", "rk4,rk4_projected,rk4_baumgarte"}}};
  for (const Case& c : cases) {
    INFO(c.file);
    const auto run = [&](const std::vector<std::string>& asked, bool force) {
      std::vector<std::string> words = c.words;
      words.insert(words.end(), asked.begin(), asked.end());
      words.insert(words.end(), {"-o", dir / c.file, "--dpi", "40", "--quiet"});
      if (force) words.push_back("--force");
      return run_program(words);
    };
    const std::string table = dir / c.file + "/" + c.file;
    REQUIRE(run(c.more, false).code == 0);
    const std::string before = file_text(table);
    const ProgramResult refused = run(c.fewer, false);
    INFO(refused.err);
    CHECK(refused.code == 5);
    CHECK(refused.err.find(
              "not asked for now and would be lost; ask for them, too, or use another -o, or --force") !=
          std::string::npos);
    CHECK(file_text(table) == before);
    CHECK(run(c.again, false).code == 0);
    CHECK(file_text(table).size() > before.size());
    CHECK(run(c.fewer, true).code == 0);
    CHECK(file_text(table).size() < before.size());
  }
}

TEST_CASE("shards are not removed by the command that merges them") {
  const ScratchDirectory dir;
  const std::vector<std::string> sweep = {"sweep",     "pendulum", "--vary", "structure.angle=10,20,30",
                                          "--measure", "energy",   "--set",  "solver.end_time=0.3",
                                          "--quiet",   "-o",       dir / "s"};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = sweep;
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words);
  };
  REQUIRE(with({"--shard", "1/2"}).code == 0);
  REQUIRE(with({"--shard", "2/2"}).code == 0);
  const ProgramResult refused = with({"--merge", dir / "s/../s", "--force"});
  CHECK(refused.code == 2);
  CHECK(refused.err.find("--force would remove the points that --merge puts together") != std::string::npos);
  CHECK(with({"--merge", dir / "s"}).code == 0);
  CHECK(std::filesystem::exists(dir / "s/sweep.csv"));
}

TEST_CASE("a directory whose scene other results need takes no other scene") {
  const ScratchDirectory dir;
  const std::vector<std::string> run = {"run",    "pendulum", "-o", dir / "o", "--set", "solver.end_time=0.1",
                                        "--quiet"};
  const auto with = [&](const std::vector<std::string>& verb, const std::vector<std::string>& more) {
    std::vector<std::string> words = verb;
    words.insert(words.end(), {"-o", dir / "o", "--set", "solver.end_time=0.1", "--dpi", "40", "--quiet"});
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words);
  };
  const std::vector<std::string> study = {"study", "pendulum", "--methods", "rk4", "--steps", "0.025:0.0125"};
  const std::vector<std::string> sweep = {"sweep",     "pendulum", "--vary", "structure.bob_mass=1,2",
                                          "--measure", "energy"};
  REQUIRE(run_program(run).code == 0);
  for (const auto& [verb, more] : {std::pair{study, std::vector<std::string>{"--set", "structure.angle=20"}},
                                   std::pair{sweep, std::vector<std::string>{}}}) {
    const ProgramResult refused = with(verb, more);
    INFO(refused.err);
    CHECK(refused.code == 5);
    CHECK(refused.err.find("holds results of unfurl run, whose scene.toml this would replace") !=
          std::string::npos);
  }
  CHECK(with(study, {}).code == 0);  // of the same scene
  CHECK(run_program({"reproduce", dir / "o/series.csv"}).code == 0);
  const ProgramResult back = run_program(run);  // would take what the study needs to go on
  CHECK(back.code == 5);
  CHECK(back.err.find("holds results of unfurl study, whose") != std::string::npos);
  CHECK(with(study, {}).code == 0);
  CHECK(with(sweep, {"--force"}).code == 0);
  CHECK(std::filesystem::exists(dir / "o/scene.toml.kept-1"));
}

TEST_CASE("a directory where a table should be is told of before anything is done") {
  const ScratchDirectory dir;
  const std::vector<std::string> run = {"run",    "pendulum", "-o", dir / "o", "--set", "solver.end_time=0.1",
                                        "--quiet"};
  REQUIRE(run_program(run).code == 0);
  const std::string summary = file_text(dir / "o/summary.json");
  std::filesystem::remove(dir / "o/trajectory.csv");
  std::filesystem::create_directories(dir / "o/trajectory.csv/mine");
  std::vector<std::string> other = run;
  other.insert(other.end(), {"--set", "structure.bob_mass=9"});
  const ProgramResult refused = run_program(other);
  CHECK(refused.code == 5);
  CHECK(refused.err.find("o/trajectory.csv: ") != std::string::npos);
  CHECK(refused.err.find("directory") != std::string::npos);
  CHECK(file_text(dir / "o/summary.json") == summary);
  CHECK(std::filesystem::exists(dir / "o/trajectory.csv/mine"));
}

TEST_CASE("a run that is refused leaves no directory") {
  const ScratchDirectory dir;
  std::filesystem::create_directories(dir / "mine");
  for (const char* path : {"o", "p/deeper/o", "p/o/", "mine/o"}) {
    INFO(path);
    const ProgramResult refused =
        run_program({"run", "bricard", "-o", dir / path, "--set", "solver.model=path"});
    INFO(refused.err);
    CHECK(refused.code == 3);
    CHECK_FALSE(std::filesystem::exists(dir / path));
    CHECK_FALSE(std::filesystem::exists(dir / "p"));
  }
  CHECK(std::filesystem::exists(dir / "mine"));  // it was there before
}

TEST_CASE("keys that are varied or solved for and do nothing are told of") {
  const ScratchDirectory dir;
  const auto sweep = [&](const std::vector<std::string>& vary) {
    std::vector<std::string> words = {"sweep",  "pendulum", "--measure",
                                      "energy", "--set",    "solver.end_time=0.1"};
    for (const std::string& axis : vary) words.insert(words.end(), {"--vary", axis});
    static int count = 0;
    words.insert(words.end(), {"-o", dir / std::to_string(++count), "--dpi", "40"});
    return run_program(words).err;
  };
  CHECK(sweep({"solver.rho_inf=0,0.5"}).find("--vary solver.rho_inf does nothing with method = 'dvm'") !=
        std::string::npos);
  CHECK(sweep({"solver.rho_inf=0,0.5", "solver.method=dvm,generalized_alpha"}).find("does nothing") ==
        std::string::npos);
  CHECK(run_program({"sweep", "pendulum", "--measure", "energy", "--set", "structure.bob_mass=3", "--vary",
                     "structure.bob_mass=1,2", "-o", dir / "twice", "--dpi", "40"})
            .err.find("--set structure.bob_mass does nothing: --vary changes the key") != std::string::npos);
  const ProgramResult solved = run_program({"solve", "pendulum", "--find", "solver.rho_inf", "--target",
                                            "energy=3", "--set", "solver.end_time=0.1"});
  CHECK(solved.code == 4);
  CHECK(solved.err.find("--find solver.rho_inf does nothing with method = 'dvm'") != std::string::npos);
  CHECK(run_program({"run", "pendulum", "-o", dir / "o", "--size", "64x64", "--set", "render.size[0]=128"})
            .code == 2);
}

TEST_CASE("measures whose names differ in what files cannot have keep a figure each") {
  const ScratchDirectory dir;
  const std::string scene =
      dir.write("two.toml",
                "[structure]\nkind = 'custom'\nnodes = [{name = 's:1', position = [0, 0, 0], fixed = true}, "
                "{name = 's_1', "
                "position = [2, 0, 0], fixed = true}, {name = 'B c', position = [1, 0, 0.5], mass = 1}]\n"
                "rods = [{nodes = ['s:1', 'B c'], mass = 1}]\n[gravity]\nacceleration = [0, 0, -10]\n"
                "[solver]\nend_time = 0.1\nstep = 0.02\n");
  REQUIRE(run_program({"sweep", scene, "--vary", "structure.nodes[2].mass=1,2", "--measure",
                       "max:s:1.reaction_N,max:s_1.reaction_N", "-o", dir / "out", "--dpi", "40", "--quiet"})
              .code == 0);
  CHECK(std::filesystem::exists(dir / "out/figures/sweep_max_s_1.reaction_N.svg"));
  CHECK(std::filesystem::exists(dir / "out/figures/sweep_max_s_1.reaction_N_.svg"));
  CHECK(file_text(dir / "out/sweep.md").find("](figures/sweep_max_s_1.reaction_N_.png)") !=
        std::string::npos);
}

// Friction acts from the start of every motion, and no reference knows it.
TEST_CASE("an atlas without any reference is refused and draws no figures of nothing") {
  const ScratchDirectory dir;
  const ProgramResult r =
      run_program({"stress", "pendulum", "-o", dir / "out", "--set",
                   "forces[0]={kind='friction', nodes=['bob'], direction=[0,0,1], kinetic=0.1}", "--quiet"});
  CHECK(r.code == 4);
  CHECK(r.err.find("none of the extremes has a reference") != std::string::npos);
  CHECK(r.err.find("dry friction") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(dir / "out/figures"));
}

TEST_CASE("a study that is refused leaves nothing behind") {
  const ScratchDirectory dir;
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{"--methods", "rk5"}, {"--steps", "0.1:0.2"}, {"--steps", "90:0.1"}}) {
    std::vector<std::string> words{"study", "pendulum", "-o", dir / "out"};
    words.insert(words.end(), wrong.begin(), wrong.end());
    const ProgramResult r = run_program(words);
    INFO(r.err);
    CHECK(r.code == 2);
    CHECK_FALSE(std::filesystem::exists(dir / "out"));
  }
}

TEST_CASE("solve says of a key that takes no number what it is") {
  for (const std::vector<std::string>& where :
       {std::vector<std::string>{}, std::vector<std::string>{"--between", "1:2"}}) {
    std::vector<std::string> words{"solve",           "hoop6",    "--find",
                                   "structure.model", "--target", "deploy_time=4.92"};
    words.insert(words.end(), where.begin(), where.end());
    const ProgramResult r = run_program(words);
    CHECK(r.code == 2);
    CHECK(r.err.find("unfurl: 'structure.model' takes no number: it is ") == 0);
    CHECK(r.err.find("--set") == std::string::npos);
  }
  // A key that is not there keeps its own message.
  const ProgramResult unknown =
      run_program({"solve", "hoop6", "--find", "structure.modl", "--target", "deploy_time=4.92"});
  CHECK(unknown.err.find("did you mean 'model'?") != std::string::npos);
}

}  // namespace refused_studies_test
