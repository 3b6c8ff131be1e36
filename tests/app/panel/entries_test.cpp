// SPDX-License-Identifier: BSD-3-Clause
// Entries of [[loads]], [[forces]] and [[constraints]] in the left pane.
#include <catch2/catch.hpp>

#include "app/panel/document/element_menu.hpp"
#include "app/panel/document/scene_entries.hpp"
#include "app/panel/runs/export_process.hpp"
#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/text_file.hpp"
#include "core/scene/write.hpp"
#include "core/scene/write_back.hpp"
#include "tests/app/panel/panel_driver.hpp"
#include "tests/app/run_program.hpp"

using namespace unfurl;

namespace entries_test {

namespace {

const ParamRow& row_named(const std::vector<ParamSection>& sections, const std::string& key) {
  for (const ParamSection& section : sections)
    for (const ParamRow& row : section.rows)
      if (row.key == key) return row;
  throw std::out_of_range(key);
}

std::vector<double> degrees(PanelDriver& driver) {
  const Series* angle = driver.state().shown->diagnostics.find("fold_angle_rad");
  if (!angle) throw std::logic_error("no fold angle");
  std::vector<double> values = angle->values;
  for (double& x : values) x /= radians_per_degree;
  return values;
}

// High enough that nothing has to be scrolled to.
PanelOptions tall() {
  PanelOptions options = PanelDriver::small();
  options.height = 1100;
  return options;
}

}  // namespace

TEST_CASE("an entry of the scene has a row for each of its parameters") {
  const auto sections = param_sections(base_scene(open_document("hoop6_motor", {})));
  CHECK(std::get<double>(row_named(sections, "constraints[0].to").value) == 5);
  CHECK(row_named(sections, "constraints[0].to").spec.unit == "deg");
  // Where it begins: the scene's own fold angle, to round-off of an arctangent.
  CHECK(row_named(sections, "constraints[0].to").typical == Approx(85).margin(1e-9));
  CHECK(row_named(sections, "constraints[0].amplitude").typical ==
        Approx(8.5).margin(1e-9));  // a swing about it
  CHECK(row_named(sections, "constraints[0].frequency").typical == 1);
  CHECK(std::get<std::string>(row_named(sections, "constraints[0].motion").value) == "smooth");
  CHECK(std::get<bool>(row_named(sections, "constraints[0].enabled").value));
  // Around the drive's own values, both ways.
  const SliderRange range = slider_range(row_named(sections, "constraints[0].to"));
  CHECK(range.low <= -180);
  CHECK(range.high >= 180);
}

TEST_CASE("a motor is changed, its motion chosen and switched off in the left pane") {
  PanelDriver driver(tall(), "hoop6_motor");
  REQUIRE(driver.state().shown);
  REQUIRE(driver.panel().has_place("constraints[0].to"));
  CHECK_FALSE(driver.panel().has_place("constraints[0].rate"));  // of another motion
  const auto opened = driver.state().shown;
  driver.drag("constraints[0].to", 0.55, 0.62);
  driver.settle();
  const double to = std::get<double>(driver.state().history.now().edits.at("constraints[0].to"));
  REQUIRE(driver.state().shown != opened);
  // The motor goes where the slider says: the last pose's fold angle, to what round-off of metres is in an
  // angle.
  CHECK(degrees(driver).back() == Approx(to).margin(1e-9));
  driver.click("constraints[0].enabled");
  driver.settle();
  CHECK_FALSE(driver.panel().has_place("constraints[0].to"));
  CHECK(driver.state().shown->simulation.trajectory.model().structure.constraints.size() + 1 ==
        opened->simulation.trajectory.model().structure.constraints.size());
  driver.key(Key::z, true);
  driver.key(Key::z, true);
  driver.settle();
  CHECK_FALSE(is_edited(driver.state().history.now()));
}

TEST_CASE("a drive is added in the left pane, acts, is written into the file and taken away again") {
  PanelDriver driver(tall());
  const SceneDocument start = driver.state().history.now();
  driver.click("add constraints");
  driver.frame();
  driver.click("add angle");
  driver.settle();
  REQUIRE(driver.panel().has_place("constraints[0].to"));
  CHECK(driver.state().problems.empty());
  const SceneDocument added = driver.state().history.now();
  CHECK(added.added.size() == 1);
  // It begins as a motor that all but deploys the ring: to a twentieth of its fold angle (rounded to 0.001).
  const auto angle = degrees(driver);
  CHECK(angle.back() == Approx(0.05 * angle.front()).margin(1e-3));
  driver.drag("constraints[0].to", 0.7, 0.6);
  driver.settle();
  const SceneDocument edited = driver.state().history.now();
  const Scene meant = read_document(edited);
  REQUIRE(meant.constraints.size() == 1);

  const ScratchDirectory scratch;
  WrittenBack written;
  const SceneDocument saved = save_document(edited, scratch / "ring.toml", written);
  CHECK_FALSE(written.anew);  // comments stay
  CHECK_FALSE(is_edited(saved));
  Scene read = read_document(saved);
  read.name = meant.name;
  CHECK(scene_text(read) == scene_text(meant));
  // And the command line that is offered means the same.
  CHECK(scene_text(read_scene_file(edited.path, overrides_of(edited))) == scene_text(meant));

  driver.click("remove constraints[0]");
  driver.settle();
  CHECK(driver.state().history.now().added.empty());
  CHECK(driver.state().history.now().edits.empty());
  CHECK(driver.state().shown->scene.constraints.empty());
  for (int i = 0; i < 3; ++i) driver.key(Key::z, true);
  CHECK(driver.state().history.now() == start);
}

TEST_CASE("a new entry of every kind is sound TOML with members of the structure") {
  for (const char* name : {"hoop6", "four_bar", "pendulum"}) {
    const SceneDocument document = open_document(name, {});
    std::vector<std::pair<std::string, std::string>> kinds{{"loads", ""}};
    for (const ElementKind& kind : scene_forces()) kinds.emplace_back("forces", kind.kind);
    for (const ElementKind& kind : scene_constraints()) kinds.emplace_back("constraints", kind.kind);
    for (const auto& [table, kind] : kinds) {
      INFO(name << " " << table << " " << kind);
      // A pendulum has one rod: no angle between two; only the ring deploys and can latch.
      const bool no_angle = std::string(name) == "pendulum" &&
                            (kind.starts_with("angle") || kind == "torsion_spring" || kind == "bending" ||
                             kind == "motor" || kind == "joint_damping");
      if (no_angle || (kind == "latch" && std::string(name) != "hoop6")) {
        CHECK_THROWS_AS(new_entry(document, table, kind, {}), SceneError);
        continue;
      }
      std::string entry;
      try {
        entry = new_entry(document, table, kind, {});
      } catch (const SceneError&) {  // first_values_test.cpp says which may be
        CHECK(table == "constraints");
        continue;
      }
      const SceneDocument with = with_entry(document, entry);
      const Scene scene = base_scene(with);
      CHECK(scene.loads.size() + scene.forces.size() + scene.constraints.size() ==
            1 + base_scene(document).loads.size() + base_scene(document).forces.size() +
                base_scene(document).constraints.size());
      CHECK_NOTHROW(build_structure(scene));
    }
  }
}

TEST_CASE("a new entry acts on what is selected") {
  const SceneDocument document = open_document("hoop6", {});
  CHECK(new_entry(document, "loads", "", {Selection::Kind::node, "T3"}) ==
        "loads[0]={nodes = [\"T3\"], force = [0.0, 0.0, -1.0]}");
  CHECK(new_entry(document, "forces", "follower", {Selection::Kind::rod, "B0-T0"}) ==
        "forces[0]={kind = \"follower\", rod = \"B0-T0\", force = 1.0}");
  // A spring joins nodes that no rod joins.
  const Scene scene = base_scene(
      with_entry(document, new_entry(document, "forces", "spring", {Selection::Kind::node, "B0"})));
  REQUIRE(scene.forces.at(0).nodes.size() == 2);
  CHECK(scene.forces[0].nodes[0] == "B0");
  for (const Rod& rod : build_structure(scene).rods) {
    const std::string &a = scene.forces[0].nodes[0], &b = scene.forces[0].nodes[1];
    CHECK(rod.name != a + "-" + b);
    CHECK(rod.name != b + "-" + a);
  }
}

TEST_CASE("a new drive or stop follows what its members measure, whatever they are called") {
  const std::string scene =
      "[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'up_stop'\nposition = [0, 0, 3]\nmass = 1\n"
      "[[structure.nodes]]\nname = 'foot'\nposition = [0, 0, 0]\nfixed = true\n";
  SceneDocument document = open_document("pendulum", {});
  document.text = std::make_shared<const std::string>(scene);
  const Selection up{Selection::Kind::node, "up_stop"};
  CHECK(new_entry(document, "constraints", "length", up).find("to = 2.7,") != std::string::npos);
  CHECK(new_entry(document, "constraints", "length_stop", up).ends_with("min = 2.7}"));
  CHECK(new_entry(document, "constraints", "coordinate_stop", up).ends_with("min = 2.9}"));
}

TEST_CASE("what is offered has a name and a sentence, and a cable is a spring that only pulls") {
  for (const char* table : {"loads", "forces", "constraints"})
    for (const ElementOffer& offer : element_offers(table)) {
      INFO(offer.kind);
      if (offer.table != "loads")
        CHECK(find_kind(offer.table == "forces" ? scene_forces() : scene_constraints(), offer.kind));
      CHECK(offer.name.size() > 3);
      CHECK(offer.sentence.size() > 10);
    }
  const auto offers = element_offers("forces");
  const auto cable =
      std::find_if(offers.begin(), offers.end(), [](const auto& o) { return o.name == "Cable"; });
  REQUIRE(cable != offers.end());
  const SceneDocument document = open_document("four_bar", {});
  const Scene scene =
      base_scene(with_entry(document, new_entry(document, cable->table, cable->kind, {}, cable->extra)));
  CHECK(scene.forces.at(0).values.boolean("tension_only"));
}

TEST_CASE("taking an entry away moves the ones behind it up, with their edits") {
  SceneDocument document = open_document("hoop6", {});
  for (const char* node : {"B0", "B1", "B2"})
    document = with_entry(document, new_entry(document, "loads", "", {Selection::Kind::node, node}));
  document = with_entry(document, new_entry(document, "forces", "drag", {Selection::Kind::node, "B5"}));
  document.edits["loads[1].force"] = std::vector<double>{1, 0, 0};
  document.edits["loads[2].force"] = std::vector<double>{2, 0, 0};
  document.edits["forces[0].damping"] = 3.0;
  document = without_entry(document, "loads[1]");
  const Scene scene = read_document(document);
  REQUIRE(scene.loads.size() == 2);
  CHECK(scene.loads[0].nodes.at(0) == "B0");
  CHECK(scene.loads[1].nodes.at(0) == "B2");
  CHECK(scene.loads[1].force.x() == 2);
  CHECK(scene.forces.at(0).values.real("damping") == 3);
  CHECK(document.edits.size() == 2);
}

TEST_CASE("what another choice makes meaningless has no row") {
  PanelDriver driver(tall());
  CHECK(driver.panel().has_place("solver.stages"));
  CHECK_FALSE(driver.panel().has_place("solver.baumgarte"));
  CHECK_FALSE(driver.panel().has_place("solver.turn"));
  driver.state().history.edit("solver.method", std::string("rk4_baumgarte"));
  driver.state().history.edit("solver.adaptive", true);
  driver.settle();
  CHECK_FALSE(driver.panel().has_place("solver.stages"));
  CHECK(driver.panel().has_place("solver.baumgarte"));
  CHECK(driver.panel().has_place("solver.turn"));
  // What is wrong is seen in any case.
  driver.state().history.edit("solver.stages", 99L);
  driver.settle();
  CHECK(driver.panel().has_place("solver.stages"));
}

TEST_CASE("the selected node or rod of a custom structure has rows of its own") {
  PanelDriver driver(tall(), "four_bar");
  driver.state().selected = {Selection::Kind::rod, "coupler"};
  driver.settle();
  REQUIRE(driver.panel().has_place("structure.rods[1].mass"));
  const ParamRow& length = row_named(driver.state().sections, "structure.rods[1].length");
  CHECK(not_given(length.value));
  CHECK(length.typical == Approx(std::hypot(2.6, 1.4)));  // from (0, 0, 1) to (2.6, 0, 2.4)
  driver.drag("structure.rods[1].mass", 0.5, 0.8);
  driver.settle();
  const double mass = std::get<double>(driver.state().history.now().edits.at("structure.rods[1].mass"));
  CHECK(mass > 3);
  CHECK(driver.state().shown->scene.custom.rods.at(1).mass == mass);
  driver.state().selected = {Selection::Kind::node, "C"};
  driver.settle();
  CHECK_FALSE(driver.panel().has_place("structure.rods[1].mass"));
  CHECK(std::get<std::vector<double>>(
            row_named(driver.state().sections, "structure.nodes[2].position").value) ==
        std::vector<double>{2.6, 0, 2.4});
  driver.click("structure.nodes[2].fixed");
  driver.settle();
  CHECK(read_document(driver.state().history.now()).custom.nodes.at(2).fixed);
  // Nodes of a family have no parameters of their own.
  CHECK(selected_section(base_scene(open_document("hoop6", {})), {Selection::Kind::node, "B0"}).rows.empty());
}

TEST_CASE("what is not given begins with a value that the parameter allows") {
  int seen = 0;
  for (const LibraryScene& scene : library_scenes()) {
    const Scene base = base_scene(open_document(scene.name, {}));
    for (const ParamSection& section : param_sections(base))
      for (const ParamRow& row : section.rows) {
        if (!not_given(row.value)) continue;
        ++seen;
        INFO(scene.name << " " << row.key);
        const double first = first_value(row);
        CHECK(range_error(row.spec, first) == "");
        if (row.spec.name == "youngs_modulus") CHECK(first == 7e10);
        if (row.spec.name == "strength") CHECK(first == 3e8);
      }
  }
  CHECK(seen > 10);
  // Of a value as small as a rounding, the value; above a limit that is none itself, something.
  ParamRow row{"a.b", "b", positive_param("b", "m", std::numeric_limits<double>::infinity(), ""),
               std::numeric_limits<double>::quiet_NaN()};
  row.typical = 1e-9;
  CHECK(first_value(row) == 1e-9);
  row.typical = std::numeric_limits<double>::quiet_NaN();
  CHECK(first_value(row) > 0);
}

}  // namespace entries_test
