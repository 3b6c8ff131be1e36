// SPDX-License-Identifier: BSD-3-Clause
// The film's camera as the panel writes it.
#include <catch2/catch.hpp>
#include <cmath>

#include "render/scene/view.hpp"
#include "tests/app/panel/panel_driver.hpp"

using namespace unfurl;

namespace film_view_test {

namespace {

std::vector<CameraKey> keys_of(PanelDriver& driver) {
  return read_document(driver.state().history.now()).render.camera_keys;
}

}  // namespace

TEST_CASE("a camera key holds what the film shows where nobody turned the view") {
  PanelOptions options = PanelDriver::small();
  options.measure_errors = false;
  PanelDriver driver(options, "pendulum");
  const OrbitCamera first = driver.panel().framed();
  driver.key(Key::k);
  driver.settle();
  driver.key(Key::end);
  driver.key(Key::k);
  driver.settle();
  const std::vector<CameraKey> held = keys_of(driver);
  REQUIRE(held.size() == 2);
  CHECK(held[0].time == 0);
  CHECK(held[1].time > 1);
  // A tenth of a degree and a thousandth of the zoom are what keys are rounded to.
  CHECK(held[0].azimuth == Approx(held[1].azimuth).margin(0.11));
  CHECK(held[0].elevation == Approx(held[1].elevation).margin(0.11));
  CHECK(held[0].zoom == Approx(held[1].zoom).margin(0.0021));
  const OrbitCamera same = driver.panel().framed();
  CHECK(std::abs(same.azimuth - first.azimuth) < 2e-3f);
  CHECK(std::abs(same.elevation - first.elevation) < 2e-3f);
  CHECK(same.distance == Approx(first.distance).epsilon(0.0021));

  // One that is turned, and then one between it and the first: the film's view there stays what it was.
  driver.drag("view", 0.3, 0.6);
  REQUIRE(driver.state().orbit);
  driver.key(Key::k);
  driver.settle();
  CHECK(keys_of(driver).size() == 2);  // in place of the one at that time
  driver.state().playback.t = 0.4 * held[1].time;
  driver.frame();
  const OrbitCamera between = driver.panel().framed();
  CHECK(std::abs(between.azimuth - first.azimuth) > 0.02f);
  driver.key(Key::k);
  driver.settle();
  CHECK(keys_of(driver).size() == 3);
  const OrbitCamera after = driver.panel().framed();
  CHECK(std::abs(after.azimuth - between.azimuth) < 2e-3f);
  CHECK(std::abs(after.elevation - between.elevation) < 2e-3f);
}

TEST_CASE("the view of a moment is taken for all of a film whose camera moves") {
  PanelOptions options = PanelDriver::small();
  options.measure_errors = false;
  PanelDriver driver(options, "pendulum");
  driver.key(Key::v);
  CHECK(driver.state().message == "the film has this view already: turn it first");
  CHECK(keys_of(driver).empty());
  driver.key(Key::k);
  driver.settle();
  driver.key(Key::end);
  driver.drag("view", 0.3, 0.6);
  driver.key(Key::k);
  driver.settle();
  const OrbitCamera last = driver.panel().framed();
  driver.key(Key::v);
  driver.settle();
  CHECK(keys_of(driver).size() == 1);
  CHECK(std::abs(driver.panel().framed().azimuth - last.azimuth) < 2e-3f);
}

// Zooms are of what sees the whole motion in the picture at hand, and views are seldom as wide as films.
TEST_CASE("the view that was taken for the film stays what it was") {
  PanelOptions options = PanelDriver::small();
  options.measure_errors = false;
  for (const char* scene : {"hoop6", "scissor_mast"}) {
    INFO(scene);
    PanelDriver driver(options, scene);
    const float whole = driver.panel().framed().distance;
    for (int i = 0; i < 3; ++i) {
      driver.drag("view", i == 1 ? 0.45 : 0.55, 0.5);
      REQUIRE(driver.state().orbit);
      const float led = driver.state().orbit->distance;
      driver.key(Key::v);
      driver.settle();
      REQUIRE(keys_of(driver).size() == 1);
      // A thousandth of the zoom, which is about 1, and a tenth of a degree are what keys are rounded to.
      CHECK(driver.panel().framed().distance == Approx(led).epsilon(2e-3));
    }
    CHECK(driver.panel().framed().distance == Approx(whole).epsilon(6e-3));
  }
}

TEST_CASE("what says which run it is stands clear of the structure") {
  for (const auto& [width, height] : {std::pair{1280, 720}, {900, 600}}) {
    INFO(width);
    PanelOptions options;
    options.width = width, options.height = height;
    options.measure_errors = false;
    PanelDriver driver(options, "scissor_mast");
    const LiveRun& run = *driver.state().shown;
    const plot::Rect words = driver.panel().place("state line"), view = driver.panel().place("view");
    const auto context = make_offscreen_context();
    SceneView pictures(*context, 1);
    PanelState& state = driver.state();
    const CornerRoom room = state.view_place.heading;
    CHECK(view.x0 + room.wide * view.width() >= words.x1);
    CHECK(view.y0 + room.high * view.height() >= words.y1);
    pictures.prepare(static_cast<int>(view.width()), static_cast<int>(view.height()), state);
    const PickView pick = pictures.pick_view(state);
    const Trajectory& motion = run.simulation.trajectory;
    double highest = view.y1;
    for (std::size_t k = 0; k < motion.size(); ++k) {
      const VectorXd whole = motion.positions(k);
      for (Index i = 0; i < whole.size(); i += 3) {
        const Vec3 at = pick.upright * (whole.segment<3>(i) - pick.origin);
        const Vec3f p = project(pick.camera, pick.width, pick.height, at.cast<float>());
        if (view.x0 + static_cast<double>(p.x()) < words.x1)
          highest = std::min(highest, view.y0 + static_cast<double>(p.y()));
      }
    }
    CHECK(highest > words.y1);
    CHECK(highest < words.y1 + 0.2 * view.height());  // no farther than that asks for, with a load above it
  }
}

// 1280 x 720 pixels and more have words as large as that anyway.
TEST_CASE("words over the view grow with the window's own") {
  PanelOptions options = PanelDriver::small();
  options.measure_errors = false;
  PanelDriver driver(options, "hoop6");
  const auto context = make_offscreen_context();
  const auto height = [&](float scale) {
    SceneView view(*context, scale);
    view.prepare(800, 450, driver.state());
    for (const TextLabel& label : view.film_picture().labels)
      if (label.text == "chord") return label.height;
    return 0.0f;
  };
  CHECK(height(1) == 13);  // 21 pixels of 720, of 450
  CHECK(height(0.5f) == 13);
  CHECK(height(2) == 23);  // twice the least, 0.55 of 21
}

}  // namespace film_view_test
