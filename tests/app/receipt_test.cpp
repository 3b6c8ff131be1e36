// SPDX-License-Identifier: BSD-3-Clause
// What a file says of its origin, and that it can be made again from that.
#include "app/output/receipt.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "app/output/receipt_formats.hpp"
#include "app/own_options.hpp"
#include "tests/app/run_program.hpp"

using namespace unfurl;
namespace fs = std::filesystem;

namespace receipt_test {

namespace {

std::string note_of(const std::string& text) {
  return std::string(note_begin) + std::string(checksum_digits, '0') + "\",\"text\":\"" + text + "\"}";
}

}  // namespace

TEST_CASE("a file of every format carries its receipt, and is made again from it to the byte") {
  const ScratchDirectory dir;
  const std::string film = dir / "film";
  REQUIRE(run_program({"render", "pendulum", "-o", film, "--size", "96x64", "--fps", "10", "--set",
                       "solver.end_time=0.5", "--set", "structure.length=0.7", "--export", "gltf,html",
                       "--dpi", "60", "--quiet"})
              .code == 0);
  for (const char* name :
       {"figures/energy.pdf", "figures/energy.svg", "figures/energy.png", "frames/frame_00003.png",
        "animation.webp", "animation.gif", "animation.mp4", "animation.glb", "viewer.html", "report.html"}) {
    INFO(name);
    // Where no list of results is.
    const std::string copy = dir / ("copy" + fs::path(name).extension().string());
    fs::copy_file(fs::path(film) / name, copy, fs::copy_options::overwrite_existing);
    const auto receipt = receipt_of(copy);
    REQUIRE(receipt);
    CHECK(receipt->command == std::vector<std::string>{"render", "pendulum", "--dpi", "60"});
    CHECK(receipt->file == name);
    CHECK(receipt->name == "pendulum");
    CHECK(receipt->scene == file_text(film + "/scene.toml"));
    CHECK(receipt->scene.find("length = 0.7") != std::string::npos);
    CHECK(receipt->errors.at("constraint_error_m") < 1e-12);
    const ProgramResult whole = run_program({"verify", copy});
    CHECK(whole.code == 0);
    CHECK(whole.out.find("unfurl render pendulum") != std::string::npos);
    const ProgramResult again = run_program({"reproduce", copy});
    INFO(again.err);
    CHECK(again.code == 0);
    CHECK(again.out.starts_with("the same, byte by byte"));
    std::string bytes = file_text(copy);
    bytes[bytes.size() / 3] = static_cast<char>(bytes[bytes.size() / 3] ^ 1);
    dir.write(fs::path(copy).filename().string(), bytes);
    CHECK(run_program({"verify", copy}).code == 7);
    // The same bit anywhere in the receipt: in its name, in what keeps its words apart.
    const std::string as_written = file_text(fs::path(film) / name);
    const std::size_t begin = as_written.find("{\"unfurl_receipt");
    REQUIRE(begin != std::string::npos);
    for (const std::size_t at : {begin + 2, as_written.find("\",\"", begin) + 1}) {
      bytes = as_written;
      bytes[at] = static_cast<char>(bytes[at] ^ 1);
      dir.write(fs::path(copy).filename().string(), bytes);
      const ProgramResult damaged = run_program({"verify", copy});
      CHECK(damaged.code == 7);
      CHECK(damaged.err == "unfurl: the file is not as it was written: its receipt is damaged\n");
    }
  }
}

TEST_CASE("a picture of the window carries its receipt, and says why it is not made again") {
  const ScratchDirectory dir;
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"view", "pendulum", "--set", "structure.length=0.7", "--at", "0.2"},
        std::vector<std::string>{"view", "--dark", "--set", "solver.end_time=0.3"}}) {
    const std::string png = dir / (std::to_string(words.size()) + ".png");
    std::vector<std::string> asked = words;
    asked.insert(asked.end(), {"--picture", png, "--size", "640x400"});
    REQUIRE(run_program(asked).code == 0);
    const auto receipt = receipt_of(png);
    REQUIRE(receipt);
    CHECK(receipt->command.front() == "view");
    CHECK(receipt->command.at(1) == (words[1] == "pendulum" ? "pendulum" : "hoop6"));
    CHECK(receipt->scene.find(words[1] == "pendulum" ? "length = 0.7" : "end_time = 0.3") <
          receipt->scene.size());
    CHECK(run_program({"verify", png}).code == 0);
    const ProgramResult again = run_program({"reproduce", png});
    CHECK(again.code == 5);
    CHECK(again.err.find("was made by unfurl view " + receipt->command.at(1)) != std::string::npos);
    CHECK(again.err.find("how long things took") != std::string::npos);
  }
}

TEST_CASE("a figure of its own, with options, is made again where it is asked for") {
  const ScratchDirectory dir;
  REQUIRE(
      run_program({"figure", "double_pendulum", "energy", "-o", dir / "a.svg", "--style", "slide", "--quiet"})
          .code == 0);
  const auto receipt = receipt_of(dir / "a.svg");
  REQUIRE(receipt);
  CHECK(receipt->command ==
        std::vector<std::string>{"figure", "double_pendulum", "energy", "--style", "slide"});
  CHECK(receipt->file.empty());
  CHECK(run_program({"reproduce", dir / "a.svg", "-o", dir / "again"}).code == 0);
  CHECK(file_text(dir / "again/a.svg") == file_text(dir / "a.svg"));
  const ProgramResult restyled =
      run_program({"reproduce", dir / "a.svg", "-o", dir / "slide", "--style", "slide"});
  CHECK(restyled.code == 2);
  CHECK(restyled.err.find("a file is made again as its receipt says") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(dir / "slide"));
  const ProgramResult none = run_program({"reproduce", dir.write("b.svg", "<svg></svg>")});
  CHECK(none.code == 5);
  CHECK(none.err.find("carries no receipt") != std::string::npos);
  const ProgramResult neither = run_program({"verify", dir / "b.svg"});
  CHECK(neither.code == 5);
  CHECK(neither.err.find("carries no receipt") != std::string::npos);
}

TEST_CASE("a table carries no receipt, and is made again from what lies beside it") {
  const ScratchDirectory dir;
  REQUIRE(
      run_program({"run", "pendulum", "-o", dir / "run", "--set", "solver.end_time=0.3", "--quiet"}).code ==
      0);
  REQUIRE(run_program({"render", "pendulum", "-o", dir / "film", "--size", "32x32", "--fps", "4", "--set",
                       "solver.end_time=0.5", "--dpi", "60", "--quiet"})
              .code == 0);
  REQUIRE(run_program({"sweep", "pendulum", "--vary", "structure.angle=10,20", "--measure", "energy", "-o",
                       dir / "sweep", "--dpi", "60", "--quiet"})
              .code == 0);
  REQUIRE(run_program(
              {"margin", "hoop6", "-o", dir / "margin", "--factor", "loads=0.9", "--dpi", "60", "--quiet"})
              .code == 0);
  for (const char* table :
       {"run/series.csv", "run/trajectory.csv", "film/series.csv", "sweep/sweep.csv", "margin/margin.csv",
        "margin/loads.csv", "margin/margin.json", "sweep/figures/sweep_energy.caption.txt"}) {
    INFO(table);
    const ProgramResult again = run_program({"reproduce", dir / table});
    INFO(again.err);
    CHECK(again.code == 0);
    CHECK(again.out.starts_with("the same, byte by byte"));
  }
  // What was changed since is not the same; what has nothing beside it says so, and is not taken for another
  // program's.
  dir.write("run/series.csv", "t_s\n0\n");
  CHECK(run_program({"reproduce", dir / "run/series.csv"}).code == 7);
  const ProgramResult summary = run_program({"reproduce", dir / "run/summary.json"});
  CHECK(summary.code == 5);
  CHECK(summary.err.find("as files of its kind do not") != std::string::npos);
  CHECK(summary.err.find("another program") == std::string::npos);
  const ProgramResult foreign = run_program({"reproduce", dir.write("run/own.csv", "x\n1\n")});
  CHECK(foreign.code == 5);
  CHECK(foreign.err.find("is not in the list of what unfurl wrote there") != std::string::npos);
  // A figure that was put beside other results is known by its receipt.
  fs::copy_file(dir / "film/figures/energy.svg", dir / "run/put.svg");
  CHECK(run_program({"verify", dir / "run/put.svg"}).code == 0);
  std::string bytes = file_text(dir / "run/put.svg");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  dir.write("run/put.svg", bytes);
  CHECK(run_program({"verify", dir / "run/put.svg"}).code == 7);
  CHECK(run_program({"verify", dir / "run/own.csv"}).code == 5);
}

TEST_CASE("arrays and long tables that a run was exported to are made again") {
  const ScratchDirectory dir;
  REQUIRE(run_program({"run", "four_bar", "-o", dir / "run", "--set", "solver.end_time=0.05", "--export",
                       "vtk,csv,npy,mat", "--quiet"})
              .code == 0);
  for (const char* name : {"run.mat", "csv/nodes.csv", "npy/positions_m.npy", "vtk/four_bar.pvd",
                           "vtk/four_bar_000002.vtu", "series.csv"}) {
    const ProgramResult again = run_program({"reproduce", dir / ("run/" + std::string(name))});
    INFO(name << again.err);
    CHECK(again.code == 0);
    CHECK(again.out.starts_with("the same, byte by byte"));
  }
}

// 2501 states: more than one part of a thousand. A run that is exported is kept whole, and adds up the work
// of its motor from the start on, not part by part.
TEST_CASE("tables of a run in parts and of one that is kept whole are both made again") {
  const ScratchDirectory dir;
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--export", "npy"}}) {
    const std::string out = dir / std::to_string(more.size());
    std::vector<std::string> words{"run",   "hoop6_motor",       "-o",     out,
                                   "--set", "solver.end_time=5", "--set",  "solver.at_deployed=pass",
                                   "--set", "solver.step=0.002", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    REQUIRE(run_program(words).code == 0);
    const ProgramResult again = run_program({"reproduce", out + "/series.csv"});
    INFO(out << again.err);
    CHECK(again.code == 0);
  }
}

// A scene that is written out has no variables any more: its text as it was read is what is kept, and what
// changed it.
TEST_CASE("a sweep over variables is made again") {
  const ScratchDirectory dir;
  const std::string scene =
      dir.write("own.toml",
                "[variables]\nL = 1\nm = 2\n[structure]\nkind = \"custom\"\n"
                "nodes = [{name = \"A\", position = [0, 0, 0], fixed = true}, {name = \"B\", position = "
                "[\"=L\", 0, 0]}]\n"
                "rods = [{nodes = [\"A\", \"B\"], mass = \"=m\"}]\n[gravity]\nacceleration = [0, 0, -10]\n"
                "[solver]\nstep = 0.01\nend_time = 0.1\n");
  REQUIRE(run_program({"sweep", scene, "--vary", "variables.L=1,2", "--set", "variables.m=3",
                       "--set=solver.step=0.02", "--measure", "max:kinetic_energy_J", "-o", dir / "sweep",
                       "--dpi", "60", "--quiet"})
              .code == 0);
  fs::remove(scene);
  for (const char* name : {"sweep/sweep.csv", "sweep/figures/sweep_max_kinetic_energy_J.svg"}) {
    INFO(name);
    const ProgramResult again = run_program({"reproduce", dir / name});
    INFO(again.err);
    CHECK(again.code == 0);
    CHECK(again.out.starts_with("the same, byte by byte"));
  }
  const auto receipt = receipt_of(dir / "sweep/figures/sweep_max_kinetic_energy_J.svg");
  REQUIRE(receipt);
  CHECK(receipt->scene.find("L = 1") != std::string::npos);
}

// At the scene's own value of the first axis `to`, `duration` mean nothing; at the other they do.
TEST_CASE("a sweep over what gives other keys their meaning is made again") {
  const ScratchDirectory dir;
  const std::string scene = dir.write(
      "drive.toml",
      "[structure]\nkind = \"custom\"\nnodes = [{name = \"A\", position = [0, 0, 0], fixed = true}, {name = "
      "\"B\", position = [1, 0, 0]}]\nrods = [{nodes = [\"A\", \"B\"], mass = 1}]\n"
      "[[constraints]]\nkind = \"plane\"\nnodes = [\"B\"]\nnormal = [0, 1, 0]\n"
      "[[constraints]]\nkind = \"coordinate\"\nname = \"motor\"\nnodes = [\"B\"]\ndirection = [0, 0, 1]\n"
      "motion = \"rate\"\nrate = 0.3\nto = 0.5\nstart = 0.1\nduration = 0.6\n[solver]\nend_time = 0.3\n");
  REQUIRE(run_program({"sweep", scene, "--vary", "constraints[motor].motion=rate,smooth", "--vary",
                       "structure.rods[0].mass=1,2", "--measure", "max:motor.force_N", "-o", dir / "sweep",
                       "--dpi", "60", "--quiet"})
              .code == 0);
  const std::string table = file_text(dir / "sweep/sweep.csv");
  CHECK(table.find("invalid") == std::string::npos);
  CHECK(std::count(table.begin(), table.end(), '\n') == 5);
  const ProgramResult again = run_program({"reproduce", dir / "sweep/sweep.csv"});
  INFO(again.err);
  CHECK(again.code == 0);
  CHECK(again.out.starts_with("the same, byte by byte"));
}

TEST_CASE("a share of a sweep is made again as a share, beside the whole") {
  const ScratchDirectory dir;
  for (const char* part : {"--shard=1/2", "--shard=2/2", "--merge"}) {
    std::vector<std::string> words = {"sweep",     "pendulum",
                                      "--vary",    "structure.angle=10,20,30",
                                      "--measure", "max:kinetic_energy_J",
                                      "--set",     "solver.end_time=0.1",
                                      "-o",        dir / "out",
                                      "--dpi",     "40",
                                      "--quiet",   part};
    if (words.back() == "--merge") words.push_back(dir / "out");
    REQUIRE(run_program(words).code == 0);
  }
  for (const char* name : {"out/sweep_1_of_2.csv", "out/sweep_2_of_2.csv", "out/sweep.csv"}) {
    const ProgramResult again = run_program({"reproduce", dir / name});
    INFO(name << again.err);
    CHECK(again.code == 0);
    CHECK(again.out.starts_with("the same, byte by byte"));
  }
}

TEST_CASE("reproduce exports what it makes again, where the command can") {
  const ScratchDirectory dir;
  REQUIRE(
      run_program({"run", "pendulum", "-o", dir / "run", "--set", "solver.end_time=0.3", "--quiet"}).code ==
      0);
  const ProgramResult page =
      run_program({"reproduce", dir / "run/series.csv", "-o", dir / "again", "--export", "html"});
  INFO(page.err);
  CHECK(page.code == 0);
  CHECK(fs::exists(dir / "again/viewer.html"));
  REQUIRE(run_program({"figure", "pendulum", "energy", "-o", dir / "e.svg", "--set", "solver.end_time=0.3",
                       "--quiet"})
              .code == 0);
  const ProgramResult figure =
      run_program({"reproduce", dir / "e.svg", "-o", dir / "no", "--export", "html"});
  CHECK(figure.code == 2);
  CHECK(figure.err.find("this is made by unfurl figure") != std::string::npos);
  CHECK_FALSE(fs::exists(dir / "no"));
  const ProgramResult paper = run_program({"reproduce", "-o", dir / "no", "--export", "html"});
  CHECK(paper.code == 2);
  CHECK(paper.err.find("--export is for unfurl reproduce FILE") != std::string::npos);
  CHECK_FALSE(fs::exists(dir / "no"));
}

TEST_CASE("every byte of a sealed file counts, its receipt's own too") {
  const ScratchDirectory dir;
  REQUIRE(run_program({"render", "pendulum", "-o", dir / "film", "--size", "32x32", "--fps", "4", "--set",
                       "solver.end_time=0.5", "--export", "gltf,html", "--dpi", "60", "--quiet"})
              .code == 0);
  std::mt19937 random(5);  // a seed
  for (const char* name :
       {"figures/energy.pdf", "figures/energy.svg", "frames/frame_00001.png", "animation.webp",
        "animation.gif", "animation.mp4", "animation.glb", "viewer.html"}) {
    INFO(name);
    const std::string extension = fs::path(name).extension().string();
    const std::string whole = file_text(dir / (std::string("film/") + name));
    REQUIRE(sealed(whole, extension) == whole);
    REQUIRE_FALSE(note_in(whole, extension).empty());
    const std::size_t receipt = whole.find(note_begin);
    for (int i = 0; i < 300; ++i) {
      std::string changed = whole;
      const std::size_t at = i < 40 ? receipt + note_begin.size() + static_cast<std::size_t>(i)
                                    : std::uniform_int_distribution<std::size_t>(0, whole.size() - 1)(random);
      changed[at] = static_cast<char>(changed[at] ^ (1 << (random() % 8)));
      INFO("byte " << at << " of " << whole.size());
      // Nothing but the first words of the receipt may hide a change, and then there is no receipt.
      const bool told = sealed(changed, extension) != changed || note_in(changed, extension).empty();
      CHECK(told);
    }
  }
}

TEST_CASE("notes stand in files of any content, or leave them as they are") {
  std::mt19937 random(11);
  for (const char* extension : {".png", ".svg", ".pdf", ".glb", ".html", ".webp", ".gif", ".mp4", ".txt"}) {
    for (int i = 0; i < 200; ++i) {
      std::string file(random() % 80, '\0');
      for (char& c : file) c = static_cast<char>(random());
      INFO(extension << " " << i);
      const std::string with = with_note(file, extension, note_of("x"));
      CHECK(with.size() >= file.size());
      const std::string once = sealed(with, extension);
      CHECK(sealed(once, extension) == once);
      note_in(file, extension);
    }
  }
}

TEST_CASE("a note is read back from where quotes, brackets and backslashes mean something") {
  const std::string hard = R"(a \"quoted\" (word) \\ back\nslash {brace} )" + std::string(700, 'y');
  const std::string pdf =
      "%PDF-1.4\n1 0 obj\n<< /Type /Catalog >>\nendobj\n2 0 obj\n<< /Title (T) >>\nendobj\nxref\n0 "
      "3\ntrailer\n<< "
      "/Size 3 /Root 1 0 R /Info 2 0 R >>\nstartxref\n60\n%%EOF\n";
  const std::pair<const char*, std::string> files[] = {{".pdf", pdf},
                                                       {".gif", "GIF89a....................;"},
                                                       {".svg", "<?xml?><svg a='b'><g/></svg>"},
                                                       {".html", "<html><body>text</body></html>"}};
  for (const auto& [extension, file] : files) {
    INFO(extension);
    const std::string with = sealed(with_note(file, extension, note_of(hard)), extension);
    const std::string note = note_in(with, extension);
    CHECK(note.size() == note_of(hard).size());
    CHECK(note.ends_with(hard + "\"}"));
  }
  // The update of a PDF keeps the old trailer's place, and its table points at the new object.
  const std::string with = with_note(pdf, ".pdf", note_of(hard));
  CHECK(with.starts_with(pdf));
  CHECK(with.find("/Prev 60 >>") != std::string::npos);
  const std::size_t object = with.find("2 0 obj", pdf.size());
  CHECK(with.find(std::string(10 - std::to_string(object).size(), '0') + std::to_string(object) +
                  " 00000 n") != std::string::npos);
}

TEST_CASE("the command of a receipt is the same wherever and by whomever the work is done") {
  const std::vector<std::string> plain = {"render", "ring"};
  const std::vector<std::vector<std::string>> ways = {
      {"render", "my/ring.toml", "-o", "film"},
      {"render", "-o", "x", "--frames", "0:4", "my/ring.toml", "--threads", "2", "--quiet"},
      {"render", "my/ring.toml", "--set", "solver.step=0.1", "--size=64x64", "--join", "--lease", "3", "-o",
       "y"},
      {"render", "my/ring.toml", "-ofilm"}};
  for (const auto& words : ways) CHECK(command_of_result(words, place_of_first_name(words), "ring") == plain);
}

TEST_CASE("which word of a command is the scene is known by its place") {
  const std::pair<std::vector<std::string>, std::size_t> commands[] = {
      {{"figure", "slide", "energy", "--style", "slide"}, 1},
      {{"figure", "--style", "slide", "slide", "energy"}, 3},
      {{"figure", "--style=slide", "-oslide", "slide"}, 3},
      {{"figure", "--output", "slide", "--set", "title='slide'", "--quiet", "slide"}, 6},
      {{"render", "--transparent", "slide"}, 2},
      {{"view", "--dark", "--picture", "slide"}, 0},
      {{"reproduce"}, 0}};
  for (const auto& command : commands) {
    INFO(command.first.back());
    CHECK(place_of_first_name(command.first) == command.second);
  }
  CHECK(command_of_result(commands[1].first, 3, "ring") ==
        std::vector<std::string>{"figure", "--style", "slide", "ring", "energy"});
  // No option, whatever a file is called.
  CHECK(command_of_result({"figure", "x/-o.toml", "energy"}, 1, "-o") ==
        std::vector<std::string>{"figure", "./-o", "energy"});
}

TEST_CASE("a scene that is called as another word of the command is made again") {
  const ScratchDirectory dir;
  const std::string pendulum = file_text(std::string(UNFURL_ROOT) + "/assets/scenes/pendulum.toml");
  const std::string figure = dir.write("figure.toml", pendulum), slide = dir.write("slide.toml", pendulum),
                    energy = dir.write("energy.toml", pendulum), dpi = dir.write("--dpi.toml", pendulum);
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"figure", figure, "energy"},
        std::vector<std::string>{"figure", "--style", "slide", slide, "energy"},
        std::vector<std::string>{"figure", "--style=slide", energy, "energy"},
        std::vector<std::string>{"figure", dpi, "energy"}}) {
    std::vector<std::string> asked = words;
    asked.insert(asked.end(), {"-o", dir / "a.svg", "--set", "solver.end_time=0.2", "--quiet"});
    REQUIRE(run_program(asked).code == 0);
    const ProgramResult again = run_program({"reproduce", dir / "a.svg"});
    INFO(words[1] << ": " << again.err);
    CHECK(again.code == 0);
    CHECK(again.out.starts_with("the same, byte by byte"));
  }
}

// A picture that comes from somebody else writes nowhere but where it is asked to.
TEST_CASE("a receipt in which a scene's name leads elsewhere is refused") {
  const ScratchDirectory dir;
  const std::string svg = dir / "a.svg", mine = dir.write("mine.toml", "precious");
  REQUIRE(run_program({"figure", "pendulum", "energy", "-o", svg, "--set", "solver.end_time=0.2", "--quiet"})
              .code == 0);
  for (const std::string& name : {dir / "mine", std::string("../mine")}) {
    std::string text = file_text(svg);
    const std::string old = R"("name":"pendulum")";
    REQUIRE(text.find(old) != std::string::npos);
    text.replace(text.find(old), old.size(), "\"name\":\"" + name + "\"");
    const std::string other = dir.write("other.svg", sealed(text, ".svg"));
    REQUIRE(run_program({"verify", other}).code == 0);
    const ProgramResult again = run_program({"reproduce", other});
    INFO(name);
    CHECK(again.code == 5);
    CHECK(again.err == "unfurl: " + other +
                           ": has a receipt that unfurl did not write, in which a scene's name is a path\n");
    CHECK(file_text(mine) == "precious");
  }
}

}  // namespace receipt_test
