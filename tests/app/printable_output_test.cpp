// SPDX-License-Identifier: BSD-3-Clause
// Titles, names and paths of strangers never command a terminal or a page.
#include "app/output/printable_output.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/study/report.hpp"
#include "core/text/xml_text.hpp"
#include "tests/app/run_program.hpp"

namespace unfurl::printable_output_test {

namespace {

// A window's title, a colour, a bell, a C1 command, a mark that turns the direction.
const std::string evil =
    "\x1b]0;owned\x07 \x1b[31mred \xc2\x9b"
    "31m \xe2\x80\xae"
    "gpj.exe <script>alert(1)</script> | x";

bool commands_in(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if ((c < 0x20 && c != '\n' && c != '\t') || c == 0x7F) return true;
    if (c == 0xC2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xA0) return true;
  }
  return text.find("\xe2\x80\xae") != std::string::npos;
}

std::string toml_string(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    char code[8];
    std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(static_cast<unsigned char>(c)));
    out += static_cast<unsigned char>(c) < 0x20 ? std::string(code) : std::string(1, c);
  }
  return out + '"';
}

}  // namespace

TEST_CASE("what is printable passes a stream as it is, what is a command is written out") {
  REQUIRE(commands_in(evil));
  std::ostringstream target;
  {
    const PrintableOutput filter(target);
    target << "m\u00e8tres, \u4e2d\u6587, tabs\tand\nlines" << std::flush << "\x1b[2J" << '\x07' << "\xff";
  }
  CHECK(target.str() == "m\u00e8tres, \u4e2d\u6587, tabs\tand\nlines\\x1b[2J\\x07\\xff");
  CHECK(printable_text("a\r\nb\rc") == "a\r\nb\\x0dc");
  CHECK(printable_text("\x7f\u0085") == "\\u007f\\u0085");
  CHECK(target.good());
  CHECK_FALSE(commands_in(printable_text(evil)));
}

TEST_CASE("a stream that fails says so through the filter") {
  std::ostringstream closed;
  closed.setstate(std::ios::badbit);
  {
    const PrintableOutput filter(closed);
    closed << "x\n" << std::flush;
  }
  CHECK(closed.fail());
}

TEST_CASE("what is shown as TOML or JSON is that, whatever is in the scene") {
  const ScratchDirectory dir;
  const std::string odd =
      dir.write("odd.toml", "title = \"d\\u007fel, \\u0085\"\r\n[structure]\r\nkind = \"pendulum\"\r\n");
  const ProgramResult json = run_program({"check", odd, "--json"});
  CHECK(json.code == 0);
  CHECK(nlohmann::json::parse(json.out, nullptr, false).is_object());
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, {"--all"}, {"--set", "structure.bob_mass=3"}}) {
    std::vector<std::string> words = {"show", odd};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult shown = run_program(words);
    INFO(shown.out);
    CHECK(run_program({"check", dir.write("again.toml", shown.out)}).code == 0);
  }
}

TEST_CASE("titles and paths reach neither the terminal nor a report as commands") {
  const ScratchDirectory dir;
  const std::string scene =
      dir.write("s.toml", "title = " + toml_string(evil) + "\n[structure]\nkind = \"pendulum\"\n");
  const ProgramResult check = run_program({"check", scene});
  CHECK(check.code == 0);
  CHECK(check.out.find("red") != std::string::npos);
  CHECK_FALSE(commands_in(check.out));
  const ProgramResult missing = run_program({"run", dir / ("no" + evil.substr(0, 9)), "-o", dir / "x"});
  CHECK(missing.code == 5);
  CHECK_FALSE(commands_in(missing.err));
  CHECK(
      run_program({"sweep", scene, "--vary", "solver.step=0.1,0.2", "--measure", "energy", "-o", dir / "out"})
          .code == 0);
  const std::string markdown = file_text(dir / "out/sweep.md");
  CHECK(markdown.find("red") != std::string::npos);
  CHECK_FALSE(commands_in(markdown));
  CHECK(markdown.find("<script>") == std::string::npos);
}

TEST_CASE("names of entries are in a sweep's report as they are, marks and all") {
  const ScratchDirectory dir;
  const std::string scene =
      dir.write("s.toml",
                "structure.kind = 'pendulum'\n[[forces]]\nkind = 'drag'\nname = '_s*p*_'\nnodes = ['*']\n"
                "damping = 0.1\n[solver]\nend_time = 0.2\nstep = 0.1\n");
  const ProgramResult r = run_program({"sweep", scene, "--vary", "forces[_s*p*_].damping=0.1,0.2",
                                       "--measure", "energy", "-o", dir / "out", "--quiet"});
  INFO(r.err);
  REQUIRE(r.code == 0);
  const std::string markdown = file_text(dir / "out/sweep.md");
  const std::size_t table = markdown.find("| forces");
  REQUIRE(table != std::string::npos);
  const std::string head = markdown.substr(table, markdown.find('\n', table) - table);
  CHECK(head.find("\\_s\\*p\\*\\_") != std::string::npos);
}

TEST_CASE("reports hold anybody's text as text") {
  Report report{"a <b> & c"};
  report.paragraph(evil);
  report.add(Table{{"k|ey"}, {{"v|alue\n<i>"}}});
  const std::string markdown = report_markdown(report), html = report_html(report, ".");
  CHECK(markdown.starts_with("# a &lt;b> & c\n"));
  CHECK(markdown.find("| k\\|ey |") != std::string::npos);
  CHECK(markdown.find("| v\\|alue &lt;i> |") != std::string::npos);
  CHECK_FALSE(commands_in(markdown));
  CHECK(html.find("<script>") == std::string::npos);
  CHECK(html.find("<i>") == std::string::npos);
}

TEST_CASE("a pipe in the place of a file is refused at once") {
  const ScratchDirectory dir;
  dir.write("s.toml", "[structure]\nkind = \"custom\"\nnodes_file = \"n.csv\"\n");
  REQUIRE(::mkfifo((dir / "n.csv").c_str(), 0600) == 0);
  const ProgramResult named = run_program({"check", dir / "s.toml"});
  CHECK(named.code == 3);
  CHECK(named.err.find("is not a regular file") != std::string::npos);
  std::filesystem::create_directories(dir / "out");
  REQUIRE(::mkfifo((dir / "out/summary.json").c_str(), 0600) == 0);
  CHECK(run_program({"run", "pendulum", "-o", dir / "out"}).code == 5);
  REQUIRE(::mkfifo((dir / "out/.unfurl").c_str(), 0600) == 0);
  CHECK(run_program({"run", "pendulum", "--force", "-o", dir / "out"}).code == 5);
}

TEST_CASE("a line that ends within an option ends no comment and no string of a job script") {
  const auto script = [](const char* name, const std::string& title) {
    return run_program({"sweep", "pendulum", "--vary", "structure.angle=10,20", "--measure", "end_time",
                        "--set", "title=\"\"\"" + title + "\"\"\"", "-o", "D", "--script", name, "--jobs",
                        "5"})
        .out;
  };
  const std::string slurm = script("slurm", "a\nb");
  REQUIRE(slurm.find("\nexec ") != std::string::npos);
  for (std::size_t at = 0; at < slurm.find("\nexec "); at = slurm.find('\n', at) + 1) CHECK(slurm[at] == '#');
  CHECK(slurm.find("a\nb") != std::string::npos);  // of the command itself
  const std::string one = script("snakemake", "a b"), two = script("snakemake", "a\nb");
  CHECK(std::ranges::count(one, '\n') == std::ranges::count(two, '\n'));
  CHECK(two.find("a\\nb") != std::string::npos);
}

}  // namespace unfurl::printable_output_test
