// SPDX-License-Identifier: BSD-3-Clause
// What is removed and replaced: nothing but what unfurl wrote, and never outside -o.
#include "app/output/written_files.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <set>

#include "tests/app/run_program.hpp"

namespace unfurl::written_files_test {

namespace fs = std::filesystem;

namespace {

using Words = std::vector<std::string>;

Words quick(const std::string& verb, const std::string& out, const Words& more = {}) {
  Words words{verb, "pendulum", "--set", "solver.end_time=0.1", "--quiet", "-o", out};
  if (verb != "run") words.insert(words.end(), {"--dpi", "60"});
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::set<std::string> files_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (!entry.is_directory()) names.insert(entry.path().lexically_relative(folder).string());
  return names;
}

// One file of every kind that any version of the program ever wrote, with words of somebody else in it.
const Words& foreign_names() {
  static const Words names{
      "animation.gif",           "animation.glb",     "csv/taxes.csv",  "figures/my_plot.png",
      "figures/notes.svg",       "figures/draft.pdf", "figures/a.csv",  "figures/a.caption.txt",
      "frames/frame_00012.png",  "npy/w.npy",         "vtk/x.vtu",      "vtk/x.pvd",
      "study_notes_of_mine.csv", "sweep_mine.csv",    "stress-2024.csv"};
  return names;
}

void put_foreign_files(const ScratchDirectory& dir, const std::string& out) {
  for (const auto& name : foreign_names()) dir.write(out + "/" + name, "mine: " + name);
}

void check_foreign_files(const std::string& out) {
  for (const auto& name : foreign_names()) {
    INFO(name);
    // In its place, or beside a file of ours that has the name.
    const std::string aside = out + "/" + name + ".kept-1";
    CHECK(file_text(fs::exists(aside) ? aside : out + "/" + name) == "mine: " + name);
  }
}

}  // namespace

TEST_CASE("files of somebody else in the directory outlive every verb, with and without force") {
  const ScratchDirectory dir;
  const Words small{"--size", "48x32", "--fps", "10", "--set", "render.mp4=false"};
  const std::vector<Words> commands{
      quick("run", dir / "out", {"--export", "csv,npy,vtk,gltf"}),
      {"figure", "pendulum", "energy", "trajectory", "--set", "solver.end_time=0.1", "--quiet", "-o",
       dir / "out"},
      {"study", "pendulum", "--steps", "0.1:0.05", "--methods", "rk4", "--repeats", "1", "--dpi", "60",
       "--quiet", "-o", dir / "out"},
      {"sweep", "pendulum", "--vary", "solver.step=0.05,0.1", "--measure", "energy", "--dpi", "60", "--quiet",
       "-o", dir / "out"},
  };
  for (const Words& command : commands) {
    fs::remove_all(dir / "out");
    put_foreign_files(dir, "out");
    for (const bool force : {true, true}) {
      Words words = command;
      if (force) words.emplace_back("--force");
      const ProgramResult r = run_program(words);
      INFO(command[0] << ": " << r.err);
      CHECK(r.code != 1);
      check_foreign_files(dir / "out");
    }
  }
}

TEST_CASE("a run does not follow links out of its directory, and keeps what stands there") {
  const ScratchDirectory dir;
  REQUIRE(run_program(quick("run", dir / "out", {"--export", "csv"})).code == 0);
  dir.write("paper/photo.png", "mine");
  fs::create_directory_symlink("../paper", dir / "out/figures");
  fs::rename(dir / "out/csv", dir / "elsewhere");  // our own files, but not in the directory any more
  fs::create_directory_symlink("../elsewhere", dir / "out/csv");
  CHECK(run_program(quick("run", dir / "out")).code == 0);
  CHECK(file_text(dir / "paper/photo.png") == "mine");
  CHECK(fs::is_symlink(dir / "out/figures"));
  CHECK(fs::exists(dir / "elsewhere/nodes.csv"));
}

TEST_CASE("of a run before nothing stays, whatever kind of file it was") {
  const ScratchDirectory dir;
  const Words film{"--size", "48x32", "--fps", "10", "--export", "csv,npy,vtk,gltf"};
  REQUIRE(run_program(quick("render", dir / "out", film)).code == 0);
  CHECK(fs::exists(dir / "out/figures/energy.pdf"));
  CHECK(fs::exists(dir / "out/figures/energy.caption.txt"));
  CHECK(run_program(
            {"run", "four_bar", "--set", "solver.end_time=0.1", "--quiet", "--force", "-o", dir / "out"})
            .code == 0);
  CHECK(files_in(dir / "out") == std::set<std::string>{".unfurl", "rod_forces.csv", "scene.toml",
                                                       "series.csv", "summary.json", "trajectory.csv"});
}

TEST_CASE("a file that was changed since, or is not ours, is kept beside the new one") {
  const ScratchDirectory dir;
  const std::string out = dir / "out";
  REQUIRE(run_program(quick("run", out)).code == 0);
  dir.write("out/series.csv", "edited");
  fs::remove(out + "/summary.json");
  fs::create_symlink("../somewhere", out + "/summary.json");
  for (const char* step : {"0.01", "0.02"}) {  // other numbers, so that files of the first run are replaced
    const ProgramResult r = run_program(quick("run", out, {"--set", std::string("solver.step=") + step}));
    CHECK(r.code == 0);
    CHECK((r.err.find("series.csv.kept-1") != std::string::npos) == (std::string(step) == "0.01"));
  }
  CHECK(file_text(out + "/series.csv.kept-1") == "edited");
  CHECK(fs::read_symlink(out + "/summary.json.kept-1") == "../somewhere");
  CHECK_FALSE(fs::exists(out + "/series.csv.kept-2"));
  CHECK_FALSE(fs::exists(out + "/trajectory.csv.kept-1"));
}

TEST_CASE("results of a version that kept no list are replaced, but none is lost") {
  const ScratchDirectory dir;
  const Words film{"--size", "48x32", "--fps", "10", "--set", "render.mp4=false"};
  REQUIRE(run_program(quick("render", dir / "out", film)).code == 0);
  dir.write("out/.unfurl", "Made by unfurl 0.1.0\n");
  dir.write("out/film.json", "{}");  // of another program
  const std::string frame = file_text(dir / "out/frames/frame_00000.png");
  Words other = quick("render", dir / "out", film);
  other.insert(other.end(), {"--force", "--look", "blueprint"});
  const ProgramResult r = run_program(other);
  INFO(r.err);
  CHECK(r.code == 0);
  CHECK(file_text(dir / "out/frames.kept-1/frame_00000.png") == frame);
  CHECK(file_text(dir / "out/frames/frame_00000.png") != frame);
}

TEST_CASE("a list that leads out of the directory removes nothing there") {
  const ScratchDirectory dir;
  const std::string precious = dir.write("precious.csv", "");  // of no bytes: their checksum is known
  fs::create_directories(dir / "out");
  dir.write("out/.unfurl",
            "Made by unfurl 0.1.0\ncbf29ce484222325 run ../precious.csv\n---------------- run " + precious +
                "\n---------------- run link\n---------------- run sub/../../precious.csv\n");
  fs::create_directories(dir / "out/sub");
  fs::create_symlink(precious, dir / "out/link");
  CHECK(run_program(quick("run", dir / "out")).code == 0);
  CHECK(fs::exists(precious));
  CHECK(fs::is_symlink(dir / "out/link"));
}

TEST_CASE("force begins a study anew, and of a sweep only the shard it is told to") {
  const ScratchDirectory dir;
  const Words sweep{"sweep",     "pendulum",
                    "--vary",    "solver.step=0.05,0.1,0.2",
                    "--set",     "solver.end_time=0.4",
                    "--measure", "energy",
                    "--quiet",   "--force",
                    "-o",        dir / "out"};
  for (const char* shard : {"1/3", "2/3", "3/3"}) {
    Words words = sweep;
    words.insert(words.end(), {"--shard", shard});
    CHECK(run_program(words).code == 0);
  }
  for (const char* name : {"/sweep_1_of_3.csv", "/sweep_2_of_3.csv", "/sweep_3_of_3.csv"})
    CHECK(fs::exists((dir / "out") + name));
  Words other = sweep;  // another sweep: what there is cannot be joined with it
  other.insert(other.end(), {"--shard", "1/3", "--set", "gravity.acceleration=[0, 0, -5]"});
  CHECK(run_program(other).code == 0);
  CHECK_FALSE(fs::exists(dir / "out/sweep_2_of_3.csv"));
}

TEST_CASE(
    "what a killed program left half written is removed, wherever it lies, what is being written is not") {
  const ScratchDirectory dir;
  REQUIRE(run_program(quick("run", dir / "out", {"--export", "csv,vtk"})).code == 0);
  Words left;
  for (const char* folder : {"out/", "out/csv/", "out/vtk/", "out/npy/", "out/frames/", "out/figures/"})
    left.push_back(dir.write(std::string(folder) + ".unfurl-0123456789abcdef.part", "t_s"));
  const std::string foreign = dir.write("out/.unfurl-notes.part", "mine");
  const PendingFile writing(dir / "out/series.csv");
  CHECK(run_program(quick("run", dir / "out")).code == 0);
  for (const auto& path : left) {
    INFO(path);
    CHECK_FALSE(fs::exists(path));
  }
  CHECK(fs::exists(foreign));
  CHECK(fs::exists(writing.name()));
}

TEST_CASE("figures go into any directory and replace only figures of ours, and a film may follow") {
  const ScratchDirectory dir;
  const std::string mine = dir.write("figs/energy.png", "mine");
  const Words figures{"figure", "pendulum", "all", "--set", "solver.end_time=0.1", "--quiet", "-o"};
  Words words = figures;
  words.push_back(dir / "figs");
  CHECK(run_program(words).code == 0);
  CHECK(file_text(mine + ".kept-1") == "mine");
  words.back() = dir / "new/";
  CHECK(run_program(words).code == 0);
  CHECK(run_program(quick("render", dir / "new", {"--size", "48x32", "--fps", "10"})).code == 0);
  CHECK(run_program(quick("run", dir / "new", {"--force"})).code == 0);
  CHECK(fs::exists(dir / "new/energy.png"));  // the results of another verb
  CHECK_FALSE(fs::exists(dir / "new/figures"));
}

TEST_CASE("verify tells what was changed, what is missing, and what is not ours") {
  const ScratchDirectory dir;
  REQUIRE(run_program({"run", "pendulum", "--set", "solver.end_time=0.1", "-o", dir / "out", "--export",
                       "npy", "--quiet"})
              .code == 0);
  const ProgramResult whole = run_program({"verify", dir / "out"});
  CHECK(whole.code == 0);
  CHECK(whole.out == "11 files as written\n");
  CHECK(run_program({"verify", dir / "out/npy/"}).out == "6 files as written\n");
  std::string bytes = file_text(dir / "out/npy/t_s.npy");
  bytes.back() = static_cast<char>(bytes.back() ^ 1);  // one bit
  std::ofstream(dir / "out/npy/t_s.npy", std::ios::binary) << bytes;
  fs::remove(dir / "out/series.csv");
  std::ofstream(dir / "out/mine.txt") << "mine";
  const ProgramResult r = run_program({"verify", dir / "out"});
  CHECK(r.code == 7);
  CHECK(r.out == "changed: npy/t_s.npy\nmissing: series.csv\n");
  CHECK(r.err == "unfurl: 2 of 11 files are not as they were written\n");
  CHECK(run_program({"verify", dir / "out/npy/t_s.npy"}).code == 7);
  CHECK(run_program({"verify", dir / "out/summary.json"}).code == 0);
  CHECK(run_program({"verify", dir / "out/mine.txt"}).code == 5);
  CHECK(run_program({"verify", dir / "nothing"}).code == 5);
}

}  // namespace unfurl::written_files_test
