// SPDX-License-Identifier: BSD-3-Clause
// Ten thousand things that nobody would do on purpose.
#include <catch2/catch.hpp>
#include <random>

#include "tests/app/panel/panel_driver.hpp"

using namespace unfurl;

namespace random_events_test {

namespace {

InputEvent random_event(std::mt19937& random, int width, int height) {
  const auto upto = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  InputEvent event;
  switch (upto(10)) {
    case 0:
    case 1:
    case 2:
    case 3:
      event.x = static_cast<float>(upto(width + 100) - 50);
      event.y = static_cast<float>(upto(height + 100) - 50);
      break;
    case 4:
    case 5:
    case 6:
      event.kind = InputEvent::Kind::button;
      event.button = upto(12) == 0 ? 1 + upto(2) : 0;
      event.down = upto(2) == 0;
      break;
    case 7:
      event.kind = InputEvent::Kind::wheel;
      event.y = static_cast<float>(upto(7) - 3);
      break;
    case 8:
      event.kind = InputEvent::Kind::key;
      do event.key = static_cast<Key>(upto(static_cast<int>(Key::count)));
      while (event.key == Key::s || event.key == Key::q);
      event.down = upto(3) != 0;
      event.control = upto(4) == 0;
      event.shift = upto(4) == 0;
      break;
    default:
      event.kind = upto(20) == 0 ? InputEvent::Kind::focus_lost : InputEvent::Kind::text;
      event.text = std::string(1, static_cast<char>("0123456789.-e?"[upto(14)]));
  }
  return event;
}

}  // namespace

TEST_CASE("ten thousand random events harm nothing, and undo leads back to the scene it began with") {
  PanelOptions options;
  options.width = 640;
  options.height = 400;
  PanelDriver driver(options);
  const SceneDocument start = driver.state().history.now();
  std::mt19937 random(20251121);
  int edits = 0;
  for (int i = 0; i < 10000; ++i) {
    driver.panel().handle(random_event(random, options.width, options.height));
    // Not an export: it would write files.
    driver.state().export_open = driver.state().files_open = false;
    driver.frame(1.0 / 60, i % 100 == 0);  // painted now and then
    edits += driver.state().history.can_undo() ? 1 : 0;
  }
  CHECK(edits > 100);  // the scene was changed along the way
  driver.panel().handle([] {
    InputEvent event;
    event.kind = InputEvent::Kind::focus_lost;
    return event;
  }());
  driver.frame();
  while (driver.state().history.undo()) {
  }
  CHECK(driver.state().history.now() == start);
  driver.settle();
  REQUIRE(driver.state().shown);
  // Looks need no new run, so the run shown may still have been asked for with others.
  CHECK(simulated_part(driver.state().shown->document) == start);
  CHECK(driver.state().picture == read_document(start).render);
}

}  // namespace random_events_test
