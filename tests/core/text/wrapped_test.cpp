// SPDX-License-Identifier: BSD-3-Clause
#include "core/text/wrapped.hpp"

#include <catch2/catch.hpp>
#include <sstream>
#include <vector>

using namespace unfurl;

namespace wrapped_test {

TEST_CASE("lines are as long as they can be, and no longer") {
  const std::string text =
      "a bb ccc dddd \u00E9\u00E9\u00E9\u00E9\u00E9 ffffff   ggggggg hhhhhhhhhhhhhhhhhhhhhhhhhhhhhhh i jj";
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; stream >> word;) words.push_back(word);
  for (const std::size_t width : {7U, 12U, 13U, 14U, 33U, 80U}) {
    INFO(width);
    std::istringstream lines(wrapped(text, width, "- ", "  "));
    std::size_t word = 0, count = 0;
    for (std::string line; std::getline(lines, line); ++count) {
      REQUIRE(line.substr(0, 2) == (count == 0 ? "- " : "  "));
      std::string rest = line.substr(2), again;
      const std::size_t before = word;
      while (word < words.size() &&
             rest.size() >= again.size() + (again.empty() ? 0 : 1) + words[word].size())
        again += (again.empty() ? "" : " ") + words[word++];
      CHECK(rest == again);  // the words in their order, one space between them
      CHECK(word > before);
      CHECK((characters_in(line) <= width || word == before + 1));
      if (word < words.size()) CHECK(characters_in(line) + 1 + characters_in(words[word]) > width);
    }
    CHECK(word == words.size());
  }
  CHECK(wrapped("one two", 7) == "one two\n");
  CHECK(wrapped("one two", 6) == "one\ntwo\n");
  CHECK(wrapped("", 10, "> ") == "> \n");
  CHECK(characters_in("\u00E9a\U0001F600") == 3);
}

}  // namespace wrapped_test
