// SPDX-License-Identifier: BSD-3-Clause
// Where strings of TOML end, before a parser has seen them.
#include <catch2/catch.hpp>
#include <string>

#include "core/scene/toml_tree.hpp"

using namespace unfurl;

namespace toml_guard_test {

// What is left of a text behind the string that it begins with.
std::string behind(const std::string& text) {
  return text.substr(string_end(text, 0));
}

TEST_CASE("a string of TOML ends where the language says (TOML 1.0, strings)") {
  CHECK(behind(R"("a" # b)") == " # b");
  CHECK(behind(R"('a' # b)") == " # b");
  CHECK(behind(R"("a\"b" c)") == " c");  // a quote that is escaped
  CHECK(behind(R"('a\' c)") == " c");    // a literal string has no escapes
  CHECK(behind(R"("" x)") == " x");
  CHECK(behind(R"("it's" x)") == " x");
  CHECK(behind("\"a\n\" x") == "\n\" x");  // no line break in it: it ends there
  for (const std::string three : {R"(""")", "\'\'\'"}) {
    const std::string one = three.substr(0, 1);
    CHECK(behind(three + "a\nb" + three + " x") == " x");
    CHECK(behind(three + "a" + one + "b" + three + " x") == " x");
    CHECK(behind(three + "a" + one + three + " x") == " x");        // four: the first is of the string
    CHECK(behind(three + "a" + one + one + three + " x") == " x");  // five
    CHECK(behind(three + "a" + three + one + one + one + " x") == one + " x");  // six: the last is not
    CHECK(behind(three + three + " x") == " x");
    CHECK(behind(three + "a") == "");  // never
    CHECK(behind(three + "a" + one + three) == "");
    CHECK(behind(three + "a" + three + one) == "");
  }
  CHECK(behind(R"("""a\""" b""" x)") == " x");
}

}  // namespace toml_guard_test
