// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/report.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <span>

#include "core/export/atomic_file.hpp"
#include "core/text/base64.hpp"
#include "core/text/xml_text.hpp"

namespace unfurl {
namespace {

constexpr const char* style = R"(
body { font: 16px/1.55 system-ui, "DejaVu Sans", sans-serif; color: #222; max-width: 52rem; margin: 2rem auto; padding: 0 1rem }
h1 { font-size: 1.7rem; line-height: 1.25 } h2 { font-size: 1.25rem; margin-top: 2.2rem }
table { border-collapse: collapse; font-size: .88rem; margin: 1rem 0; display: block; overflow-x: auto }
th, td { padding: .3rem .7rem; border-bottom: 1px solid #ddd; text-align: left; vertical-align: top }
th { border-bottom: 2px solid #888 } td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap }
figure { margin: 1.5rem 0 } img { max-width: 100%; height: auto } figcaption, .caption { font-size: .88rem; color: #555 }
pre { background: #f6f6f6; padding: .8rem; overflow-x: auto; font-size: .82rem; line-height: 1.4 }
code { background: #f2f2f2; padding: .1em .3em; border-radius: 3px }
)";

constexpr std::string_view marks = "\\`*_";

std::size_t run_of(std::string_view text, std::size_t at) {  // of equal characters
  const std::size_t end = text.find_first_not_of(text[at], at);
  return (end == std::string_view::npos ? text.size() : end) - at;
}

// The end of code that begins with so many backquotes: as many again.
std::size_t code_end(std::string_view text, std::size_t from, std::size_t quotes) {
  for (std::size_t i = text.find('`', from); i != std::string_view::npos; i = text.find('`', i)) {
    const std::size_t run = run_of(text, i);
    if (run == quotes) return i;
    i += run;
  }
  return std::string_view::npos;
}

// Where the mark is again, beyond code and what a backslash takes as it is; npos: nowhere.
std::size_t mark_again(std::string_view text, std::size_t from, std::string_view mark) {
  for (std::size_t i = text.find_first_of("\\`*", from); i != std::string_view::npos;
       i = text.find_first_of("\\`*", i)) {
    const std::size_t run = text[i] == '\\' ? 2 : run_of(text, i);
    if (text[i] == '*' && text.substr(i, run) == mark) return i;
    const std::size_t end = text[i] == '`' ? code_end(text, i + run, run) : std::string_view::npos;
    i = (end == std::string_view::npos ? i : end) + run;
  }
  return std::string_view::npos;
}

std::string html_text(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t next = std::min(text.find_first_of("\\`*", i), text.size());
    out += xml_text(text.substr(i, next - i));
    if (next == text.size()) break;
    const char mark = text[next];
    const std::size_t run = mark == '\\' ? 1 : run_of(text, next), inside = next + run;
    if (mark == '\\' && inside < text.size() && marks.find(text[inside]) != std::string_view::npos) {
      out += text[inside];
      i = inside + 1;
      continue;
    }
    const std::size_t end = mark == '`'               ? code_end(text, inside, run)
                            : mark == '*' && run <= 2 ? mark_again(text, inside, text.substr(next, run))
                                                      : std::string_view::npos;
    if (end == std::string_view::npos) {
      out += text.substr(next, run);
      i = inside;
      continue;
    }
    std::string_view within = text.substr(inside, end - inside);
    if (mark == '`' && within.size() > 2 && within.front() == ' ' && within.back() == ' ')
      within = within.substr(1, within.size() - 2);
    const std::string element = mark == '`' ? "code" : run == 2 ? "strong" : "em";
    out += "<" + element + ">" + (mark == '`' ? xml_text(within) : html_text(within)) + "</" + element + ">";
    i = end + run;
  }
  return out;
}

std::string html_table(const Table& table) {
  std::string text = "<table>\n<tr>";
  for (const auto& name : table.columns) text += "<th>" + html_text(name) + "</th>";
  text += "</tr>\n";
  for (const auto& row : table.rows) {
    text += "<tr>";
    for (const auto& cell : row)
      text += (is_number(cell) ? "<td class=\"n\">" : "<td>") + html_text(cell) + "</td>";
    text += "</tr>\n";
  }
  return text + "</table>\n";
}

std::string html_picture(const ReportBlock& block, const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / block.file;
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw FileError(path, "cannot be read");
  const std::string extension = path.extension().string();
  const std::string type = extension == ".svg" ? "svg+xml" : extension == ".webp" ? "webp" : "png";
  return "<figure><img alt=\"" + xml_text(block.text) + "\" src=\"data:image/" + type + ";base64," +
         base64(std::as_bytes(std::span(bytes))) + "\"><figcaption>" + html_text(block.text) +
         "</figcaption></figure>\n";
}

}  // namespace

std::string as_plain(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto within_word = [&](std::size_t k) {
      return k < text.size() && std::isalnum(static_cast<unsigned char>(text[k])) != 0;
    };
    // Within a word "_" marks nothing, nor does a backslash before anything but a mark.
    const bool mark = text[i] == '_' ? !(i > 0 && within_word(i - 1) && within_word(i + 1))
                      : text[i] == '\\'
                          ? i + 1 == text.size() || std::ispunct(static_cast<unsigned char>(text[i + 1])) != 0
                          : marks.find(text[i]) != std::string_view::npos;
    if (mark) out += '\\';
    out += text[i];
  }
  return out;
}

// In more backquotes than any in it.
std::string as_code(std::string_view text) {
  std::size_t most = 0;
  for (std::size_t i = text.find('`'); i != std::string_view::npos; i = text.find('`', i)) {
    const std::size_t run = run_of(text, i);
    most = std::max(most, run);
    i += run;
  }
  const std::string fence(most + 1, '`'), gap = most > 0 ? " " : "";
  return fence + gap + std::string(text) + gap + fence;
}

void Report::heading(std::string text) {
  blocks.push_back({ReportBlock::Kind::heading, std::move(text)});
}
void Report::paragraph(std::string text) {
  blocks.push_back({ReportBlock::Kind::paragraph, std::move(text)});
}
void Report::add(Table table, std::string caption) {
  blocks.push_back({ReportBlock::Kind::table, std::move(caption), std::move(table)});
}
void Report::picture(std::string file, std::string caption) {
  blocks.push_back({ReportBlock::Kind::picture, std::move(caption), {}, std::move(file)});
}
void Report::listing(std::string text) {
  blocks.push_back({ReportBlock::Kind::listing, std::move(text)});
}

// A destination with spaces is one in brackets only.
std::string markdown_link(const std::string& file) {
  return file.find_first_of(" ()") == std::string::npos ? file : "<" + file + ">";
}

std::string report_markdown(const Report& report) {
  std::string text = "# " + markdown_line(as_plain(report.title)) + "\n";
  for (const ReportBlock& block : report.blocks) {
    text += "\n";
    if (block.kind == ReportBlock::Kind::heading) text += "## " + markdown_line(block.text) + "\n";
    if (block.kind == ReportBlock::Kind::paragraph) text += markdown_line(block.text) + "\n";
    if (block.kind == ReportBlock::Kind::table)
      text += (block.text.empty() ? "" : markdown_line(block.text) + "\n\n") + markdown_text(block.table);
    if (block.kind == ReportBlock::Kind::picture)
      text += "![" + markdown_line(block.text) + "](" + markdown_link(block.file) + ")\n";
    if (block.kind == ReportBlock::Kind::listing) text += "```\n" + block.text + "```\n";
  }
  return text;
}

std::string report_html(const Report& report, const std::filesystem::path& folder) {
  std::string text =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\"><title>" +
      xml_text(report.title) + "</title><style>" + style + "</style></head><body>\n<h1>" +
      xml_text(report.title) + "</h1>\n";
  for (const ReportBlock& block : report.blocks) {
    if (block.kind == ReportBlock::Kind::heading) text += "<h2>" + html_text(block.text) + "</h2>\n";
    if (block.kind == ReportBlock::Kind::paragraph) text += "<p>" + html_text(block.text) + "</p>\n";
    if (block.kind == ReportBlock::Kind::table) {
      if (!block.text.empty()) text += "<p class=\"caption\">" + html_text(block.text) + "</p>\n";
      text += html_table(block.table);
    }
    if (block.kind == ReportBlock::Kind::picture) text += html_picture(block, folder);
    if (block.kind == ReportBlock::Kind::listing) text += "<pre>" + xml_text(block.text) + "</pre>\n";
  }
  return text + "</body></html>\n";
}

}  // namespace unfurl
