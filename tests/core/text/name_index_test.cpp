// SPDX-License-Identifier: BSD-3-Clause
#include "core/text/name_index.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace unfurl;

namespace name_index_test {

namespace {

// What * and ? mean, as it is defined: without a thought of what it costs.
bool matches(std::string_view pattern, std::string_view name) {
  if (pattern.empty()) return name.empty();
  const std::string_view rest = pattern.substr(1);
  if (pattern[0] == '*') return matches(rest, name) || (!name.empty() && matches(pattern, name.substr(1)));
  return !name.empty() && (pattern[0] == '?' || pattern[0] == name[0]) && matches(rest, name.substr(1));
}

// Every text of at most so many of these letters.
std::vector<std::string> all_of(std::string_view letters, std::size_t longest) {
  std::vector<std::string> texts = {""};
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (texts[i].size() == longest) break;
    for (const char c : letters) texts.push_back(texts[i] + c);
  }
  return texts;
}

}  // namespace

TEST_CASE("patterns match what their definition says, every short one against every short name") {
  const auto patterns = all_of("ab*?", 5), names = all_of("ab", 5);
  std::size_t found = 0;
  for (const auto& pattern : patterns)
    for (const auto& name : names) {
      const bool same = glob_match(pattern, name) == matches(pattern, name);
      found += matches(pattern, name);
      if (!same) FAIL("'" << pattern << "' and '" << name << "'");
    }
  CHECK(found > names.size());
}

TEST_CASE("a question mark stands for one character, of however many bytes") {
  for (const char* name : {"Aa", "A\u00e9", "A\u20ac", "A\U0001F6F0"}) {
    CHECK(glob_match("A?", name));
    CHECK(glob_match("*?", name));
    CHECK(glob_match("??", name));
    CHECK_FALSE(glob_match("A??", name));
    CHECK_FALSE(glob_match("?", name));
  }
  CHECK(glob_match("?-?", "\u03b1-\u03b2"));
}

TEST_CASE("names are found by themselves and by patterns, in their order") {
  NameIndex index;
  CHECK(index.add("B10") == -1);
  CHECK(index.add("B2") == -1);
  CHECK(index.add("B*") == -1);  // a name that looks like a pattern is itself first
  CHECK(index.add("A2") == -1);
  CHECK(index.add("B2") == 1);  // who had it before
  CHECK(index.add("C2") == -1);
  CHECK(index.names() == std::vector<std::string_view>{"B10", "B2", "B*", "A2", "B2", "C2"});
  CHECK(index.find("C2") == 5);
  CHECK(index.find("B2") == 1);
  CHECK(index.find("B") == -1);
  CHECK(index.matching("B*") == std::vector<int>{2});
  CHECK(index.matching("?2") == std::vector<int>{1, 3, 4, 5});
  CHECK(index.matching("B1*") == std::vector<int>{0});
  CHECK(index.matching("C2") == std::vector<int>{5});
  CHECK(index.matching("C") == std::vector<int>{});
  CHECK(index.matching("*9") == std::vector<int>{});
  const NameIndex moved = std::move(index);
  CHECK(moved.find("A2") == 3);
}

}  // namespace name_index_test
