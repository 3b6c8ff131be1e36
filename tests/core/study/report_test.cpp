// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>

#include "core/export/atomic_file.hpp"
#include "core/study/report.hpp"

using namespace unfurl;
namespace fs = std::filesystem;

TEST_CASE("a report is Markdown and a page that stands alone") {
  const fs::path folder = fs::temp_directory_path() / ("unfurl_report_test_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  write_file_atomically(folder / "a.png", std::string_view("Man"));  // "TWFu" in base64 (RFC 4648)
  Report report{"T < U"};
  report.heading("H");
  report.paragraph("**bold** and `code`");
  report.add({{"name", "n"}, {{"x", "1.5"}}}, "cap");
  report.picture("a.png", "a \"picture\"");
  CHECK(report_markdown(report) ==
        "# T < U\n\n## H\n\n**bold** and `code`\n\ncap\n\n| name | n |\n|---|---:|\n| x | 1.5 |\n\n"
        "![a \"picture\"](a.png)\n");
  const std::string html = report_html(report, folder);
  for (const char* part :
       {"<h1>T &lt; U</h1>", "<strong>bold</strong> and <code>code</code>", "<td class=\"n\">1.5</td>",
        "src=\"data:image/png;base64,TWFu\"", "alt=\"a &quot;picture&quot;\""})
    CHECK(html.find(part) != std::string::npos);
  // Names, titles, messages and commands are taken as they are.
  Report foreign{"panel 3*4*5 `x` **b _y_ m_z"};
  foreign.paragraph(as_plain("k*l*m `n` \\*o") + " with " + as_code("--set 'a=\"*`b\\*\"'") +
                    " and *p `*` q* \u2713");
  CHECK(report_markdown(foreign) ==
        "# panel 3\\*4\\*5 \\`x\\` \\*\\*b \\_y\\_ m_z\n\nk\\*l\\*m \\`n\\` \\\\\\*o with "
        "`` --set 'a=\"*`b\\*\"' `` and *p `*` q* \u2713\n");
  const std::string page = report_html(foreign, folder);
  for (const char* part :
       {"<title>panel 3*4*5 `x` **b _y_ m_z</title>", "<h1>panel 3*4*5 `x` **b _y_ m_z</h1>",
        "<p>k*l*m `n` \\*o with <code>--set 'a=&quot;*`b\\*&quot;'</code> and <em>p "
        "<code>*</code> q</em> \u2713</p>"})
    CHECK(page.find(part) != std::string::npos);
  report.picture("none.png", "");
  CHECK_THROWS_AS(report_html(report, folder), FileError);
  fs::remove_all(folder);
}
