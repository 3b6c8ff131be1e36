// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/panel_layout.hpp"

#include <algorithm>
#include <cmath>

#include "render/plot/style.hpp"
#include "render/plot/text_metrics.hpp"

namespace unfurl::plot {
namespace {

constexpr double tick_gap = 2.5, label_gap = 4.0, edge = 1.0;
constexpr double tick_text = tick_length + tick_gap;  // from the frame to tick labels
constexpr double half_digit = cap_height * small_size / 2;

Ticks ticks_of(const Axis& axis, const Limits& l, int most) {
  if (!axis.names.empty()) {
    Ticks ticks;
    ticks.labels = axis.names;
    for (std::size_t k = 0; k < axis.names.size(); ++k) ticks.major.push_back(static_cast<double>(k));
    return ticks;
  }
  if (axis.log) return log_ticks(l.lo, l.hi, most);
  if (axis.whole) return whole_ticks(l.lo, l.hi, most);
  return axis.degrees ? degree_ticks(l.lo, l.hi, most) : linear_ticks(l.lo, l.hi, most);
}

double widest(const std::vector<std::string>& labels) {
  double w = 0;
  for (const std::string& s : labels) w = std::max(w, text_width(s, small_size));
  return w;
}

// Whether neighbouring labels keep `gap` between them when each needs `extent` along the axis.
template <class Extent>
bool fits(const AxisLayout& axis, double gap, Extent extent) {
  for (std::size_t i = 1; i < axis.ticks.major.size(); ++i) {
    const double apart = std::abs(axis.scale(axis.ticks.major[i]) - axis.scale(axis.ticks.major[i - 1]));
    if (apart < (extent(i) + extent(i - 1)) / 2 + gap) return false;
  }
  return true;
}

// As many ticks as read well: more on a longer axis, but not in proportion; two or more where labels can be
// had.
void set_ticks(const Axis& axis, const Limits& limits, bool horizontal, AxisLayout& out) {
  const double length = std::abs(out.scale.at_hi - out.scale.at_lo);
  const double spacing = horizontal ? 25 + 0.08 * length : axis.log ? 15 : 12 + 0.06 * length;
  const auto fit = [&](int most) {
    out.ticks = ticks_of(axis, limits, most);
    const auto extent = [&](std::size_t i) {
      return horizontal ? text_width(out.ticks.labels[i], small_size) : small_size;
    };
    return fits(out, horizontal ? 6.0 : 4.0, extent);
  };
  int most = std::clamp(static_cast<int>(length / spacing), 1, 12);
  while (!fit(most) && most > 1) --most;
  for (int more = most + 1; out.ticks.major.size() < 2 && more <= most + 3; ++more)
    if (!fit(more)) fit(most), more = most + 3;
}

void set_axis(const Panel& panel, AxisOf which, double at_lo, double at_hi, AxisLayout& out) {
  const Axis& axis = which == AxisOf::x ? panel.x : which == AxisOf::y ? panel.y : panel.y2;
  const Limits l = axis_limits(panel, which);
  out.scale = {l.lo, l.hi, at_lo, at_hi, axis.log};
  if (!panel.bare) set_ticks(axis, l, which == AxisOf::x, out);
}

// Both scales in the same units to the point, about the middle of their limits.
void equalise(PanelLayout& out) {
  Scale &x = out.x.scale, &y = out.y.scale;
  const double unit = std::max((x.hi - x.lo) / out.frame.width(), (y.hi - y.lo) / out.frame.height());
  const auto widen = [unit](Scale& s, double length) {
    const double middle = (s.lo + s.hi) / 2, half = unit * length / 2;
    s.lo = middle - half, s.hi = middle + half;
  };
  widen(x, out.frame.width());
  widen(y, out.frame.height());
}

std::string in_one_line(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + " ";
  return text;
}

std::vector<std::string> y_label_lines(const Axis& axis, double height) {
  constexpr std::size_t most = 3;
  std::vector<std::string> lines = wrap_text(axis.label, label_size, height);
  if (lines.size() > most) {
    lines[most - 1] = shorten_text(lines[most - 1] + " " + lines[most], label_size, height);
    lines.resize(most);
  } else if (lines.size() == most) {  // of like lengths, so that no sign or number is alone in the last one
    for (double share = 0.95; share > 0.3; share -= 0.05) {
      std::vector<std::string> narrower = wrap_text(axis.label, label_size, share * height);
      if (narrower.size() > most || in_one_line(narrower) != in_one_line(lines))
        break;  // nothing is left out for it
      lines = std::move(narrower);
    }
  }
  return lines;
}

double y_margin(const Axis& axis, const AxisLayout& layout, double height) {
  if (!layout.used) return edge;
  double sum = tick_length + edge;
  if (!axis.shown) return sum;
  sum += tick_gap + widest(layout.ticks.labels);
  const auto lines = static_cast<double>(y_label_lines(axis, height).size());
  return lines > 0 ? sum + label_gap + lines * label_size * 1.2 : sum;
}

// The axis's colour: that of its curves where there are two axes to tell apart and all its curves share one.
FigureColor axis_text_color(const Panel& panel, const PanelLayout& layout, bool right) {
  int color = -1;
  for (const Curve& c : panel.curves) {
    if (c.right_axis != right) continue;
    if (color >= 0 && color != c.color) return ink;
    color = c.color;
  }
  return layout.y2.used && color >= 0 ? readable(palette(color)) : ink;
}

void add_x_labels(const Panel& panel, const Rect& cell, PanelLayout& out) {
  if (!panel.x.shown) return;
  const TextStyle ticks{small_size, axis_color, Anchor::middle};
  const double base = out.frame.y1 + tick_text + cap_height * small_size;
  for (std::size_t i = 0; i < out.x.ticks.major.size(); ++i)
    out.labels.push_back({{out.x.scale(out.x.ticks.major[i]), base}, out.x.ticks.labels[i], ticks});
  const double label_base = cell.y1 - edge - descent * label_size;
  const std::string& note = out.x.ticks.note;
  if (!note.empty())
    out.labels.push_back({{out.frame.x1, label_base}, note, {small_size, axis_color, Anchor::end}});
  const double note_room = note.empty() ? 0 : text_width(note, small_size) + 6;
  // In the middle, or from the left where the note leaves no room there.
  const bool middle = text_width(panel.x.label, label_size) <= out.frame.width() - 2 * note_room;
  const std::string label =
      shorten_text(panel.x.label, label_size, std::max(out.frame.width() - note_room, 20.0));
  const double at = middle ? (out.frame.x0 + out.frame.x1) / 2 : out.frame.x0;
  if (!label.empty())
    out.labels.push_back(
        {{at, label_base}, label, {label_size, ink, middle ? Anchor::middle : Anchor::start}});
}

void add_y_labels(const Panel& panel, const Rect& cell, bool right, PanelLayout& out) {
  const Axis& axis = right ? panel.y2 : panel.y;
  const AxisLayout& layout = right ? out.y2 : out.y;
  if (!axis.shown || !layout.used) return;
  const Rect& f = out.frame;
  const double side = right ? 1 : -1, from = right ? f.x1 : f.x0;
  const TextStyle ticks{small_size, axis_color, right ? Anchor::start : Anchor::end};
  for (std::size_t i = 0; i < layout.ticks.major.size(); ++i)
    out.labels.push_back({{from + side * tick_text, layout.scale(layout.ticks.major[i]) + half_digit},
                          layout.ticks.labels[i],
                          ticks});
  if (!layout.ticks.note.empty())
    out.labels.push_back({{from - side * 1.0, f.y0 - 4.5},
                          layout.ticks.note,
                          {small_size, axis_color, right ? Anchor::end : Anchor::start}});
  const std::vector<std::string> lines = y_label_lines(axis, f.height());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double row = static_cast<double>(right ? lines.size() - 1 - i : i) * label_size * 1.2;
    const double x =
        right ? cell.x1 - edge - descent * label_size - row : cell.x0 + edge + ascent * label_size + row;
    out.labels.push_back({{x, (f.y0 + f.y1) / 2},
                          lines[i],
                          {label_size, axis_text_color(panel, out, right), Anchor::middle, true}});
  }
}

}  // namespace

bool has_note(const PanelLayout& l) {
  return (l.y.used && !l.y.ticks.note.empty()) || (l.y2.used && !l.y2.ticks.note.empty());
}

void set_axes(const Panel& panel, PanelLayout& out) {
  const Rect& f = out.frame;
  out.x.used = out.y.used = !panel.bare;
  out.y2.used = !panel.bare && std::any_of(panel.curves.begin(), panel.curves.end(),
                                           [](const Curve& c) { return c.right_axis; });
  set_axis(panel, AxisOf::x, f.x0, f.x1, out.x);
  set_axis(panel, AxisOf::y, f.y1, f.y0, out.y);
  if (out.y2.used) set_axis(panel, AxisOf::y2, f.y1, f.y0, out.y2);
  if (!panel.equal_scale) return;
  equalise(out);
  if (panel.bare) return;
  set_ticks(panel.x, {out.x.scale.lo, out.x.scale.hi}, true, out.x);
  set_ticks(panel.y, {out.y.scale.lo, out.y.scale.hi}, false, out.y);
}

Margins margins(const Panel& panel, const PanelLayout& l, int legend_rows) {
  Margins m{edge, edge, edge, edge};
  if (!panel.title.empty()) m.top += panel_title_height + (panel.bare ? bare_gap : 0);
  m.top += legend_rows > 0 ? legend_rows * legend_row_height + 3 : 0;
  if (panel.scale_bar > 0) m.bottom += scale_bar_height;
  if (panel.bare) return m;
  m.top += has_note(l) ? note_height : half_digit;  // the uppermost tick label stands half above the frame
  m.left = y_margin(panel.y, l.y, l.frame.height());
  m.right = y_margin(panel.y2, l.y2, l.frame.height());
  m.bottom = tick_length + edge;
  if (!panel.x.shown) return m;
  m.bottom += tick_gap + small_size;
  if (!panel.x.label.empty() || !l.x.ticks.note.empty()) m.bottom += label_size * 1.35;
  for (std::size_t i = 0; i < l.x.ticks.major.size(); ++i) {
    const double at = l.x.scale(l.x.ticks.major[i]),
                 half = text_width(l.x.ticks.labels[i], small_size) / 2 + edge;
    m.right = std::max(m.right, at + half - l.frame.x1);
    m.left = std::max(m.left, l.frame.x0 - at + half);
  }
  return m;
}

void set_traces(const Panel& panel, PanelLayout& out) {
  for (const Curve& c : panel.curves) {
    const bool right = c.right_axis && out.y2.used;
    const Scale& y = right ? out.y2.scale : out.y.scale;
    out.curves.push_back(trace(c.x, c.y, {out.x.scale, y, (right ? panel.y2 : panel.y).zeros_at_floor}));
  }
  for (const Band& b : panel.bands)
    out.bands.push_back(
        trace_band(b.x, b.lower, b.upper, {out.x.scale, out.y.scale, panel.y.zeros_at_floor}));
}

void add_axis_labels(const Panel& panel, const Rect& cell, int legend_rows, PanelLayout& out) {
  if (!panel.title.empty()) {
    const double above = (has_note(out) ? note_height : half_digit) +
                         (legend_rows > 0 ? legend_rows * legend_row_height + 3 : 0);
    const double base = out.frame.y0 - (panel.bare ? 0 : above) - 3.5;
    const std::string title = shorten_text(panel.title, label_size, cell.width() - 2);
    if (panel.bare)
      out.labels.push_back(
          {{(out.frame.x0 + out.frame.x1) / 2, base}, title, {label_size, ink, Anchor::middle}});
    else
      out.labels.push_back({{std::min(out.frame.x0, cell.x1 - 1 - text_width(title, label_size)), base},
                            title,
                            {label_size, ink}});
  }
  if (panel.bare) return;
  add_x_labels(panel, cell, out);
  add_y_labels(panel, cell, false, out);
  add_y_labels(panel, cell, true, out);
}

}  // namespace unfurl::plot
