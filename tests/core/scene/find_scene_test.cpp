// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "core/scene/library.hpp"
#include "core/scene/reader.hpp"

using namespace unfurl;
namespace fs = std::filesystem;

namespace find_scene_test {

TEST_CASE("a scene is a file that is there, or one that comes with the program, and never a directory") {
  const fs::path folder =
      fs::temp_directory_path() / ("unfurl_find_scene_test_" + std::to_string(::getpid()));
  fs::create_directories(folder / "hoop6");
  const std::string file = (folder / "mine.toml").string(), none = (folder / "none.toml").string();
  std::ofstream(file) << "title = 'mine'\n";
  CHECK(find_scene(file) == file);
  CHECK(fs::path(find_scene("hoop6")).filename() == "hoop6.toml");
  CHECK(fs::path(find_scene("four_bar")).stem() == "four_bar");
  CHECK_THROWS_WITH(find_scene(folder.string()), "cannot read scene " + folder.string() + ": is a directory");
  const std::string ran = (folder / "hoop6" / "").string(),
                    scene = (folder / "hoop6" / "scene.toml").string();
  std::ofstream(scene) << "title = 'mine'\n";
  CHECK_THROWS_WITH(find_scene(ran),
                    "cannot read scene " + ran + ": is a directory, whose scene is " + scene);
  CHECK_THROWS_WITH(find_scene(none), "cannot read scene " + none + ": no such file");
  CHECK_THROWS_WITH(find_scene("none.toml"), "cannot read scene none.toml: no such file");
  CHECK_THROWS_WITH(find_scene("hop6"),
                    "no scene 'hop6', neither a file nor a built-in one; did you mean 'hoop6'?");
  const fs::path before = fs::current_path();
  fs::current_path(folder);  // a directory of its name beside it hides no scene
  CHECK(fs::path(find_scene("hoop6")).filename() == "hoop6.toml");
  CHECK(find_scene("mine.toml") == "mine.toml");
  fs::current_path(before);
  fs::remove_all(folder);
}

}  // namespace find_scene_test
