// SPDX-License-Identifier: BSD-3-Clause
#include "core/text/name_index.hpp"

namespace unfurl {

namespace {

// A byte of UTF-8 behind the first of its character.
bool within_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0) == 0x80;
}

}  // namespace

// Greedy matching with one point of return, the last star: linear in practice, never exponential.
bool glob_match(std::string_view pattern, std::string_view name) {
  constexpr std::size_t none = std::string_view::npos;
  std::size_t p = 0, n = 0, star = none, resume = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = n;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n])) {
      ++n;
      while (pattern[p] == '?' && n < name.size() && within_character(name[n])) ++n;
      ++p;
    } else if (star != none) {
      p = star + 1;
      n = ++resume;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

int NameIndex::add(std::string_view name) {
  names_.push_back(kept_.emplace_back(name));
  const auto [entry, is_new] = index_.try_emplace(names_.back(), static_cast<int>(names_.size()) - 1);
  return is_new ? -1 : entry->second;
}

int NameIndex::find(std::string_view name) const {
  const auto entry = index_.find(name);
  return entry == index_.end() ? -1 : entry->second;
}

std::vector<int> NameIndex::matching(std::string_view pattern) const {
  if (const int exact = find(pattern); exact >= 0) return {exact};
  std::vector<int> found;
  if (pattern.find_first_of("*?") == std::string_view::npos) return found;
  for (std::size_t i = 0; i < names_.size(); ++i)
    if (glob_match(pattern, names_[i])) found.push_back(static_cast<int>(i));
  return found;
}

}  // namespace unfurl
