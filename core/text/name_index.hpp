// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace unfurl {

// Does `name` match `pattern` with * and ?
bool glob_match(std::string_view pattern, std::string_view name);

// Finds entries of a list by name or pattern.
class NameIndex {
 public:
  NameIndex() = default;
  NameIndex(NameIndex&&) = default;  // a deque's entries stay where they are; those of a copy are others
  NameIndex& operator=(NameIndex&&) = default;

  // The index of the name before, where it is there already; -1 where it is new (and takes the next index).
  int add(std::string_view name);
  int find(std::string_view name) const;  // -1: there is none
  // What one pattern means: the name itself where there is one, else all that match its * and ?. Ascending.
  std::vector<int> matching(std::string_view pattern) const;
  const std::vector<std::string_view>& names() const { return names_; }

 private:
  std::deque<std::string> kept_;
  std::vector<std::string_view> names_;  // of those
  std::unordered_map<std::string_view, int> index_;
};

}  // namespace unfurl
