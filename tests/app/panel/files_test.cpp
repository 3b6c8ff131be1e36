// SPDX-License-Identifier: BSD-3-Clause
// Opening, beginning anew, saving, leaving: nothing is lost unasked.
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <thread>

#include "app/panel/document/file_list.hpp"
#include "app/panel/view/film_camera.hpp"
#include "render/scene/film_style.hpp"
#include "tests/app/panel/panel_driver.hpp"
#include "tests/app/run_program.hpp"

using namespace unfurl;

namespace files_test {

namespace {

const char* const pendulum = "title = 'Mine'\n[structure]\nkind = 'pendulum'\n[solver]\nend_time = 0.5\n";

PanelOptions tall() {
  PanelOptions options = PanelDriver::small();
  options.height = 900;
  options.measure_errors = false;
  return options;
}

}  // namespace

TEST_CASE("a path is completed as far as it is clear, and lists folders and scenes only") {
  const ScratchDirectory scratch;
  std::filesystem::create_directories(scratch / "masts/tall");
  scratch.write("mast_one.toml", "");
  scratch.write("mast_two.toml", "");
  scratch.write("mast.txt", "");
  const std::string folder = scratch / "";
  std::vector<std::string> names;
  for (const FileEntry& entry : matching_files(folder)) names.push_back(entry.name);
  CHECK(names == std::vector<std::string>{"../", "mast_one.toml", "mast_two.toml", "masts/"});
  CHECK(completed_path(folder + "m") == folder + "mast");
  CHECK(completed_path(folder + "mast_o") == folder + "mast_one.toml");
  CHECK(completed_path(folder + "masts") == folder + "masts/");
  CHECK(completed_path(folder + "x") == folder + "x");
  CHECK(matching_files(folder + "nowhere/").size() <= 1);
}

TEST_CASE("a scene is opened by its path, by dropping it, and again from the recent ones") {
  const ScratchDirectory scratch;
  const std::string file = scratch.write("mine.toml", pendulum),
                    broken = scratch.write("broken.toml", "x = [");
  PanelDriver driver(tall());
  driver.key(Key::o, true);
  driver.frame();
  REQUIRE(driver.panel().has_place("file path"));
  driver.type(scratch / "mi");
  driver.key(Key::tab);
  CHECK(driver.state().file_path == file);
  driver.key(Key::enter);
  driver.settle();
  CHECK(driver.state().shown->scene.title == "Mine");
  CHECK(driver.state().recent == std::vector<std::string>{file});
  CHECK_FALSE(driver.state().files_open);
  CHECK(driver.panel().settings().recent == driver.state().recent);
  driver.key(Key::z, true);  // the scene before, with its changes
  driver.settle();
  CHECK(driver.state().shown->scene.title != "Mine");
  InputEvent drop;
  drop.kind = InputEvent::Kind::drop;
  drop.text = broken;
  driver.panel().handle(drop);
  driver.settle();
  CHECK(driver.state().shown->scene.title != "Mine");  // what is open stays
  CHECK_FALSE(driver.state().message.empty());
  drop.text = file;
  driver.panel().handle(drop);
  driver.settle();
  CHECK(driver.state().shown->scene.title == "Mine");
  driver.state().files_open = true;
  driver.frame();
  driver.frame();
  CHECK(driver.panel().has_place("recent=" + file));
}

TEST_CASE("a new scene comes from a family or from nothing") {
  PanelDriver driver(tall());
  driver.click("open");
  driver.frame();
  driver.click("new bricard");
  driver.settle();
  CHECK(driver.state().shown->scene.kind == "bricard");
  driver.key(Key::end);
  driver.click("open");
  driver.frame();
  driver.click("new from nothing");
  driver.settle();
  CHECK(driver.state().shown->scene.kind == "custom");
  CHECK(driver.state().history.now().path.empty());
  CHECK(driver.state().tool == Tool::build);
  CHECK(driver.state().playback.t == 0);
  CHECK(driver.state().grid.plane == 1);  // upright, and seen from the front
}

TEST_CASE("leaving with changes asks, and without it does not") {
  const ScratchDirectory scratch;
  const std::string file = scratch.write("mine.toml", pendulum);
  PanelDriver driver(tall(), open_document(file, {}));
  driver.state().history.edit("solver.end_time", 0.25);
  driver.settle();
  driver.key(Key::q, true);
  driver.frame();
  CHECK_FALSE(driver.state().closed);
  REQUIRE(driver.panel().has_place("answer Save"));
  driver.key(Key::escape);
  CHECK_FALSE(driver.state().closed);
  CHECK(driver.state().question.text.empty());
  driver.key(Key::q, true);
  driver.frame();
  driver.click("answer Cancel");
  CHECK_FALSE(driver.state().closed);
  driver.key(Key::q, true);
  driver.frame();
  driver.click("answer Save");
  driver.frame();
  CHECK(driver.state().closed);
  CHECK(file_text(file).find("end_time = 0.25") != std::string::npos);
  PanelDriver other(tall());
  other.key(Key::q, true);
  CHECK(other.state().closed);
}

TEST_CASE("a file and a folder that are there are replaced only after a question") {
  const ScratchDirectory scratch;
  const std::string file = scratch.write("taken.toml", "# mine\n");
  PanelDriver driver(tall());
  driver.state().export_open = true;
  driver.frame();
  driver.state().export_path = file;
  driver.frame();
  driver.click("save");
  driver.frame();
  CHECK(file_text(file) == "# mine\n");
  REQUIRE(driver.panel().has_place("answer Replace"));
  driver.click("answer Replace");
  driver.frame();
  CHECK(file_text(file).find("# Data of the example") != std::string::npos);
  driver.settle();  // runs that arrive have nothing to say
  CHECK(driver.state().message ==
        "saved " + std::filesystem::path(file).lexically_normal().string() + ", comments kept");
  driver.state().export_output = scratch / "";
  driver.frame();
  driver.click("start export");
  driver.frame();
  CHECK_FALSE(driver.state().exporting.running);
  REQUIRE(driver.panel().has_place("answer Cancel"));
  driver.click("answer Cancel");
  driver.frame();
  CHECK_FALSE(driver.state().exporting.running);
}

TEST_CASE("a file loses comments and repeats only after a question and what was lost is said first") {
  const ScratchDirectory scratch;
  const std::string text =
      "# mine\n[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'A'\nposition = [0, 0, 0]\n"
      "fixed = true\n[[structure.nodes]]\nrepeat = {i = '1:3'}\nname = 'B{i}'\nposition = ['=i', 0, 0]\n"
      "[[structure.rods]]\nnodes = ['A', 'B1']\nmass = 1\n[[structure.rods]]\nnodes = ['B1', 'B2']\nmass = "
      "1\n";
  const std::string file = scratch.write("own.toml", text);
  PanelDriver driver(tall(), open_document(file, {"structure.nodes[2].mass=2"}));
  driver.key(Key::s, true);
  driver.frame();
  CHECK(file_text(file) == text);
  CHECK(driver.state().question.text.ends_with("written anew, without its comments, expressions, repeats."));
  REQUIRE(driver.panel().has_place("answer Cancel"));
  driver.click("answer Cancel");
  driver.frame();
  CHECK(file_text(file) == text);
  driver.key(Key::s, true);
  driver.frame();
  driver.click("answer Save as\u2026");
  driver.frame();
  CHECK(driver.state().export_open);
  CHECK(file_text(file) == text);
  driver.key(Key::escape);
  driver.key(Key::s, true);
  driver.frame();
  driver.click("answer Save anew");
  driver.frame();
  CHECK(file_text(file).find("repeat") == std::string::npos);
  CHECK(driver.state().message.starts_with("written anew, without its comments, expressions, repeats: "));
  driver.key(Key::s, true);  // it has none any more
  driver.frame();
  CHECK(driver.state().question.text.empty());
}

TEST_CASE("what another program changed in the scene's file is replaced only after a question") {
  const ScratchDirectory scratch;
  const std::string text = pendulum, file = scratch.write("own.toml", text);
  std::filesystem::create_symlink("own.toml", scratch / "link.toml");
  PanelDriver driver(tall());
  driver.state().intents.emplace_back(
      [path = scratch / "link.toml"](LiveSession& session) { session.open_file(path); });
  driver.frame();
  const auto save_with = [&](double end_time) {
    SceneDocument changed = driver.state().history.now();
    changed.edits["solver.end_time"] = end_time;
    driver.state().history.replace(changed);
    driver.key(Key::s, true);
    driver.frame();
  };
  save_with(0.25);
  save_with(0.125);
  CHECK(driver.state().question.text.empty());
  CHECK(file_text(file).find("end_time = 0.125") != std::string::npos);  // behind the link, which stays
  CHECK(std::filesystem::is_symlink(scratch / "link.toml"));
  scratch.write("own.toml", text + "# mine\n");
  save_with(0.0625);
  REQUIRE(driver.panel().has_place("answer Replace"));
  CHECK(file_text(file) == text + "# mine\n");
  driver.click("answer Cancel");
  driver.frame();
  CHECK(file_text(file) == text + "# mine\n");
  driver.key(Key::s, true);
  driver.frame();
  driver.click("answer Replace");
  driver.frame();
  CHECK(file_text(file).find("end_time = 0.0625") != std::string::npos);
}

TEST_CASE("a scene that another program changed is told of, and exported after a question") {
  const ScratchDirectory scratch;
  const std::string text = pendulum, file = scratch.write("own.toml", text);
  PanelDriver driver(tall(), open_document(file, {}));
  CHECK(driver.state().own_file == OwnFile::same);
  scratch.write("own.toml", text + "# mine\n");
  driver.frame();
  CHECK(driver.state().own_file == OwnFile::changed);
  CHECK(driver.state().message.find("own.toml was changed by another program") != std::string::npos);
  driver.state().export_output = scratch / "out";
  driver.state().export_open = true;
  driver.frame();
  driver.click("start export");
  driver.frame();
  REQUIRE(driver.panel().has_place("answer Export what is shown"));
  CHECK_FALSE(driver.state().exporting.running);
  driver.click("answer Open it again");
  driver.settle();
  CHECK(driver.state().own_file == OwnFile::same);
  CHECK(*driver.state().history.now().text == text + "# mine\n");
}

TEST_CASE("what was undone behind a save is in no file, and leaving asks") {
  const ScratchDirectory scratch;
  PanelDriver driver(tall(), open_document(scratch.write("own.toml", pendulum), {}));
  driver.state().history.edit("solver.end_time", 0.25);
  driver.key(Key::s, true);
  driver.settle();
  CHECK(driver.state().own_file == OwnFile::same);
  driver.key(Key::z, true);
  driver.settle();
  CHECK_FALSE(is_edited(driver.state().history.now()));
  CHECK(driver.state().own_file == OwnFile::other);
  driver.key(Key::q, true);
  driver.frame();
  CHECK_FALSE(driver.state().closed);
  driver.click("answer Save");
  driver.frame();
  CHECK(driver.state().closed);
  CHECK(file_text(scratch / "own.toml") == pendulum);
}

TEST_CASE("leaving while something is exported asks") {
  PanelDriver driver(tall());
  LiveSession session(open_document("hoop6", {}), {});
  session.state().exporting.running = true;
  session.ask_to_close();
  CHECK_FALSE(session.state().closed);
  driver.state().question = session.state().question;
  driver.frame();
  driver.frame();
  REQUIRE(driver.panel().has_place("answer Cancel"));
  driver.click("answer Stop it");
  driver.frame();
  CHECK(driver.state().closed);
}

TEST_CASE("a scene that came through a pipe has no file") {
  const ScratchDirectory scratch;
  const std::string pipe = scratch / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  std::thread writer([&] { std::ofstream(pipe) << pendulum; });
  const SceneDocument document = open_document(pipe, {});
  writer.join();
  CHECK(document.path.empty());
  CHECK(document.name == pipe);
  CHECK(*document.text == pendulum);
}

TEST_CASE("the view that was turned by hand is the film's, and its command line says so") {
  PanelDriver driver(tall());
  driver.key(Key::end);
  driver.drag("view", 0.3, 0.55);
  InputEvent wheel;
  wheel.kind = InputEvent::Kind::wheel;
  wheel.y = 3;
  driver.move_to("view", 0.5, 0.5);
  driver.panel().handle(wheel);
  driver.frame();
  REQUIRE(driver.state().orbit);
  const OrbitCamera led = *driver.state().orbit;
  const long runs = driver.panel().session().simulator().started();
  driver.key(Key::v);
  driver.settle();
  CHECK_FALSE(driver.state().orbit);
  CHECK(driver.panel().session().simulator().started() == runs);  // how it looks needs no run
  const Scene scene = read_document(driver.state().history.now());
  REQUIRE(scene.render.camera_keys.size() == 1);
  // Keys are rounded to a tenth of a degree and a thousandth of the zoom.
  const CameraKey key = scene.render.camera_keys[0];
  CHECK(key.azimuth == Approx(led.azimuth / radians_per_degree).margin(0.051));
  CHECK(key.elevation == Approx(led.elevation / radians_per_degree).margin(0.051));
  const OrbitCamera shown = driver.panel().framed();
  CHECK(shown.distance * std::tan(shown.field_of_view / 2) ==
        Approx(led.distance * std::tan(led.field_of_view / 2)).epsilon(2e-3));
  // As much nearer than what sees the whole motion is the film's, in a picture of its own size.
  const LiveRun& run = *driver.state().shown;
  const auto reach_of = [&](double zoom) {
    Scene zoomed = scene;
    zoomed.render.camera_keys[0].zoom = zoom;
    return orbit_of(
               FrameBuilder(run.simulation.trajectory, film_style(zoomed, run.simulation, run.diagnostics))
                   .camera())
        .distance;
  };
  CHECK(key.zoom > 1.2);
  CHECK(reach_of(1) / reach_of(key.zoom) == Approx(key.zoom).epsilon(1e-3));
  CHECK(command_line(driver.state().history.now(), "render", "out").find("render.camera_keys=[{") !=
        std::string::npos);
  // A second key beside the first, at the present time.
  driver.drag("view", 0.5, 0.4);
  driver.key(Key::k);
  driver.settle();
  const auto keys = read_document(driver.state().history.now()).render.camera_keys;
  REQUIRE(keys.size() == 2);
  CHECK(keys[1].time == Approx(driver.state().playback.t).margin(1e-4));
  driver.key(Key::z, true);
  driver.key(Key::z, true);
  driver.settle();
  CHECK(read_document(driver.state().history.now()).render.camera_keys.empty());
}

}  // namespace files_test
