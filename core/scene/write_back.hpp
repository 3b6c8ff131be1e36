// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace unfurl {

// The text of a scene file with overrides ("key=value", overrides.hpp) written into it: changed values in
// their places, new keys behind the others of their table, everything else as it was, comments and order
// included. Where that cannot be done (a key inside an inline table, say), the scene written anew
// (write.hpp), with the title that the text gives; `anew` tells. Either way the result means the same scene
// as text and overrides together. Throws SceneError where those are not sound.
struct WrittenBack {
  std::string text;
  bool anew = false;
};
inline constexpr const char* said_of_written_anew =
    "the file has no place for these values: the scene is written anew, without its comments and variables";
WrittenBack write_back(std::string_view text, const std::string& name,
                       const std::vector<std::string>& overrides, const std::string& folder);

}  // namespace unfurl
