// SPDX-License-Identifier: BSD-3-Clause
// `unfurl study`, `sweep`, `solve`, `stress`, `reproduce`: what they write, what they refuse, what they keep.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/app/run_program.hpp"

using namespace unfurl;
namespace fs = std::filesystem;

namespace study_commands_test {

namespace {

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

const std::vector<std::string> quick_study = {"study",   "double_pendulum", "--set", "solver.end_time=0.4",
                                              "--steps", "0.05:0.01"};

std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

TEST_CASE("study writes points, a report and figures, and goes on where it stopped") {
  const ScratchDirectory dir;
  const auto asked = quick_study + std::vector<std::string>{"-o", dir / "out"};
  const auto command = asked + std::vector<std::string>{"--repeats", "1"};
  const ProgramResult first = run_program(command);
  INFO(first.err);
  CHECK(first.code == 0);
  CHECK(first.err.find("The cheapest setting for 0.001 m is ") == 0);
  const std::string points = file_text(dir / "out/study.csv");
  CHECK(points.starts_with("setting,steps,method,stages,"));
  for (const char* name : {"study.md", "figures/work_precision.png", "figures/work_precision.svg",
                           "figures/convergence.png", "scene.toml"})
    CHECK(fs::exists(dir / (std::string("out/") + name)));
  CHECK(run_program(command).code == 0);
  CHECK(file_text(dir / "out/study.csv") == points);  // CPU times and all: nothing was measured again
  const ProgramResult repeated = run_program(asked + std::vector<std::string>{"--repeats", "2"});
  CHECK(repeated.code == 5);
  CHECK(repeated.err.find("holds \"A study from steps of 0.05 s with 1 repeat") != std::string::npos);
  CHECK(repeated.err.find("asked for: \"A study from steps of 0.05 s with 2 repeats, by unfurl") !=
        std::string::npos);
  // Errors are compared at times that are spaced as the largest step says: none of others come in between.
  auto finer = command;
  finer[5] = "0.02:0.01";
  const ProgramResult spaced = run_program(finer);
  CHECK(spaced.code == 5);
  CHECK(spaced.err.find("asked for: \"A study from steps of 0.02 s with") != std::string::npos);
  CHECK(file_text(dir / "out/study.csv") == points);
  finer[5] = "0.05:0.005";  // the same times, one step more
  CHECK(run_program(finer).code == 0);
  CHECK(lines(file_text(dir / "out/study.csv")) > lines(points));
  const ProgramResult other =
      run_program(command + std::vector<std::string>{"--set", "gravity.acceleration=[0,0,-1]"});
  CHECK(other.code == 5);
  CHECK(other.err.find("holds results of another scene or other settings") != std::string::npos);
}

TEST_CASE("study refuses ladders that are none") {
  const ScratchDirectory dir;
  for (const char* ladder : {"0.01", "0.01:0.05", "0:0.1", "a:b", "0.3:0.1"}) {
    auto words = quick_study + std::vector<std::string>{"-o", dir / "out"};
    words[5] = ladder;
    const ProgramResult r = run_program(words);
    INFO(ladder << r.err);
    CHECK(r.code == 2);
    CHECK(lines(r.err) == 1);
  }
}

TEST_CASE("study compares models: a sector moves as the whole, for less") {
  const ScratchDirectory dir;
  const ProgramResult r = run_program(
      {"study", "hoop6", "--models", "--set", "solver.end_time=0.5", "--repeats", "1", "-o", dir / "out"});
  CHECK(r.code == 0);
  CHECK(lines(file_text(dir / "out/models.csv")) == 12);
  CHECK(r.err.find("| sector: one sector solved, all shown | 4 | 3 |") != std::string::npos);
}

TEST_CASE("shards of a sweep merge into the whole") {
  const ScratchDirectory dir;
  const std::vector<std::string> sweep = {"sweep",     "hoop6_sector",
                                          "--vary",    "structure.fold_angle=40:60:5",
                                          "--measure", "deploy_time,peak_rod_force",
                                          "--dpi",     "100",
                                          "-o",        dir / "out"};
  for (const char* shard : {"1/2", "2/2"})
    CHECK(run_program(sweep + std::vector<std::string>{"--shard", shard}).code == 0);
  CHECK(lines(file_text(dir / "out/sweep_1_of_2.csv")) == 4);
  CHECK(run_program(sweep + std::vector<std::string>{"--merge", dir / "out"}).code == 0);
  const std::string merged = file_text(dir / "out/sweep.csv");
  CHECK(merged.starts_with(
      "structure.fold_angle,outcome,deploy_time_s,peak_rod_force_N,peak_rod_force_unique\n40,deployed,"));
  CHECK(lines(merged) == 6);
  for (const char* end : {".svg", ".pdf", ".png", ".csv", ".caption.txt"})
    CHECK(fs::exists(dir / "out/figures/sweep_deploy_time" + end));

  fs::remove(dir / "out/sweep_2_of_2.csv");
  fs::remove(dir / "out/sweep.csv");
  const ProgramResult missing = run_program(sweep + std::vector<std::string>{"--merge", dir / "out"});
  CHECK(missing.code == 5);
  CHECK(missing.err.find("2 of 5 points are missing") != std::string::npos);
  // The command that computes them, to be copied: it does.
  const std::size_t at = missing.err.find("\n  unfurl sweep ");
  REQUIRE(at != std::string::npos);
  CHECK(missing.err.find("--shard 2/2", at) != std::string::npos);
  CHECK(missing.err.find("--merge", at) == std::string::npos);
}

TEST_CASE("shards that do not agree on a point are named when they are merged") {
  const ScratchDirectory dir;
  const std::vector<std::string> sweep = {"sweep",     "pendulum",    "--vary", "structure.angle=20,40",
                                          "--measure", "peak_energy", "--set",  "solver.end_time=0.3",
                                          "-o",        dir / "out"};
  for (const char* shard : {"1/2", "2/2"})
    REQUIRE(run_program(sweep + std::vector<std::string>{"--shard", shard}).code == 0);
  const std::string one = file_text(dir / "out/sweep_1_of_2.csv");
  const std::size_t comma = one.rfind(',');
  std::ofstream(dir / "out/sweep_1_of_7.csv") << one.substr(0, comma) + ",123.25\n";
  const ProgramResult r = run_program(sweep + std::vector<std::string>{"--merge", dir / "out"});
  CHECK(r.code == 0);
  CHECK(r.err.find("sweep_1_of_7.csv disagree; the first was taken") != std::string::npos);
  CHECK(file_text(dir / "out/sweep.csv").find("123.25") == std::string::npos);
}

TEST_CASE("a task of a job array knows its shard") {
  const ScratchDirectory dir;
  const auto shard = [&](const char* given, std::vector<std::string> environment) {
    const std::string out = dir / "out";
    fs::remove_all(out);
    const ProgramResult r =
        run_program({"sweep", "pendulum", "--vary", "structure.angle=10:50:5", "--measure", "end_time",
                     "--set", "solver.end_time=0.05", "-o", out, "--shard", given, "--quiet"},
                    {.environment = std::move(environment)});
    if (r.code != 0) return r.err;
    for (const auto& entry : fs::directory_iterator(out))
      if (entry.path().extension() == ".csv") return entry.path().stem().string();
    return std::string("nothing");
  };
  CHECK(shard("auto", {"SLURM_ARRAY_TASK_ID=12", "SLURM_ARRAY_TASK_MIN=8", "SLURM_ARRAY_TASK_STEP=2",
                       "SLURM_ARRAY_TASK_COUNT=5"}) == "sweep_3_of_5");
  CHECK(shard("auto", {"SGE_TASK_ID=7", "SGE_TASK_FIRST=1", "SGE_TASK_LAST=9", "SGE_TASK_STEPSIZE=2"}) ==
        "sweep_4_of_5");
  CHECK(shard("auto", {"OMPI_COMM_WORLD_RANK=1", "OMPI_COMM_WORLD_SIZE=3"}) == "sweep_2_of_3");
  CHECK(shard("auto", {"PMI_RANK=0", "PMI_SIZE=3"}) == "sweep_1_of_3");
  CHECK(shard("auto", {"SLURM_PROCID=2", "SLURM_NTASKS=4"}) == "sweep_3_of_4");
  CHECK(shard("auto/6", {"PBS_ARRAY_INDEX=6"}) == "sweep_6_of_6");
  CHECK(shard("auto/4", {"SLURM_ARRAY_TASK_ID=0", "SLURM_ARRAY_TASK_MIN=0", "SLURM_ARRAY_TASK_COUNT=4"}) ==
        "sweep_1_of_4");
  // Submitted again by itself (sbatch --array=3).
  CHECK(shard("auto/4", {"SLURM_ARRAY_TASK_ID=3", "SLURM_ARRAY_TASK_MIN=3", "SLURM_ARRAY_TASK_COUNT=1"}) ==
        "sweep_3_of_4");
  CHECK(shard("auto/4", {"SGE_TASK_ID=4", "SGE_TASK_FIRST=2", "SGE_TASK_LAST=4", "SGE_TASK_STEPSIZE=2"}) ==
        "sweep_4_of_4");
  CHECK(shard("auto", {"PBS_ARRAY_INDEX=6"}).find("--shard auto/N") != std::string::npos);
  CHECK(shard("auto", {"SGE_TASK_ID=undefined"}).find("no job array is around") != std::string::npos);
  CHECK(shard("automatic", {}).find("a shard is I/N, auto, or auto/N; got 'automatic'") != std::string::npos);
  // A task beyond the number that was told has no share, and says so.
  CHECK(shard("auto/6", {"PBS_ARRAY_INDEX=7"}).find("1 <= I <= N; got '7/6'") != std::string::npos);
}

TEST_CASE("job scripts repeat the sweep with a share for every task and end in a merge") {
  const std::vector<std::string> sweep = {"sweep",     "pendulum",       "--vary",    "structure.angle=10,20",
                                          "--measure", "end_time",       "--threads", "3",
                                          "--set",     "title=\"it's\"", "-o",        "D"};
  const auto script = [&](const char* name) {
    return run_program(sweep + std::vector<std::string>{"--script", name, "--jobs", "5"}).out;
  };
  const std::string same =
      "unfurl sweep pendulum --vary structure.angle=10,20 --measure end_time --set 'title=\"it'\\''s\"' -o D";
  CHECK(script("slurm").find("#SBATCH --array=1-5\n") != std::string::npos);
  CHECK(script("slurm").find("\nexec " + same + " --shard auto/5 --threads 1 --quiet\n") !=
        std::string::npos);
  CHECK(script("parallel")
            .find("seq 5 | parallel -q --halt soon,fail=1 " + same + " --threads 1 --quiet --shard {}/5\n" +
                  same + " --merge D\n") != std::string::npos);
  CHECK(script("snakemake").find("expand(\"D.shard_{i}_done\", i=range(1, 6))") != std::string::npos);
  // Tasks that begin again keep what is finished, whatever the sweep began with.
  CHECK(run_program(sweep + std::vector<std::string>{"--force", "--script", "parallel", "--jobs", "5"}).out ==
        script("parallel"));
  CHECK(run_program(sweep + std::vector<std::string>{"--script", "slrm"}).err ==
        "unfurl: no script for 'slrm'; did you mean 'slurm'?\n");
}

TEST_CASE("a sweep says how many of its points have no answer") {
  const ScratchDirectory dir;
  const ProgramResult r = run_program({"sweep", "hoop6_sector", "--vary", "structure.units=5,7", "--measure",
                                       "deploy_time", "--set", "solver.step=2", "--set", "solver.method=rk4",
                                       "--set", "solver.model=full", "-o", dir / "out"});
  CHECK(r.code == 4);
  // Runge-Kutta in three steps loses every constraint: no answer, not a wrong one.
  CHECK(r.err.starts_with("unfurl: warning: failed: structure.units=5: from t = "));
  CHECK(r.err.find("\n2 points in " + dir / "out/sweep.csv" + ", 2 of them without an answer\n") !=
        std::string::npos);
  CHECK(file_text(dir / "out/sweep.csv").find("failed,nan") != std::string::npos);
}

TEST_CASE("sweeps say how far nodes were moved to fit the lengths of rods") {
  const ScratchDirectory dir;
  const std::vector<std::string> made{"--set", "structure.length_error=1e-4", "--set",
                                      "solver.end_time=0.05"};
  const std::string said = "unfurl: warning: structure.error_seed=1: ";
  const ProgramResult swept =
      run_program(std::vector<std::string>{"sweep", "scissor_mast", "--vary", "structure.error_seed=1,2",
                                           "--measure", "end_time", "-o", dir / "out"} +
                  made);
  INFO(swept.err);
  CHECK(swept.code == 0);
  CHECK(swept.err.find(said) != std::string::npos);
  CHECK(swept.err.find("nodes were moved to fit") != std::string::npos);
  const ProgramResult exact =
      run_program({"sweep", "scissor_mast", "--vary", "structure.density=2000,2100", "--measure", "end_time",
                   "-o", dir / "exact", "--set", "solver.end_time=0.05"});
  CHECK(exact.code == 0);
  CHECK(exact.err.find("nodes were moved") == std::string::npos);
}

TEST_CASE("a sweep says which measure its scene does not have") {
  const ScratchDirectory dir;
  const ProgramResult r =
      run_program({"sweep", "double_pendulum", "--set", "solver.end_time=0.1", "--vary",
                   "solver.step=0.01,0.02", "--measure", "deploy_time,peak_energy", "-o", dir / "out"});
  CHECK(r.code == 0);
  CHECK(
      r.err.find("; deploy_time has no value in 2 of them (nothing deploys: [deployment] says what does)") !=
      std::string::npos);
  const ProgramResult rigid =
      run_program({"sweep", "hoop6_sector", "--set", "solver.end_time=0.1", "--vary",
                   "structure.hinge_force=100,200", "--measure", "stress_margin", "-o", dir / "rigid"});
  CHECK(rigid.err.find("stress_margin has no value in 2 of them (no rod has a structure.youngs_modulus)") !=
        std::string::npos);
  CHECK(r.err.find("peak_energy has no value") == std::string::npos);
}

TEST_CASE("solve begins at what a variable is worked out to") {
  // A uniform rod that hangs and falls from the horizontal: its energies scale with its length.
  const ScratchDirectory dir;
  const std::string scene =
      dir.write("rod.toml",
                "[variables]\nL = '=3/4'\n[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, "
                "0, 0], fixed = "
                "true},\n{name = 'B', position = ['=L', 0, 0]}]\nrods = [{nodes = ['A', 'B'], mass = 2}]\n"
                "[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nstep = 0.01\nend_time = 1\n");
  // At its lowest it has fallen by L/2: the largest kinetic energy is m g L / 2, here of L = 0.9.
  const ProgramResult r = run_program(
      {"solve", scene, "--find", "variables.L", "--target", "max:kinetic_energy_J=8.829", "--json"});
  INFO(r.err);
  REQUIRE(r.code == 0);
  CHECK(nlohmann::json::parse(r.out)["value"].get<double>() == Approx(0.9).epsilon(1e-6));
}

TEST_CASE("whole numbers are neither searched nor swept in between") {
  const ScratchDirectory dir;
  const ProgramResult sweep = run_program({"sweep", "hoop6_sector", "--vary", "structure.units=3:40:3",
                                           "--measure", "deploy_time", "-o", dir / "out"});
  CHECK(sweep.code == 2);
  CHECK(sweep.err.find("'structure.units' takes whole numbers; 21.5 is none") != std::string::npos);
  const ProgramResult solve =
      run_program({"solve", "hoop6_sector", "--find", "structure.units", "--target", "deploy_time=8"});
  const ProgramResult rigid = run_program(
      {"solve", "hoop6_sector", "--find", "structure.youngs_modulus", "--target", "deploy_time=4"});
  CHECK(rigid.code == 2);  // rigid rods have an infinite one
  CHECK(rigid.err.find("--between LOW:HIGH") != std::string::npos);
  CHECK(solve.code == 2);
  CHECK(solve.err.find("takes whole numbers, which cannot be searched") != std::string::npos);
}

TEST_CASE("a study without a reference ends with a sentence") {
  // The pendulum is chaotic: after a minute no two solutions agree.
  const ScratchDirectory dir;
  const ProgramResult r = run_program({"study", "double_pendulum", "--set", "solver.end_time=60", "--steps",
                                       "5:2", "--repeats", "1", "-o", dir / "out"});
  CHECK(r.code == 4);
  CHECK(r.err.find("the reference does not converge") != std::string::npos);
  CHECK(r.err.find("internal") == std::string::npos);
}

TEST_CASE("journals that hold no results are refused or measured again") {
  const ScratchDirectory dir;
  const std::vector<std::string> sweep = {"sweep",     "pendulum",   "--vary", "structure.angle=40,50",
                                          "--measure", "peak_speed", "-o",     dir / "out"};
  REQUIRE(run_program(sweep).code == 0);
  const std::string points = file_text(dir / "out/sweep.csv");
  std::string damaged = points;
  damaged.replace(damaged.rfind(',') + 1, 3, "abc");
  std::ofstream(dir / "out/sweep.csv") << damaged;
  std::ofstream(dir / "out/.unfurl", std::ios::app) << "---------------- sweep sweep.csv\n";  // unfinished
  CHECK(run_program(sweep).code == 0);
  CHECK(file_text(dir / "out/sweep.csv") == points);
  for (const char* verb : {"study", "stress"}) {
    const std::string out = dir / verb;
    REQUIRE(fs::create_directories(out));
    std::ofstream(out + "/" + verb + ".csv") << "setting,steps,other\n";
    const ProgramResult r = run_program({verb, "pendulum", "-o", out});
    CHECK(r.code == 5);
    CHECK(r.err.find("use --force") != std::string::npos);
  }
}

TEST_CASE("points of another sweep are neither joined nor merged") {
  const ScratchDirectory dir;
  const std::vector<std::string> sweep = {
      "sweep", "hoop6_sector", "--vary", "structure.fold_angle=40:60:3", "--measure", "deploy_time"};
  const std::vector<std::string> heavier = {"--set", "structure.density=3500"};
  REQUIRE(run_program(sweep + std::vector<std::string>{"--shard", "1/2", "-o", dir / "out"}).code == 0);
  const ProgramResult joined =
      run_program(sweep + heavier + std::vector<std::string>{"--shard", "2/2", "-o", dir / "out"});
  CHECK(joined.code == 5);
  CHECK(joined.err == "unfurl: " + dir / "out" +
                          ": holds results of another scene or other settings; use another directory, or "
                          "--force to begin anew\n");
  const ProgramResult merged =
      run_program(sweep + heavier + std::vector<std::string>{"--merge", dir / "out", "-o", dir / "new"});
  CHECK(merged.code == 5);
  CHECK(merged.err.find("holds results of another scene or other settings; merge what one command") !=
        std::string::npos);
}

// Both pairs agree at the scene's own values and differ at others, so that points of one are not of the
// other.
TEST_CASE("points of scenes that agree only before something is varied are not mixed") {
  const ScratchDirectory dir;
  const std::string head =
      "[structure]\nkind = \"custom\"\nnodes = [{name = \"A\", position = [0, 0, 0], fixed = true}, "
      "{name = \"B\", position = [1, 0, 0]}, {name = \"C\", position = [0, 0, 1], fixed = true}]\nrods = "
      "[{nodes = [\"A\", \"B\"], mass = 1}]\n"
      "[solver]\nend_time = 0.3\n";
  const auto gravity = [&](const std::string& down) {
    return head + "[variables]\nk = 2\n[gravity]\nacceleration = [0, 0, \"=" + down + "\"]\n";
  };
  const auto motor = [&](const std::string& constant) {
    return head +
           "[[constraints]]\nkind = \"plane\"\nnodes = [\"B\"]\nnormal = [0, 1, 0]\n[[forces]]\nkind = "
           "\"motor\"\n"
           "name = \"m\"\nnodes = [\"C\", \"A\", \"B\"]\nstall_torque = 2\nno_load_speed = "
           "90\ntorque_constant = " +
           constant + "\n";
  };
  struct Pair {
    std::string one, other, axis;
  };
  int number = 0;
  for (const Pair& pair : {Pair{gravity("-4*k"), gravity("-2*k^2"), "variables.k=1,2"},
                           Pair{motor("0.1"), motor("0.2"), "forces.m.current_limit=1,2"}}) {
    const std::string scene = dir / "scene.toml", out = dir / ("out" + std::to_string(++number));
    const std::vector<std::string> sweep = {"sweep",     scene,        "--vary", pair.axis,
                                            "--measure", "peak_speed", "-o",     out};
    std::ofstream(scene) << pair.one;
    const ProgramResult first = run_program(sweep);
    INFO(first.err);
    REQUIRE(first.code == 0);
    std::ofstream(scene) << pair.one << "# a remark\n";
    CHECK(run_program(sweep).code == 0);
    std::ofstream(scene) << pair.other;
    const ProgramResult other = run_program(sweep);
    CHECK(other.code == 5);
    CHECK(other.err.find("holds results of another scene or other settings") != std::string::npos);
    CHECK(run_program({"sweep", scene, "--vary", pair.axis, "--measure", "peak_speed", "--merge", out, "-o",
                       dir / "new"})
              .code == 5);
    CHECK(run_program({"check", out + "/scene.toml"}).code == 0);
  }
}

TEST_CASE("which model solved a sweep is part of it, and makes its figures again") {
  const ScratchDirectory dir;
  const std::vector<std::string> command = {"sweep",     "pendulum",
                                            "--vary",    "structure.length=0.8,1.2",
                                            "--set",     "solver.end_time=0.2",
                                            "--measure", "end_time,peak_speed",
                                            "-o",        dir / "out"};
  REQUIRE(run_program(command).code == 0);
  CHECK(file_text(dir / "out/scene.toml").find("model = \"auto\"") != std::string::npos);
  CHECK(run_program({"reproduce", dir / "out/figures/sweep_peak_speed.png"}).code == 0);
  const ProgramResult other = run_program(command + std::vector<std::string>{"--set", "solver.model=full"});
  CHECK(other.code == 5);
  CHECK(other.err.find("holds results of another scene or other settings") != std::string::npos);
}

TEST_CASE("sweep refuses what cannot be swept") {
  const ScratchDirectory dir;
  const auto refused = [&](const std::string& vary, const std::string& measure, int code,
                           const std::string& why) {
    const ProgramResult r =
        run_program({"sweep", "hoop6", "--vary", vary, "--measure", measure, "-o", dir / "out"});
    INFO(r.err);
    CHECK(r.code == code);
    CHECK(r.err.find(why) != std::string::npos);
  };
  refused("structure.fold_angle=1:1:3", "deploy_time", 2, "the range is empty");
  refused("structure.fold_angle=1:2:0", "deploy_time", 2, "the count must be a whole number from 1");
  refused("structure.fold_angle=90:95:3", "deploy_time", 3, "structure.fold_angle");
  refused("structure.fold_angle=10:80:3", "deploy", 2, "no measure 'deploy'");
  refused("structure.fold_angle=10:80:3", "", 2, "nothing to measure");
}

TEST_CASE("solve finds the ring's fold angle from its deployment time") {
  const ProgramResult r = run_program({"solve", "hoop6_sector", "--find", "structure.fold_angle", "--target",
                                       "deploy_time=4.92", "--set", "structure.fold_angle=80", "--json"});
  REQUIRE(r.code == 0);
  // The time is good to 1e-7 s with three nodes; it changes by 3.5 s per degree there.
  CHECK(nlohmann::json::parse(r.out)["value"].get<double>() == Approx(89.34053637766085).margin(1e-6));
}

TEST_CASE("solve begins with its directory, and keeps the answer of the last target") {
  const ScratchDirectory dir;
  const auto solve = [&](const char* target, const std::string& out) {
    return run_program({"solve", "hoop6_sector", "--find", "structure.fold_angle", "--target",
                        std::string("deploy_time=") + target, "-o", out});
  };
  REQUIRE(solve("2", dir / "out").code == 0);
  const std::string before = file_text(dir / "out/scene.toml");
  const ProgramResult r = solve("3", dir / "out");
  CHECK(r.code == 0);
  CHECK(r.out.starts_with("structure.fold_angle = "));
  const std::string value = r.out.substr(23, r.out.size() - 24);  // between "= " and the line's end
  CHECK(file_text(dir / "out/scene.toml").find("fold_angle = " + value + "  # deg\n") != std::string::npos);
  CHECK(file_text(dir / "out/scene.toml") != before);
  // What ends there ends before the work: no answer was found.
  REQUIRE(
      run_program({"run", "pendulum", "-o", dir / "run", "--set", "solver.end_time=0.1", "--quiet"}).code ==
      0);
  for (const std::string& other : {dir.write("file", ""), dir / "run"}) {
    const ProgramResult refused = solve("3", other);
    CHECK(refused.code == 5);
    CHECK(refused.out == "");
  }
  CHECK(run_program({"reproduce", dir / "run/series.csv"}).code == 0);
}

TEST_CASE("solve finds numbers of forces, and says what is wrong with either end") {
  const std::vector<std::string> scene{
      "solve",    "four_bar",
      "--set",    R"(forces[0]={kind="spring",name="s",nodes=["B","D"],stiffness=40})",
      "--set",    "solver.end_time=0.5",
      "--target", "end_time=0.5",
      "--find"};
  const auto solve = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = scene;
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words);
  };
  for (const char* key : {"forces[0].stiffness", "forces[s].stiffness"}) {
    const ProgramResult r = solve({key});
    CHECK(r.out == std::string(key) + " = 40\n");
    CHECK(r.code == 0);
  }
  for (const char* ends : {"-3:5", "-9:-3"}) {
    const ProgramResult r = solve({"forces[0].stiffness", "--between", ends});
    CHECK(r.code == 3);
    CHECK(r.err.find("forces[0].stiffness: must be") != std::string::npos);
  }
  const ProgramResult r = run_program({"solve", "hoop6", "--find", "structure.fold_angle", "--target",
                                       "deploy_time=1", "--between", "50:102"});
  CHECK(r.code == 3);
  CHECK(r.err.find("structure.fold_angle: must be in (0, 90) deg; got 102") != std::string::npos);
}

TEST_CASE("options of other verbs are refused") {
  const ProgramResult r = run_program({"check", "hoop6", "--shard", "1/2"});
  CHECK(r.code == 2);
  CHECK(r.err == "unfurl: unfurl check has no option '--shard'; unfurl sweep has it\n");
}

TEST_CASE("a tolerance is met and the estimate is in the summary") {
  const ProgramResult r = run_program(
      {"run", "double_pendulum", "--set", "solver.end_time=1", "--tolerance", "1e-7", "--json", "--quiet"});
  REQUIRE(r.code == 0);
  CHECK(nlohmann::json::parse(r.out)["errors"]["position_estimate_m"].get<double>() <= 1e-7);
}

TEST_CASE("reproduce holds what the paper claims, in a page that stands alone") {
  const ScratchDirectory dir;
  const ProgramResult r = run_program({"reproduce", "-o", dir / "out", "--quiet"});
  INFO(r.err);
  CHECK(r.code == 0);
  const std::string html = file_text(dir / "out/report.html");
  CHECK(html.find("src=\"data:image/png;base64,") != std::string::npos);
  CHECK(html.find("src=\"figures/") == std::string::npos);
  CHECK(lines(file_text(dir / "out/runs.csv")) == 17);
}

}  // namespace study_commands_test
