// SPDX-License-Identifier: BSD-3-Clause
// The panel driven without a display, by mouse and keyboard.
#include "app/panel/control_panel.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "tests/app/panel/panel_driver.hpp"

using namespace unfurl;

namespace control_panel_test {

namespace {

std::size_t differing_pixels(const Image& a, const Image& b, const plot::Rect& in) {
  std::size_t count = 0;
  for (int y = static_cast<int>(in.y0); y < static_cast<int>(in.y1); ++y)
    for (int x = static_cast<int>(in.x0); x < static_cast<int>(in.x1); ++x) {
      const auto at =
          4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(a.width) + static_cast<std::size_t>(x));
      count +=
          a.rgba[at] != b.rgba[at] || a.rgba[at + 1] != b.rgba[at + 1] || a.rgba[at + 2] != b.rgba[at + 2];
    }
  return count;
}

double real_edit(PanelDriver& driver, const std::string& key) {
  return std::get<double>(driver.state().history.now().edits.at(key));
}

}  // namespace

TEST_CASE("dragging a slider of the panel changes the scene, its simulation and the picture") {
  PanelDriver driver;
  REQUIRE(driver.state().shown);
  driver.key(Key::end);
  const auto before = driver.state().shown;
  const Image old = driver.picture();
  driver.drag("structure.post_length", 0.5, 0.9);
  CHECK(real_edit(driver, "structure.post_length") > 1.3);
  driver.settle();
  REQUIRE(driver.state().shown != before);
  CHECK(driver.state().shown->scene.structure.real("post_length") ==
        real_edit(driver, "structure.post_length"));
  // The longer posts are seen: more than a hundredth of the view is another colour.
  const plot::Rect view = driver.panel().place("view");
  CHECK(static_cast<double>(differing_pixels(old, driver.picture(), view)) >
        0.01 * view.width() * view.height());
  driver.key(Key::z, true);
  driver.settle();
  CHECK(driver.state().history.now().edits.empty());
  CHECK(driver.state().shown->scene.structure.real("post_length") == 1.2);
}

TEST_CASE(
    "a slider takes a typed value, and one out of range is an error at the widget, as on the command line") {
  PanelDriver driver;
  const auto type_into = [&](const std::string& key, const std::string& text) {
    InputEvent control;
    control.kind = InputEvent::Kind::key;
    control.control = true;
    control.down = true;
    driver.panel().handle(control);
    driver.click(key);
    control.control = control.down = false;
    driver.panel().handle(control);
    driver.frame();
    driver.type(text);
    driver.key(Key::enter);
    driver.settle();
  };
  type_into("structure.fold_angle", "60");
  CHECK(real_edit(driver, "structure.fold_angle") == 60.0);
  CHECK(driver.state().shown->scene.structure.real("fold_angle") == 60.0);
  const auto sound = driver.state().shown;
  type_into("structure.fold_angle", "95");
  CHECK(driver.state().shown == sound);  // the old result stays
  REQUIRE(driver.state().problems.size() == 1);
  CHECK(driver.state().problems[0].key == "structure.fold_angle");
  SceneDocument document = driver.state().history.now();
  try {
    read_document(document);
    FAIL("the command line takes 95 degrees");
  } catch (const SceneError& error) {
    CHECK(error.problems()[0].message == driver.state().problems[0].message);
  }
  driver.key(Key::r);
  driver.settle();
  CHECK(driver.state().problems.empty());
}

TEST_CASE("the right mouse button resets a parameter") {
  PanelDriver driver;
  driver.drag("structure.density", 0.6, 0.3);
  REQUIRE(driver.state().history.now().edits.size() == 1);
  driver.click("structure.density", 1);
  driver.frame();
  driver.click("reset structure.density");
  CHECK(driver.state().history.now().edits.empty());
}

TEST_CASE("the timeline scrubs, plays and steps") {
  PanelDriver driver;
  const Trajectory& run = driver.state().shown->simulation.trajectory;
  const double end = run.end_time();
  driver.drag("timeline", 0.1, 0.5);
  // Within a pixel of the bar, which is several hundred long.
  CHECK(driver.state().playback.t == Approx(0.5 * end).margin(0.005 * end));
  driver.key(Key::home);
  CHECK(driver.state().playback.t == 0.0);
  driver.key(Key::right);
  CHECK(driver.state().playback.t == run.time(1));
  driver.key(Key::left);
  CHECK(driver.state().playback.t == 0.0);
  driver.click("step +");
  CHECK(driver.state().playback.t == run.time(1));
  driver.click("step \u2212");
  CHECK(driver.state().playback.t == 0.0);
  driver.key(Key::end);
  CHECK(driver.state().playback.t == end);
  driver.key(Key::home);
  driver.click("play");
  CHECK(driver.state().playback.playing);
  const double before = driver.state().playback.t;
  driver.frame(0.25);
  CHECK(driver.state().playback.t == Approx(before + 0.25));
  driver.key(Key::space);
  CHECK_FALSE(driver.state().playback.playing);
}

TEST_CASE("the time stands before its line, however many digits it has") {
  for (const double end : {2e-4, 5e7}) {
    SceneDocument still = open_document("pendulum", {});
    still.edits["gravity.acceleration"] = std::vector<double>{0, 0, 0};
    still.edits["solver.step"] = end / 20;
    still.edits["solver.end_time"] = end;
    PanelDriver driver(PanelDriver::small(), still);
    driver.key(Key::end);
    driver.frame();
    CHECK(driver.state().playback.t == end);
    // Its handle is a disc of 7 pixels on the line's beginning.
    CHECK(driver.panel().place("time").x1 + 7 * 0.75 < driver.panel().place("timeline").x0);
  }
}

TEST_CASE("dragging in a figure moves the time") {
  PanelDriver driver;
  const double end = driver.state().shown->simulation.trajectory.end_time();
  driver.drag("figure deployment 0", 0.1, 0.6);
  CHECK(driver.state().playback.t > 0.4 * end);
  CHECK(driver.state().playback.t < 0.8 * end);
}

TEST_CASE("the view turns, moves and zooms, and F frames it again") {
  PanelDriver driver;
  driver.drag("view", 0.3, 0.6);
  REQUIRE(driver.state().orbit);
  const OrbitCamera turned = *driver.state().orbit;
  InputEvent wheel;
  wheel.kind = InputEvent::Kind::wheel;
  wheel.y = 2;
  driver.panel().handle(wheel);
  driver.frame();
  CHECK(driver.state().orbit->distance < turned.distance);
  driver.key(Key::f);
  CHECK_FALSE(driver.state().orbit);
  driver.click("view options");
  driver.frame();
  driver.click("view Top");
  REQUIRE(driver.state().orbit);
  CHECK(driver.state().orbit->elevation > 1.5f);
}

TEST_CASE("a click in the view reads a rod") {
  PanelDriver driver;
  driver.key(Key::end);
  const Structure& structure = driver.state().shown->simulation.trajectory.structure();
  const plot::Rect view = driver.panel().place("view");
  // The middle of a rod in the picture, by the film's own camera.
  FrameStyle style;
  style.width = static_cast<int>(view.width());
  style.height = static_cast<int>(view.height());
  const FrameBuilder builder(driver.state().shown->simulation.trajectory, style);
  const PickView pick_view{builder.camera(), style.width, style.height, builder.upright()};
  // The lowest one in the picture: buttons and titles are at the top.
  double lowest = 0;
  Eigen::Vector2d middle(0, 0);
  for (const RodCopy& copy : structure.rod_copies) {
    const PickedPlace at = place_of({Selection::Kind::rod, copy.name}, *driver.state().shown,
                                    driver.state().playback.t, pick_view);
    const double y = 0.5 * (at.a.y() + at.b.y());
    if (y > lowest) lowest = y, middle = {view.x0 + 0.5 * (at.a.x() + at.b.x()), view.y0 + y};
  }
  driver.move(middle.x(), middle.y());
  CHECK(driver.state().hovered.kind == Selection::Kind::rod);
  driver.press(true);
  driver.press(false);
  CHECK(driver.state().selected == driver.state().hovered);
  driver.key(Key::escape);
  CHECK(driver.state().selected.kind == Selection::Kind::none);
}

TEST_CASE("a pinned run is compared with the present one") {
  PanelDriver driver;
  driver.key(Key::p);
  REQUIRE(driver.state().pinned);
  driver.drag("structure.hinge_force", 0.6, 0.65);
  driver.settle();
  CHECK(driver.panel().has_place("comparison"));
  CHECK(driver.state().pinned != driver.state().shown);
  // Beside the view, in which the structure is; in it where the figures are not open.
  CHECK(driver.panel().place("comparison").x0 > driver.panel().place("view").x1);
  driver.state().right_open = false;
  driver.frame();
  CHECK(driver.panel().place("comparison").x1 < driver.panel().place("view").x1);
  driver.state().right_open = true;
  // More force deploys sooner.
  REQUIRE(driver.state().shown->simulation.events.size() == 1);
  CHECK(driver.state().shown->simulation.events.at(0).t < driver.state().pinned->simulation.events.at(0).t);
  driver.key(Key::p);
  CHECK_FALSE(driver.state().pinned);
}

TEST_CASE("keys and buttons open and close what they say") {
  PanelDriver driver;
  driver.key(Key::f1);
  CHECK(driver.panel().has_place("help box"));
  driver.key(Key::escape);
  CHECK_FALSE(driver.panel().has_place("help box"));
  driver.type("?");
  CHECK(driver.state().help_open);
  driver.key(Key::escape);
  driver.key(Key::t);
  CHECK(driver.state().dark);
  driver.key(Key::e);
  CHECK(driver.state().export_open);
}

TEST_CASE("the legend's colours are those of the rods in the dark too") {
  PanelDriver driver;
  const auto orange_in_legend = [&] {  // of the posts
    const Image picture = driver.picture();
    const plot::Rect view = driver.panel().place("view");
    int count = 0;
    for (int y = static_cast<int>(view.y1) - 30; y < static_cast<int>(view.y1); ++y)
      for (int x = static_cast<int>(view.x0); x < static_cast<int>(view.x1); ++x) {
        const std::size_t i = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                                   static_cast<std::size_t>(x));
        count += picture.rgba[i] - picture.rgba[i + 2] > 100 && picture.rgba[i + 1] > 90;
      }
    return count;
  };
  driver.state().dark = false;
  driver.settle();
  const int light = orange_in_legend();
  CHECK(light > 12);  // a square of some pixels
  driver.state().dark = true;
  driver.settle();
  CHECK(2 * orange_in_legend() > light);
}

TEST_CASE("looks change the picture without a new simulation") {
  PanelDriver driver;
  driver.key(Key::end);
  const long runs = driver.panel().session().simulator().started();
  const Image before = driver.picture();
  driver.state().history.edit("render.look", std::string("blueprint"));
  driver.settle();
  CHECK(driver.panel().session().simulator().started() == runs);
  CHECK(driver.state().picture.look == "blueprint");
  const plot::Rect view = driver.panel().place("view");
  // A blueprint has another ground everywhere.
  CHECK(static_cast<double>(differing_pixels(before, driver.picture(), view)) >
        0.5 * view.width() * view.height());
  // What is for paper stands on white, not on nothing.
  driver.state().history.edit("render.look", std::string("print"));
  driver.settle();
  const Image print = driver.picture();
  const auto corner = 4 * ((static_cast<std::size_t>(view.y1) - 3) * static_cast<std::size_t>(print.width) +
                           static_cast<std::size_t>(view.x0) + 3);
  CHECK(static_cast<int>(print.rgba.at(corner)) > 240);
  driver.state().history.edit("render.inset", std::string("no_such_column"));
  driver.settle();
  REQUIRE(driver.state().picture_problems.size() == 1);
  CHECK(driver.state().picture_problems[0].key == "render.inset");
  driver.state().history.edit("render.look", std::string("nolook"));
  driver.settle();
  REQUIRE(driver.state().problems.size() == 1);
  CHECK(driver.state().problems[0].key == "render.look");
}

TEST_CASE("look and colours are at hand in the view") {
  PanelDriver driver;
  driver.click("view options");
  driver.frame();
  driver.click("render.colour_by");
  driver.frame();
  driver.click("render.colour_by=axial_force");
  driver.frame();
  CHECK(driver.state().picture.colour_by == "axial_force");
}

TEST_CASE("every run of a session is a point of speed against accuracy") {
  PanelDriver driver;
  REQUIRE(driver.state().trade.size() == 1);
  driver.state().history.edit("solver.stages", 2L);
  driver.settle();
  driver.state().history.edit("solver.method", std::string("rk4"));
  driver.settle();
  REQUIRE(driver.state().trade.size() == 3);
  CHECK(driver.state().trade[1].error > driver.state().trade[0].error);  // order 2 against order 4
  const Figure figure = trade_figure(driver.state().trade);
  REQUIRE(figure.panels.at(0).curves.size() == 4);  // the trail, two methods, and the present point
  CHECK(figure.panels[0].curves[0].x.size() == 3);
  CHECK(figure.panels[0].curves[3].y.at(0) == driver.state().trade[2].position_error);
  CHECK(driver.state().trade[0].setting == "dvm, 3 stages, step 0.05 s");
  CHECK(driver.state().trade[2].setting == "rk4, step 0.05 s");
  REQUIRE(driver.panel().has_place("trade now"));
  driver.move_to("trade now");
  CHECK(driver.panel().has_place("trade point"));  // named
  driver.move_to("trade points", 0.999, 0.001);
  CHECK_FALSE(driver.panel().has_place("trade point"));
}

TEST_CASE("the panel picks stages and step for a tolerance as the command line does") {
  PanelDriver driver;
  driver.state().history.edit("solver.tolerance", 1e-4);
  driver.settle();
  const Simulation& run = driver.state().shown->simulation;
  CHECK(run.position_estimate <= 1e-4);
  CHECK(run.options.step != 0.05);
  CHECK(driver.state().trade.back().estimate == run.position_estimate);
  // What was estimated is near what is measured: within the tolerance, and no guess out of the air.
  CHECK(driver.state().trade.back().position_error <= 1e-4);
  CHECK(driver.state().trade.back().position_error > 1e-3 * run.position_estimate);
}

TEST_CASE("nothing is painted again where nothing changed") {
  PanelDriver driver;
  const long before = driver.panel().view_paints();
  for (int i = 0; i < 5; ++i) driver.frame(0);
  CHECK(driver.panel().view_paints() == before);
  CHECK_FALSE(driver.panel().frame(0));  // and no further frame is asked for
}

// Counts, not times: of a run that is there within a moment nothing is painted before it, and the view and
// the figures once with it. The bound: the fields, buttons and figures that a change touches are less than
// the picture, and so is what its run changes.
TEST_CASE("a change is shown with its run, once, and is told of before only where it takes its time") {
  for (const bool patient : {true, false}) {
    CAPTURE(patient);
    PanelOptions options = PanelDriver::small();
    options.moment = patient ? 1e9 : 0.0;
    options.measure_errors = false;
    PanelDriver driver(options);
    const ControlPanel& panel = driver.panel();
    const double whole = static_cast<double>(options.width) * options.height, painted = panel.painted();
    const long views = panel.view_paints(), runs = panel.session().simulator().started();
    SceneDocument changed = driver.state().history.now();
    // Ten times the steps: on no machine done before the next frame looks.
    changed.edits["solver.step"] = 0.097 * driver.state().shown->scene.solver.step;
    driver.state().history.replace(changed);
    bool told = false;
    for (int frames = 0; !(driver.state().shown->document == changed); ++frames) {
      REQUIRE(frames < 60000);
      driver.frame(0);
      told = told || driver.state().simulation.late;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    CHECK(panel.session().simulator().started() == runs + 1);
    CHECK(panel.view_paints() == views + 1);
    CHECK(told == !patient);
    if (patient) CHECK(panel.painted() - painted < 2 * whole);
  }
}

// In a wide view and in one that breaks the hint's line.
TEST_CASE("what a tool does and how far a run is are said beside one another") {
  for (const int width : {1000, 560})
    for (const Key tool : {Key::b, Key::g}) {
      CAPTURE(width, name_of(tool));
      PanelOptions options = PanelDriver::small();
      options.width = width;
      options.moment = 0.0;
      options.measure_errors = false;
      PanelDriver driver(options);
      driver.key(tool);
      SceneDocument changed = driver.state().history.now();
      changed.edits["solver.step"] = 0.097 * driver.state().shown->scene.solver.step;
      driver.state().history.replace(changed);
      for (int frames = 0; !driver.panel().has_place("progress"); ++frames) {
        REQUIRE(frames < 60000);
        driver.frame(0);
      }
      const plot::Rect hint = driver.panel().place("tool hint"), done = driver.panel().place("progress");
      CHECK_FALSE(hint.overlaps(done));
      for (const plot::Rect& text : {hint, done}) {
        CHECK(driver.panel().place("view").contains(text));
        if (tool == Key::b) CHECK_FALSE(text.overlaps(driver.panel().place("build plane")));
      }
    }
}

TEST_CASE("what is painted in parts is what would be painted at once") {
  PanelDriver driver;
  driver.key(Key::p);
  driver.drag("timeline", 0.2, 0.6);
  driver.drag("view", 0.3, 0.5);
  driver.key(Key::f1);
  driver.key(Key::escape);
  driver.click("page Studies");
  driver.click("page Figures");
  driver.drag("structure.post_length", 0.5, 0.6);
  driver.settle();
  for (const char* hovered : {"undo", "structure.units", "trade now", "timeline"}) {
    driver.move_to(hovered);
    driver.frame();
    driver.frame();
    const Image parts = driver.picture();
    driver.panel().resize(parts.width, parts.height);  // forgets what was painted
    driver.frame();
    INFO(hovered);
    CHECK(differing_pixels(parts, driver.picture(),
                           {0, 0, static_cast<double>(parts.width), static_cast<double>(parts.height)}) == 0);
  }
}

TEST_CASE("a slow machine sees one sample a pixel while something moves, and smooth edges at rest") {
  PanelDriver driver;
  driver.move_to("view", 0.5, 0.8);
  const Image smooth = driver.picture();
  const plot::Rect view = driver.panel().place("view");
  const double t = driver.state().playback.t;
  driver.state().playback.playing = true;
  driver.state().playback.speed = 0.01;
  for (int i = 0; i < 6; ++i) driver.frame(0.2);  // five frames a second
  driver.state().playback.playing = false;
  driver.state().playback.t = t;
  CHECK(driver.panel().frame(0.2));  // it moved: another frame is wanted
  CHECK(differing_pixels(smooth, driver.picture(), view) > 0);
  for (int i = 0; i < 3; ++i) driver.frame(0);
  CHECK(differing_pixels(smooth, driver.picture(), view) == 0);
}

TEST_CASE("the panel fits pictures from small to large") {
  const auto [width, height, scale] = GENERATE(
      table<int, int, float>({{640, 400, 1.f}, {1280, 720, 1.f}, {1920, 1080, 1.f}, {1600, 900, 2.f}}));
  PanelOptions options;
  options.width = width;
  options.height = height;
  options.scale = scale;
  PanelDriver driver(options);
  for (const char* key : {"undo", "export", "help", "theme", "play", "timeline", "view", "scene"}) {
    INFO(key << " at " << width << " x " << height);
    const plot::Rect r = driver.panel().place(key);
    CHECK(r.x0 >= 0);
    CHECK(r.y0 >= 0);
    CHECK(r.x1 <= width);
    CHECK(r.y1 <= height);
    CHECK(r.width() > 0);
  }
}

TEST_CASE("a message that is too long for its line takes two and stays in the bar") {
  const auto [width, scale] = GENERATE(table<int, float>({{640, 1.f}, {800, 1.f}, {1000, 1.f}, {1600, 2.f}}));
  PanelOptions options = PanelDriver::small();
  options.width = width;
  options.scale = scale;
  PanelDriver driver(options);
  const auto place = [&](const std::string& message) {
    driver.state().message = message;
    driver.frame();
    driver.frame();
    return driver.panel().place("message");
  };
  const plot::Rect one = place("saved"),
                   two = place("written anew, without its comments, variables: " + std::string(200, 'p') +
                               ".toml");
  CHECK(two.height() > one.height());
  for (const plot::Rect& r : {one, two}) {
    CHECK(r.x0 > driver.panel().place("pin").x1);
    CHECK(r.x1 < driver.panel().place("palette").x0);
    CHECK(r.y0 >= 0);
    CHECK(r.y1 <= driver.panel().place("view").y0);
  }
}

TEST_CASE("a long title ends within the view") {
  SceneDocument document = open_document("hoop6", {});
  const std::string title(GENERATE(30u, 60u, 200u), 'n');
  document.overrides = {"solver.step=0.05", "title=\"" + title + "\""};
  PanelDriver driver(PanelDriver::small(), std::move(document));
  const plot::Rect view = driver.panel().place("view"), line = driver.panel().place("state line");
  CHECK(line.x0 >= view.x0);
  CHECK(line.x1 <= view.x1);
}

}  // namespace control_panel_test
