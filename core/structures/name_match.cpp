#include <algorithm>

#include "core/structures/custom.hpp"

namespace unfurl {

// Greedy matching with one point of return, the last star: linear in practice, never exponential.
bool glob_match(std::string_view pattern, std::string_view name) {
  constexpr std::size_t none = std::string_view::npos;
  std::size_t p = 0, n = 0, star = none, resume = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = n;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n])) {
      ++p;
      ++n;
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

std::vector<int> matching_names(std::string_view pattern, const std::vector<std::string_view>& names) {
  if (const auto exact = std::find(names.begin(), names.end(), pattern); exact != names.end())
    return {static_cast<int>(exact - names.begin())};
  std::vector<int> found;
  if (pattern.find_first_of("*?") == std::string_view::npos) return found;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (glob_match(pattern, names[i])) found.push_back(static_cast<int>(i));
  return found;
}

}  // namespace unfurl
