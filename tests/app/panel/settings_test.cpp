// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/settings.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/app/run_program.hpp"

using namespace unfurl;

TEST_CASE("the window's settings survive, and nonsense in their file does not harm") {
  const ScratchDirectory scratch;
  PanelSettings settings;
  settings.width = 1700;
  settings.dark = true;
  settings.open_figures = {"energy"};
  const std::string file = scratch / "deep/down/window.json";
  CHECK(save_settings(file, settings));
  CHECK(load_settings(file) == settings);
  CHECK(load_settings(scratch / "missing.json") == PanelSettings{});
  CHECK(load_settings(scratch.write("a.json", "{ not json")) == PanelSettings{});
  CHECK(load_settings(scratch.write("b.json", R"({"width": "wide", "dark": 3, "open_figures": 7})")) ==
        PanelSettings{});
  CHECK(load_settings(scratch.write("c.json", R"({"width": -1e300})")).width == 640);
}

TEST_CASE("settings that cannot be written are no error") {
  const ScratchDirectory scratch;
  // A file where a directory should be: it fails for root as well, unlike a directory without permission.
  const std::string file = scratch.write("config", "");
  CHECK_FALSE(save_settings(file + "/unfurl/window.json", PanelSettings{}));
  CHECK_FALSE(save_settings("", PanelSettings{}));
}
