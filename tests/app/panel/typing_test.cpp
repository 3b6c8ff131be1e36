// SPDX-License-Identifier: BSD-3-Clause
// What stands in a field while it is typed: a number begun is not yet one, Esc leads back, and nothing that
// nobody touched is another.
#include <catch2/catch.hpp>

#include "core/scene/reader.hpp"
#include "tests/app/panel/panel_driver.hpp"
#include "tests/app/run_program.hpp"

using namespace unfurl;

namespace typing_test {

namespace {

PanelOptions quick() {
  PanelOptions options = PanelDriver::small();
  options.measure_errors = false;
  return options;
}

void begin(PanelDriver& driver, const std::string& key) {
  driver.state().reveal = key;
  for (int i = 0; i < 4; ++i) driver.frame();
}

void type_letters(PanelDriver& driver, const std::string& text) {
  for (const char letter : text) {
    driver.type(std::string(1, letter));
    driver.frame();
  }
}

// Empties the field that is typed into, by a step that Ctrl Z in it would take back, and types this instead.
void retype(PanelDriver& driver, const std::string& text) {
  driver.key(Key::a, true);
  driver.key(Key::del);
  type_letters(driver, text);
}

// A load of these values at times of as many.
std::string loaded(const std::string& times, const std::string& values) {
  return "[structure]\nkind = 'pendulum'\n[[forces]]\nkind = 'load_over_time'\nnodes = ['bob']\n"
         "force = [1, 0, 0]\ntimes = [" +
         times + "]\nvalues = [" + values + "]\n[solver]\nend_time = 0.1\nstep = 0.05\n";
}

std::vector<double> values_of(PanelDriver& driver) {
  const auto& edits = driver.state().history.now().edits;
  const auto found = edits.find("forces[0].values");
  return found == edits.end() ? std::vector<double>() : std::get<std::vector<double>>(found->second);
}

}  // namespace

TEST_CASE("typed letter by letter: no number leaves the value that stood there") {
  PanelDriver driver(quick(), "pendulum");
  const auto& edits = driver.state().history.now().edits;
  for (const char* wrong : {"150 cm", "0x10", "1.5.2", "12*"}) {
    INFO(wrong);
    begin(driver, "structure.length");
    type_letters(driver, wrong);
    CHECK(driver.state().message.find(std::string("'") + wrong + "' is no number") != std::string::npos);
    driver.key(Key::enter);
    driver.settle();
    CHECK(edits.empty());
    CHECK_FALSE(driver.state().history.can_undo());
  }
  begin(driver, "structure.length");
  type_letters(driver, "1.25");
  driver.key(Key::enter);
  driver.settle();
  CHECK(edits.at("structure.length") == ParamValue(1.25));
  CHECK(driver.state().history.undo());  // one step
  CHECK(edits.empty());
}

TEST_CASE("Esc out of a number gives back the value with all its digits") {
  SceneDocument document = open_document("pendulum", {});
  document.overrides = {"structure.length=1.23456789012", "solver.end_time=0.1"};
  PanelDriver driver(quick(), document);
  begin(driver, "structure.length");
  type_letters(driver, "2.5");
  CHECK(driver.state().history.now().edits.at("structure.length") == ParamValue(2.5));
  driver.key(Key::escape);
  driver.settle();
  CHECK(driver.state().history.now() == document);
  CHECK_FALSE(driver.state().history.can_undo());
  // A component shows four digits, and has all.
  document.overrides = {"gravity.acceleration=[0.123456789, 0, -9.81]", "solver.end_time=0.1"};
  PanelDriver other(quick(), document);
  begin(other, "gravity.acceleration");
  other.key(Key::enter);
  other.settle();
  CHECK(other.state().history.now() == document);
}

TEST_CASE("Esc out of a vector's number after an undo gives back what stood there, and the redo") {
  SceneDocument document = open_document("pendulum", {});
  document.overrides = {"gravity.acceleration=[0.5, 0.25, -9.81]", "solver.end_time=0.1"};
  PanelDriver driver(quick(), document);
  const auto gravity = [&] {
    const auto& edits = driver.state().history.now().edits;
    const auto found = edits.find("gravity.acceleration");
    return found == edits.end() ? std::vector<double>() : std::get<std::vector<double>>(found->second);
  };
  begin(driver, "gravity.acceleration");
  type_letters(driver, "5");
  driver.key(Key::enter);
  driver.settle();
  CHECK(gravity() == std::vector<double>{5, 0.25, -9.81});
  CHECK(driver.state().history.undo());
  driver.settle();
  CHECK(gravity().empty());
  begin(driver, "gravity.acceleration");
  type_letters(driver, "7");
  CHECK(gravity() == std::vector<double>{7, 0.25, -9.81});
  driver.key(Key::escape);
  driver.settle();
  CHECK(gravity().empty());
  CHECK(driver.state().history.redo());
  CHECK(gravity() == std::vector<double>{5, 0.25, -9.81});
}

TEST_CASE("a comma is a point, or stands between two arguments") {
  PanelDriver driver(quick(), "pendulum");
  for (const auto& [text, value] :
       {std::pair{"1,75", 1.75}, std::pair{"max(1,2)", 2.0}, std::pair{"hypot(3,4)", 5.0}}) {
    INFO(text);
    begin(driver, "structure.length");
    type_letters(driver, text);
    driver.key(Key::enter);
    driver.settle();
    CHECK(driver.state().history.now().edits.at("structure.length") == ParamValue(value));
  }
}

TEST_CASE("numbers of a list that nobody touches keep their digits") {
  const ScratchDirectory scratch;
  const std::string file =
      scratch.write("timed.toml", loaded("0, 0.1, 0.3", "0.0, 1234567.8, 0.30000000000000004"));
  PanelDriver driver(quick(), open_document(file, {}));
  begin(driver, "forces[0].values");
  driver.key(Key::end);
  type_letters(driver, ", 5");
  driver.key(Key::enter);
  CHECK(values_of(driver) == std::vector<double>{0, 1234567.8, 0.30000000000000004, 5});
}

TEST_CASE("a long list is edited whole") {
  const ScratchDirectory scratch;
  constexpr int count = 700;
  std::string times, values;
  for (int i = 0; i < count; ++i) {
    times += (i ? ", " : "") + std::to_string(i) + ".0";
    values += (i ? ", " : "") + std::to_string(i) + ".125";
  }
  PanelDriver driver(quick(), open_document(scratch.write("long.toml", loaded(times, values)), {}));
  begin(driver, "forces[0].values");
  driver.key(Key::end);
  type_letters(driver, "5, 7");
  driver.key(Key::enter);
  const std::vector<double> now = values_of(driver);
  REQUIRE(now.size() == count + 1);
  CHECK(now[0] == 0.125);
  CHECK(now[count - 1] == count - 1 + 0.1255);
  CHECK(now[count] == 7);
}

// A field that is entered again with another text: steps back that were kept of the one before put that in
// again, or go out of the text's bounds.
TEST_CASE("Ctrl Z in a field that was left and changed does nothing") {
  SceneDocument document = open_document("pendulum", {});
  document.overrides = {"gravity.acceleration=[0.5, 0.25, -9.81]", "solver.end_time=0.1"};
  PanelDriver driver(quick(), document);
  const EditHistory& history = driver.state().history;
  for (const auto& [key, text] :
       {std::pair{"title", "another and much longer title"}, std::pair{"structure.length", "1.23456789"},
        std::pair{"gravity.acceleration", "2"}}) {
    INFO(key);
    begin(driver, key);
    retype(driver, text);
    driver.key(Key::enter);
    driver.settle();
    CHECK(history.now().edits.contains(key));
    while (driver.state().history.undo()) {
    }
    driver.settle();
    begin(driver, key);
    for (const Key step : {Key::z, Key::z, Key::y}) driver.key(step, true);
    CHECK(history.now() == document);
    driver.key(Key::enter);
    CHECK(history.now() == document);
  }
}

TEST_CASE("Ctrl Z in a box that is opened again knows nothing of what was typed before") {
  PanelDriver driver(quick(), "pendulum");
  for (const auto& [key, text] :
       {std::pair{Key::p, &driver.state().palette_query}, std::pair{Key::o, &driver.state().file_path}}) {
    driver.key(key, true);
    for (int i = 0; i < 4; ++i) driver.frame();
    type_letters(driver, "a long text");
    CHECK(*text == "a long text");
    retype(driver, "");
    driver.key(Key::escape);
    text->clear();
    driver.key(key, true);
    for (int i = 0; i < 4; ++i) driver.frame();
    driver.key(Key::z, true);
    CHECK(text->empty());
    driver.key(Key::escape);
  }
  driver.settle();
  driver.key(Key::three);
  double& step = driver.state().study.largest_step;
  driver.click("study largest");
  retype(driver, "0.125");
  driver.key(Key::enter);
  CHECK(step == 0.125);
  step = 0.5;
  driver.click("study largest");
  for (int i = 0; i < 9; ++i) driver.key(Key::z, true);
  CHECK(step == 0.5);
}

TEST_CASE("a scene that is dropped while a field is typed into keeps its own values") {
  PanelDriver driver(quick(), "pendulum");
  for (const auto& [key, text] : {std::pair{"title", "of the pendulum"}, std::pair{"solver.step", "0.04"}}) {
    INFO(key);
    begin(driver, key);
    retype(driver, text);
    InputEvent drop;
    drop.kind = InputEvent::Kind::drop;
    drop.text = UNFURL_ROOT "/assets/scenes/four_bar.toml";
    driver.panel().handle(drop);
    for (int i = 0; i < 4; ++i) driver.frame();
    CHECK(driver.state().history.now() == open_document(drop.text, {}));
    driver.state().history.undo();
    CHECK(driver.state().history.now().edits.contains(key));
    driver.settle();
  }
}

}  // namespace typing_test
