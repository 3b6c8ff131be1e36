// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace unfurl {

// The text of a scene file with overrides ("key=value", overrides.hpp) written into it: changed values in
// their places, new keys behind the others of their table, everything else as it was, comments and order
// included. Where that cannot be done (a value of one copy of a repeated entry, say), the scene written anew
// (write.hpp), with the title that the text gives. Either way the result means the same scene as text and
// overrides together. Throws SceneError where those are not sound.
struct WrittenBack {
  std::string text;
  bool anew = false;
  std::string lost = {};  // what of the text's own is not in it: "comments, variables"; empty: nothing
};
WrittenBack write_back(std::string_view text, const std::string& name,
                       const std::vector<std::string>& overrides, const std::string& folder);

// What a person who asked for it must know; empty: nothing.
std::string said_of(const WrittenBack& written);

}  // namespace unfurl
