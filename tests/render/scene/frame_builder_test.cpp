// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/frame_builder.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"
#include "render/plot/text_metrics.hpp"
#include "render/plot/ticks.hpp"
#include "render/scene/view.hpp"

using namespace unfurl;

namespace frame_builder_test {

namespace {

const std::string ring = R"(
[structure]
kind = "hoop"
units = 6
fold_angle = 85.0
hinge_force = 200.0
[solver]
step = 0.02
end_time = 10.0
)";

const std::string pendulum = R"(
[[structure.nodes]]
name = "P"
position = [0, 0, 0]
fixed = true
[[structure.nodes]]
name = "E"
position = [1, 0, 0]
velocity = VELOCITY
[[structure.rods]]
nodes = ["P", "E"]
mass = 1.0
[structure]
kind = "custom"
[gravity]
acceleration = GRAVITY
[solver]
step = 0.02
end_time = 2.0
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

Simulation run(const std::string& text) {
  const Scene scene = read_scene_text(text, "test.toml");
  return simulate(build_model(scene), scene.solver);
}

// The smallest distance [pixels] of any node, at any state, from the nearest edge of the picture.
double margin(const Trajectory& trajectory, const FrameBuilder& builder, int width, int height) {
  double least = 1e9;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const VectorXd q = trajectory.positions(i);
    for (Index k = 0; k < q.size() / 3; ++k) {
      const Vec3 x = builder.upright() * q.segment<3>(3 * k);
      const Vec3f p = project(builder.camera(), width, height, x.cast<float>());
      if (p.z() <= builder.camera().near_plane) return -1;
      least = std::min({least, static_cast<double>(p.x()), width - static_cast<double>(p.x()),
                        static_cast<double>(p.y()), height - static_cast<double>(p.y())});
    }
  }
  return least;
}

}  // namespace

TEST_CASE("the whole motion of a ring stays inside the picture, whatever its shape") {
  const Simulation result = run(ring);
  REQUIRE(result.status == RunStatus::deployed);
  const auto [width, height] = GENERATE(std::pair{1280, 720}, std::pair{400, 400}, std::pair{360, 640});
  const FrameBuilder builder(result.trajectory, {width, height, "Ring", true, true});
  const double least = margin(result.trajectory, builder, width, height);
  CHECK(least > 0.05 * std::min(width, height));
  CHECK(least < 0.30 * std::min(width, height));  // and fills it
}

TEST_CASE("parts of the ring are all there, coloured by group, and stay above the floor") {
  const Simulation result = run(ring);
  const FrameBuilder builder(result.trajectory, {1280, 720, "Ring", true, true});
  for (const double share : {0.0, 0.5, 0.9, 1.0}) {
    const DrawList list = builder.build(share * result.trajectory.end_time());
    CHECK(list.tubes.size() == 30);
    CHECK(list.sleeves.size() >= 60);  // an end's fitting, and pins
    CHECK(list.balls.size() == 12);    // where a post and two faces meet; hinges between two chords have none
    CHECK(list.arrows.size() == 12);
    for (const Ball& ball : list.balls) {
      CHECK(ball.center.z() - ball.radius > list.ground.z);
      CHECK((ball.center - list.center).norm() + ball.radius <= list.radius);
    }
  }
  const DrawList list = builder.build(0);
  std::size_t posts = 0;
  for (const Tube& tube : list.tubes)
    posts += tube.color.r == group_color(1).r && tube.color.b == group_color(1).b;
  CHECK(posts == 6);
}

TEST_CASE("joints are where the trajectory says at that time") {
  const Simulation result = run(ring);
  const FrameBuilder builder(result.trajectory, {1280, 720, "", true, true});
  const double t = 0.617 * result.trajectory.end_time();
  const VectorXd q = result.trajectory.positions_at(t);
  const DrawList list = builder.build(t);
  const auto& copies = result.trajectory.structure().node_copies;
  std::size_t ball = 0;
  for (std::size_t i = 0; i < copies.size(); ++i) {
    if (copies[i].name.front() == 'M') continue;  // hinges of two chords
    // The ring is some 6 m in size: single precision holds it to 1e-6 m.
    CHECK((list.balls[ball++].center.cast<double>() - q.segment<3>(3 * static_cast<Index>(i))).norm() < 1e-6);
  }
  CHECK(ball == list.balls.size());
}

TEST_CASE("title, time and deployed fraction are written") {
  const Simulation result = run(ring);
  const FrameBuilder builder(result.trajectory, {1280, 720, "Ring", true, true});
  const auto texts = [&](double t) {
    std::string all;
    for (const TextLabel& label : builder.build(t).labels) all += label.text + "|";
    return all;
  };
  CHECK_THAT(texts(0), Catch::StartsWith("Ring|rods drawn ") &&
                           Catch::Contains("as thick|t = 0.00 s    deployed 0 %|"));
  CHECK_THAT(texts(1e9), Catch::Contains("deployed 100 %"));  // after the end: the end
  FrameStyle bare;
  bare.labels = bare.loads = false;
  const DrawList list = FrameBuilder(result.trajectory, bare).build(0);
  CHECK(list.labels.empty());
  CHECK(list.arrows.empty());
}

TEST_CASE("a sector model shows the whole ring and the same deployed fraction") {
  const Simulation full = run(ring);
  const Simulation sector = run(replaced(ring, "units = 6", "units = 6\nmodel = \"sector\""));
  const DrawList a = FrameBuilder(full.trajectory, {}).build(2.0);
  const DrawList b = FrameBuilder(sector.trajectory, {}).build(2.0);
  CHECK(b.tubes.size() == a.tubes.size());
  CHECK(b.arrows.size() == a.arrows.size());
  REQUIRE(!a.labels.empty());
  CHECK(b.labels[0].text == a.labels[0].text);
}

TEST_CASE("gravity points down in the picture, whatever axis the scene chose") {
  const std::string gravity =
      GENERATE("[0, 0, -9.81]", "[0, -9.81, 0]", "[0, 9.81, 0]", "[-5, 0, -8]", "[0, 0, 9.81]");
  const Simulation result = run(replaced(replaced(pendulum, "GRAVITY", gravity), "VELOCITY", "[0, 0, 0]"));
  const FrameBuilder builder(result.trajectory, {});
  const Vec3 down = builder.upright() * result.trajectory.structure().gravity;
  CHECK(down.z() == Approx(-down.norm()).epsilon(1e-12));
  CHECK(std::abs(builder.upright().determinant() - 1) < 1e-12);  // turned, not mirrored
  CHECK(margin(result.trajectory, builder, 1280, 720) > 36);
}

TEST_CASE("a motion in a plane is seen nearly along its normal") {
  const Simulation result =
      run(replaced(replaced(pendulum, "GRAVITY", "[0, 0, -9.81]"), "VELOCITY", "[0, 0, -1]"));
  const FrameBuilder builder(result.trajectory, {});
  const Vec3f view = (builder.camera().target - builder.camera().eye).normalized();
  CHECK(std::abs(view.dot(Vec3f::UnitY())) > std::cos(25 * radians_per_degree));
  CHECK(std::abs(view.dot(Vec3f::UnitY())) < std::cos(10 * radians_per_degree));  // but not flat on
  CHECK(margin(result.trajectory, builder, 1280, 720) > 36);
}

TEST_CASE("a structure that rests is framed as well") {
  const Simulation result =
      run(replaced(replaced(pendulum, "GRAVITY", "[0, 0, 0]"), "VELOCITY", "[0, 0, 0]"));
  const FrameBuilder builder(result.trajectory, {});
  CHECK(margin(result.trajectory, builder, 1280, 720) > 36);
  CHECK(builder.camera().eye.allFinite());
}

TEST_CASE("frames come at the film's rate and the last one shows the end") {
  const Simulation result =
      run(replaced(replaced(pendulum, "GRAVITY", "[0, 0, -9.81]"), "VELOCITY", "[0, 0, 0]"));
  REQUIRE(result.trajectory.end_time() == Approx(2.0));
  const std::vector<double> times = frame_times(result.trajectory, 25, 1);
  REQUIRE(times.size() == 51);  // 2 s: 50 gaps
  CHECK(times[1] == Approx(0.04));
  CHECK(times.back() == result.trajectory.end_time());
  const std::vector<double> slow = frame_times(result.trajectory, 25, 0.3);
  CHECK(slow[1] == Approx(0.012));
  CHECK(slow.back() == result.trajectory.end_time());
  CHECK(slow[slow.size() - 2] < slow.back());
}

TEST_CASE("rods drawn thicker than they are say by how much, and rod_scale = 1 draws them as they are") {
  const Simulation r = run(ring);
  const double own = std::sqrt(9e-4 / pi);  // of the section's area, 9e-4 m^2
  const auto drawn = [&](double rod_scale, double& radius) {
    FrameStyle style;
    style.options.rod_scale = rod_scale;
    const DrawList list = FrameBuilder(r.trajectory, style).build(0.0);
    radius = static_cast<double>(list.tubes.at(0).radius);
    std::string note;
    for (const TextLabel& label : list.labels)
      if (label.text.find("rods drawn") != std::string::npos) note += label.text;
    return note;
  };
  double radius = 0;
  CHECK(drawn(1.0, radius).empty());
  CHECK(radius == Approx(own));
  CHECK(drawn(3.0, radius) == "rods drawn 3.0 \u00D7 as thick");
  CHECK(radius == Approx(3 * own));
  CHECK(drawn(0.02, radius) == "rods drawn 0.02 \u00D7 as thick");
  const std::string note = drawn(0.0, radius);
  REQUIRE(radius > 1.5 * own);  // a ring of 12 m, seen whole
  char factor[32];
  std::snprintf(factor, sizeof factor, "%.1f", radius / own);
  CHECK(note == "rods drawn " + std::string(factor) + " \u00D7 as thick");
}

TEST_CASE(
    "dimension lines and their numbers stay inside the picture and off what is written in its corners") {
  const Simulation r = run(ring);
  for (const char* camera : {"auto", "front", "side", "iso"}) {
    FrameStyle style;
    style.options.dimensions = true;
    style.options.camera = camera;
    const FrameBuilder with(r.trajectory, style);
    style.options.dimensions = false;
    const FrameBuilder without(r.trajectory, style);
    for (const double share : {0.0, 0.4, 0.8, 1.0}) {
      INFO(camera << " at " << share);
      const DrawList list = with.build(share * r.trajectory.end_time());
      const std::size_t plain = without.build(share * r.trajectory.end_time()).lines.size();
      REQUIRE(list.lines.size() > plain);
      for (const OverlayLine& line : list.lines)
        for (const auto& [x, y] : {std::pair(line.x0, line.y0), std::pair(line.x1, line.y1)}) {
          CHECK(x > 0);
          CHECK(x < 1280);
          CHECK(y > 0);
          CHECK(y < 720 - 51);  // the legend and the time: an edge of 30 and a line of 21 pixels
        }
    }
  }
}

TEST_CASE("the number of a dimension line stands where neither rods nor arrows are") {
  const Scene scene = read_scene_file(find_scene("hoop6"), {"render.look=blueprint", "render.hold=0"});
  const Simulation r = simulate(build_model(scene), scene.solver);
  for (const auto& size : {std::pair(960, 600), std::pair(480, 800), std::pair(1280, 720)}) {
    const auto width = size.first, height = size.second;
    FrameStyle style;
    style.width = width, style.height = height;
    style.options = scene.render;
    const FrameBuilder frames(r.trajectory, style);
    for (const double t :
         {4.5, 4.7, 4.9}) {  // open: in 4.9 s of 960 x 600 pixels an arrow points at the middle of one
      const DrawList list = frames.build(t);
      std::vector<Vec3f> drawn;
      const auto add = [&](const Vec3f& a, const Vec3f& b) {
        for (int k = 0; k <= 50; ++k)
          drawn.push_back(project(list.camera, width, height, a + 0.02f * static_cast<float>(k) * (b - a)));
      };
      for (const Tube& tube : list.tubes) add(tube.a, tube.b);
      for (const Arrow& arrow : list.arrows) add(arrow.tail, arrow.head);
      int numbers = 0;
      for (const TextLabel& label : list.labels) {
        if (!label.text.ends_with(" m")) continue;
        ++numbers;
        CAPTURE(label.text, width, height, t);
        const float half =
            0.3f * label.height * static_cast<float>(label.text.size());  // at least as wide as its letters
        CHECK(std::ranges::none_of(drawn, [&](const Vec3f& p) {
          return std::abs(p.x() - label.x) < half && p.y() > label.y && p.y() < label.y + label.height;
        }));
      }
      CHECK(numbers >= 2);  // an upright one may be too short for its own
    }
  }
}

TEST_CASE("arrows of loads stay apart where they crowd") {
  const Scene scene = read_scene_file(find_scene("hoop6"));
  const Simulation r = simulate(build_model(scene), scene.solver);
  const FrameBuilder frames(r.trajectory, {});
  const std::vector<Arrow> open = frames.build(r.trajectory.end_time()).arrows;
  REQUIRE(open.size() == 12);
  for (const double t : {0.0, 3.0, 4.0}) {
    const std::vector<Arrow> arrows = frames.build(t).arrows;
    REQUIRE(arrows.size() == open.size());
    for (std::size_t i = 0; i < arrows.size(); ++i) {
      CHECK(arrows[i].radius <= open[i].radius);
      CHECK(arrows[i].radius >= 0.99f * open[i].radius / 3);
      for (std::size_t k = 0; k < arrows.size();
           ++k) {  // shafts of one sense do not touch, unless as thin as may be
        const bool alike = (arrows[i].head - arrows[i].tail).dot(arrows[k].head - arrows[k].tail) > 0;
        if (i != k && alike && arrows[i].radius > 0.34f * open[i].radius)
          CHECK((arrows[i].tail - arrows[k].tail).norm() > arrows[i].radius + arrows[k].radius);
      }
    }
  }
  CHECK(frames.build(0).arrows[0].radius < 0.5f * open[0].radius);  // stowed, millimetres apart
}

TEST_CASE("a picture of what is far from the origin is that of the same beside it") {
  // The motions differ by the round-off of coordinates of 2e6 m, 2e-10 m; single precision by 6e-6 of the
  // size, some hundredths of a pixel at most.
  const auto fallen = [](const std::string& at) {
    return run(
        replaced(replaced(replaced(replaced(pendulum, "VELOCITY", "[0, 0.7, 0]"), "GRAVITY", "[0, -1, -9]"),
                          "[0, 0, 0]", at.empty() ? "[0, 0, 0]" : "[1e6, 2e6, -3e5]"),
                 "[1, 0, 0]", at.empty() ? "[1, 0, 0]" : "[1000001, 2e6, -3e5]"));
  };
  const Simulation near = fallen(""), far = fallen("far");
  FrameStyle style;
  style.options.dimensions = style.options.node_labels = true;
  style.options.ghosts = 3;
  style.options.projection = GENERATE("perspective", "orthographic");
  style.trails = {1};
  const FrameBuilder there(far.trajectory, style), here(near.trajectory, style);
  CHECK(here.origin().isZero());
  CHECK((there.origin() - Vec3(1e6, 2e6, -3e5)).norm() < 100);
  for (const double t : {0.0, 0.31, 2.0}) {
    const DrawList a = here.build(t), b = there.build(t);
    const auto same = [&](const Vec3f& p, const Vec3f& q) {
      const Vec3f x = project(a.camera, 1280, 720, p), y = project(b.camera, 1280, 720, q);
      return (x - y).head<2>().norm() < 0.05f;
    };
    REQUIRE(a.tubes.size() == b.tubes.size());
    REQUIRE(a.ghosts.size() == b.ghosts.size());
    REQUIRE(a.labels.size() == b.labels.size());
    for (std::size_t k = 0; k < a.tubes.size(); ++k)
      CHECK((same(a.tubes[k].a, b.tubes[k].a) && same(a.tubes[k].b, b.tubes[k].b)));
    for (std::size_t k = 0; k < a.ghosts.size(); ++k) CHECK(same(a.ghosts[k].b, b.ghosts[k].b));
    for (std::size_t k = 0; k < a.labels.size(); ++k) CHECK(a.labels[k].text == b.labels[k].text);
  }
}

TEST_CASE("a dimension line says its length to three digits, however small it is") {
  const double size = GENERATE(1.0, 1e-2, 1e-4);
  const Simulation r =
      run(replaced(replaced(replaced(pendulum, "VELOCITY", "[0, 0, 0]"), "GRAVITY", "[0, 0, 0]"), "[1, 0, 0]",
                   "[" + std::to_string(1.44 * size) + ", 0, 0]"));
  FrameStyle style;
  style.options.dimensions = true;
  std::string text;
  for (const TextLabel& label : FrameBuilder(r.trajectory, style).build(0).labels)
    if (label.text.ends_with(" m")) text = label.text;
  INFO(text);
  if (size < 1e-3)
    CHECK(text == "1.44\u00D710" + plot::superscript(-4) + " m");
  else
    CHECK(std::stod("0" + text) == Approx(1.44 * size).epsilon(1e-9));
}

namespace {

// The words of a card's lines; each line is inside the picture and below the one before.
std::string words_of_card(const DrawList& list, const FrameStyle& style) {
  std::string words;
  float bottom = 0;
  for (const TextLabel& label : list.labels) {
    const auto wide = static_cast<float>(
        plot::text_width(label.text, static_cast<double>(label.height) / plot::line_height));
    CHECK(wide <= static_cast<float>(style.width));
    CHECK(label.y >= bottom);
    bottom = label.y + label.height;
    words += (words.empty() ? "" : " ") + label.text;
  }
  CHECK(bottom <= static_cast<float>(style.height));
  return words;
}

}  // namespace

TEST_CASE("a title card has the whole title in letters that can be read and its rule below") {
  const Simulation r = run(ring);
  const auto [width, height] = GENERATE(std::pair(320, 180), std::pair(1280, 720), std::pair(360, 640));
  FrameStyle style;
  style.width = width, style.height = height;
  for (const char* title :
       {"A short title",
        "A mast of two hundred units, which opens along its axis in free fall, with its hinges "
        "rubbing and its cables slack, until it meets the latches of its last bay"}) {
    style.title = title;
    Shot card;
    card.card = true;
    const DrawList list = FrameBuilder(r.trajectory, style).build(card);
    CAPTURE(width, height, title);
    REQUIRE_FALSE(list.labels.empty());
    CHECK(words_of_card(list, style) == title);
    CHECK(list.labels.front().height >= 7);  // pixels: smaller letters are not told apart
    REQUIRE(list.areas.size() == 1);
    CHECK(list.areas[0].y0 > list.labels.back().y + 0.9f * list.labels.back().height);
    CHECK(list.areas[0].y1 - list.areas[0].y0 > 0);
  }
  style.title.clear();
  for (int k = 0; k < 400; ++k) style.title += "without end ";
  Shot card;
  card.card = true;
  CHECK(words_of_card(FrameBuilder(r.trajectory, style).build(card), style).ends_with("\u2026"));
}

}  // namespace frame_builder_test
