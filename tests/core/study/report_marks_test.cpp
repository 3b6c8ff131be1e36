// SPDX-License-Identifier: BSD-3-Clause
// What marks of a report's text mean on its page, by the rules of CommonMark.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>

#include "core/export/atomic_file.hpp"
#include "core/study/report.hpp"

using namespace unfurl;
namespace fs = std::filesystem;

namespace report_marks_test {

namespace {

std::string page_of(const std::string& text) {
  Report report{"T"};
  report.paragraph(text);
  const std::string page = report_html(report, ".");
  const std::size_t begin = page.find("<p>") + 3, end = page.rfind("</p>");
  return page.substr(begin, end - begin);
}

}  // namespace

TEST_CASE("marks of a report's text open and close where they are, and are text where they do not") {
  const std::pair<std::string, std::string> all[] = {
      {"plain", "plain"},
      {"a < b & c", "a &lt; b &amp; c"},
      {"*a*", "<em>a</em>"},
      {"**a** b", "<strong>a</strong> b"},
      {"x *a* y *b* z", "x <em>a</em> y <em>b</em> z"},
      {"*a **b** c*", "<em>a <strong>b</strong> c</em>"},
      {"**a *b* c**", "<strong>a <em>b</em> c</strong>"},
      {"***a***", "***a***"},  // three are no mark here
      {"*a", "*a"},
      {"**a*", "**a*"},
      {"2 * 3", "2 * 3"},
      {"`a*b*c`", "<code>a*b*c</code>"},
      {"`a<b&c`", "<code>a&lt;b&amp;c</code>"},
      {"``a`b``", "<code>a`b</code>"},
      {"`a``b`", "<code>a``b</code>"},
      {"`` `a` ``", "<code>`a`</code>"},  // a blank at each end is not the code's
      {"` a`", "<code> a</code>"},
      {"`a `", "<code>a </code>"},
      {"``a`", "``a`"},
      {"`a", "`a"},
      {"`a` and `b`", "<code>a</code> and <code>b</code>"},
      {"*a `*` b*", "<em>a <code>*</code> b</em>"},  // code binds closer
      {"*a ``*`*`` b*", "<em>a <code>*`*</code> b</em>"},
      {"*a `b* c", "<em>a `b</em> c"},  // what opens nothing hides nothing
      {"*a \\* b*", "<em>a * b</em>"},
      {"\\*a\\*", "*a*"},
      {"\\`a\\`", "`a`"},
      {"a\\_b", "a_b"},
      {"a\\\\b", "a\\b"},
      {"C:\\dir", "C:\\dir"},  // before what is no mark it is text
      {"end\\", "end\\"},
      {"\\*\\*a*b*", "**a<em>b</em>"},
      {"`a\\`b", "<code>a\\</code>b"},  // none within code
  };
  for (const auto& [text, html] : all) {
    INFO(text);
    CHECK(page_of(text) == html);
  }
}

// What is written as it is, is read as it is, in code too.
TEST_CASE("any text comes back from a report as it was") {
  for (const std::string text :
       {"a_b_c", "_a_",   "a _b",  "b_ a", "_",     "\\",        "\\\\",  "a\\",    "\\n",
        "\\.",   "\\*",   "*",     "**",   "***",   "`",         "``",    "a`b``c", "`a",
        "a`",    " `a` ", "x*y*z", "`*`",  "a\\`b", "1 * 2 * 3", "**a**", "\\_x",   "a\\_b"}) {
    INFO(text);
    CHECK(page_of(as_plain(text)) == text);
    CHECK(page_of(as_plain(text) + " and *" + as_plain(text) + "*") == text + " and <em>" + text + "</em>");
    CHECK(page_of(as_code(text)) == "<code>" + text + "</code>");
    CHECK(page_of("*" + as_code(text) + "*, " + as_code(text)) ==
          "<em><code>" + text + "</code></em>, <code>" + text + "</code>");
  }
  CHECK(as_plain("a_b _c_ d_") == "a_b \\_c\\_ d\\_");
  CHECK(as_plain("1_2") == "1_2");
  CHECK(as_plain("a\\b") == "a\\b");
  CHECK(as_plain("a\\.b") == "a\\\\.b");
  CHECK(as_code("a") == "`a`");
  CHECK(as_code("``a`") == "``` ``a` ```");
}

TEST_CASE("blocks of a report stand in their order, pictures by their kind, listings as they are") {
  const fs::path folder = fs::temp_directory_path() / ("unfurl_report_marks_" + std::to_string(::getpid()));
  fs::create_directories(folder / "b c");
  for (const char* name : {"b c/p.svg", "p.webp", "p.png"}) write_file_atomically(folder / name, "fo");
  Report report{"T"};
  report.listing("x = '<1>'\n`y`\n");
  report.picture("b c/p.svg", "*one*");
  report.picture("p.webp", "two");
  report.picture("p.png", "");
  report.add({{"*n*", "m"}, {{"`1`", "-2e3"}, {"", "nan"}}});
  CHECK(report_markdown(report) ==
        "# T\n\n```\nx = '<1>'\n`y`\n```\n\n![*one*](<b c/p.svg>)\n\n![two](p.webp)\n\n![](p.png)\n\n"
        "| *n* | m |\n|---|---:|\n| `1` | -2e3 |\n|  | nan |\n");
  const std::string page = report_html(report, folder);
  const auto picture = [](const char* alt, const char* type, const char* caption) {
    return std::string("<figure><img alt=\"") + alt + "\" src=\"data:image/" + type +
           ";base64,Zm8=\"><figcaption>" + caption + "</figcaption></figure>\n";  // "fo" (RFC 4648)
  };
  CHECK(page.ends_with("<h1>T</h1>\n<pre>x = '&lt;1&gt;'\n`y`\n</pre>\n" +
                       picture("*one*", "svg+xml", "<em>one</em>") + picture("two", "webp", "two") +
                       picture("", "png", "") +
                       "<table>\n<tr><th><em>n</em></th><th>m</th></tr>\n<tr><td><code>1</code></td>"
                       "<td class=\"n\">-2e3</td></tr>\n<tr><td></td><td class=\"n\">nan</td></tr>\n"
                       "</table>\n</body></html>\n"));
  fs::remove_all(folder);
}

}  // namespace report_marks_test
