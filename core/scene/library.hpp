// SPDX-License-Identifier: BSD-3-Clause
// The scenes that come with the program.
#pragma once

#include <string>
#include <vector>

namespace unfurl {

// The folder of a kind of asset ("scenes"): in $UNFURL_ASSETS, in ../share/unfurl beside the program, where
// it was installed, or in the source tree that the program lies in; the first that exists. Empty: none does.
std::string asset_folder(const std::string& kind);

struct LibraryScene {
  std::string name;  // "hoop6"
  std::string path;
  std::string title;  // "" where the file cannot be read
};
std::vector<LibraryScene> library_scenes();  // by name; none where they are not installed
std::string no_library();                    // says so, and what to do

// The file that SCENE of a command line means: the file of that name, or else the library's scene. Throws
// UnreadableScene (reader.hpp) with the nearest name.
std::string find_scene(const std::string& scene);

}  // namespace unfurl
