// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "core/scene/build.hpp"
#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"
#include "core/simulate/simulation.hpp"

using namespace unfurl;

// What is asked of a run between its states must not depend on what was asked before: a file that was written
// behind another one is made again by itself (reproduce), to the byte. The first question meets a method that
// is new.
TEST_CASE("the motion between states has the same bits whatever was asked before") {
  for (const char* method : {"dvm", "rk4_projected", "generalized_alpha"})
    for (const char* name : {"bricard", "reentrant_sheet", "hoop6", "scissor_mast"}) {
      INFO(method << " " << name);
      const Scene scene = read_scene_file(find_scene(name), {"solver.end_time=0.06", "solver.step=0.004",
                                                             std::string("solver.method=") + method});
      const auto run = [&] { return simulate(build_model(scene), scene.solver).trajectory; };
      const Trajectory asked_much = run();
      for (const double share : {0.08, 0.5, 0.93}) {
        const double t = share * asked_much.end_time();
        const VectorXd first = run().positions_at(t);
        for (const double other : {0.03, 0.31, 0.77})
          (void)asked_much.positions_at(other * asked_much.end_time());
        CHECK((asked_much.positions_at(t).array() == first.array()).all());
      }
    }
}
