// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/layout.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "render/plot/legend.hpp"
#include "render/plot/panel_layout.hpp"
#include "render/plot/style.hpp"
#include "render/plot/text_metrics.hpp"

namespace unfurl::plot {
namespace {

constexpr double outer = 4.0, column_gap = 12.0, row_gap = 6.0, smallest_frame = 12.0;

constexpr double letter_height = ascent * title_size + 1;

bool takes_letter(const Panel& panel) {
  constexpr double thin = 0.2;  // colour bars
  return !panel.bare && panel.height >= thin;
}

// Where there are several to tell apart, panels have letters: a, b, ...
bool lettered(const Figure& figure, std::size_t panel) {
  const auto titled = [](const Panel& p) { return !p.title.empty(); };
  if (figure.columns > 1 || std::any_of(figure.panels.begin(), figure.panels.end(), titled)) return false;
  return std::count_if(figure.panels.begin(), figure.panels.end(), takes_letter) > 1 &&
         takes_letter(figure.panels[panel]);
}

// The frames of a grid of panels: rows and columns line up, whatever their labels need.
class Grid {
 public:
  Grid(const Figure& figure, const Rect& area, std::vector<PanelLayout>& panels)
      : figure_(figure), area_(area), panels_(panels), columns_(std::max(figure.columns, 1)) {
    rows_ = std::max(figure.rows, static_cast<int>((panels.size() + static_cast<std::size_t>(columns_) - 1) /
                                                   static_cast<std::size_t>(columns_)));
  }

  // Ticks depend on the frames' sizes and these on the ticks' labels: three rounds settle it.
  void settle(const std::vector<int>& legend_rows) {
    legend_rows_ = legend_rows;
    column_.assign(static_cast<std::size_t>(columns_), {30, 10, 0, 0});
    row_.assign(static_cast<std::size_t>(rows_), {0, 0, 10, 25});
    for (int round = 0; round < 3; ++round) {
      place();
      for (std::size_t i = 0; i < panels_.size(); ++i) set_axes(figure_.panels[i], panels_[i]);
      measure();
    }
    place();
    for (std::size_t i = 0; i < panels_.size(); ++i) set_axes(figure_.panels[i], panels_[i]);
  }

  Rect cell(std::size_t i) const {
    const Margins &c = column_[i % column_.size()], &r = row_[i / column_.size()];
    const Rect& f = panels_[i].frame;
    return {f.x0 - c.left, f.y0 - r.top, f.x1 + c.right, f.y1 + r.bottom};
  }

 private:
  void measure() {
    for (Margins& m : column_) m = {};
    for (Margins& m : row_) m = {};
    for (std::size_t i = 0; i < panels_.size(); ++i) {
      const Margins m = margins(figure_.panels[i], panels_[i], legend_rows_[i]);
      Margins &c = column_[i % column_.size()], &r = row_[i / column_.size()];
      c.left = std::max(c.left, m.left), c.right = std::max(c.right, m.right);
      r.top = std::max(r.top, m.top), r.bottom = std::max(r.bottom, m.bottom);
      if (lettered(figure_, i))
        r.top = std::max(r.top, letter_height), c.left = std::max(c.left, letter_height);
    }
  }

  double share(std::size_t row) const {
    const std::size_t i = row * column_.size();
    return i < figure_.panels.size() ? std::max(figure_.panels[i].height, 0.05) : 1.0;
  }

  void place() {
    double width = area_.width() - column_gap * (columns_ - 1),
           height = area_.height() - row_gap * (rows_ - 1), shares = 0;
    for (const Margins& m : column_) width -= m.left + m.right;
    for (std::size_t r = 0; r < row_.size(); ++r) height -= row_[r].top + row_[r].bottom, shares += share(r);
    const double frame_width = std::max(width / columns_, smallest_frame);
    double y = area_.y0;
    for (std::size_t r = 0; r < row_.size(); ++r) {
      const double frame_height = std::max(height * share(r) / shares, smallest_frame);
      double x = area_.x0;
      for (std::size_t c = 0; c < column_.size(); ++c) {
        x += column_[c].left;
        const std::size_t i = r * column_.size() + c;
        if (i < panels_.size())
          panels_[i].frame = {x, y + row_[r].top, x + frame_width, y + row_[r].top + frame_height};
        x += frame_width + column_[c].right + column_gap;
      }
      y += row_[r].top + frame_height + row_[r].bottom + row_gap;
    }
  }

  const Figure& figure_;
  Rect area_;
  std::vector<PanelLayout>& panels_;
  int columns_, rows_ = 1;
  std::vector<int> legend_rows_;
  std::vector<Margins> column_, row_;  // of columns: left and right; of rows: top and bottom
};

// Title above, caption below; what is left for the panels.
Rect lay_out_page(const Figure& figure, const LayoutOptions& options, FigureLayout& out) {
  Rect area{outer, outer, out.width - outer, out.height - outer};
  if (options.title && !figure.title.empty()) {
    const std::string title = shorten_text(figure.title, title_size, area.width());
    out.labels.push_back({{area.x0, area.y0 + ascent * title_size}, title, {title_size, ink}});
    area.y0 += 1.5 * title_size;
  }
  if (!options.caption || figure.caption.empty()) return area;
  const std::vector<std::string> lines = caption_lines(figure.caption, area.width(), out.height);
  const double pitch = line_spacing * small_size;
  const double top = area.y1 - pitch * static_cast<double>(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i)
    out.labels.push_back({{area.x0, top + pitch * static_cast<double>(i) + 0.9 * small_size},
                          lines[i],
                          {small_size, caption_color}});
  area.y1 = top - 5;
  return area;
}

// Legends inside their frames where a place is free, else in rows above them. These take half of what the
// frames have without them, at most: entries that then have no room are counted.
class Legends {
 public:
  Legends(const Figure& figure, std::vector<PanelLayout>& panels)
      : figure_(figure), panels_(panels), columns_(static_cast<std::size_t>(std::max(figure.columns, 1))) {
    rows_.assign(panels.size(), 0);
    most_ = rows_;
  }

  const std::vector<int>& rows() const { return rows_; }  // above each panel's frame

  // False where room above has to be made first.
  bool place() {
    std::vector<std::size_t> unplaced;
    bool room = true;
    for (std::size_t i = 0; i < panels_.size(); ++i) {
      const Panel& panel = figure_.panels[i];
      if (most_[i] > 0) {
        const int rows = legend_rows(panel, width(i), most_[i]);
        if (rows > rows_[i]) rows_[i] = rows, room = false;  // ticks made the frame narrower
        panels_[i].legend = above(i);
        continue;
      }
      panels_[i].legend = inside_legend(panel, panels_[i]);
      if (!panels_[i].legend && has_legend(panel)) unplaced.push_back(i);
    }
    return !make_rows(unplaced) && room;
  }

 private:
  // Poses have their legend over all of them, else each panel's stands over its own frame.
  double width(std::size_t i) const {
    const std::size_t first = i - i % columns_, end = std::min(first + columns_, panels_.size());
    const Rect& frame = panels_[i].frame;
    if (i != first || !figure_.panels[i].bare) return frame.width();
    for (std::size_t k = i + 1; k < end; ++k)
      if (!figure_.panels[k].bare || has_legend(figure_.panels[k])) return frame.width();
    return panels_[end - 1].frame.x1 - frame.x0;
  }

  Legend above(std::size_t i) const {
    const Panel& panel = figure_.panels[i];
    double bottom = panels_[i].frame.y0 - 3 - (has_note(panels_[i]) ? note_height : 0);
    if (panel.bare && !panel.title.empty()) bottom -= panel_title_height + bare_gap;  // titles in one line
    return legend_above(panel, {panels_[i].frame.x0, bottom}, width(i), rows_[i]);
  }

  // What is left is shared by the rows of panels that need some of it now. False where none gets any.
  bool make_rows(const std::vector<std::size_t>& unplaced) {
    if (!room_) {
      room_ = 0;
      for (std::size_t i = 0; i < panels_.size(); i += columns_) *room_ += 0.5 * panels_[i].frame.height();
    }
    std::map<std::size_t, int> taken;  // by rows of panels
    for (const std::size_t i : unplaced) taken[i / columns_] = 0;
    const double share = *room_ / static_cast<double>(std::max<std::size_t>(taken.size(), 1));
    const int most = static_cast<int>((share - 3) / legend_row_height);
    for (const std::size_t i : unplaced) {
      most_[i] = std::max(most, 0);
      rows_[i] = legend_rows(figure_.panels[i], width(i), most_[i]);
      taken[i / columns_] = std::max(taken[i / columns_], rows_[i]);
    }
    bool any = false;
    for (const auto& row : taken)
      if (row.second > 0) any = true, *room_ -= row.second * legend_row_height + 3;
    return any;
  }

  const Figure& figure_;
  std::vector<PanelLayout>& panels_;
  std::size_t columns_;
  std::vector<int> rows_, most_;
  std::optional<double> room_;  // for rows [points]
};

}  // namespace

std::vector<std::string> caption_lines(const std::string& caption, double width, double page_height) {
  std::vector<std::string> lines = wrap_text(caption, small_size, width);
  const auto most = static_cast<std::size_t>(std::max(0.5 * page_height / (line_spacing * small_size), 1.0));
  if (lines.size() <= most) return lines;
  lines[most - 1] = shorten_text(lines[most - 1] + " " + lines[most], small_size, width);
  lines.resize(most);
  return lines;
}

FigureLayout lay_out(const Figure& figure, const LayoutOptions& options) {
  FigureLayout out;
  out.width = (options.width_mm > 0 ? options.width_mm : figure.width_mm) * points_per_mm;
  out.height = (options.height_mm > 0 ? options.height_mm : figure.height_mm) * points_per_mm;
  out.scale = options.scale;
  const Rect area = lay_out_page(figure, options, out);
  out.panels.resize(figure.panels.size());
  if (figure.panels.empty()) return out;
  Grid grid(figure, area, out.panels);
  Legends legends(figure, out.panels);
  for (bool placed = false; !placed;) {
    grid.settle(legends.rows());
    for (std::size_t i = 0; i < out.panels.size(); ++i) {
      out.panels[i].curves.clear();
      out.panels[i].bands.clear();
      set_traces(figure.panels[i], out.panels[i]);
    }
    placed = legends.place();
  }
  char letter = 'a';
  for (std::size_t i = 0; i < out.panels.size(); ++i) {
    add_axis_labels(figure.panels[i], grid.cell(i), legends.rows()[i], out.panels[i]);
    add_inner_labels(figure.panels[i], out.panels[i]);
    if (!lettered(figure, i)) continue;
    const Rect cell = grid.cell(i);
    out.panels[i].labels.push_back(
        {{cell.x0 + 1, cell.y0 + ascent * title_size}, std::string(1, letter++), {title_size, ink}});
  }
  return out;
}

}  // namespace unfurl::plot
