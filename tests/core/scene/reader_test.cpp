// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/reader.hpp"

#include <catch2/catch.hpp>

#include "tests/support/scene_run.hpp"

using namespace unfurl;

namespace reader_test {

namespace {

using testing::error_of;

const std::string hoop = "[structure]\nkind = 'hoop'\n";

}  // namespace

TEST_CASE("a short scene takes the defaults") {
  const Scene scene = read_scene_text(hoop, "dir/ring.toml");
  CHECK(scene.name == "ring");
  CHECK(scene.title == "ring");
  CHECK(scene.kind == "hoop");
  CHECK(scene.structure.integer("units") == 6);
  CHECK(scene.solver.method == "dvm");
  CHECK(scene.gravity.isZero(0.0));
  CHECK(scene.render.width == 1280);
}

TEST_CASE("every table is read") {
  const Scene scene = read_scene_text(
      "title = 'T'\n" + hoop +
          "units = 7\npost_length = 2\n[gravity]\nacceleration = [0, 0, -9.81]\n[[loads]]\nnodes = 'B*'\n"
          "force = [1, 2, 3]\n[solver]\nstages = 4\nstep = 0.5\nend_time = 3\n[render]\nsize = [64, 48]\nfps "
          "= 25\n",
      "x");
  CHECK(scene.title == "T");
  CHECK(scene.structure.integer("units") == 7);
  CHECK(scene.structure.real("post_length") == 2.0);
  CHECK(scene.gravity == Vec3(0, 0, -9.81));
  REQUIRE(scene.loads.size() == 1);
  CHECK(scene.loads[0].nodes == std::vector<std::string>{"B*"});
  CHECK(scene.loads[0].force == Vec3(1, 2, 3));
  CHECK(scene.solver.stages == 4);
  CHECK(scene.solver.step == 0.5);
  CHECK(scene.render.width == 64);
  CHECK(scene.render.fps == 25.0);
}

TEST_CASE("a whole number may be written 3.0, anything else may not") {
  CHECK(read_scene_text(hoop + "units = 8.0", "x").structure.integer("units") == 8);
  CHECK(error_of(hoop + "units = 8.5") ==
        "s.toml:3:9: structure.units: must be a whole number in [3, 100000]; got 8.5");
  CHECK(error_of(hoop + "units = 1e300").find("must be a whole number") != std::string::npos);
}

TEST_CASE("an error names file, line, column, key, range and the nearest name") {
  CHECK(error_of(hoop + "units = 2") ==
        "s.toml:3:9: structure.units: must be a whole number in [3, 100000]; got 2");
  CHECK(error_of(hoop + "post_length = -1") == "s.toml:3:15: structure.post_length: must be > 0 m; got -1");
  CHECK(error_of(hoop + "post_lenght = 1") ==
        "s.toml:3:1: structure.post_lenght: unknown key; did you mean 'post_length'?");
  // A rename alone would take 1200 mm for 1200 m.
  CHECK(error_of(hoop + "post_length_mm = 1200") ==
        "s.toml:3:1: structure.post_length_mm: unknown key; give 'post_length', converted to m");
  for (const char* unit : {"_nm", "_\u00B5m", " km", "_A", "_kgm3"})
    CHECK(error_of(hoop + "\"post_length" + unit + "\" = 750") ==
          std::string("s.toml:3:1: structure.post_length") + unit +
              ": unknown key; give 'post_length', converted to m");
  CHECK(error_of(hoop + "post_length_error = 0.1").find("converted") == std::string::npos);  // no unit
  CHECK(error_of(hoop + "density = 'x'") ==
        "s.toml:3:11: structure.density: must be a number > 0 kg/m^3; got the text 'x'");
  CHECK(error_of(hoop + "density = nan") ==
        "s.toml:3:11: structure.density: must be a finite number > 0 kg/m^3; got nan");
  CHECK(error_of(hoop + "density = inf") ==
        "s.toml:3:11: structure.density: must be a finite number > 0 kg/m^3; got inf");
  CHECK(error_of(hoop + "model = 'sectr'") ==
        "s.toml:3:9: structure.model: must be one of full, sector, joints; got 'sectr'; did you mean "
        "'sector'?");
  CHECK(error_of(hoop + "units = [1]") ==
        "s.toml:3:9: structure.units: must be a whole number in [3, 100000]; got a list of 1 entry");
  CHECK(error_of(hoop + "units = 1979-05-27").find("got a date or time") != std::string::npos);
  CHECK(error_of(hoop + "[solvr]\n") == "s.toml:3:2: solvr: unknown key; did you mean 'solver'?");
  CHECK(error_of(hoop + "[solver]\nmethod = 'rk5'").find("did you mean 'rk4'?") != std::string::npos);
  CHECK(error_of("") == "s.toml:1:1: structure: is missing; a scene needs a [structure] table");
  CHECK(error_of("structure = 3") ==
        "s.toml:1:13: structure: must be a table, [structure]; got the whole number 3");
  const std::string no_kind = error_of("[structure]\n");
  CHECK(no_kind.starts_with("s.toml:1:1: structure.kind: is missing; must be one of hoop, "));
  CHECK(no_kind.ends_with(", custom"));
  CHECK(error_of("[structure]\nkind = 'hop'").find("did you mean 'hoop'?") != std::string::npos);
}

TEST_CASE("lists of the wrong length or with wrong entries are refused") {
  CHECK(error_of(hoop + "[gravity]\nacceleration = [0, 0]") ==
        "s.toml:4:16: gravity.acceleration: must be a list of 3 numbers in m/s^2; got [0, 0]");
  CHECK(error_of(hoop + "[gravity]\nacceleration = [0, 0, 'x']") ==
        "s.toml:4:16: gravity.acceleration: must be a list of 3 numbers in m/s^2; got a list with text");
  CHECK(error_of(hoop + "[gravity]\nacceleration = [0, 0, nan]").find("got [0, 0, nan]") !=
        std::string::npos);
  CHECK(error_of(hoop + "[render]\nsize = [100.5, 100]").find("whole numbers of pixels") !=
        std::string::npos);
  CHECK(error_of(hoop + "[[loads]]\nforce = [0,0,1]").find("loads[0].nodes: is missing") !=
        std::string::npos);
  CHECK(error_of(hoop + "[loads]\nforce = [0,0,1]").find("must be an array of tables, [[loads]]") !=
        std::string::npos);
  CHECK(error_of(hoop + "[[loads]]\nnodes = []\nforce = [0,0,1]").find("got an empty list") !=
        std::string::npos);
  CHECK(error_of(hoop + "[[loads]]\nnodes = [3]\nforce = [0,0,1]").find("a list with the whole number 3") !=
        std::string::npos);
}

TEST_CASE("all mistakes are reported at once, in the file's order") {
  CHECK(error_of(hoop + "units = 2\nmodell = 'full'\n[solver]\nstep = 0\n[render]\nfps = 'x'\n") ==
        "s.toml:3:9: structure.units: must be a whole number in [3, 100000]; got 2\n"
        "s.toml:4:1: structure.modell: unknown key; did you mean 'model'?\n"
        "s.toml:6:8: solver.step: must be > 0 s; got 0\n"
        "s.toml:8:7: render.fps: must be a number in [0.1, 1000] frames/s; got the text 'x'");
}

TEST_CASE("mistakes in overrides name --set") {
  CHECK(error_of(hoop, {"solver.step=0"}) == "--set solver.step: must be > 0 s; got 0");
  CHECK(error_of(hoop, {"solver.stpe=1"}) == "--set solver.stpe: unknown key; did you mean 'step'?");
  CHECK(error_of(hoop + "units = 2", {"structure.units=4"}).empty());
  CHECK(error_of(hoop, {"structure.kind=custom"}).find("a custom structure needs nodes") !=
        std::string::npos);
}

TEST_CASE("an unreasonable number of steps is refused") {
  CHECK(error_of(hoop + "[solver]\nstep = 1e-9\nend_time = 10") ==
        "s.toml:4:8: solver.step: end_time / step would be more than 1e9 steps; take a larger step or an "
        "earlier "
        "end_time");
}

TEST_CASE("a scene file that is not there is named") {
  CHECK_THROWS_WITH(read_scene_file("/nowhere/x.toml"),
                    "cannot read scene /nowhere/x.toml: No such file or directory");
  CHECK_THROWS_WITH(read_scene_file("/"), "cannot read scene /: is a directory");
  CHECK_THROWS_WITH(read_scene_file("/dev/zero"), "cannot read scene /dev/zero: is larger than 64 MB");
}

}  // namespace reader_test
