// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "core/scene/toml_tree.hpp"

using namespace unfurl;

namespace toml_parse_test {

namespace {

std::string error_of(std::string_view text) {
  try {
    parse_toml(text, "x.toml");
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a document becomes a tree with locations") {
  const TomlTree tree = parse_toml("b = 1\n[t]\na = [1.5, 'x']\n", "x.toml");
  REQUIRE(tree.find("b"));
  CHECK(tree.find("b")->integer == 1);
  CHECK(tree.find("b")->where == SourceLocation{"x.toml", 1, 5});
  CHECK(tree.find("b")->key_where == SourceLocation{"x.toml", 1, 1});
  const TomlTree* a = tree.find("t")->find("a");
  REQUIRE(a);
  REQUIRE(a->items.size() == 2);
  CHECK(a->items[0].real == 1.5);
  CHECK(a->items[1].text == "x");
  CHECK(a->items[1].where.line == 3);
  CHECK(tree.find("c") == nullptr);
}

TEST_CASE("entries keep the file's order") {
  const TomlTree tree = parse_toml("z = 1\na = 2\nm = 3\n", "x.toml");
  CHECK(tree.entries[0].key == "z");
  CHECK(tree.entries[1].key == "a");
  CHECK(tree.entries[2].key == "m");
}

TEST_CASE("a UTF-8 byte-order mark is skipped, others are named") {
  CHECK(parse_toml("\xEF\xBB\xBF"
                   "a = 1",
                   "x.toml")
            .find("a"));
  CHECK(error_of("\xFF\xFE"
                 "a") ==
        "x.toml:1:1: the file is UTF-16 (it starts with that byte-order mark); save it as UTF-8");
}

TEST_CASE("text that is not UTF-8 is refused with its place") {
  CHECK(error_of("a = 1\nb = \"\xC3\x28\"") == "x.toml:2:6: not valid UTF-8");
  CHECK(error_of("\xC0\xAF") == "x.toml:1:1: not valid UTF-8");              // overlong
  CHECK(error_of("a='\xED\xA0\x80'") == "x.toml:1:4: not valid UTF-8");      // surrogate
  CHECK(error_of("a='\xF4\x90\x80\x80'") == "x.toml:1:4: not valid UTF-8");  // beyond U+10FFFF
  CHECK(error_of("a='\xE2\x82") == "x.toml:1:4: not valid UTF-8");           // cut off
  CHECK(error_of(std::string_view("a\0b", 3)) == "x.toml:1:2: a zero byte: this is not a text file in UTF-8");
  CHECK(error_of("title = 'h\xC3\xB6he \xE2\x82\xAC \xF0\x9F\x9A\x80'").empty());
}

TEST_CASE("columns count characters, not bytes") {
  CHECK(error_of("a = '\xC3\xB6\xC3\xB6' \xFF") == "x.toml:1:10: not valid UTF-8");
}

TEST_CASE("what makes the library fail an assertion is an error with its place") {
  CHECK(error_of("[$") == "x.toml:1:2: not TOML: unexpected character here");
  CHECK(error_of("a = 1\n\n[[ $") == "x.toml:3:4: not TOML: unexpected character here");
}

TEST_CASE("letters beyond ASCII outside strings are refused, inside they are kept") {
  // U+FEDF is the bytes EF BB 9F, nearly a byte-order mark; the others lie in each of the library's ranges of
  // blanks.
  for (const char* letter :
       {"\xEF\xBB\x9F", "\xC3\xA9", "\xE2\xB1\xA0", "\xEF\xAC\xA6", "\xF0\x9F\x9A\x80"}) {
    const std::string text = letter;
    CHECK(error_of(text).starts_with("x.toml:1:1: not TOML: "));
    CHECK(error_of("a = 1 " + text).starts_with("x.toml:1:"));
    CHECK(error_of("a = 1'" + text + "'").starts_with("x.toml:1:"));
    CHECK(error_of("a" + text + " = 1").starts_with("x.toml:1:"));
    CHECK(error_of("a = [1," + text + "]").starts_with("x.toml:1:"));
    CHECK(parse_toml("a = '" + text + "' # " + text, "x").find("a")->text == text);
    CHECK(parse_toml("\"" + text + "\" = 1", "x").find(text));
    CHECK(parse_toml("a = \"\"\"\\\n   " + text + "\"\"\"", "x").find("a")->text == text);
  }
}

TEST_CASE("mistakes of syntax carry line and column") {
  CHECK(error_of("a = 1\na = 2\n").starts_with("x.toml:2:"));
  CHECK(error_of("a = 1\na = 2\n").find("redefine") != std::string::npos);
  CHECK(error_of("a = \n").starts_with("x.toml:1:"));
  CHECK(error_of("[a\n").starts_with("x.toml:1:"));
}

TEST_CASE("nesting past reason is an error, not a stack overflow") {
  std::string dots = "a";
  for (int i = 0; i < 1000000; ++i) dots += ".a";
  CHECK(error_of(dots + " = 1").find("a key with too many dots") != std::string::npos);
  CHECK(error_of("a = " + std::string(1000000, '[')).find("brackets nested too deeply") != std::string::npos);
  CHECK(error_of("a = " + std::string(1000000, '{')).find("brackets nested too deeply") != std::string::npos);
}

TEST_CASE("dots and brackets in strings and comments do not count") {
  const std::string many(200, '[');
  CHECK(error_of("a = '" + many + "'\nb = \"" + many + "\\\"" + many + "\"\n# " + many + "\n").empty());
  CHECK(error_of("a = \"\"\"x\n" + many + "\n\"\"\"\nb = '''\n" + many + "'''\n").empty());
  CHECK(error_of("a = \"................................\"").empty());
  CHECK(error_of("a = \"\"\"x\"\"\"\"\"\nb = 1\n").empty());
}

}  // namespace toml_parse_test
