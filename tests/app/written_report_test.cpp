// SPDX-License-Identifier: BSD-3-Clause
// What a verb says that it wrote is what lies there.
#include "app/output/written_report.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/app/run_program.hpp"

namespace unfurl::written_report_test {

namespace fs = std::filesystem;

namespace {

using Words = std::vector<std::string>;

// Counted in the directory itself, without the program's own list.
std::string counted(const fs::path& folder) {
  int files = 0;
  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || entry.path().filename() == ".unfurl") continue;
    ++files;
    bytes += entry.file_size();
  }
  return "written into " + folder.string() + ": " + std::to_string(files) +
         (files == 1 ? " file, " : " files, ") + bytes_text(bytes) + "\n";
}

}  // namespace

TEST_CASE("sizes are said in powers of a thousand, of three to four digits") {
  CHECK(bytes_text(0) == "0 B");
  CHECK(bytes_text(999) == "999 B");
  CHECK(bytes_text(1000) == "1.0 kB");
  CHECK(bytes_text(12345) == "12.3 kB");
  CHECK(bytes_text(999949) == "999.9 kB");
  CHECK(bytes_text(999950) == "1.0 MB");
  CHECK(bytes_text(2500000000) == "2.5 GB");
  CHECK(bytes_text(7000000000000000) == "7000.0 TB");
}

TEST_CASE("after every verb that writes stands what was written, where and how large") {
  const ScratchDirectory dir;
  const std::string scene = "pendulum", end = "solver.end_time=0.1", out = dir / "out";
  const Words command = GENERATE_COPY(
      Words{"run", scene, "--export", "csv,npy"},
      Words{"render", scene, "--size", "48x32", "--fps", "10", "--set", "render.mp4=false", "--dpi", "60"},
      Words{"render", scene, "--size", "48x32", "--frames", "0:1", "--dpi", "60"},
      Words{"figure", scene, "all"},
      Words{"study", scene, "--steps", "0.025:0.0125", "--methods", "rk4", "--repeats", "1", "--dpi", "60"},
      Words{"sweep", scene, "--vary", "solver.step=0.05,0.1", "--measure", "energy", "--dpi", "60"},
      Words{"solve", scene, "--find", "gravity.acceleration[2]", "--target", "max:kinetic_energy_J=1",
            "--between", "-20:-1"},
      Words{"margin", "hoop6", "--set", "structure.fold_angle=60"}, Words{"modes", "ladder"});
  Words words = command;
  if (scene == command[1]) words.insert(words.end(), {"--set", end});
  words.insert(words.end(), {"-o", out});
  const ProgramResult r = run_program(words);
  INFO(command[0] << ": " << r.err);
  REQUIRE(r.code == 0);
  const std::string truth = counted(out);
  CHECK(r.err.find(truth) != std::string::npos);
  CHECK(r.out.find("written into") == std::string::npos);
  for (const auto& entry : fs::directory_iterator(out)) {
    const std::string name = entry.path().filename().string() + (entry.is_directory() ? "/" : "");
    INFO(name);
    CHECK((r.err.find(" " + name + " ") != std::string::npos) == (name != ".unfurl"));
  }
  words.insert(words.end(), {"--quiet", "--force"});
  if (command[0] != "figure") CHECK(run_program(words).err.find("written into") == std::string::npos);
}

TEST_CASE("of single files those that were written, not those that lie beside") {
  const ScratchDirectory dir;
  dir.write("mine.txt", "mine");
  const std::string in = "written into " + fs::path(dir / "x").parent_path().string();
  const ProgramResult figure =
      run_program({"figure", "pendulum", "energy", "--set", "solver.end_time=0.1", "-o", dir / "x.svg"});
  INFO(figure.err);
  CHECK(figure.err.find(in + ": 3 files, ") != std::string::npos);
  CHECK(figure.err.find("mine") == std::string::npos);
  const ProgramResult poster = run_program({"poster", "pendulum", "--set", "solver.end_time=0.1", "--poses",
                                            "2", "--size", "48x32", "-o", dir / "p.png"});
  const std::string size = bytes_text(fs::file_size(dir / "p.png"));
  CHECK(poster.err.ends_with(in + ": 1 file, " + size + "\n  p.png " + size + "\n"));
  const ProgramResult panel =
      run_program({"view", "pendulum", "--size", "640x400", "--picture", dir / "panel.png"});
  INFO(panel.err);
  CHECK(panel.err.find(in + ": 1 file, ") != std::string::npos);
}

TEST_CASE("nothing is said where nothing was written, and JSON stays JSON") {
  const ScratchDirectory dir;
  CHECK(run_program({"run", "pendulum", "-o", dir / "out", "--plan"}).err.find("written") ==
        std::string::npos);
  CHECK(run_program({"run", "pendulum", "--set", "solver.end_time=0.1"}).err.find("written") ==
        std::string::npos);
  const ProgramResult json =
      run_program({"run", "pendulum", "--set", "solver.end_time=0.1", "-o", dir / "out", "--json"});
  CHECK(json.out.starts_with("{"));
  CHECK(json.out.ends_with("}\n"));
  CHECK(json.err.find("\nwritten into ") != std::string::npos);
}

}  // namespace unfurl::written_report_test
