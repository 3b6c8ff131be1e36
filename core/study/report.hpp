// SPDX-License-Identifier: BSD-3-Clause
// A report as data: headings, paragraphs, tables and pictures, written as Markdown or as one HTML file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/study/table.hpp"

namespace unfurl {

struct ReportBlock {
  enum class Kind { heading, paragraph, table, picture, listing };
  Kind kind = Kind::paragraph;
  std::string text;  // of a picture: its caption
  Table table = {};
  std::string file = {};  // of a picture, relative to the report: "figures/poses.png"
};

// Text may hold `code`, *emphasis* and **strong emphasis**; everything else is plain. A backslash before a
// mark takes it as it is.
struct Report {
  std::string title;  // plain
  std::vector<ReportBlock> blocks = {};

  void heading(std::string text);
  void paragraph(std::string text);
  void add(Table table, std::string caption = "");
  void picture(std::string file, std::string caption);
  void listing(std::string text);  // of a file, line by line as it is
};

// What is not the program's own: names, messages; a command or an expression.
std::string as_plain(std::string_view text);
std::string as_code(std::string_view text);

std::string report_markdown(const Report& report);
// Self-contained: pictures (PNG, SVG or WebP in `folder`) are embedded. Throws FileError where one cannot be
// read.
std::string report_html(const Report& report, const std::filesystem::path& folder);

}  // namespace unfurl
