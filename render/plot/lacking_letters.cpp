// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/lacking_letters.hpp"

#include <mutex>
#include <set>

namespace unfurl::plot {

namespace {

struct Lacking {
  std::mutex mutex;
  std::set<std::string, std::less<>> letters;
};

Lacking& lacking() {
  static Lacking all;
  return all;
}

}  // namespace

void note_lacking(std::string_view letter) {
  const std::lock_guard lock(lacking().mutex);
  lacking().letters.emplace(letter);
}

std::string lacking_letters() {
  constexpr std::size_t most = 12;
  const std::lock_guard lock(lacking().mutex);
  std::string text;
  std::size_t told = 0;
  for (const std::string& letter : lacking().letters) {
    if (told == most) return text + " and " + std::to_string(lacking().letters.size() - most) + " more";
    text += (told++ == 0 ? "" : ", ") + letter;
  }
  return text;
}

}  // namespace unfurl::plot
