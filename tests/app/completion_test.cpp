// SPDX-License-Identifier: BSD-3-Clause
// Completions and the manual page name every verb and every option that the help names.
#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <fstream>

#include "app/own_options.hpp"
#include "core/export/formats.hpp"
#include "core/study/extremes.hpp"
#include "render/plot/figure_style.hpp"
#include "tests/app/run_program.hpp"

using namespace unfurl;

namespace completion_test {

namespace {

std::string script(const char* shell) {
  const ProgramResult r = run_program({"completion", shell});
  REQUIRE(r.code == 0);
  return r.out;
}

// What a shell says to a text on its standard input.
std::string said_by(const std::string& command, const std::string& text) {
  const ScratchDirectory dir;
  std::ofstream(dir / "in") << text;
  const std::string line = command + " < " + (dir / "in") + " 2>&1";
  std::string out;
  FILE* pipe = ::popen(line.c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::array<char, 4096> part{};
  while (const std::size_t n = std::fread(part.data(), 1, part.size(), pipe)) out.append(part.data(), n);
  ::pclose(pipe);
  return out;
}

bool names(const std::string& text, std::string_view word) {
  return text.find(word) != std::string::npos;
}

}  // namespace

TEST_CASE("every verb and option is in every completion and in the manual") {
  for (const char* shell : {"bash", "zsh", "fish", "man"}) {
    const std::string text = script(shell);
    for (const Command& command : commands()) {
      INFO(shell << " " << command.name);
      CHECK(names(text, command.name));
    }
    for (const OwnOption& own : own_options()) {
      std::string name(own.name);
      if (std::string(shell) == "fish") name = name == "-o" ? "-s o" : "-l " + name.substr(2);
      if (std::string(shell) == "man") {
        std::string masked;
        for (const char c : name) masked += c == '-' ? std::string("\\-") : std::string(1, c);
        name = masked;
      }
      INFO(shell << " " << name);
      CHECK(names(text, name));
    }
  }
}

TEST_CASE("bash completes verbs, options of the verb and scenes") {
  const std::string setup =
      "PATH=" + std::string(UNFURL_PROGRAM).substr(0, std::string(UNFURL_PROGRAM).rfind('/')) + ":$PATH\n" +
      script("bash");
  const auto completed = [&](const std::string& words, int at) {
    return said_by("bash", setup + "COMP_WORDS=(" + words + "); COMP_CWORD=" + std::to_string(at) +
                               "; _unfurl; printf '%s ' \"${COMPREPLY[@]}\"\n");
  };
  CHECK(completed("unfurl ren", 1) == "render ");
  CHECK(completed("unfurl solve --tar", 2) == "--target ");
  CHECK(completed("unfurl solve --fra", 2) == " ");  // of render
  CHECK(completed("unfurl run hoop6_s", 2) == "hoop6_sector ");
  CHECK(completed("unfurl study hoop6 --methods rk4_b", 4) == "rk4_baumgarte ");
  CHECK(completed("unfurl completion z", 2) == "zsh ");
  CHECK(completed("unfurl list surf", 2) == "surfaces ");
  CHECK(completed("unfurl list sol", 2) == "solver ");
  for (const ExportFormat& format : export_formats())
    CHECK(names(completed("unfurl run hoop6 --export " + std::string(format.name), 4), format.name));
}

TEST_CASE("the help of a list option has every name of its table") {
  const auto help_of = [](std::string_view option) {
    for (const OwnOption& own : own_options())
      if (own.name == option) return std::string(own.help);
    return std::string();
  };
  for (const ExportFormat& format : export_formats()) CHECK(names(help_of("--export"), format.name));
  for (const FigureStyle& style : figure_styles()) CHECK(names(help_of("--style"), style.name));
  for (const ExtremeKind& extreme : extreme_kinds()) CHECK(names(help_of("--extreme"), extreme.name));
}

TEST_CASE("the manual page is sound troff") {
  CHECK(said_by("groff -man -Tutf8 -ww -z", script("man")) == "");
}

TEST_CASE("another shell is refused by name") {
  const ProgramResult r = run_program({"completion", "bsh"});
  CHECK(r.code == 2);
  CHECK(r.err == "unfurl: no completion for 'bsh'; did you mean 'bash'?\n");
}

}  // namespace completion_test
