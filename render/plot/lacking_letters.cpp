// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/lacking_letters.hpp"

#include <mutex>
#include <set>
#include <utility>

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

std::string take_lacking_letters() {
  constexpr std::size_t most = 12;
  const std::lock_guard lock(lacking().mutex);
  const auto letters = std::exchange(lacking().letters, {});
  if (letters.empty()) return {};
  std::string text = "DejaVu Sans has no ";
  std::size_t told = 0;
  for (const std::string& letter : letters)
    if (told < most) text += (told++ == 0 ? "" : ", ") + letter;
  if (letters.size() > most) text += " and " + std::to_string(letters.size() - most) + " more";
  return text + ": pictures and figures show signs in their place; figures as SVG have them";
}

}  // namespace unfurl::plot
