// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>
#include <unordered_map>
#include <vector>

namespace unfurl {

// Does `name` match `pattern` with * and ?
bool glob_match(std::string_view pattern, std::string_view name);

// Finds entries of a list by name or pattern. Keeps views: the names must outlive it.
class NameIndex {
 public:
  // The index of the name before, where it is there already; -1 where it is new (and takes the next index).
  int add(std::string_view name);
  int find(std::string_view name) const;  // -1: there is none
  // What one pattern means: the name itself where there is one, else all that match its * and ?. Ascending.
  std::vector<int> matching(std::string_view pattern) const;
  const std::vector<std::string_view>& names() const { return names_; }

 private:
  std::vector<std::string_view> names_;
  std::unordered_map<std::string_view, int> index_;
};

}  // namespace unfurl
