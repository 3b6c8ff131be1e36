// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/figure_data.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include "core/export/atomic_file.hpp"

namespace unfurl {
namespace {

std::string number(double v) {
  if (std::isnan(v)) return {};
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, v).ptr};
}

std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + '"';
}

// The rows of one panel.
class PanelTable {
 public:
  PanelTable(const Panel& panel, std::size_t number, std::string& out)
      : panel_(panel), start_(std::to_string(number) + ','), out_(out) {}

  void write() {
    heading("title", panel_.title);
    if (!panel_.bare) {
      heading("x_axis", panel_.x.label);
      heading("y_axis", panel_.y.label);
      heading("right_axis", panel_.y2.label);
    }
    for (const Cell& c : panel_.cells)
      if (!c.stands_for.empty())
        row("cell", c.stands_for, {number(c.x0), number(c.y0), number(c.x1), number(c.y1)});
    for (const Curve& c : panel_.curves) curve(c);
    for (const Band& b : panel_.bands)
      for (std::size_t i = 0; i < std::min({b.x.size(), b.lower.size(), b.upper.size()}); ++i)
        row("band", b.label, {number(b.x[i]), number(b.lower[i]), "", number(b.upper[i])});
    for (const ReferenceLine& l : panel_.lines)
      row("line", l.label,
          {l.horizontal ? "" : number(l.value), l.horizontal ? number(l.value) : "", "", ""});
    for (const Segment& s : panel_.segments)
      row("rod", number(s.value), {number(s.x0), number(s.y0), number(s.x1), number(s.y1)});
    for (const Dot& d : panel_.dots) row("node", "", {number(d.x), number(d.y), "", ""});
  }

 private:
  struct Cells {
    std::string x, y, x_end, y_end;
  };

  void row(const char* kind, const std::string& series, const Cells& c) {
    out_ += start_ + kind + ',' + cell(series) + ',' + c.x + ',' + c.y + ',' + c.x_end + ',' + c.y_end + '\n';
  }
  void heading(const char* kind, const std::string& text) {
    if (!text.empty()) row(kind, text, {});
  }
  void curve(const Curve& c) {
    const std::string& axis = (c.right_axis ? panel_.y2 : panel_.y).label;
    const std::string& name = c.label.empty() ? axis : c.label;
    const auto& words = panel_.y.names;
    const auto y = [&](double v) {
      return words.empty() ? number(v) : cell(words.at(static_cast<std::size_t>(std::lround(v))));
    };
    for (std::size_t i = 0; i < std::min(c.x.size(), c.y.size()); ++i)
      row(c.right_axis ? "right_curve" : "curve", name, {number(c.x[i]), y(c.y[i]), "", ""});
  }

  const Panel& panel_;
  std::string start_;
  std::string& out_;
};

std::filesystem::path beside(std::filesystem::path picture, const char* extension) {
  return picture.replace_extension(extension);
}

}  // namespace

std::string figure_csv(const Figure& figure) {
  std::string out = figure_csv_header;
  for (std::size_t i = 0; i < figure.panels.size(); ++i) PanelTable(figure.panels[i], i + 1, out).write();
  return out;
}

std::string figure_caption(const Figure& figure) {
  std::string out = figure.title;
  if (!out.empty() && !figure.caption.empty()) out += ". ";
  return out + figure.caption + "\n";
}

// Tables of a run or of the user's own are not for us to replace. A caption is ours where it stands beside a
// table of ours.
std::array<std::filesystem::path, 2> figure_data_files(const std::filesystem::path& picture) {
  return {beside(picture, ".csv"), beside(picture, ".caption.txt")};
}

void refuse_other_data(const std::filesystem::path& picture) {
  const auto [table, caption] = figure_data_files(picture);
  std::ifstream file(table, std::ios::binary);
  std::string line;
  const bool there = file && std::getline(file, line);
  if (there && line + '\n' != figure_csv_header)
    throw FileError(
        table,
        "holds other data, which the figure's numbers would replace; name the figure otherwise, or use "
        "another directory");
  std::error_code ignored;
  if (!there && std::filesystem::exists(caption, ignored))
    throw FileError(caption, "is not of a figure, whose caption would replace it; name the figure otherwise");
}

void write_figure_data(const Figure& figure, const std::filesystem::path& picture) {
  refuse_other_data(picture);
  const auto [table, caption] = figure_data_files(picture);
  write_file_atomically(table, figure_csv(figure));
  write_file_atomically(caption, figure_caption(figure));
}

}  // namespace unfurl
