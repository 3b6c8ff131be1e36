#pragma once

#include <string>

namespace unfurl {

inline constexpr std::size_t max_text_file_bytes = std::size_t{64} << 20U;

struct TextFile {
  std::string path;  // as messages name it
  std::string text;
  std::string error;  // empty: the text is there
};

// The whole file. Refuses what is not readable as a file and more than max_text_file_bytes (also of an
// endless device).
TextFile read_text_file(const std::string& path);

// A file whose name is relative to the folder and that lies inside it, links followed.
TextFile read_file_beside(const std::string& folder, const std::string& name);

}  // namespace unfurl
