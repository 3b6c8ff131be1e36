// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/document/own_file.hpp"

#include "core/scene/text_file.hpp"

namespace unfurl {

OwnFile own_file(const SceneDocument& document, const SceneDocument* saved) {
  if (document.path.empty()) return OwnFile::same;
  const TextFile there = read_text_file(document.path);
  if (!there.error.empty()) return OwnFile::other;
  if (there.text == *document.text) return OwnFile::same;
  const bool ours = saved != nullptr && saved->path == document.path && there.text == *saved->text;
  return ours ? OwnFile::other : OwnFile::changed;
}

OwnFile OwnFileWatch::look(const SceneDocument& document, const SceneDocument* saved) {
  if (document.path.empty()) return OwnFile::same;
  std::error_code unknown;
  const auto written = std::filesystem::last_write_time(document.path, unknown);
  const std::uintmax_t size = std::filesystem::file_size(document.path, unknown);
  const auto saved_text = saved != nullptr ? saved->text : nullptr;
  if (path_ == document.path && text_ == document.text && saved_ == saved_text && written_ == written &&
      size_ == size)
    return last_;
  path_ = document.path;
  text_ = document.text;
  saved_ = saved_text;
  written_ = written;
  size_ = size;
  return last_ = own_file(document, saved);
}

}  // namespace unfurl
