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

}  // namespace typing_test
