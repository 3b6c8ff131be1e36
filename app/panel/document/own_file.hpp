// SPDX-License-Identifier: BSD-3-Clause
// How a scene that is open stands to the file that it came from.
#pragma once

#include <cstdint>
#include <filesystem>

#include "app/panel/document/scene_document.hpp"

namespace unfurl {

enum class OwnFile {
  same,    // holds the document's text; or the document has no file
  other,   // holds another text that was saved from here, or is gone
  changed  // by another program
};

// `saved`: what was saved last; null: nothing.
OwnFile own_file(const SceneDocument& document, const SceneDocument* saved);

// The same from frame to frame: reads the file only where it, or the document, is another than before.
class OwnFileWatch {
 public:
  OwnFile look(const SceneDocument& document, const SceneDocument* saved);

 private:
  std::string path_;
  std::shared_ptr<const std::string> text_, saved_;
  std::filesystem::file_time_type written_ = {};
  std::uintmax_t size_ = 0;
  OwnFile last_ = OwnFile::same;
};

}  // namespace unfurl
