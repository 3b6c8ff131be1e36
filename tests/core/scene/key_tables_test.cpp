// SPDX-License-Identifier: BSD-3-Clause
// The list of keys is what the reader reads: every key of every table, and nothing else.
#include "core/scene/key_tables.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "core/scene/build.hpp"
#include "core/scene/elements.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/scene_template.hpp"
#include "core/structures/family.hpp"
#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace key_tables_test {

namespace {

using testing::error_of;

// A value that no key takes: each says of itself what it wants, and an unknown key that it is unknown.
std::string with_every_key(const KeyTable& table) {
  std::string text = table.header.starts_with("[structure]") ? "" : "[structure]\nkind = \"custom\"\n";
  text += table.header + "\n";
  for (const ParamSpec& spec : table.keys)
    text += std::string(spec.name) + " = " +
            (spec.name == "kind" ? "\"" + std::get<std::string>(spec.fallback) + "\"" : "1979-05-27") + "\n";
  return text;
}

}  // namespace

TEST_CASE("every listed key is read") {
  for (const KeyTable& table : key_tables()) {
    if (table.header.empty()) continue;
    const std::string told = error_of(with_every_key(table));
    INFO(table.name << "\n" << told);
    CHECK(told.find("unknown key") == std::string::npos);
    for (const ParamSpec& spec : table.keys)
      if (spec.name != "kind") CHECK(told.find("." + std::string(spec.name) + ": ") != std::string::npos);
  }
}

TEST_CASE("every key has a meaning, a type and a range, and tables have names of their own") {
  std::set<std::string> names;
  for (const KeyTable& table : key_tables()) {
    CHECK(names.insert(table.name).second);
    CHECK_FALSE(table.help.empty());
    for (const ParamSpec& spec : table.keys) {
      INFO(table.name << "." << spec.name);
      CHECK_FALSE(spec.help.empty());
      CHECK_FALSE(range_text(spec).empty());
    }
  }
  for (const Family& family : families()) CHECK(names.contains("structure." + std::string(family.kind)));
  for (const ElementKind& kind : scene_forces()) CHECK(names.contains("forces." + std::string(kind.kind)));
  for (const ElementKind& kind : scene_constraints())
    CHECK(names.contains("constraints." + std::string(kind.kind)));
}

// What a condition names is a key of the same table, its values are among the choices of that, and no key
// waits for itself.
TEST_CASE("keys that go with others go with keys that there are, and with values that those can have") {
  for (const KeyTable& table : key_tables())
    for (const ParamSpec& spec : table.keys)
      for (const ParamCondition& condition : spec.only) {
        INFO(table.name << "." << spec.name << " with " << condition.other);
        const auto other = std::ranges::find(table.keys, condition.other, &ParamSpec::name);
        REQUIRE(other != table.keys.end());
        for (const std::string_view value : condition.values) {
          if (other->kind == ParamKind::boolean)
            CHECK((value == "true" || value == "false"));
          else
            CHECK(std::ranges::count(other->choices, value) == 1);
        }
        if (condition.values.empty())
          CHECK((other->kind == ParamKind::real || other->kind == ParamKind::integer));
        std::vector<std::string_view> above{spec.name, condition.other};
        for (std::size_t i = 1; i < above.size(); ++i)
          for (const ParamSpec& key : table.keys)
            if (key.name == above[i])
              for (const ParamCondition& further : key.only) {
                REQUIRE(further.other != spec.name);
                above.push_back(further.other);
                REQUIRE(above.size() < 100);
              }
      }
}

TEST_CASE("a new scene shows as comments what does nothing as the others are") {
  const std::string chain = scene_template("chain"), custom = scene_template("custom");
  CHECK(chain.find("\nspan = ") != std::string::npos);  // shape = "catenary"
  CHECK(chain.find("\n# angle = ") != std::string::npos);
  CHECK(custom.find("\n# error_seed = 1\n") != std::string::npos);  // length_error = 0
  CHECK(scene_template("cable_ring").find("\ncable_ramp = ") != std::string::npos);
}

TEST_CASE("tables are found by name, by group and by their last word") {
  CHECK(find_key_tables("solver").size() == 1);
  CHECK(find_key_tables("render").size() == 3);
  CHECK(find_key_tables("structure").size() == families().size() + 3);
  REQUIRE(find_key_tables("torsion_spring").size() == 1);
  CHECK(find_key_tables("torsion_spring").front()->name == "forces.torsion_spring");
  CHECK(find_key_tables("sprung").empty());
}

TEST_CASE("a new scene of every kind has every key and is a scene that can be built") {
  std::vector<std::string> kinds = {"custom"};
  for (const Family& family : families()) kinds.emplace_back(family.kind);
  for (const std::string& kind : kinds) {
    INFO(kind);
    const std::string text = scene_template(kind);
    CHECK(error_of(text) == "");
    CHECK_NOTHROW(build_model(read_scene_text(text, "s.toml")));
    for (const char* name : {"gravity", "loads", "solver", "render"})
      for (const ParamSpec& spec : find_key_tables(name).front()->keys)
        CHECK(text.find("\n" + std::string(spec.name) + " = ") +
                  text.find("\n# " + std::string(spec.name) + " = ") !=
              2 * std::string::npos);
    for (const ParamSpec& spec : find_key_tables("structure." + kind).front()->keys)
      CHECK(text.find("\n" + std::string(spec.name) + " = ") +
                text.find("\n# " + std::string(spec.name) + " = ") !=
            2 * std::string::npos);
  }
}

TEST_CASE("families that say that they deploy have a deployed pose, the others none") {
  for (const Family& family : families()) {
    INFO(family.kind);
    CHECK(family.deploys == !family.build(ParamSet(family.params())).deployment.empty());
  }
}

TEST_CASE("the values of a new scene are the defaults") {
  const Scene made = read_scene_text(scene_template("scissor_mast"), "s.toml");
  const Scene bare = read_scene_text("[structure]\nkind = \"scissor_mast\"\n", "s.toml");
  for (const ParamSpec& spec : find_family("scissor_mast")->params())
    CHECK(made.structure.value(spec.name) == bare.structure.value(spec.name));
  CHECK(made.solver.end_time == bare.solver.end_time);
  CHECK(made.solver.method == bare.solver.method);
}

TEST_CASE("what a new scene shows as a comment can be switched on") {
  // Every commented key of [solver] and [render], with the value that stands there.
  const std::string text = scene_template("hoop");
  for (std::size_t at = text.find("\n[solver]"); at < text.size();) {
    const std::size_t end = text.find('\n', at + 1);
    const std::string line = text.substr(at + 1, end - at - 1);
    const std::size_t equals = line.find(" = ");
    if (line.starts_with("# ") && equals != std::string::npos && line.find(' ', 2) == equals) {
      std::string changed = text;
      changed.erase(at + 1, 2);
      INFO(line);
      CHECK(error_of(changed) == "");
    }
    at = end;
  }
}

}  // namespace key_tables_test
