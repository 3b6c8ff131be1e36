// SPDX-License-Identifier: BSD-3-Clause
// A scene that is saved elsewhere, left for another one, or names files of its own.
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>

#include "app/panel/runs/simulator.hpp"
#include "core/scene/reader.hpp"
#include "tests/app/panel/panel_driver.hpp"
#include "tests/app/run_program.hpp"

using namespace unfurl;
namespace fs = std::filesystem;

namespace other_scene_test {

namespace {

const char* const pendulum = "title = 'Mine'\n[structure]\nkind = 'pendulum'\n[solver]\nend_time = 0.5\n";

PanelOptions quick() {
  PanelOptions options = PanelDriver::small();
  options.height = 900;
  options.measure_errors = false;
  return options;
}

void edit(PanelDriver& driver, double end_time) {
  SceneDocument changed = driver.state().history.now();
  changed.edits["solver.end_time"] = end_time;
  driver.state().history.replace(changed);
  driver.settle();
}

void save(PanelDriver& driver, const std::string& path) {
  driver.state().intents.emplace_back([path](LiveSession& session) { session.save(path); });
  driver.frame();
  driver.settle();
}

void open(PanelDriver& driver, const std::string& path) {
  driver.state().intents.emplace_back([path](LiveSession& session) { session.open_file(path); });
  driver.frame();
  driver.settle();
}

// A rod of the length that the file gives, hanging at an angle.
std::string scene_of_files(const ScratchDirectory& scratch) {
  fs::create_directories(scratch / "a");
  fs::create_directories(scratch / "b");
  scratch.write("a/n.csv", "name,x,y,z,fixed\nA,0,0,0,true\nB,1,0,0,false\n");
  scratch.write("a/r.csv", "a,b,mass\nA,B,1\n");
  return scratch.write("a/own.toml",
                       "[structure]\nkind = 'custom'\nnodes_file = 'n.csv'\nrods_file = 'r.csv'\n"
                       "[gravity]\nacceleration = [0, 0, -9.81]\n[solver]\nend_time = 0.2\nstep = 0.05\n");
}

}  // namespace

TEST_CASE("a scene is not saved where the files that it names are not") {
  const ScratchDirectory scratch;
  PanelDriver driver(quick(), open_document(scene_of_files(scratch), {}));
  edit(driver, 0.15);
  const std::string other = scratch / "b/other.toml";
  save(driver, other);
  CHECK_FALSE(fs::exists(other));
  CHECK(driver.state().message.starts_with("not saved: cannot read "));
  CHECK(driver.state().message.find("/b/") != std::string::npos);
  CHECK(driver.state().history.now().path == scratch / "a/own.toml");
  for (const char* name : {"n.csv", "r.csv"})
    fs::copy_file(scratch / (std::string("a/") + name), scratch / (std::string("b/") + name));
  save(driver, other);
  CHECK(read_scene_file(other).solver.end_time == 0.15);
  CHECK(driver.state().problems.empty());
}

TEST_CASE("files that a scene names are read again when they change") {
  const ScratchDirectory scratch;
  PanelDriver driver(quick(), open_document(scene_of_files(scratch), {}));
  REQUIRE(driver.state().shown);
  CHECK(driver.state().shown->scene.custom.nodes[1].position == Vec3(1, 0, 0));
  const std::string nodes = scratch.write("a/n.csv", "name,x,y,z,fixed\nA,0,0,0,true\nB,2,0,0,false\n");
  // Later than before, whatever the clock of the file system tells apart.
  fs::last_write_time(nodes, fs::last_write_time(nodes) + std::chrono::seconds(3));
  driver.frame();
  driver.settle();
  CHECK(driver.state().shown->scene.custom.nodes[1].position == Vec3(2, 0, 0));
  CHECK(driver.state().message == "files that the scene names were changed: read again");
  fs::remove(nodes);
  driver.frame();
  driver.settle();
  CHECK_FALSE(driver.state().problems.empty());
}

TEST_CASE("undo behind a save under another name stays in the new file") {
  const ScratchDirectory scratch;
  const std::string original = scratch.write("a.toml", pendulum), copy = scratch / "b.toml";
  PanelDriver driver(quick(), open_document(original, {}));
  edit(driver, 0.25);
  edit(driver, 0.125);
  driver.key(Key::z, true);  // for a redo
  save(driver, copy);
  CHECK(file_text(copy).find("end_time = 0.25") != std::string::npos);
  for (const bool back : {true, false}) {
    INFO(back);
    driver.key(back ? Key::z : Key::y, true);
    driver.settle();
    CHECK(driver.state().history.now().path == copy);
    driver.key(Key::s, true);
    driver.settle();
    CHECK(file_text(original) == pendulum);
    CHECK(file_text(copy).find(back ? "end_time = 0.5" : "end_time = 0.25") != std::string::npos);
  }
}

TEST_CASE("leaving asks for a scene that was left with changes for another one") {
  const ScratchDirectory scratch;
  const std::string first = scratch.write("first.toml", pendulum),
                    second = scratch.write("second.toml", pendulum);
  PanelDriver driver(quick(), open_document(first, {}));
  edit(driver, 0.25);
  open(driver, second);
  driver.key(Key::q, true);
  driver.frame();
  CHECK_FALSE(driver.state().closed);
  REQUIRE(driver.panel().has_place("answer Back to it"));
  driver.click("answer Back to it");
  driver.settle();
  CHECK(driver.state().history.now().path == first);
  CHECK(is_edited(driver.state().history.now()));
  save(driver, first);
  open(driver, second);
  driver.key(Key::q, true);
  CHECK(driver.state().closed);
}

TEST_CASE("leaving asks for every scene that has changes, one after the other") {
  const ScratchDirectory scratch;
  for (const char* answer : {"answer Save", "answer Discard"}) {
    INFO(answer);
    const std::string first = scratch.write("first.toml", pendulum),
                      second = scratch.write("second.toml", pendulum);
    PanelDriver driver(quick(), open_document(first, {}));
    edit(driver, 0.25);
    open(driver, second);
    edit(driver, 0.125);
    driver.key(Key::q, true);
    driver.frame();
    driver.click(answer);
    driver.frame();
    CHECK_FALSE(driver.state().closed);
    CHECK((file_text(second) == pendulum) == (std::string(answer) == "answer Discard"));
    REQUIRE(driver.panel().has_place("answer Back to it"));
    driver.click("answer Discard");
    driver.frame();
    CHECK(driver.state().closed);
    CHECK(file_text(first) == pendulum);
  }
}

TEST_CASE("a scene left for another of the same name is asked for") {
  const ScratchDirectory scratch;
  const std::string file = scratch.write("own.toml", pendulum);
  PanelDriver driver(quick(), open_document(file, {}));
  const auto asks = [](PanelDriver& of) {
    of.key(Key::q, true);
    of.frame();
    return !of.state().closed && of.panel().has_place("answer Back to it");
  };
  edit(driver, 0.25);
  open(driver, file);  // over its own changes
  CHECK_FALSE(is_edited(driver.state().history.now()));
  CHECK(asks(driver));
  PanelDriver untitled(quick());
  for (int i = 0; i < 2; ++i) {
    untitled.state().intents.emplace_back([](LiveSession& session) { session.build_from_nothing(); });
    untitled.frame();
    untitled.settle();
    if (i == 0) edit(untitled, 0.25);
  }
  CHECK(asks(untitled));
}

TEST_CASE("behind a save into another folder its files are looked at") {
  const ScratchDirectory scratch;
  PanelDriver driver(quick(), open_document(scene_of_files(scratch), {}));
  const std::string other = scratch / "b/other.toml";
  scratch.write("b/n.csv", "name,x,y,z,fixed\nA,0,0,0,true\nB,5,0,0,false\n");
  fs::copy_file(scratch / "a/r.csv", scratch / "b/r.csv");
  save(driver, other);  // a file of this name is another there
  CHECK_FALSE(fs::exists(other));
  CHECK(driver.state().message.find("n.csv") != std::string::npos);
  CHECK(driver.state().message.find("holds something else there") != std::string::npos);
  fs::copy_file(scratch / "a/n.csv", scratch / "b/n.csv", fs::copy_options::overwrite_existing);
  save(driver, other);
  REQUIRE(fs::exists(other));
  const auto change = [&](const char* name, double x) {
    const std::string nodes =
        scratch.write(name, "name,x,y,z,fixed\nA,0,0,0,true\nB," + std::to_string(x) + ",0,0,false\n");
    fs::last_write_time(nodes, fs::last_write_time(nodes) + std::chrono::seconds(3));
    driver.frame();
    driver.settle();
    return driver.state().shown->scene.custom.nodes[1].position.x();
  };
  CHECK(change("a/n.csv", 7) == 1);  // left behind
  CHECK(change("b/n.csv", 3) == 3);
}

TEST_CASE("a table that a change names is looked at, and the one before no more") {
  const ScratchDirectory scratch;
  scratch.write("t.csv", "t,value\n0,0\n1,1\n");
  scratch.write("t2.csv", "t,value\n0,0\n1,2\n");
  const std::string file =
      scratch.write("timed.toml", std::string(pendulum) +
                                      "[[forces]]\nkind = 'load_over_time'\nnodes = ['bob']\n"
                                      "force = [1, 0, 0]\ntable = 't.csv'\n");
  PanelDriver driver(quick(), open_document(file, {}));
  const auto last = [&] { return driver.state().shown->scene.forces[0].values.vector("values").back(); };
  REQUIRE(last() == 1);
  SceneDocument changed = driver.state().history.now();
  changed.edits["forces[0].table"] = std::string("t2.csv");
  driver.state().history.replace(changed);
  driver.settle();
  REQUIRE(last() == 2);
  const auto rewrite = [&](const char* name) {
    const std::string table = scratch.write(name, "t,value\n0,0\n1,9\n");
    fs::last_write_time(table, fs::last_write_time(table) + std::chrono::seconds(3));
    driver.frame();
    driver.settle();
  };
  rewrite("t.csv");
  CHECK(driver.state().message.find("read again") == std::string::npos);
  rewrite("t2.csv");
  CHECK(last() == 9);
}

TEST_CASE("a file that is no scene is told with its place") {
  const ScratchDirectory scratch;
  const std::string bad = scratch.write("bad.toml", std::string(pendulum) + "step = -1\nstages = 1000\n");
  PanelDriver driver(quick());
  open(driver, bad);
  CHECK(driver.state().message.find("bad.toml:6:8: solver.step: must be") != std::string::npos);
  CHECK(driver.state().message.ends_with("; and 1 more"));
}

TEST_CASE("another scene has no part selected, and studies of its own") {
  const ScratchDirectory scratch;
  PanelDriver driver(quick(), "hoop6");
  driver.click("page Studies");
  driver.frame();
  REQUIRE(driver.state().study.key.starts_with("structure."));
  driver.state().study.key = "structure.post_length";
  driver.state().selected = {Selection::Kind::node, "A0"};
  open(driver, scratch.write("mine.toml", pendulum));
  for (int i = 0; i < 3; ++i) driver.frame();
  CHECK(driver.state().selected.kind == Selection::Kind::none);
  CHECK(driver.state().study.key == "structure.length");
  CHECK(driver.state().study.largest_step == 4 * driver.state().base.solver.step);
}

TEST_CASE("a path below one's home is meant as a shell means it") {
  const ScratchDirectory scratch;
  const std::string file = scratch.write("mine.toml", pendulum);
  const char* before = std::getenv("HOME");
  const std::string home = before != nullptr ? before : "";
  ::setenv("HOME", fs::path(file).parent_path().c_str(), 1);
  PanelDriver driver(quick());
  driver.key(Key::o, true);
  driver.frame();
  driver.type("~/mine.toml");
  driver.key(Key::enter);
  driver.settle();
  CHECK(driver.state().shown->scene.title == "Mine");
  CHECK(driver.state().recent == std::vector<std::string>{file});
  edit(driver, 0.25);
  save(driver, "~/other.toml");
  CHECK(fs::exists(scratch / "other.toml"));
  ::setenv("HOME", home.c_str(), 1);
}

TEST_CASE("what is typed behind the key that opens a box goes into the box") {
  PanelDriver driver(quick());
  const auto key = [&](Key which, bool control) {
    InputEvent event;
    event.kind = InputEvent::Kind::key;
    event.key = which;
    event.control = control;
    for (const bool down : {true, false}) {
      event.down = down;
      driver.panel().handle(event);
    }
  };
  key(Key::p, true);
  for (const char* letter : {"e", "n", "d"}) {  // "e" opens the box of exports, else
    InputEvent text;
    text.kind = InputEvent::Kind::text;
    text.text = letter;
    if (*letter == 'e') key(Key::e, false);
    driver.panel().handle(text);
  }
  for (int i = 0; i < 20; ++i) driver.frame();
  CHECK(driver.state().palette_open);
  CHECK_FALSE(driver.state().export_open);
  CHECK(driver.state().palette_query == "end");
}

TEST_CASE("the view says that a run has warnings and the first of them") {
  SceneDocument document = open_document("double_pendulum", {});
  document.overrides = {"solver.step=0.05", "solver.end_time=1"};
  PanelDriver driver(quick(), document);
  CHECK(warning_sentence(*driver.state().shown).empty());
  const plot::Rect before = driver.panel().place("state line");
  driver.state().history.edit("solver.step", 0.2);  // some steps a swing, off by per cents
  driver.state().history.edit("solver.end_time", 2.0);
  driver.settle();
  const LiveRun& run = *driver.state().shown;
  REQUIRE_FALSE(run.warnings.empty());
  const std::string sentence = warning_sentence(run);
  CHECK(sentence.find(run.warnings.size() == 1 ? "1 warning: " : " warnings: ") != std::string::npos);
  CHECK(sentence.ends_with(run.warnings.front()));
  CHECK(driver.panel().place("state line").height() > before.height());
}

}  // namespace other_scene_test
