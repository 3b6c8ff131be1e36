// SPDX-License-Identifier: BSD-3-Clause
// The panel without a mouse.
#include <catch2/catch.hpp>

#include "app/panel/actions.hpp"
#include "app/panel/panes/panes.hpp"
#include "tests/app/panel/panel_driver.hpp"

using namespace unfurl;

namespace keyboard_test {

TEST_CASE("Tab reaches the parameters, a value is typed, Esc leaves, and keys mean actions again") {
  PanelOptions options = PanelDriver::small();
  options.measure_errors = false;
  PanelDriver driver(options);
  driver.key(Key::tab);
  driver.frame();
  CHECK(driver.state().history.now().edits.empty());
  std::string edited;
  for (int i = 0; i < 12 && edited.empty();
       ++i) {  // from one to the next, until a number takes what is typed
    driver.key(Key::tab);
    driver.type("7");
    driver.key(Key::enter);
    driver.frame();
    for (const auto& [key, value] : driver.state().history.now().edits)
      if (key != "title") edited = key;
  }
  INFO(edited);
  CHECK_FALSE(edited.empty());
  driver.key(Key::escape);
  driver.key(Key::escape);
  driver.settle();
  driver.move_to("view", 0.5, 0.9);
  driver.press(true);
  driver.press(false);
  driver.key(Key::end);
  REQUIRE(driver.state().shown);
  CHECK(driver.state().playback.t == driver.state().shown->simulation.trajectory.end_time());
}

TEST_CASE("Enter presses buttons and switches, opens lists and takes their choices") {
  PanelOptions options = PanelDriver::small();
  options.measure_errors = false;
  const Key press = GENERATE(Key::enter, Key::space);
  CAPTURE(name_of(press));
  PanelDriver driver(options, "four_bar");
  const auto& edits = [&]() -> const auto& {
    return driver.state().history.now().edits;
  };
  driver.key(Key::tab);
  driver.key(Key::enter);  // the title is left
  driver.key(Key::down);
  driver.key(Key::down);
  driver.key(press);  // the list of what rods weigh
  driver.key(Key::down);
  driver.key(press);
  driver.settle();
  REQUIRE(edits().contains("structure.mass"));
  CHECK(std::get<std::string>(edits().at("structure.mass")) == "lumped");
  driver.key(Key::down);
  driver.key(press);  // the button "not given"
  driver.settle();
  REQUIRE(edits().contains("structure.youngs_modulus"));
  CHECK(std::get<double>(edits().at("structure.youngs_modulus")) == 7e10);
}

TEST_CASE("the palette finds actions and parameters, and Enter does them") {
  PanelOptions options = PanelDriver::small();
  options.measure_errors = false;
  PanelDriver driver(options);
  driver.key(Key::p, true);
  driver.frame();
  REQUIRE(driver.panel().has_place("palette query"));
  driver.type("light or");
  driver.key(Key::enter);
  driver.frame();
  CHECK(driver.state().dark);
  CHECK_FALSE(driver.state().palette_open);
  const auto items = palette_items(driver.state(), "post length");
  REQUIRE_FALSE(items.empty());
  CHECK(items.front().name.find("structure.post_length") != std::string::npos);
  driver.key(Key::p, true);
  driver.frame();
  driver.type("post length");
  driver.key(Key::enter);
  for (int i = 0; i < 3; ++i) driver.frame();
  CHECK(driver.state().reveal.empty());  // it was drawn, and has the keyboard
  driver.type("1,75");                   // the comma of a keyboard's numbers
  driver.key(Key::enter);
  driver.settle();
  CHECK(std::get<double>(driver.state().history.now().edits.at("structure.post_length")) == 1.75);
  // Esc closes what is open: the palette, a drop-down.
  driver.key(Key::p, true);
  driver.frame();
  driver.key(Key::escape);
  CHECK_FALSE(driver.state().palette_open);
  driver.click("view options");
  driver.frame();
  REQUIRE(driver.panel().has_place("render.look"));
  driver.key(Key::escape);
  driver.frame();
  CHECK_FALSE(driver.panel().has_place("use view"));
}

// A slider with the keyboard is a text field.
TEST_CASE("what is typed into a number is the whole of it, as in a scene") {
  PanelOptions options = PanelDriver::small();
  options.measure_errors = false;
  PanelDriver driver(options, "pendulum");
  const auto typed = [&](const std::string& key, const std::string& text) {
    driver.state().reveal = key;
    for (int i = 0; i < 4; ++i) driver.frame();
    driver.type(text);
    driver.frame();
    driver.key(Key::enter);
    driver.settle();
    const auto& edits = driver.state().history.now().edits;
    const auto found = edits.find(key);
    return found == edits.end() ? ParamValue(false) : found->second;
  };
  const auto length = [&](const std::string& text) { return typed("structure.length", text); };
  CHECK(length("1.5") == ParamValue(1.5));
  CHECK(length("1/4") == ParamValue(0.25));
  CHECK(length("=2*pi") == ParamValue(2 * pi));
  CHECK(length("3e-1") == ParamValue(0.3));
  for (const char* wrong : {"150 cm", "0x10", "1.5.2", "abc", "2*"}) {
    INFO(wrong);
    CHECK(length(wrong) == ParamValue(0.3));
    CHECK(driver.state().message.find(std::string("'") + wrong + "' is no number") != std::string::npos);
  }
  CHECK(typed("solver.stages", "6/2") == ParamValue(3L));
  CHECK(typed("solver.stages", "7/2") == ParamValue(3L));
  CHECK(driver.state().message.find("3.5 is no whole number") != std::string::npos);
}

TEST_CASE("Tab behind Enter goes to the next field, with Shift to the one before") {
  PanelOptions options = PanelDriver::small();
  options.measure_errors = false;
  PanelDriver driver(options, "pendulum");
  const auto typed = [&](const char* text) {
    driver.type(text);
    driver.frame();
    driver.key(Key::enter);
    driver.settle();
  };
  const auto tab = [&](bool shift = false) {
    driver.key(Key::tab, false, shift);
    driver.frame();
  };
  tab(), tab();  // the title, and what follows it
  typed("1.5");
  tab();
  typed("2.5");
  tab();
  typed("3.5");
  const auto& edits = driver.state().history.now().edits;
  const auto edited = [&](const char* key) {
    const auto found = edits.find(key);
    return found == edits.end() ? ParamValue(false) : found->second;
  };
  CHECK_FALSE(edits.contains("title"));
  CHECK(edited("structure.length") == ParamValue(1.5));
  CHECK(edited("structure.rod_mass") == ParamValue(2.5));
  CHECK(edited("structure.bob_mass") == ParamValue(3.5));
  tab(true);
  typed("4.5");
  CHECK(edited("structure.rod_mass") == ParamValue(4.5));
}

TEST_CASE("every action has a name, and no two have one key") {
  for (const Action& a : actions()) {
    CHECK_FALSE(a.help.empty());
    for (const Action& b : actions())
      CHECK(
          (&a == &b || a.key == Key::none || a.key != b.key || a.control != b.control || a.shift != b.shift));
  }
}

TEST_CASE("each step back or forward goes to another time, past what has two states at one") {
  PanelOptions options = PanelDriver::small();
  options.measure_errors = false;
  SceneDocument document = open_document("cable_ring", {});
  document.overrides = {"solver.end_time=2"};  // cables go taut at 25 us and at 1.8 s
  PanelDriver driver(options, document);
  REQUIRE(driver.state().shown);
  const Trajectory& run = driver.state().shown->simulation.trajectory;
  std::size_t doubled = 0;
  for (std::size_t i = 1; i < run.size(); ++i) doubled += run.time(i) == run.time(i - 1);
  REQUIRE(doubled > 0);
  for (const bool back : {true, false}) {
    driver.key(back ? Key::end : Key::home);
    std::size_t steps = 0;
    for (double before = driver.state().playback.t + 1; driver.state().playback.t != before; ++steps) {
      before = driver.state().playback.t;
      driver.key(back ? Key::left : Key::right);
    }
    CHECK(driver.state().playback.t == (back ? run.start_time() : run.end_time()));
    CHECK(steps == run.size() - doubled);
  }
}

TEST_CASE("the guided tour has six steps, comes once, and can be called again") {
  PanelOptions options = PanelDriver::small();
  options.measure_errors = false;
  PanelDriver driver(options, "hoop6", true);
  CHECK(driver.state().tour == 1);
  CHECK_FALSE(driver.panel().settings().tour_seen);
  for (int step = 1; step <= 6; ++step) {
    CHECK(driver.state().tour == step);
    driver.frame();
    driver.click("tour next");
  }
  CHECK(driver.state().tour == 0);
  CHECK(driver.panel().settings().tour_seen);
  PanelDriver second(options);
  CHECK(second.state().tour == 0);
}

}  // namespace keyboard_test
