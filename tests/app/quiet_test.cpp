// SPDX-License-Identifier: BSD-3-Clause
// --quiet: what is written is in files, and nothing is said but errors and warnings.
#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/app/run_program.hpp"

namespace unfurl::quiet_test {

namespace {

using Words = std::vector<std::string>;

}  // namespace

TEST_CASE("every verb that writes says nothing with quiet, and writes the same") {
  const ScratchDirectory dir;
  const std::string fold = dir.write("plates.fold",
                                     "{\"vertices_coords\": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],\n"
                                     "\"edges_vertices\": [[0, 1], [1, 2], [2, 0]]}\n"),
                    out = dir / "out";
  const Words commands[] = {
      {"run", "pendulum", "--set", "solver.end_time=0.1"},
      {"figure", "pendulum", "energy", "--set", "solver.end_time=0.1", "--dpi", "40"},
      {"render", "pendulum", "--set", "solver.end_time=0.1", "--size", "48x32", "--fps", "10", "--dpi", "40",
       "--set", "render.mp4=false"},
      {"study", "pendulum", "--steps", "0.1:0.05", "--methods", "rk4", "--repeats", "1", "--dpi", "40"},
      {"study", "pendulum", "--models", "--repeats", "1", "--set", "solver.end_time=0.1"},
      {"sweep", "pendulum", "--vary", "structure.angle=10,20", "--measure", "energy", "--dpi", "40"},
      {"modes", "ladder", "--dpi", "40"},
      {"margin", "hoop6", "--set", "structure.fold_angle=60", "--stuck", "--dpi", "40"},
      {"import", fold}};
  for (const Words& command : commands) {
    std::filesystem::remove_all(out);
    Words words = command;
    words.insert(words.end(), {"-o", out, "--quiet"});
    const ProgramResult r = run_program(words);
    INFO(command[0] << " " << command[1]);
    CHECK(r.code == 0);
    CHECK(r.out == "");
    CHECK(r.err == "");
    CHECK(std::filesystem::exists(out));
  }
  // What is asked for as JSON is the answer.
  CHECK(run_program({"modes", "ladder", "--json", "--quiet"}).out.starts_with("{"));
  CHECK(run_program({"modes", "ladder", "--quiet"}).out == "");
}

TEST_CASE("characters that the program's font has not are named once") {
  const ScratchDirectory dir;
  const auto titled = [&](const char* title, const char* file) {
    Words words = {"poster",
                   "pendulum",
                   "--poses",
                   "2",
                   "--size",
                   "480x270",
                   "--set",
                   "solver.end_time=0.1",
                   "--quiet",
                   "--set",
                   std::string("title=") + title,
                   "-o",
                   dir / file};
    return run_program(words);
  };
  // Of Latin, Greek and Cyrillic it has all.
  CHECK(titled("\"Ring \u0142\u03b1\u0436\"", "a.png").err == "");
  const ProgramResult r = titled("\"Ring \u6e2c\u8a66\u6e2c \U0001F6F0\"", "b.png");
  CHECK(r.code == 0);
  CHECK(r.err ==
        "unfurl: warning: DejaVu Sans has no \u6e2c, \u8a66, \U0001F6F0: pictures and figures show signs in "
        "their "
        "place; figures as SVG have them\n");
}

}  // namespace unfurl::quiet_test
