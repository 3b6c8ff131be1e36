// SPDX-License-Identifier: BSD-3-Clause
// `unfurl render` and `unfurl figure`: which files they write and how they fail.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "render/image/png.hpp"
#include "tests/app/run_program.hpp"

using namespace unfurl;
namespace fs = std::filesystem;

namespace picture_commands_test {

namespace {

// Three small frames of a short run.
const std::vector<std::string> small = {"hoop6_sector",
                                        "--set",
                                        "solver.end_time=0.1",
                                        "--set",
                                        "render.size=[96, 64]",
                                        "--set",
                                        "render.fps=20",
                                        "--set",
                                        "render.hold=0",
                                        "--dpi",
                                        "60",
                                        "--quiet"};

std::vector<std::string> with(const std::vector<std::string>& first, std::vector<std::string> rest) {
  std::vector<std::string> all = first;
  all.insert(all.end(), rest.begin(), rest.end());
  return all;
}

std::vector<std::string> files_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

bool is_png(const std::string& path) {
  return file_text(path).starts_with("\x89PNG\r\n\x1a\n");
}

// Width and height that a PNG declares.
std::pair<int, int> png_size(const std::string& path) {
  const std::string bytes = file_text(path);
  const auto number = [&](std::size_t at) {
    int value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = 256 * value + static_cast<unsigned char>(bytes[at + i]);
    return value;
  };
  return {number(16), number(20)};
}

}  // namespace

TEST_CASE("render writes data, frames, an animation and every figure twice") {
  const ScratchDirectory dir;
  const ProgramResult r = run_program(with({"render"}, with(small, {"-o", dir / "out"})));
  INFO(r.err);
  CHECK(r.code == 0);
  CHECK(r.out == "");
  CHECK(files_in(dir / "out/frames") ==
        std::vector<std::string>{"frame_00000.png", "frame_00001.png", "frame_00002.png"});
  CHECK(png_size(dir / "out/frames/frame_00002.png") == std::pair(96, 64));
  const std::string animation = file_text(dir / "out/animation.webp");
  CHECK(animation.starts_with("RIFF"));
  CHECK(animation.substr(8, 4) == "WEBP");
  for (const char* name :
       {"deployment", "constraint_error", "energy", "rod_forces", "phase", "steps", "jacobian", "poses"}) {
    CHECK(is_png(dir / "out/figures/" + std::string(name) + ".png"));
    CHECK(file_text(dir / "out/figures/" + std::string(name) + ".svg").find("<svg") != std::string::npos);
    for (const char* extension : {".pdf", ".csv", ".caption.txt"})
      CHECK(fs::exists(dir / "out/figures/" + std::string(name) + extension));
  }
  CHECK(nlohmann::json::parse(file_text(dir / "out/summary.json"))["status"] == "completed");
  CHECK(fs::exists(dir / "out/trajectory.csv"));
}

TEST_CASE(
    "frames drawn in parts are joined by --encode-only, which names what is missing and draws nothing") {
  const ScratchDirectory dir;
  const std::vector<std::string> film = with({"render"}, with(small, {"-o", dir / "out"}));
  REQUIRE(run_program(with(film, {"--frames", "0:1"})).code == 0);
  const ProgramResult lacking = run_program(with(film, {"--encode-only"}));
  CHECK(lacking.code == 5);
  CHECK(lacking.err.find("2 of 3 frames are missing; these draw them:\n  unfurl render ") !=
        std::string::npos);
  CHECK(lacking.err.find(" --frames 1:3\n") != std::string::npos);
  CHECK(files_in(dir / "out/frames").size() == 1);
  CHECK_FALSE(fs::exists(dir / "out/report.html"));  // whose receipt asks for the whole film
  REQUIRE(run_program(with(film, {"--frames", "1:3"})).code == 0);
  CHECK(run_program({"reproduce", dir / "out/report.html"}).code == 0);
  fs::remove(dir / "out/animation.webp");
  fs::remove(dir / "out/report.html");
  // Another film's frames do not go for one of which nothing is drawn.
  const ProgramResult other =
      run_program(with(film, {"--encode-only", "--force", "--set", "solver.end_time=0.05"}));
  CHECK(other.code == 5);
  CHECK(other.err.find("--encode-only draws none") != std::string::npos);
  const ProgramResult joined = run_program(with(film, {"--encode-only"}));
  CHECK(joined.code == 0);
  CHECK(fs::exists(dir / "out/animation.webp"));
  CHECK(fs::exists(dir / "out/report.html"));
}

TEST_CASE("frames of an earlier, longer film do not survive") {
  const ScratchDirectory dir;
  const auto command = with({"render"}, with(small, {"-o", dir / "out"}));
  CHECK(run_program(command).code == 0);
  CHECK(run_program(with(command, {"--set", "solver.end_time=0.05", "--force"})).code == 0);
  CHECK(files_in(dir / "out/frames") == std::vector<std::string>{"frame_00000.png", "frame_00001.png"});
}

TEST_CASE("a film of too many frames is refused before the work") {
  const ProgramResult r = run_program({"render", "hoop6", "-o", "/nowhere/x", "--set", "render.speed=1e-6"});
  CHECK(r.code == 3);
  CHECK(r.err.find("render.fps: the film would have more than 99999 frames") != std::string::npos);
}

TEST_CASE("Ctrl-C while drawing keeps the finished frames") {
  const ScratchDirectory dir;
  const ProgramResult r =
      run_program({"render", "hoop6", "--quiet", "-o", dir / "out", "--set", "render.fps=500"},
                  {.interrupt_after_s = 0.3, .first_wait_for = dir / "out/frames/frame_00000.png"});
  CHECK(r.code == 130);
  CHECK(r.err.find("unfurl: interrupted; what is finished is kept\n") != std::string::npos);
  const auto frames = files_in(dir / "out/frames");
  REQUIRE_FALSE(frames.empty());
  for (const auto& frame : frames) CHECK(is_png(dir / "out/frames/" + frame));
  CHECK(fs::exists(dir / "out/summary.json"));
}

TEST_CASE("EGL draws the same pixels as OSMesa, and steps in where that is missing") {
  const ScratchDirectory dir;
  const std::vector<std::string> poster = {"poster", "hoop6_sector", "--size", "480x270", "--quiet", "-o"};
  const ProgramOptions osmesa{.environment = {"UNFURL_GL=osmesa"}}, egl{.environment = {"UNFURL_GL=egl"}},
      none{.environment = {"UNFURL_OSMESA=libNoSuchThing.so"}};
  REQUIRE(run_program(with(poster, {dir / "osmesa.png"}), osmesa).code == 0);
  REQUIRE(run_program(with(poster, {dir / "egl.png"}), egl).code == 0);
  REQUIRE(run_program(with(poster, {dir / "none.png"}), none).code == 0);
  CHECK(file_text(dir / "osmesa.png") == file_text(dir / "egl.png"));
  CHECK(file_text(dir / "osmesa.png") == file_text(dir / "none.png"));
}

// Where panels meet, what is behind the poses goes on: below what is written it differs from row to row only.
TEST_CASE("the legend of a poster has the sample of a cable in the last panel") {
  const ScratchDirectory dir;
  const std::string file = dir / "poster.png";
  REQUIRE(run_program({"poster", "mesh_reflector", "-o", file, "--poses", "3", "--size", "960x540", "--set",
                       "solver.end_time=0.02", "--quiet"})
              .code == 0);
  const Image poster = read_png(file);
  REQUIRE(poster.width == 960);
  int red = 0;
  for (int y = 0; y < poster.height - 270; ++y)  // the strip above the poses
    for (int x = 640; x < poster.width; ++x) {
      const auto* pixel = poster.rgba.data() + 4 * (y * poster.width + x);
      red += pixel[0] > 150 && pixel[1] < 60 && pixel[2] > 30 && pixel[2] < 90;
    }
  CHECK(red >= 6);  // one row of eight pixels, less its ends
}

TEST_CASE("a poster has no Earth whose limb would break where two poses meet") {
  const ScratchDirectory dir;
  const std::string file = dir / "poster.png";
  REQUIRE(run_program({"poster", "pendulum", "-o", file, "--poses", "3", "--look", "space", "--size", "96x64",
                       "--set", "render.title=false", "--set", "render.legend=false", "--set",
                       "solver.end_time=0.2", "--quiet"})
              .code == 0);
  const Image poster = read_png(file);
  REQUIRE(poster.width == 96);
  const auto at = [&](int x, int y) { return poster.rgba.data() + 4 * (y * poster.width + x); };
  for (const int seam : {32, 64})
    for (int y = 2 * poster.height / 3; y < poster.height; ++y) {
      CAPTURE(seam, y);
      CHECK(std::equal(at(seam - 1, y), at(seam - 1, y) + 4, at(0, y)));
    }
}

TEST_CASE("without OSMesa and EGL pictures end before the work, SVG and data do not need it") {
  const ScratchDirectory dir;
  const ProgramOptions missing{.environment = {"UNFURL_OSMESA=libNoSuchThing.so", "UNFURL_EGL=libNoSuch.so"}};
  const ProgramResult r = run_program({"render", "hoop6", "-o", dir / "out"}, missing);
  CHECK(r.code == 6);
  CHECK(std::count(r.err.begin(), r.err.end(), '\n') == 1);
  CHECK(r.err.find("libosmesa6") != std::string::npos);
  CHECK_FALSE(fs::exists(dir / "out/summary.json"));
  CHECK(run_program({"run", "hoop6_sector", "-o", dir / "data", "--quiet"}, missing).code == 0);
  CHECK(run_program({"figure", "hoop6_sector", "energy", "-o", dir / "e.svg", "--quiet"}, missing).code == 0);
  CHECK(run_program({"figure", "hoop6_sector", "energy", "-o", dir / "e.png", "--quiet"}, missing).code == 6);
}

TEST_CASE("one figure goes into the file that -o names") {
  const ScratchDirectory dir;
  const auto scene =
      std::vector<std::string>{"figure", "hoop6_sector", "energy", "--set", "solver.end_time=0.1", "--quiet"};
  CHECK(run_program(with(scene, {"-o", dir / "e.svg"})).code == 0);
  CHECK(file_text(dir / "e.svg").find("<svg") != std::string::npos);
  CHECK(run_program(with(scene, {"-o", dir / "e.png"})).code == 0);
  CHECK(is_png(dir / "e.png"));
  CHECK(run_program(with(scene, {"-o", dir / "e.pdf", "--style", "single-column"})).code == 0);
  CHECK(file_text(dir / "e.pdf").starts_with("%PDF-"));
  CHECK(file_text(dir / "e.caption.txt").starts_with("Energy. "));
  CHECK(run_program(with(scene, {"-o", dir / "slide.png", "--style", "slide"})).code == 0);
  CHECK(png_size(dir / "slide.png") == std::pair(1920, 1080));
  CHECK(run_program(with(scene, {"-o", dir / "small.png", "--dpi", "72"})).code == 0);
  CHECK(png_size(dir / "small.png").first == 454);  // 160 mm at 72 dpi: 453.5
  const std::vector<std::string> files = files_in(dir / "");
  CHECK(std::vector<std::string>(files.begin(), files.begin() + 5) ==
        std::vector<std::string>{"e.caption.txt", "e.csv", "e.pdf", "e.png", "e.svg"});
  const ProgramResult r = run_program(with(scene, {"-o", dir / "x.png", "--style", "slides"}));
  CHECK(r.code == 2);
  CHECK(r.err == "unfurl: no style 'slides'; did you mean 'slide'?\n");
}

TEST_CASE("all figures go into a directory, those that the scene has data for") {
  const ScratchDirectory dir;
  const ProgramResult r = run_program(
      {"figure", "double_pendulum", "all", "--set", "solver.end_time=0.1", "--quiet", "-o", dir / "figures"});
  CHECK(r.code == 0);
  CHECK(fs::exists(dir / "figures/energy.svg"));
  CHECK_FALSE(fs::exists(dir / "figures/deployment.svg"));
}

TEST_CASE("of all figures those that a structure is too large for are named") {
  const ScratchDirectory dir;
  const ProgramResult r = run_program({"figure", "chain", "all", "--set", "structure.links=200", "--set",
                                       "solver.end_time=0.002", "-o", dir / "figures"});
  CHECK(r.code == 0);
  CHECK_FALSE(fs::exists(dir / "figures/jacobian.svg"));
  CHECK_THAT(r.err, Catch::Contains("unfurl: jacobian is left out: it is drawn up to 400 coordinates and "
                                    "constraints, and the scene has "));
}

TEST_CASE("figures that cannot be made say why") {
  const ScratchDirectory dir;
  const auto error = [](const std::vector<std::string>& arguments) { return run_program(arguments); };
  ProgramResult r = error({"figure", "hoop6", "energi", "-o", dir / "x.png"});
  CHECK(r.code == 2);
  CHECK(r.err == "unfurl: no figure 'energi'; did you mean 'energy'?\n");
  // Names from elsewhere lead on, to a figure, to the verb that draws it, or to the list.
  const std::pair<const char*, const char*> elsewhere[] = {
      {"forces", "; did you mean 'rod_forces'?"},
      {"Poisson-ratio", "; did you mean 'poisson'?"},
      {"phase_portrait", "; did you mean 'phase'?"},
      {"step_histogram", "; did you mean 'steps'?"},
      {"singular_values", "; did you mean 'jacobian'?"},
      {"pose_strip", "; did you mean 'poses'?"},
      {"torque", "; did you mean 'drives'?"},
      {"work_precision", " of a run; unfurl study SCENE -o DIR draws it"},
      {"work-precision", " of a run; unfurl study SCENE -o DIR draws it"},
      {"margins", " of a run; unfurl margin SCENE -o DIR draws it"}};
  for (const auto& [name, leads] : elsewhere) {
    r = error({"figure", "hoop6", name, "-o", dir / "x.png"});
    CHECK(r.code == 2);
    CHECK(r.err == "unfurl: no figure '" + std::string(name) + "'" + leads + "\n");
  }
  r = error({"figure", "hoop6", "zzzzzzzz", "-o", dir / "x.png"});
  CHECK(r.err.find(", ...; unfurl list figures tells all\n") != std::string::npos);
  r = error({"figure", "hoop6", "energy", "-o", dir / "x.eps"});
  CHECK(r.code == 2);
  CHECK(r.err == "unfurl: a figure is written as .png, .svg or .pdf, not '.eps'\n");
  r = error({"figure", "hoop6", "energy", "poses", "-o", dir / "x.png"});
  CHECK(r.code == 2);
  r = error({"figure", "four_bar", "deployment", "-o", dir / "x.png"});
  CHECK(r.code == 2);
  CHECK(r.err == "unfurl: the scene four_bar has no data for the figure 'deployment'\n");
  r = error({"figure", "hoop6", "energy", "-o", "/nowhere/x.png"});
  CHECK(r.code == 5);
  CHECK(r.err == "unfurl: /nowhere/x.png: no such file or directory\n");
  r = error({"figure", "hoop6", "energy"});
  CHECK(r.code == 2);
  CHECK(r.err == "unfurl: -o is missing; usage: unfurl figure SCENE NAME... -o FILE\n");
  CHECK(files_in(dir / "").empty());
}

TEST_CASE("every figure that is asked for by name must be there to be made") {
  const ScratchDirectory dir;
  const auto figures = [&](const std::vector<std::string>& names, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"figure", "double_pendulum"};
    words.insert(words.end(), names.begin(), names.end());
    return run_program(
        with(with(words, {"--set", "solver.end_time=0.1", "--quiet", "-o", dir / "out"}), more));
  };
  ProgramResult r = figures({"energy", "poisson"});
  CHECK(r.code == 2);
  CHECK(r.err == "unfurl: the scene double_pendulum has no data for the figure 'poisson'\n");
  CHECK_FALSE(fs::exists(dir / "out/energy.svg"));
  r = figures({"all", "energi"});
  CHECK(r.code == 2);
  CHECK(r.err == "unfurl: no figure 'energi'; did you mean 'energy'?\n");
  CHECK(figures({"energi", "all"}).code == 2);
  CHECK(figures({"poisson", "all"}).code == 0);  // all that there are
  CHECK(fs::exists(dir / "out/energy.svg"));
  CHECK_FALSE(fs::exists(dir / "out/poisson.svg"));
}

TEST_CASE("a figure whose file or caption would have too long a name is refused before the run") {
  // File systems here take names of 255 bytes; ".caption.txt" has 8 more than ".svg".
  const ScratchDirectory dir;
  for (const std::size_t length : {244u, 247u, 251u, 300u}) {
    const std::string stem(length, 'a');
    const ProgramResult r = run_program(
        {"figure", "pendulum", "energy", "--set", "solver.end_time=0.1", "-o", dir / (stem + ".svg")});
    INFO(length << " " << r.err);
    CHECK(r.code == 5);
    CHECK(r.err.find(length > 251 ? stem + ".svg: the name has 304 bytes"
                                  : stem + ".caption.txt: the name has ") != std::string::npos);
    CHECK(r.err.find("at most 255") != std::string::npos);
    CHECK(r.err.find(" steps") == std::string::npos);  // nothing was run
    CHECK(files_in(dir / "").empty());
  }
  const std::string longest(243, 'a');
  CHECK(run_program(
            {"figure", "pendulum", "energy", "--set", "solver.end_time=0.1", "-o", dir / (longest + ".svg")})
            .code == 0);
  CHECK(files_in(dir / "").size() == 3);
}

TEST_CASE("a figure is not drawn where its numbers would replace other data") {
  const ScratchDirectory dir;
  const std::string table = dir.write("f.csv", "mass,price\n1,2\n"), picture = dir.write("f.png", "mine");
  const ProgramResult r = run_program(
      {"figure", "double_pendulum", "energy", "--set", "solver.end_time=0.1", "--quiet", "-o", picture});
  CHECK(r.code == 5);
  CHECK(r.err.find("name the figure otherwise") != std::string::npos);
  CHECK(file_text(picture) == "mine");
  CHECK(file_text(table) == "mass,price\n1,2\n");
  fs::create_directory(dir / "all");
  dir.write("all/energy.csv", "mass,price\n1,2\n");
  CHECK(run_program({"figure", "double_pendulum", "energy", "--set", "solver.end_time=0.1", "--quiet", "-o",
                     dir / "all"})
            .code == 5);
  CHECK_FALSE(fs::exists(dir / "all/energy.svg"));
  // A run's table in the way of one of all: none is drawn. The other way round the figure's numbers are kept.
  const std::vector<std::string> run{"run", "pendulum", "--set", "solver.end_time=0.1", "--quiet", "-o"},
      figures{"figure", "pendulum", "all", "--set", "solver.end_time=0.1", "--dpi", "40", "--quiet", "-o"};
  const auto into = [&](std::vector<std::string> words, const char* folder) {
    words.push_back(dir / folder);
    return run_program(words);
  };
  REQUIRE(into(run, "run").code == 0);
  const auto before = files_in(dir / "run");
  CHECK(into(figures, "run").code == 5);
  CHECK(files_in(dir / "run") == before);
  REQUIRE(into(figures, "figures").code == 0);
  const std::string numbers = file_text(dir / "figures/rod_forces.csv");
  const ProgramResult beside = into(run, "figures");
  CHECK(beside.code == 0);
  CHECK(beside.err == "unfurl: warning: " + (dir / "figures/rod_forces.csv") +
                          " held what unfurl figure wrote; it is kept as " +
                          (dir / "figures/rod_forces.csv.kept-1") + "\n");
  CHECK(file_text(dir / "figures/rod_forces.csv.kept-1") == numbers);
}

}  // namespace picture_commands_test
