// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/camera_path.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>
#include <string>
#include <tuple>

#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"
#include "render/scene/frame_builder.hpp"
#include "render/scene/view.hpp"
#include "tests/support/models.hpp"

using namespace unfurl;

namespace camera_path_test {

namespace {

constexpr int width = 640, height = 360;

Simulation ring(int units = 6) {
  const Scene scene =
      read_scene_text("structure.kind = \"hoop\"\nstructure.units = " + std::to_string(units) +
                          "\nstructure.model = \"sector\"\nstructure.fold_angle = 85.0\n"
                          "structure.hinge_force = 200.0\nsolver.step = 0.02\nsolver.end_time = 30.0\n",
                      "ring.toml");
  return simulate(build_model(scene), scene.solver);
}

FrameBuilder builder(const Simulation& run, const RenderOptions& options) {
  FrameStyle style;
  style.width = width, style.height = height;
  style.options = options;
  return {run.trajectory, style};
}

// The smallest distance [pixels] of any joint from an edge in this picture.
double margin(const DrawList& list) {
  double least = 1e9;
  for (const Tube& tube : list.tubes)
    for (const Vec3f& end : {tube.a, tube.b}) {
      const Vec3f p = project(list.camera, width, height, end);
      if (p.z() <= list.camera.near_plane || p.z() >= list.camera.far_plane) return -1;
      least = std::min<double>({least, p.x(), width - p.x(), p.y(), height - p.y()});
    }
  return least;
}

Vec3f direction(const Camera& camera) {
  return (camera.eye - camera.target).normalized();
}

}  // namespace

TEST_CASE("a preset looks from where it says, with all of the motion in the picture") {
  const Simulation run = ring(GENERATE(3, 6, 24));
  const auto [name, x, y, z] = GENERATE(table<std::string, float, float, float>(
      {{"front", 0.f, -1.f, 0.f}, {"side", 1.f, 0.f, 0.f}, {"top", 0.f, 0.f, 1.f}, {"iso", 1.f, -1.f, 1.f}}));
  RenderOptions options;
  options.camera = name;
  options.projection = GENERATE("perspective", "orthographic");
  const FrameBuilder frames = builder(run, options);
  CHECK((direction(frames.camera()) - Vec3f(x, y, z).normalized()).norm() < 1e-5f);
  INFO(name << " " << options.projection);
  for (const double share : {0.0, 0.5, 0.8, 1.0})
    CHECK(margin(frames.build(share * run.trajectory.end_time())) > 0.03 * height);
  // And they fill it: folded it is tall, unfolded it is wide.
  CHECK(std::min(margin(frames.build(0)), margin(frames.build(run.trajectory.end_time()))) < 0.25 * height);
}

TEST_CASE("in a parallel projection a length has the same pixels everywhere") {
  Camera camera;
  camera.eye = {0, -10, 4};
  camera.target = {0, 0, 0};
  camera.parallel_height = 5;
  const Vec3f right(1, 0, 0);
  for (const Vec3f& p : {Vec3f(0, 0, 0), Vec3f(1, 7, -2), Vec3f(-2, -5, 1)}) {
    const Vec3f a = project(camera, width, height, p), b = project(camera, width, height, p + right);
    CHECK((b - a).head<2>().norm() == Approx(height / 5.0).epsilon(1e-5));
  }
}

TEST_CASE("an orbit turns by its angle, keeps its distance and the motion in the picture") {
  const Simulation run = ring();
  RenderOptions options;
  options.orbit = 360;
  const FrameBuilder frames = builder(run, options);
  const double end = run.trajectory.end_time();
  const auto camera = [&](double u) { return frames.build(Shot{u * end, u, 0}).camera; };
  CHECK((camera(0).eye - camera(1).eye).norm() < 1e-4f * camera(0).eye.norm());
  Vec3f quarter = direction(camera(0));
  quarter = Vec3f(-quarter.y(), quarter.x(), quarter.z());
  CHECK((direction(camera(0.25)) - quarter).norm() < 1e-5f);
  for (double u = 0; u <= 1; u += 0.1) CHECK(margin(frames.build(Shot{u * end, u, 0})) > 0.03 * height);
}

TEST_CASE("a camera that follows has every pose in the picture, larger than one that stands still") {
  const Simulation run = ring();
  RenderOptions options;
  const FrameBuilder still = builder(run, options);
  options.follow = true;
  const FrameBuilder frames = builder(run, options);
  const double end = run.trajectory.end_time();
  for (double u = 0; u <= 1; u += 0.04) CHECK(margin(frames.build(u * end)) > 0.03 * height);
  const auto tall = [&](const FrameBuilder& b) {
    const DrawList list = b.build(0);
    float low = 1e9f, high = -1e9f;
    for (const Ball& ball : list.balls) {
      const float y = project(list.camera, width, height, ball.center).y();
      low = std::min(low, y), high = std::max(high, y);
    }
    return high - low;
  };
  CHECK(tall(frames) > 1.2f * tall(still));
}

TEST_CASE("camera keys are passed at their times") {
  const Simulation run = ring();
  RenderOptions options;
  options.camera_keys = {{0.5, -90, 0, 1}, {1.5, 0, 30, 2}, {2.0, 90, 60, 1}};
  const FrameBuilder frames = builder(run, options);
  const Vec3f center = frames.build(0).camera.target;
  for (const CameraKey& key : options.camera_keys) {
    const Camera camera = frames.build(key.time).camera;
    const double azimuth = key.azimuth * radians_per_degree, elevation = key.elevation * radians_per_degree;
    const Vec3f wanted(static_cast<float>(std::cos(azimuth) * std::cos(elevation)),
                       static_cast<float>(std::sin(azimuth) * std::cos(elevation)),
                       static_cast<float>(std::sin(elevation)));
    CHECK((direction(camera) - wanted).norm() < 1e-5f);
  }
  const float plain = (frames.build(0.5).camera.eye - center).norm();
  CHECK((frames.build(1.5).camera.eye - center).norm() == Approx(plain / 2).epsilon(1e-4));
  CHECK((frames.build(0.0).camera.eye - frames.build(0.5).camera.eye).norm() <
        1e-5f);  // rests before the first
  // From where a camera without keys would look does nothing, neither to the distance.
  const Simulation pendulum =
      simulate(testing::make_model(testing::double_pendulum()), testing::dvm_options(3, 0.02, 2));
  std::optional<Vec3f> eye;
  for (const char* camera : {"auto", "iso", "front", "top"}) {
    CAPTURE(camera);
    options.camera = camera;
    const Vec3f here = builder(pendulum, options).build(1.0).camera.eye;
    CHECK(here == eye.value_or(here));
    eye = here;
  }
}

// Equal keys stay equal between their times, and no key is overshot on the way to one that is like it.
TEST_CASE("between two camera keys the camera never goes beyond either") {
  const Simulation run = ring();
  RenderOptions options;
  options.camera_keys = {{0, 0, 80, 1}, {1, 0, 90, 1}, {2, 90, 90, 20}};
  const FrameBuilder frames = builder(run, options);
  const auto distance = [&](double t) {
    const Camera camera = frames.build(t).camera;
    return (camera.eye - camera.target).norm();
  };
  const float whole = distance(0);
  float nearest = whole;
  for (int k = 0; k <= 40; ++k) {
    const double t = 0.05 * k;
    INFO(t);
    CHECK(distance(t) <= whole * 1.0001f);  // rounding of single precision
    CHECK(distance(t) >= whole / 20 * 0.9999f);
    if (t <= 1) CHECK(distance(t) == Approx(whole).epsilon(1e-4));
    CHECK(distance(t) <= nearest * 1.0001f);  // towards the last key, never back
    nearest = std::min(nearest, distance(t));
    if (t <= 1) CHECK(std::abs(direction(frames.build(t).camera).y()) < 1e-5f);  // not turned yet
  }
}

TEST_CASE("turntable and hold come after the motion") {
  const Simulation run = ring();
  RenderOptions options;
  options.fps = 10;
  options.hold = 0;
  const auto motion = film_shots(run.trajectory, options);
  options.turntable = 2;
  options.hold = 0.5;
  const auto shots = film_shots(run.trajectory, options);
  REQUIRE(shots.size() == motion.size() + 20 + 5);
  CHECK(shots[motion.size() + 9].turn == Approx(0.5));
  CHECK(shots.back().turn == 1.0);
  CHECK(shots.back().t == run.trajectory.end_time());
}

TEST_CASE("an even pace shows equal shares of the deployment, and the time's pace equal times") {
  const Simulation run = ring();
  const Trajectory& motion = run.trajectory;
  const Deployment& deployment = motion.structure().deployment;
  REQUIRE(!deployment.empty());
  RenderOptions options;
  options.fps = 24;
  options.hold = 0;
  const std::size_t count = film_shots(motion, options).size();
  options.pace = "even";
  const auto shots = film_shots(motion, options);
  CHECK(shots.size() == count);
  const auto fraction = [&](double t) {
    return deployment.fraction(motion.node_positions(motion.state_before(t)));
  };
  // Between two states the fraction is taken to be linear, and a thousandth of the film is for what rests:
  // together less than the largest step of the fraction from state to state, 0.03 here.
  for (std::size_t k = 0; k + 1 < shots.size(); ++k)
    CHECK(std::abs(fraction(shots[k].t) - static_cast<double>(k) / static_cast<double>(shots.size() - 1)) <
          0.035);
  options.pace = "time";
  options.easing = 0.5;
  const auto eased = film_shots(motion, options);
  CHECK(eased.size() == count + 12);  // half a second
  const auto step = [&](std::size_t k) { return eased[k + 1].t - eased[k].t; };
  CHECK(step(0) < 0.01 * options.speed / options.fps);
  CHECK(step(eased.size() - 3) < 0.05 * options.speed / options.fps);
  CHECK(step(eased.size() / 2) == Approx(options.speed / options.fps).epsilon(1e-9));
}

TEST_CASE("a film begins with its card and its first picture, and its last one stays") {
  const Simulation run = ring();
  RenderOptions options;
  options.fps = 10;
  options.title_card = 0.7;
  options.hold_start = 0.4;
  const auto shots = film_shots(run.trajectory, options);
  for (std::size_t k = 0; k < 11; ++k) {
    CHECK(shots[k].card == (k < 7));
    CHECK(shots[k].t == run.trajectory.start_time());
  }
  CHECK(shots[12].t > shots[11].t);
  CHECK(shots[shots.size() - 11] == shots.back());  // a second, by default
  CHECK(shots[shots.size() - 12].t < shots.back().t);
}

TEST_CASE("the picture of a time is the one that the film has of it, whatever the pace") {
  const Simulation run = ring();
  RenderOptions options;
  options.fps = 10;
  options.title_card = options.hold_start = options.turntable = 0.5;
  options.motion_blur = 0.4;
  for (const auto& [pace, easing] :
       {std::pair("time", 0.0), std::pair("time", 0.5), std::pair("even", 0.3)}) {
    options.pace = pace;
    options.easing = easing;
    const auto shots = film_shots(run.trajectory, options);
    for (std::size_t k = 10; k + 15 < shots.size(); ++k) {  // the motion
      const Shot at = shot_at(run.trajectory, options, shots[k].t);
      CHECK(at == shots[k]);
      const double middle = 0.5 * (shots[k].t + shots[k + 1].t);
      const Shot between = shot_at(run.trajectory, options, middle);
      CHECK(between.t == middle);
      CHECK(between.progress == Approx(0.5 * (shots[k].progress + shots[k + 1].progress)).margin(1e-12));
    }
    CHECK(shot_at(run.trajectory, options, run.trajectory.end_time()) == Shot{run.trajectory.end_time(), 1});
  }
}

TEST_CASE("a camera that follows while it turns has every pose in the picture, larger at the start") {
  const Simulation run = ring();
  RenderOptions options;
  options.orbit = 70;
  const double start = run.trajectory.start_time();
  const auto size_at = [&](const FrameBuilder& frames, double t) {
    const DrawList list = frames.build(t);
    float low = 1e9f, high = -1e9f;
    for (const Tube& tube : list.tubes)
      for (const Vec3f& end : {tube.a, tube.b}) {
        const Vec3f p = project(list.camera, 1280, 720, end);
        CHECK(p.x() > 0);
        CHECK(p.x() < 1280);
        CHECK(p.y() > 0);
        CHECK(p.y() < 720);
        low = std::min(low, p.y()), high = std::max(high, p.y());
      }
    return high - low;
  };
  const float plain = size_at(builder(run, options), start);
  options.follow = true;
  const FrameBuilder frames = builder(run, options);
  CHECK(size_at(frames, start) > 1.3f * plain);
  for (const double share : {0.3, 0.7, 0.9, 1.0}) size_at(frames, share * run.trajectory.end_time());
}

// A rod that turns once a second: a ninth of the camera's window is a whole number of its turns.
TEST_CASE("a camera that follows while it turns has what turns fast in the picture") {
  const Scene scene = read_scene_text(
      "[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'A'\nposition = [0, 0, 0]\nfixed = true\n"
      "[[structure.nodes]]\nname = 'B'\nposition = [1, 0, 0]\nvelocity = [0, 0, 6.283185307179586]\n"
      "[[structure.rods]]\nnodes = ['A', 'B']\nmass = 1\n[solver]\nend_time = 42\nstep = 0.02\n",
      "spin.toml");
  const Simulation run = simulate(build_model(scene), scene.solver);
  RenderOptions options;
  options.orbit = 20;
  options.follow = true;
  const FrameBuilder frames = builder(run, options);
  for (double t = 0; t <= 42; t += 0.37) {
    CAPTURE(t);
    CHECK(margin(frames.build(t)) > 0.02 * height);
  }
}

TEST_CASE("whatever heights camera keys pass, all is in the picture") {
  // A mast is small from above and tall from beside it; a rod that leans by 45 degrees is longest from there.
  const std::string
      mast =
          "[structure]\nkind = 'scissor_mast'\ncells = 12\nsides = 4\nfold_angle = 60\n[solver]\n"
          "end_time = 3\nstep = 0.02\n",
      leaning =
          "[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'A'\nposition = [0, -2, -2]\n"
          "fixed = true\n[[structure.nodes]]\nname = 'B'\nposition = [0, 2, 2]\n"
          "velocity = [0.1, 0, 0]\n[[structure.rods]]\nnodes = ['A', 'B']\nmass = 1\n[solver]\n"
          "end_time = 3\nstep = 0.02\n";
  for (const std::string& text : {mast, leaning}) {
    const Scene scene = read_scene_text(text, "keys.toml");
    const Simulation run = simulate(build_model(scene), scene.solver);
    const double end = run.trajectory.end_time();
    RenderOptions options;
    options.loads = false;
    options.camera_keys = {{0, -90, 0, 1}, {end, -90, 90, 1}};
    for (const char* projection : {"perspective", "orthographic"})
      for (const bool follow : {false, true}) {
        options.projection = projection;
        options.follow = follow;
        const FrameBuilder frames = builder(run, options);
        for (double u = 0; u <= 1; u += 0.05) {
          CAPTURE(text, projection, follow, u);
          CHECK(margin(frames.build(u * end)) > 0.02 * height);
        }
      }
  }
}

namespace {

// Three rods of 1 m around a triangle that flies along y, through the place where y = 0 at the time 1 s.
Simulation flight(double speed) {
  const std::string v = std::to_string(speed), start = std::to_string(-speed);
  std::string text = "[solver]\nend_time = 2\nstep = 0.01\n[structure]\nkind = 'custom'\nnodes = [";
  for (const auto& [name, x, z] : {std::tuple("A", "-0.5", "0.1"), {"B", "0.5", "0.1"}, {"C", "0", "0.966"}})
    text += std::string("{name='") + name + "', position=[" + x + "," + start + "," + z + "], velocity=[0," +
            v + ",0]},";
  text += "]\nrods = [{nodes=['A','B'],mass=1},{nodes=['B','C'],mass=1},{nodes=['C','A'],mass=1}]\n";
  const Scene scene = read_scene_text(text, "flight.toml");
  return simulate(build_model(scene), scene.solver);
}

float apart(const Camera& camera, const Vec3f& a, const Vec3f& b) {
  return (project(camera, width, height, b) - project(camera, width, height, a)).head<2>().norm();
}

}  // namespace

TEST_CASE("a camera that follows a flight keeps its direction and what flies in the picture") {
  for (const double speed : {100.0, -100.0, 3000.0}) {
    const Simulation run = flight(speed);
    RenderOptions options;
    options.follow = true;
    for (const char* camera : {"front", "auto", "side"})
      for (const char* projection : {"perspective", "orthographic"})
        for (const double orbit : {0.0, 1e-3})  // degrees: the cameras that turn, without a turn to speak of
          for (const bool dimensions : {false, true}) {
            options.camera = camera;
            options.projection = projection;
            options.orbit = orbit;
            options.dimensions = dimensions;
            const FrameBuilder frames = builder(run, options);
            const Vec3f first = direction(frames.build(0).camera);
            for (double t = 0; t <= 2; t += 0.1) {
              CAPTURE(speed, camera, projection, orbit, dimensions, t);
              const DrawList list = frames.build(t);
              CHECK(margin(list) > 0);
              // 1e-3 degrees are 2e-5.
              CHECK((direction(list.camera) - first).norm() < 1e-4f);
            }
          }
  }
}

TEST_CASE("the scale bar of a camera that follows is that of what it follows") {
  const Simulation run = flight(100);
  RenderOptions options;
  options.follow = options.scale_bar = true;
  options.camera = "front";
  for (const double t : {0.0, 0.4, 1.7, 2.0}) {
    const DrawList list = builder(run, options).build(t);
    const auto text = std::ranges::find_if(
        list.labels, [](const TextLabel& label) { return label.text.ends_with(" m in the middle"); });
    REQUIRE(text != list.labels.end());
    const auto bar = std::ranges::find_if(list.lines, [&](const OverlayLine& line) {
      return line.y0 == line.y1 && std::abs(0.5f * (line.x0 + line.x1) - text->x) < 0.01f;
    });
    REQUIRE(bar != list.lines.end());
    const auto y = static_cast<float>(100 * (t - 1));
    const float metre = apart(list.camera, {-0.5f, y, 0}, {0.5f, y, 0});
    CHECK((bar->x1 - bar->x0) / std::stof(text->text) == Approx(metre).epsilon(1e-3));
  }
}

// In an even flight, away from its ends, as much of the way within the window is before what flies as behind
// it: the middle of the picture is where that is. The run's states are 1 m apart, the camera some 20 m away:
// to 5 %.
TEST_CASE("zoom in a camera that follows is about what it follows") {
  const Simulation run = flight(100);
  RenderOptions options;
  options.follow = true;
  options.camera = "front";
  const auto metre = [&](double zoom, double t) {
    options.zoom = zoom;
    const auto y = static_cast<float>(100 * (t - 1));
    return apart(builder(run, options).build(t).camera, {-0.5f, y, 0}, {0.5f, y, 0});
  };
  for (const double t : {0.5, 1.5}) CHECK(metre(1.7, t) == Approx(1.7 * metre(1, t)).epsilon(0.05));
}

}  // namespace camera_path_test
