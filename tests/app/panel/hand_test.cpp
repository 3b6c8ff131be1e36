// SPDX-License-Identifier: BSD-3-Clause
// A hand on the structure: pulling nodes, wiggling, building.
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "app/panel/document/build_edits.hpp"
#include "core/scene/build.hpp"
#include "core/scene/write_back.hpp"
#include "render/scene/view.hpp"
#include "tests/app/panel/panel_driver.hpp"

using namespace unfurl;

namespace hand_test {

namespace {

PanelOptions quick() {
  PanelOptions options = PanelDriver::small();
  options.measure_errors = false;
  return options;
}

// Where a node of the shown run is in the window, by the camera that frames the motion or is led by hand.
Eigen::Vector2d pixel_of(PanelDriver& driver, const std::string& node,
                         const std::optional<VectorXd>& pose = std::nullopt) {
  const plot::Rect view = driver.panel().place("view");
  FrameStyle style;
  style.width = static_cast<int>(view.width());
  style.height = static_cast<int>(view.height());
  const FrameBuilder builder(driver.state().shown->simulation.trajectory, style);
  PickView pick{builder.camera(), style.width, style.height, builder.upright()};
  if (const auto& orbit = driver.state().orbit) pick.camera = camera_of(*orbit, Vec3f::Zero(), 100);
  PickedPlace at =
      place_of({Selection::Kind::node, node}, *driver.state().shown, driver.state().playback.t, pick);
  REQUIRE(at.found);
  const Structure& structure = driver.state().shown->simulation.trajectory.structure();
  for (std::size_t i = 0; pose && i < structure.nodes.size(); ++i)
    if (structure.nodes[i].name == node) {
      const Vec3 place = pick.upright * (pose->segment<3>(3 * static_cast<Index>(i)) - pick.origin);
      at.a = project(pick.camera, pick.width, pick.height, place.cast<float>());
    }
  return {view.x0 + at.a.x(), view.y0 + at.a.y()};
}

void drag_node(PanelDriver& driver, const std::string& node, double dx, double dy) {
  const Eigen::Vector2d at = pixel_of(driver, node);
  driver.move(at.x(), at.y());
  REQUIRE(driver.state().hovered.name == node);
  driver.press(true);
  for (int i = 1; i <= 4; ++i) driver.move(at.x() + dx * i / 4, at.y() + dy * i / 4);
}

}  // namespace

TEST_CASE("a node is pulled with the mouse, rods keep their lengths, and Esc gives the run back") {
  PanelDriver driver(quick(), "four_bar");
  driver.click("tool pull");
  drag_node(driver, "C", -40, 25);
  REQUIRE(driver.state().pose);
  const Structure& structure = driver.state().shown->simulation.trajectory.structure();
  const VectorXd& pose = *driver.state().pose;
  CHECK((pose - driver.state().shown->simulation.trajectory.positions(0)).norm() > 0.05);
  for (const Rod& rod : structure.rods)
    CHECK((pose.segment<3>(3 * rod.b) - pose.segment<3>(3 * rod.a)).norm() ==
          Approx(rod.length).epsilon(1e-9));
  driver.press(false);
  CHECK(driver.state().pose);  // it stays where it was led
  // And is led on from there: 40 and 25 pixels from where the run has it.
  const Eigen::Vector2d at = pixel_of(driver, "C");
  const VectorXd before = *driver.state().pose;
  driver.move(at.x(), at.y());
  CHECK(driver.state().hovered.name != "C");
  const Eigen::Vector2d there = pixel_of(driver, "C", driver.state().pose);
  driver.move(there.x(), there.y());
  REQUIRE(driver.state().hovered.name == "C");
  driver.press(true);
  for (int i = 1; i <= 4; ++i) driver.move(there.x() - 3 * i, there.y() + 2 * i);
  driver.press(false);
  CHECK((*driver.state().pose - before).norm() > 0.01);
  CHECK_FALSE(driver.state().orbit);  // and the view did not turn
  driver.key(Key::escape);
  CHECK_FALSE(driver.state().pose);
}

TEST_CASE("the free motions of a pose are shown one after the other") {
  PanelDriver driver(quick(), "four_bar");
  driver.key(Key::w);
  CHECK(driver.state().motions == 1);
  CHECK(driver.state().wiggled == 0);
  const VectorXd start = *driver.state().pose;
  driver.frame(0.4);
  CHECK((*driver.state().pose - start).norm() > 0.01);
  CHECK(driver.panel().frame(0.1));  // it goes on by itself
  CHECK(driver.state().message == "free motion 1 of 1");
  driver.key(Key::w);
  CHECK_FALSE(driver.state().pose);
  CHECK(driver.state().message == "after the last free motion: the run");
  driver.key(Key::w);
  CHECK(driver.state().message == "free motion 1 of 1");
}

TEST_CASE("nodes and rods are added, moved, connected and deleted as lines of TOML, and undone") {
  PanelDriver driver(quick(), blank_document());
  const SceneDocument start = driver.state().history.now();
  driver.key(Key::b);
  CHECK(driver.state().tool == Tool::build);
  auto& intents = driver.state().intents;
  intents.emplace_back([](LiveSession& s) { s.add_node({0.52, 0, 0.98}); });
  driver.settle();
  CHECK(driver.state().history.now().added.back() ==
        "structure.nodes[2]={name = \"N1\", position = [0.5, 0.0, 1.0], mass = 1.0}");
  CHECK(driver.state().selected.name == "N1");
  intents.emplace_back([](LiveSession& s) { s.connect("B", "N1"); });
  driver.settle();
  CHECK(driver.state().history.now().added.back() ==
        "structure.rods[1]={nodes = [\"B\", \"N1\"], mass = 1.0}");
  REQUIRE(driver.state().shown->simulation.trajectory.structure().rods.size() == 2);
  driver.state().playback.t = 0;
  driver.frame();
  const Vec3 before = driver.state().shown->scene.custom.nodes.at(2).position;
  drag_node(driver, "N1", 30, -20);
  driver.press(false);
  driver.settle();
  const Vec3 after = driver.state().shown->scene.custom.nodes.at(2).position;
  CHECK((after - before).norm() > 0.05);
  for (Index i = 0; i < 3; ++i)
    CHECK(std::remainder(after[i], 0.1) == Approx(0).margin(1e-9));  // on the grid
  CHECK(driver.state().history.now().edits.contains("structure.nodes[2].position"));
  driver.key(Key::z, true);  // the whole drag is one step
  driver.settle();
  CHECK(driver.state().shown->scene.custom.nodes.at(2).position == before);
  driver.state().selected = {Selection::Kind::node, "N1"};
  driver.key(Key::del);
  driver.settle();
  CHECK(driver.state().shown->scene.custom.nodes.size() == 2);
  CHECK(driver.state().shown->scene.custom.rods.size() == 1);
  while (driver.state().history.undo()) {
  }
  CHECK(driver.state().history.now() == start);
}

TEST_CASE("Build is of the start: it is framed, every node is seen, and the timeline puts Build away") {
  PanelDriver driver(quick(), blank_document());
  driver.key(Key::end);
  driver.key(Key::b);
  driver.frame();
  CHECK(driver.state().playback.t == 0);
  REQUIRE(driver.state().orbit);
  const OrbitCamera begun = *driver.state().orbit;
  driver.state().intents.emplace_back([](LiveSession& s) { s.add_node({0.5, 0, 1}); });
  driver.settle();
  CHECK(*driver.state().orbit == begun);  // though the new node falls for 20 m
  // The rod of 1 m is seen as long, and what is built beside it has room.
  const double seen = (pixel_of(driver, "B") - pixel_of(driver, "A")).norm(),
               high = driver.panel().place("view").height();
  CHECK(seen > 0.15 * high);
  CHECK(seen < 0.6 * high);
  driver.state().selected = {};
  driver.frame();
  // From N1 no rod begins: the pixels around it are of its mark alone.
  const Eigen::Vector2d at = pixel_of(driver, "N1");
  const plot::Rect view = driver.panel().place("view");
  CHECK(at.y() > view.y0 + 20);
  CHECK(at.y() < view.y1 - 20);
  const Image built = driver.picture();
  const OrbitCamera led = zoomed(begun, 0.01f, {0, 0, 0}, 1);  // by hand: it stays
  driver.state().orbit = led;
  driver.state().tool = Tool::read;
  driver.settle();
  CHECK(*driver.state().orbit == led);
  const Image plain = driver.picture();
  int ring = 0;
  for (int y = -8; y <= 8; ++y)
    for (int x = -8; x <= 8; ++x) {
      const auto pixel = 4 * (static_cast<std::size_t>(at.y() + y) * static_cast<std::size_t>(plain.width) +
                              static_cast<std::size_t>(at.x() + x));
      ring += std::abs(built.rgba[pixel] - plain.rgba[pixel]) > 40;
    }
  CHECK(ring > 10);  // the circle of 3 pixels is over the card with the title, too
  driver.key(Key::b);
  driver.drag("timeline", 0.3, 0.6);
  CHECK(driver.state().tool == Tool::read);
  CHECK(driver.state().message.find("Build") == 0);
  CHECK(driver.state().playback.t > 0.5);
  driver.key(Key::b);
  CHECK(driver.state().tool == Tool::build);
  driver.key(Key::space);
  CHECK(driver.state().tool == Tool::read);
  // A view that nobody led by hand is given back.
  driver.state().orbit.reset();
  driver.key(Key::b);
  driver.frame();
  CHECK(driver.state().orbit);
  driver.key(Key::b);
  driver.frame();
  CHECK_FALSE(driver.state().orbit);
}

// What is left is written anew: every key of it, to the last digit.
TEST_CASE("a part that is deleted changes nothing of the others") {
  const std::string text = R"(
[structure]
kind = "custom"
nodes = [{name = "A", position = [0.1234567890123, 0, 0], fixed = true},
         {name = "B", position = [1.1, 0.2, 1e-10], velocity = [0, 1e-11, 2], mass = 0.3},
         {name = "C", position = [2, 0, 1], mass = 1}]
[[structure.rods]]
nodes = ["A", "B"]
name = "r"
density = 2700
area = 1e-4
group = "g"
youngs_modulus = 7e10
strength = 1e8
second_moment = 1e-9
elastic = true
free_length = 0.99
[[structure.rods]]
nodes = ["B", "C"]
mass = 0.25
length = 1.5
segments = 3
youngs_modulus = 5e9
area = 2e-4
[[structure.rods]]
nodes = ["C", "A"]
mass = 0.5
area = 1e-4
youngs_modulus = inf
strength = inf
[[structure.rods]]
nodes = ["A", "C"]
mass = 1
)";
  SceneDocument document;
  document.name = "untitled";
  document.text = std::make_shared<const std::string>(text);
  const CustomSpec before = read_document(document).custom,
                   after = read_document(without_part(document, {Selection::Kind::rod, "A-C"})).custom;
  REQUIRE(after.nodes.size() == 3);
  REQUIRE(after.rods.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const CustomNode &a = before.nodes[i], &b = after.nodes[i];
    CHECK(a.name == b.name);
    CHECK(a.position == b.position);
    CHECK(a.velocity == b.velocity);
    CHECK(a.mass == b.mass);
    CHECK(a.fixed == b.fixed);
  }
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  for (std::size_t i = 0; i < 3; ++i) {
    const CustomRod &a = before.rods[i], &b = after.rods[i];
    CHECK(a.name == b.name);
    CHECK(a.nodes == b.nodes);
    CHECK(a.mass == b.mass);
    CHECK(a.density == b.density);
    CHECK(a.area == b.area);
    CHECK(a.group == b.group);
    CHECK(a.length == b.length);
    CHECK(same(a.youngs_modulus, b.youngs_modulus));
    CHECK(same(a.strength, b.strength));
    CHECK(a.second_moment == b.second_moment);
    CHECK(a.elastic == b.elastic);
    CHECK(a.segments == b.segments);
    CHECK(a.free_length == b.free_length);
  }
}

TEST_CASE("building has a mirror, a saved scene has what was built, and a family refuses in words") {
  PanelDriver driver(quick(), blank_document());
  driver.state().grid.mirror = 1;
  driver.state().intents.emplace_back([](LiveSession& s) { s.add_node({0.5, 0.7, 0.3}); });
  driver.settle();
  const auto& nodes = driver.state().shown->scene.custom.nodes;
  REQUIRE(nodes.size() == 4);
  CHECK(nodes[3].position.isApprox(Vec3(0.5, -0.7, 0.3)));
  driver.state().intents.emplace_back([](LiveSession& s) { s.connect("A", "N1"); });
  driver.settle();
  CHECK(driver.state().shown->scene.custom.rods.size() == 3);  // and its image, A-N2
  WrittenBack written;
  const SceneDocument saved = saved_document(driver.state().history.now(), "built.toml", written);
  CHECK_FALSE(written.anew);
  CHECK(saved.text->find("[[structure.rods]]\nnodes = [\"A\", \"N2\"]") != std::string::npos);
  CHECK(read_document(saved).custom.nodes.size() == 4);

  PanelDriver family(quick());
  family.state().intents.emplace_back([](LiveSession& s) { s.add_node({0, 0, 0}); });
  family.frame();
  CHECK(family.state().message.find("custom") != std::string::npos);
  CHECK(family.state().history.now().added.empty());
}

TEST_CASE("where lengths stay, the rest of the structure goes along and stays assembled") {
  PanelDriver driver(quick(), "four_bar");
  driver.key(Key::b);
  driver.state().grid.follow = false;
  driver.state().grid.step = 0;
  const Structure before = build_structure(driver.state().shown->scene);
  driver.state().intents.emplace_back([&](LiveSession& s) { s.move_node("C", {2.4, 0, 2.5}); });
  driver.settle();
  const Structure after = build_structure(driver.state().shown->scene);
  CHECK((after.nodes[2].position - before.nodes[2].position).norm() > 0.05);
  CHECK((after.nodes[1].position - before.nodes[1].position).norm() > 0.01);  // B went along
  for (std::size_t i = 0; i < before.rods.size(); ++i)
    CHECK(after.rods[i].length == Approx(before.rods[i].length).epsilon(1e-8));
}

TEST_CASE("a double click is one by the time between its presses, however long frames take") {
  struct Clicks {
    double between, frame;  // [s]
    bool timed, twice;
  };
  // Four frames for two clicks: a quick one takes 0.8 s where each frame takes 0.2.
  const auto clicks =
      GENERATE(Clicks{0.1, 0.2, false, true}, Clicks{0.2, 0.25, true, true}, Clicks{0.2, 0.016, true, true},
               Clicks{0.1, 0.016, false, true}, Clicks{5.0, 0.0, true, false}, Clicks{1.0, 0.2, true, false});
  CAPTURE(clicks.between, clicks.frame, clicks.timed);
  PanelDriver driver(quick(), blank_document());
  driver.key(Key::b);
  driver.frame();
  driver.move_to("view", 0.85, 0.35);
  driver.frame(1.0);
  REQUIRE(driver.state().hovered.kind == Selection::Kind::none);
  InputEvent event;
  event.kind = InputEvent::Kind::button;
  for (int i = 0; i < 4; ++i) {
    event.down = i % 2 == 0;
    if (clicks.timed) event.time = 10 + (i / 2) * clicks.between;
    driver.panel().handle(event);
  }
  for (int i = 0; i < 4; ++i) driver.frame(clicks.frame);
  driver.settle();
  CHECK(driver.state().shown->scene.custom.nodes.size() == (clicks.twice ? 3 : 2));
}

// A motor's rotor is a number of its own, and no node at the origin.
TEST_CASE("a node that is built in a plane mechanism is in its plane wherever that is") {
  SceneDocument document = blank_document();
  document.text = std::make_shared<const std::string>(
      "[structure]\nkind = 'custom'\nnodes = [{name = 'O', position = [0, 2.3, 0], fixed = true}, {name = "
      "'A', "
      "position = [0, 2.3, 1]}, {name = 'B', position = [1, 2.3, 1]}]\nrods = [{nodes = ['O', 'A'], mass = "
      "1}, "
      "{nodes = ['A', 'B'], mass = 1}]\n[[constraints]]\nkind = 'plane'\nnodes = ['A', 'B']\nnormal = [0, 1, "
      "0]\n"
      "[[forces]]\nkind = 'motor'\nnodes = ['O', 'A', 'B']\naxis = [0, 1, 0]\nstall_torque = "
      "1\nno_load_speed = "
      "90\ninertia = 1\n[solver]\nend_time = 0.1\n");
  PanelDriver driver(quick(), document);
  driver.key(Key::b);
  driver.frame();
  CHECK(driver.state().grid.plane == 1);
  driver.move_to("view", 0.85, 0.35);
  driver.frame(1.0);
  REQUIRE(driver.state().hovered.kind == Selection::Kind::none);
  InputEvent event;
  event.kind = InputEvent::Kind::button;
  for (int i = 0; i < 4; ++i) {
    event.down = i % 2 == 0;
    driver.panel().handle(event);
  }
  for (int i = 0; i < 4; ++i) driver.frame(0.016);
  driver.settle();
  const auto& nodes = driver.state().shown->scene.custom.nodes;
  REQUIRE(nodes.size() == 4);
  CHECK(nodes[3].position.y() == Approx(2.3).epsilon(1e-12));
}

}  // namespace hand_test
