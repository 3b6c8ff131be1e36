// SPDX-License-Identifier: BSD-3-Clause
// Lengths and names beside a picture.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <string>

#include "core/diagnostics/diagnostics.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"
#include "render/plot/text_metrics.hpp"
#include "render/scene/film_style.hpp"
#include "render/scene/view.hpp"

using namespace unfurl;

namespace overlay_names_test {

namespace {

DrawList picture(const std::string& structure, const std::string& render) {
  const Scene scene = read_scene_text(structure + "[render]\n" + render, "ring.toml");
  const Simulation run = simulate(build_model(scene), scene.solver);
  const Diagnostics diagnostics = diagnose(run);
  FrameStyle style = film_style(scene, run, diagnostics);
  style.width = 1280, style.height = 720;
  return FrameBuilder(run.trajectory, style).build(2.0);
}

bool overlap(const TextLabel& a, const TextLabel& b) {
  return a.y < b.y + b.height && b.y < a.y + a.height;
}

const TextLabel* label(const DrawList& list, const std::string& end) {
  const auto found =
      std::ranges::find_if(list.labels, [&](const TextLabel& l) { return l.text.ends_with(end); });
  return found == list.labels.end() ? nullptr : &*found;
}

}  // namespace

TEST_CASE("dimensions of the smallest and the largest structures have powers of ten") {
  const auto dimension = [](const std::string& unit) {
    const DrawList list = picture("structure.kind = 'custom'\nvariables.L = " + unit + R"(
structure.nodes = [{name="A",position=[0,0,0]},{name="B",position=["=2*L",0,0]}]
structure.rods = [{nodes=["A","B"],mass=1}]
constraints = [{kind="fixed",nodes=["A"]}]
solver.end_time = 2
)",
                                  "dimensions = true\ntime = false\n");
    const TextLabel* text = label(list, " m");
    REQUIRE(text);
    return text->text;
  };
  CHECK(dimension("1") == "2.00 m");
  CHECK(dimension("1e4") == "20000.0 m");
  CHECK(dimension("1.25e-3") == "0.00250 m");
  CHECK(dimension("1e8") == "2\u00D710\u2078 m");
  CHECK(dimension("1.234e-6") == "2.47\u00D710\u207B\u2076 m");
}

TEST_CASE("names of nodes and rods lie on nothing else that is written") {
  const std::string structure =
      "title = 'A ring'\nstructure.kind = 'hoop'\nstructure.fold_angle = 85.0\nsolver.end_time = 3.0\n";
  for (const char* dimensions : {"false", "true"}) {
    const std::string others =
        "scale_bar = true\naxes = true\nlegend = true\ninset = 'energy_balance_J'\ndimensions = " +
        std::string(dimensions) + "\n";
    const DrawList plain = picture(structure, others),
                   named = picture(structure, others + "node_labels = true\nrod_labels = true\n");
    std::set<std::string> before;
    for (const TextLabel& l : plain.labels) before.insert(l.text);
    int names = 0;
    for (const TextLabel& l : named.labels) {
      if (before.contains(l.text)) continue;
      ++names;
      const auto wide = static_cast<float>(plot::text_width(l.text, static_cast<double>(l.height))) / 2;
      CAPTURE(l.text);
      const Inset& in = named.inset;
      CHECK((l.x + wide < in.x || l.x - wide > in.x + in.width || l.y + l.height < in.y ||
             l.y > in.y + in.height));
      for (const TextLabel& other : plain.labels) {
        const auto room = static_cast<float>(
            plot::text_width(other.text, static_cast<double>(other.height) / plot::line_height));
        const float left = other.x - other.align * room;
        CHECK((!overlap(l, other) || l.x + 0.8f * wide < left || l.x - 0.8f * wide > left + room));
      }
    }
    CHECK(names > 20);  // of 12 nodes and 24 rods
  }
}

// A body that flies at 3 m/s and falls: steps of a quarter of a second, of which dvm knows kinetic energy
// exactly, m (9 + g^2 t^2) / 2. The dot lies on the straight line between the states around its time.
TEST_CASE("the dot of an inset is where the film is between two states as well") {
  const Scene scene = read_scene_text(R"(structure.kind = 'custom'
structure.nodes = [{name="P",position=[0,0,0],velocity=[3,0,0],mass=2}]
structure.rods = []
gravity.acceleration = [0,0,-10]
solver = {step = 0.25, end_time = 1}
render.inset = 'kinetic_energy_J'
)",
                                      "s.toml");
  const Simulation run = simulate(build_model(scene), scene.solver);
  const Diagnostics diagnostics = diagnose(run);
  const FrameBuilder builder(run.trajectory, film_style(scene, run, diagnostics));
  const auto energy = [](double t) { return 9 + 100 * t * t; };
  for (const double t : {0.0, 0.1, 0.25, 0.6, 0.75 - 1e-15, 0.999, 1.0, 1.2}) {
    CAPTURE(t);
    const DrawList list = builder.build(t);
    REQUIRE(list.inset.figure);
    const auto& curves = list.inset.figure->panels[0].curves;
    REQUIRE(curves.size() == 2);
    const double shown = std::min(t, 1.0), before = 0.25 * std::floor(4 * shown), u = 4 * (shown - before);
    CHECK(curves[1].x.back() == Approx(shown));
    CHECK(curves[1].y.back() == Approx((1 - u) * energy(before) + u * energy(before + 0.25)));
    CHECK(curves[0].x.back() == curves[1].x.back());
    CHECK(curves[0].y.back() == curves[1].y.back());
  }
}

// The same picture, led to the left by 60 degrees and nearer: what is written goes with it.
TEST_CASE("names and lengths stand where the camera that is led sees what they are of") {
  const Scene scene = read_scene_text(R"(structure.kind = 'custom'
structure.nodes = [{name="A",position=[0,0,0]},{name="B",position=[2,0,0]},{name="C",position=[2,0,1]}]
structure.rods = [{nodes=["A","B"],mass=1},{nodes=["B","C"],mass=1}]
solver = {step = 0.25, end_time = 1}
render = {node_labels = true, scale_bar = true, projection = "orthographic"}
)",
                                      "s.toml");
  const Simulation run = simulate(build_model(scene), scene.solver);
  const Diagnostics diagnostics = diagnose(run);
  const FrameBuilder builder(run.trajectory, film_style(scene, run, diagnostics));
  CHECK(builder.writes_by_camera());
  Camera film;
  const DrawList led = builder.build(0.5, [&](const DrawList& list) {
    Camera camera = film = list.camera;
    const Vec3f away = camera.eye - camera.target;
    camera.eye = camera.target +
                 Vec3f(0.5f * away.x() - 0.866f * away.y(), 0.866f * away.x() + 0.5f * away.y(), away.z());
    camera.parallel_height /= 1.25f;
    return camera;
  });
  CHECK(film.eye == builder.build(0.5).camera.eye);
  CHECK(led.camera.eye != film.eye);
  const FrameStyle style = film_style(scene, run, diagnostics);
  int named = 0;
  for (std::size_t n = 0; n < 3; ++n) {
    const Vec3 at =
        builder.upright() *
        (run.trajectory.positions_at(0.5).segment<3>(3 * static_cast<Index>(n)) - builder.origin());
    const Vec3f seen = project(led.camera, style.width, style.height, at.cast<float>());
    const TextLabel* name = label(led, run.trajectory.structure().node_copies[n].name);
    if (!name) continue;
    ++named;
    CHECK(std::hypot(name->x - seen.x(), name->y - seen.y()) < 60);
  }
  CHECK(named >= 2);  // one may be left out for want of room
  // A metre is longer.
  const auto pixels_per_metre = [&](const DrawList& list) {
    const TextLabel* text = label(list, " m");
    REQUIRE(text);
    const auto bar = std::ranges::find_if(list.lines, [&](const OverlayLine& line) {
      return line.y0 == line.y1 && std::abs(0.5f * (line.x0 + line.x1) - text->x) < 0.01f;
    });
    REQUIRE(bar != list.lines.end());
    return static_cast<double>(bar->x1 - bar->x0) / std::stod(text->text);
  };
  CHECK(pixels_per_metre(led) == Approx(1.25 * pixels_per_metre(builder.build(0.5))).epsilon(1e-3));
}

}  // namespace overlay_names_test
