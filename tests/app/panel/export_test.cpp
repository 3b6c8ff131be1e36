// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/output/checkpoint_head.hpp"
#include "app/output/film_folder.hpp"
#include "app/panel/document/own_file.hpp"
#include "app/panel/runs/export_process.hpp"
#include "app/panel/runs/study_job.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/write.hpp"
#include "core/scene/write_back.hpp"
#include "tests/app/panel/panel_driver.hpp"
#include "tests/app/run_program.hpp"

using namespace unfurl;

TEST_CASE("a saved document is the scene as edited, with its comments") {
  const ScratchDirectory scratch;
  SceneDocument document = open_document("hoop6", {"solver.stages=4"});
  document.edits["solver.step"] = 0.025;
  const std::string path = scratch / "mine.toml";
  WrittenBack written;
  const SceneDocument saved = save_document(document, path, written);
  CHECK_FALSE(written.anew);
  CHECK(saved.edits.empty());
  CHECK(saved.path == path);
  CHECK(scene_text(read_scene_file(path)) == scene_text(read_document(document)));
  CHECK(file_text(path).find("# Data of the example") != std::string::npos);
}

TEST_CASE("an export from the panel is what the command line makes") {
  const ScratchDirectory scratch;
  SceneDocument document = open_document("hoop6", {});
  document.edits["solver.step"] = 0.05;
  ExportProcess job;
  job.submit({UNFURL_PROGRAM, export_words(document, export_kinds()[2], scratch / "panel")});
  std::string report;
  for (int i = 0; i < 60000 && report.empty(); ++i) {
    report = job.take().value_or("");
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  // What, where, how much.
  const auto files = std::count_if(
      std::filesystem::directory_iterator(scratch / "panel"), std::filesystem::directory_iterator(),
      [](const auto& entry) { return !entry.path().filename().string().starts_with('.'); });
  CHECK(report.starts_with("exported to " + (scratch / "panel") + ": " + std::to_string(files) + " files, "));
  REQUIRE(run_program({"run", "hoop6", "-o", scratch / "shell", "--set", "solver.step=0.05"}).code == 0);
  CHECK(file_text(scratch / "panel/trajectory.csv") == file_text(scratch / "shell/trajectory.csv"));
  CHECK_FALSE(file_text(scratch / "panel/trajectory.csv").empty());
}

TEST_CASE("the command line of a scene without a file names the file that an export writes") {
  const ScratchDirectory scratch;
  const SceneDocument document = blank_document();
  const std::string output = scratch / "out",
                    line = export_command(document, export_kinds()[2], output, false);
  CHECK(line.starts_with("unfurl run " + output + ".toml -o " + output));
  CHECK_FALSE(std::filesystem::exists(output + ".toml"));  // it writes nothing
  CHECK(export_words(document, export_kinds()[2], output)[1] == output + ".toml");
  CHECK(file_text(output + ".toml") == *document.text);
  CHECK(export_command(document, export_kinds()[2], output, false) == line);  // it is there now
  CHECK(study_command({}, document).starts_with("unfurl study untitled.toml "));
}

TEST_CASE("a scene without a file gets one beside its output, however that is written") {
  const ScratchDirectory scratch;
  const std::string here = scratch / "";
  const SceneDocument document = blank_document();
  for (const auto& [output, file] : {std::pair("new/", "new.toml"), {"sub/deep/dir", "sub/deep/dir.toml"}}) {
    CAPTURE(output);
    const std::string written = export_words(document, export_kinds()[2], here + output)[1];
    CHECK(written == std::filesystem::path(here + file).lexically_normal());
    CHECK(file_text(written) == *document.text);
  }
  CHECK(exported_scene(document, "-x", false) == "./-x.toml");
  CHECK(exported_scene(document, ".", false) == "./exported.toml");
}

TEST_CASE("what is shown is exported, whatever its file holds by now") {
  const ScratchDirectory scratch;
  const std::string text = *blank_document().text, file = scratch.write("mine.toml", text);
  SceneDocument document = open_document(file, {});
  const auto exported = [&] { return export_words(document, export_kinds()[2], scratch / "out")[1]; };
  CHECK(exported() == file);
  scratch.write("mine.toml", text + "# by another\n");
  CHECK(own_file(document, nullptr) == OwnFile::changed);
  CHECK(exported() == scratch / "mine-2.toml");  // beside it, where the files lie that a scene names
  CHECK(file_text(scratch / "mine-2.toml") == text);
  CHECK(file_text(file) == text + "# by another\n");
  CHECK(exported() == scratch / "mine-2.toml");
  SceneDocument saved = document;
  saved.text = std::make_shared<const std::string>(text + "# by another\n");
  CHECK(own_file(document, &saved) == OwnFile::other);  // that was saved from here, and undone
  CHECK(own_file(saved, nullptr) == OwnFile::same);
  std::filesystem::remove(file);
  CHECK(own_file(document, nullptr) == OwnFile::other);
  CHECK(own_file(blank_document(), nullptr) == OwnFile::same);
}

TEST_CASE("an export that fails says why in one line") {
  const ScratchDirectory scratch;
  const std::string file = scratch.write("taken", "a file");
  ExportProcess job;
  job.submit({UNFURL_PROGRAM, export_words(open_document("hoop6", {}), export_kinds()[2], file)});
  std::string report;
  for (int i = 0; i < 60000 && report.empty(); ++i) {
    report = job.take().value_or("");
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  CHECK(report.find("is a file") != std::string::npos);
}

TEST_CASE("every kind of export has a command line that its verb takes") {
  const SceneDocument document = open_document("hoop6", {"solver.step=0.05"});
  for (const ExportKind& kind : export_kinds()) {
    const std::string line = export_command(document, kind, "my out", true);
    INFO(line);
    CHECK(line.starts_with("unfurl " + std::string(kind.verb) + " hoop6"));
    CHECK(line.find(" -o 'my out'") != std::string::npos);
    if (!kind.formats.empty())
      CHECK(line.find(" --export " + std::string(kind.formats)) != std::string::npos);
    CHECK(line.ends_with(" --set solver.step=0.05"));
    std::vector<std::string> words = export_words(document, kind, "out", true);
    words[0] = "help";  // the verb's help names every option that is used
    words.resize(1);
    words.emplace_back(kind.verb);
    const std::string help = run_program(words).out;
    if (!kind.formats.empty()) CHECK(help.find("--export") != std::string::npos);
    CHECK((kind.verb == "figure" || help.find("--force") != std::string::npos));
  }
}

namespace {

// Longer than anybody waits.
constexpr const char* long_run = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0]}]
rods = [{nodes = ["A", "B"], mass = 1}]
[gravity]
acceleration = [0, 0, -9.81]
[solver]
step = 0.001
end_time = 1e5
)";

}  // namespace

TEST_CASE("an export that is stopped keeps what it has simulated") {
  for (const bool closed : {true, false}) {
    CAPTURE(closed);
    const ScratchDirectory scratch;
    const std::string scene = scratch.write("long.toml", long_run), out = scratch / "out";
    {
      ExportProcess job;
      job.submit({UNFURL_PROGRAM, export_words(open_document(scene, {}), export_kinds()[2], out)});
      const auto written = [&] {
        std::error_code none;
        return std::filesystem::file_size(out + "/unfinished/trajectory.csv", none) > 100'000 && !none;
      };
      const auto wait = [](const auto& done) {
        for (int i = 0; i < 60000 && !done(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        REQUIRE(done());
      };
      wait(written);
      if (!closed) {  // by its button
        job.stop();
        wait([&] { return job.ready(); });
        CHECK(job.take().value_or("").find("interrupted") != std::string::npos);
      }
    }  // as the window does that is closed
    CHECK(std::filesystem::exists(out + "/summary.json"));
    CHECK(std::filesystem::exists(out + "/unfinished/checkpoint"));
  }
}

TEST_CASE("an export into the folder of an unfinished run or film of its scene offers to go on") {
  const ScratchDirectory scratch;
  const std::string scene =
      scratch.write("own.toml", "[structure]\nkind = 'pendulum'\n[solver]\nend_time = 0.5\n");
  scratch.write("other.toml", "[structure]\nkind = 'pendulum'\n[solver]\nend_time = 0.25\n");
  PanelDriver driver(PanelDriver::small(), open_document(scene, {"solver.step=0.01"}));
  using Answers = std::vector<std::string>;
  const auto asked = [&](std::size_t kind, const std::string& output) {
    driver.state().export_kind = kind;
    driver.state().export_output = scratch / output;
    driver.state().intents.emplace_back([](LiveSession& s) { s.start_export(); });
    driver.frame();
    CHECK_FALSE(driver.state().exporting.running);
    const Question question = std::exchange(driver.state().question, {});
    Answers answers;
    for (const auto& answer : question.answers) answers.push_back(answer.first);
    return std::pair(question.text, answers);
  };
  const auto run_of = [&](const std::string& file) {
    scratch.write("run/unfinished/checkpoint",
                  checkpoint_head(read_scene_file(scratch / file, {"solver.step=0.01"})));
  };
  const Answers go_on{"Go on", "Begin anew", "Cancel"}, replace{"Replace", "Cancel"};
  const std::size_t film = 0, figures = 1, data = 2, gltf = 3;
  std::filesystem::create_directories(scratch / "run/unfinished");
  run_of("own.toml");
  CHECK(asked(data, "run").second == go_on);
  for (const std::size_t kind : {film, gltf}) {  // which simulate anew
    const auto [text, answers] = asked(kind, "run");
    CHECK(answers == replace);
    CHECK(text.ends_with("The unfinished run there would be lost."));
  }
  CHECK(asked(figures, "run").first.ends_with("Replace those of the same names?"));  // it stays
  run_of("other.toml");
  const auto [text, answers] = asked(data, "run");
  CHECK(answers == replace);
  CHECK(text.ends_with("The unfinished run there would be lost."));

  const Scene shown = read_scene_file(scene, {"solver.step=0.01"});
  FilmFolder(scratch / "film", shown).claim();
  CHECK(asked(film, "film").second == Answers{"Go on", "Cancel"});  // drawn frames stay in any case
  CHECK(asked(data, "film").second == replace);
  driver.state().history.replace([&] {
    SceneDocument changed = driver.state().history.now();
    changed.edits["solver.end_time"] = 0.25;
    return changed;
  }());
  CHECK(asked(film, "film").second == replace);
}

TEST_CASE("what an export says is in its box when the window comes to rest") {
  PanelDriver driver(PanelDriver::small(), "four_bar");
  driver.key(Key::e);
  const auto rest = [&] {  // as the window's loop: no frame that is not asked for
    for (int i = 0; i < 20 && driver.panel().frame(0); ++i) {
    }
  };
  rest();
  for (const char* message : {"one line", "", "the first of two lines\nand the second one"}) {
    CAPTURE(message);
    driver.state().message = message;
    rest();
    if (!*message) continue;
    const plot::Rect &box = driver.panel().place("export box"), &said = driver.panel().place("export said");
    CHECK(said.y1 < box.y1);
  }
}
