// SPDX-License-Identifier: BSD-3-Clause
// Programs beside this one when this one is ended by a signal.
#include "render/image/child_process.hpp"

#include <signal.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

#include "tests/app/run_program.hpp"

using namespace unfurl;

namespace child_process_test {

TEST_CASE("children that keep their work are asked to end once and the others are killed") {
  const ScratchDirectory scratch;
  const std::string ready = scratch / "ready", asked = scratch / "asked";
  const std::string script = "n=0; trap 'n=$((n+1)); echo x >> " + asked + "' TERM; : > " + ready +
                             "; for i in 1 2 3 4 5 6 7 8 9 10; do sleep 0.05; done; exit $n";
  const auto code = [&](ChildProcess::Ending ending, bool stopped_before) {
    std::filesystem::remove(ready);
    std::filesystem::remove(asked);
    ChildProcess child;
    REQUIRE(child.start({"sh", "-c", script}, {}, ending) == 0);
    const auto wait_for = [](const std::string& file) {
      for (int i = 0; i < 20000 && !std::filesystem::exists(file); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
    wait_for(ready);
    if (stopped_before) {
      child.send(SIGTERM);
      wait_for(asked);  // two signals that wait are one
    }
    end_children();
    return child.wait().value_or(-1);
  };
  CHECK(code(ChildProcess::Ending::killed, false) == 128 + SIGKILL);
  CHECK(code(ChildProcess::Ending::asked, false) == 1);
  CHECK(code(ChildProcess::Ending::asked, true) == 1);
}

}  // namespace child_process_test
