// SPDX-License-Identifier: BSD-3-Clause
#include "app/output/checkpoint_head.hpp"

#include <fstream>
#include <iterator>
#include <system_error>

#include "core/export/checksum.hpp"
#include "core/scene/text_file.hpp"
#include "core/scene/write.hpp"
#include "core/text/version.hpp"

namespace unfurl {

std::string checkpoint_head(const Scene& scene) {
  Checksum sum;
  sum.add(scene_text(scene));
  sum.add(version());
  sum.add(read_text_file("/proc/self/exe").text);
  return std::string(checkpoint_magic) + sum.text() + "\n";
}

bool holds_checkpoint(const std::filesystem::path& directory) {
  std::error_code error;
  return std::filesystem::exists(directory / "unfinished" / "checkpoint", error);
}

bool holds_checkpoint_of(const Scene& scene, const std::filesystem::path& directory) {
  std::ifstream in(directory / "unfinished" / "checkpoint", std::ios::binary);
  std::string first(checkpoint_magic.size(), '\0');
  if (!in.read(first.data(), std::ssize(first)) || first != checkpoint_magic) return false;
  const std::string head = checkpoint_head(scene);
  first.resize(head.size());
  in.seekg(0);
  return in.read(first.data(), std::ssize(first)) && first == head;
}

}  // namespace unfurl
