// SPDX-License-Identifier: BSD-3-Clause
// `unfurl run`: what it writes, what it refuses, what it keeps.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/app/run_program.hpp"

using namespace unfurl;
namespace fs = std::filesystem;

namespace run_command_test {

namespace {

const std::vector<std::string> quick = {"run", "hoop6_sector", "--set", "solver.end_time=0.1", "--quiet"};

std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::string single_error(const ProgramResult& r) {
  INFO(r.err);
  CHECK(std::count(r.err.begin(), r.err.end(), '\n') == 1);
  return r.err;
}

}  // namespace

TEST_CASE("run writes the data and nothing else") {
  const ScratchDirectory dir;
  const ProgramResult r = run_program(quick + std::vector<std::string>{"-o", dir / "out"});
  CHECK(r.code == 0);
  CHECK(r.out == "");
  CHECK(r.err == "");
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(dir / "out"))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  CHECK(names == std::vector<std::string>{".unfurl", "rod_forces.csv", "scene.toml", "series.csv",
                                          "summary.json", "trajectory.csv"});
  CHECK(file_text(dir / "out/series.csv").starts_with("t_s,kinetic_energy_J,"));
  CHECK(file_text(dir / "out/trajectory.csv").starts_with("t_s,B0.x_m,B0.y_m,B0.z_m,B0.vx_m_s,"));
}

TEST_CASE("the written scene reproduces the run") {
  const ScratchDirectory dir;
  run_program(quick + std::vector<std::string>{"-o", dir / "a"});
  CHECK(run_program({"run", dir / "a/scene.toml", "-o", dir / "b", "--quiet"}).code == 0);
  CHECK(file_text(dir / "a/trajectory.csv") == file_text(dir / "b/trajectory.csv"));
}

TEST_CASE("with --json the summary that is written is also printed") {
  const ScratchDirectory dir;
  const ProgramResult r = run_program(quick + std::vector<std::string>{"-o", dir / "out", "--json"});
  CHECK(r.out == file_text(dir / "out/summary.json"));
  CHECK(nlohmann::json::parse(r.out)["status"] == "completed");
  const ProgramResult alone = run_program(quick + std::vector<std::string>{"--json"});
  CHECK(alone.code == 0);
  CHECK(nlohmann::json::parse(alone.out)["model"]["nodes"] == 24);
}

TEST_CASE("a directory with results of our own is used again, one with other files only by force") {
  const ScratchDirectory dir;
  const auto run = quick + std::vector<std::string>{"-o", dir / "out"};
  CHECK(run_program(run).code == 0);
  CHECK(run_program(run).code == 0);

  dir.write("mine/thesis.txt", "precious");
  const auto other = quick + std::vector<std::string>{"-o", dir / "mine"};
  const ProgramResult refused = run_program(other);
  CHECK(refused.code == 5);
  CHECK(single_error(refused) ==
        "unfurl: " + dir / "mine" +
            ": is not empty and holds no earlier results; use --force to write into it\n");
  CHECK(run_program(other + std::vector<std::string>{"--force"}).code == 0);
  CHECK(file_text(dir / "mine/thesis.txt") == "precious");
  // Force is asked for again as long as there is no summary.
  CHECK(file_text(dir / "mine/.unfurl").starts_with("Written into by unfurl "));
  fs::remove(dir / "mine/summary.json");
  CHECK(run_program(other).code == 5);
}

TEST_CASE("an output directory that cannot be used is found before the work") {
  const ScratchDirectory dir;
  dir.write("file", "x");
  const ProgramResult file = run_program(quick + std::vector<std::string>{"-o", dir / "file"});
  CHECK(file.code == 5);
  CHECK(single_error(file) == "unfurl: " + dir / "file" + ": is a file; -o names a directory\n");

  const ProgramResult below = run_program(quick + std::vector<std::string>{"-o", dir / "file/below"});
  CHECK(below.code == 5);
  CHECK(single_error(below).find("not a directory") != std::string::npos);

  fs::create_directory(dir / "closed");
  fs::permissions(dir / "closed", fs::perms::owner_read | fs::perms::owner_exec);
  // Root may write anywhere but among the kernel's own files.
  const std::string out = ::geteuid() != 0 ? dir / "closed" : "/sys/closed";
  const ProgramResult closed = run_program(quick + std::vector<std::string>{"-o", out});
  CHECK(closed.code == 5);
  CHECK(single_error(closed).find(::geteuid() != 0 ? "ermission denied" : "not permitted") !=
        std::string::npos);
}

TEST_CASE("a solver that fails says so and keeps the good part") {
  const ScratchDirectory dir;
  // A speed of 1e298 m/s after one step: its square is no double.
  const ProgramResult r = run_program({"run", "double_pendulum", "--set",
                                       "gravity.acceleration=[0, 0, 1e300]", "--quiet", "-o", dir / "out"});
  CHECK(r.code == 4);
  CHECK(single_error(r).starts_with("unfurl: the solver failed: at t = 0 s: "));
  const auto summary = nlohmann::json::parse(file_text(dir / "out/summary.json"));
  CHECK(summary["status"] == "failed");
  CHECK(summary["message"].get<std::string>() != "");
  CHECK(summary["final"]["t_s"] == 0.0);
  CHECK(fs::exists(dir / "out/trajectory.csv"));
}

TEST_CASE("Ctrl-C keeps what is done") {
  const ScratchDirectory dir;
  // About a minute of work, interrupted after one second.
  const ProgramResult r = run_program(
      {"run", "hoop6", "--set", "solver.step=1e-6", "--set", "solver.end_time=4", "-o", dir / "out"},
      {.interrupt_after_s = 1.0});
  CHECK(r.code == 130);
  CHECK(r.err.find("unfurl: interrupted; what is finished is kept\n") != std::string::npos);
  const auto summary = nlohmann::json::parse(file_text(dir / "out/summary.json"));
  CHECK(summary["status"] == "stopped");
  CHECK(summary["solver"]["steps"] > 0);
  CHECK(fs::exists(dir / "out/trajectory.csv"));
}

TEST_CASE("the option --export takes a comma list and repeats, and says what it does not know") {
  const ScratchDirectory dir;
  const auto run = quick + std::vector<std::string>{"-o", dir / "out", "--export"};
  CHECK(run_program(run + std::vector<std::string>{"vtk,csv", "--export", "npy", "--export", "gltf"}).code ==
        0);
  for (const char* file : {"vtk/hoop6_sector.pvd", "vtk/hoop6_sector_000000.vtu", "csv/nodes.csv",
                           "csv/rods.csv", "npy/t_s.npy", "animation.glb"})
    CHECK(fs::exists(fs::path(dir / "out") / file));
  CHECK(run_program(quick + std::vector<std::string>{"-o", dir / "out"}).code == 0);
  CHECK(!fs::exists(dir / "out/vtk"));  // nothing of the earlier run stays
  CHECK(!fs::exists(dir / "out/animation.glb"));
  const ProgramResult wrong = run_program(run + std::vector<std::string>{"vkt"});
  CHECK(wrong.code == 2);
  CHECK(single_error(wrong) == "unfurl: no export format 'vkt'; did you mean 'vtk'?\n");
}

}  // namespace run_command_test
