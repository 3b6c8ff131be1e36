// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/figures/sweep_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "core/text/utf8.hpp"
#include "render/plot/contours.hpp"
#include "render/plot/figures/run_facts.hpp"
#include "render/plot/same_curves.hpp"
#include "render/plot/ticks.hpp"

namespace unfurl {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t most_curves = 12;  // that can be told apart
constexpr std::size_t most_words = 30;   // that stand below each other

// Values of a measure by the numbers of the row's axes; finite ones only.
double value_of(const SweepPlan& plan, const std::vector<std::string>& row, std::size_t measure) {
  const double x = number_of(row[plan.axes.size() + 1 + measure]);
  return std::isfinite(x) ? x : nan;
}

std::string count_sentence(const SweepPlan& plan, const Sweep& sweep) {
  const std::size_t bad = unanswered(plan, sweep);
  std::string text = std::to_string(sweep.table.rows.size()) + " runs";
  if (bad > 0) text += ", " + std::to_string(bad) + " of them without an answer (left out)";
  if (!sweep.missing.empty()) text += ", " + std::to_string(sweep.missing.size()) + " more not done yet";
  return text + ".";
}

// What never comes, a time at which a run is not deployed say, has no place on an axis.
std::string endless_sentence(const SweepPlan& plan, const Sweep& sweep, std::size_t measure) {
  const auto endless = std::count_if(sweep.table.rows.begin(), sweep.table.rows.end(), [&](const auto& row) {
    return std::isinf(number_of(row[plan.axes.size() + 1 + measure]));
  });
  return endless == 0 ? ""
                      : " Infinite in " + std::to_string(endless) +
                            (endless == 1 ? " of the runs, which is not drawn."
                                          : " of the runs, which are not drawn.");
}

// Beside runs that ended deployed: in how many others that was still to come, as peaks and sums of those are
// not of a whole deployment.
std::string undeployed_sentence(const SweepPlan& plan, const Sweep& sweep) {
  const auto runs = [&](const char* outcome) {
    return std::ranges::count_if(sweep.table.rows,
                                 [&](const auto& row) { return row[plan.axes.size()] == outcome; });
  };
  const auto open = runs("completed");
  const auto goes_on = [](const SweepAxis& axis) { return axis.key == "solver.at_deployed"; };
  if (std::ranges::any_of(plan.axes, goes_on) || open == 0 || runs("deployed") == 0) return {};
  return " " + std::to_string(open) + " of them ended before " +
         (open == 1 ? "its structure was deployed." : "their structures were deployed.");
}

// Of a force: in how many of the runs the rigid model does not determine it.
std::string uniqueness_sentence(const SweepPlan& plan, const Sweep& sweep, std::size_t measure) {
  const std::string name = uniqueness_of(plan.measures[measure].name);
  const auto at = std::find_if(plan.measures.begin(), plan.measures.end(),
                               [&](const RunMeasure& m) { return m.name == name; });
  if (name.empty() || at == plan.measures.end()) return {};
  const auto column = static_cast<std::size_t>(at - plan.measures.begin());
  const auto open = std::count_if(sweep.table.rows.begin(), sweep.table.rows.end(),
                                  [&](const auto& row) { return value_of(plan, row, column) == 0.0; });
  if (open == 0) return {};
  return " Not unique in " + std::to_string(open) +
         " of them: there the rigid model does not determine this force, and shown is the choice of least "
         "norm, or it has no bound beside a singular pose.";
}

bool is_flag(const RunMeasure& measure) {
  return measure.name.ends_with("_unique");
}

std::string file_name(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == ':' || c == '/'; }, '_');
  constexpr std::size_t longest = 100;  // of 255 that file systems take
  return text.substr(0, utf8_cut(text, longest));
}

// Values over more than three decades are read on a log axis; exact zeros then stand at its bottom edge.
void set_scale(Panel& p) {
  double least = std::numeric_limits<double>::infinity(), largest = 0;
  for (const Curve& c : p.curves)
    for (const double y : c.y) {
      if (y < 0) return;
      if (y > 0) least = std::min(least, y), largest = std::max(largest, y);
    }
  p.y.log = p.y.zeros_at_floor = largest > 1e3 * least;
}

bool has_zeros(const Panel& p) {
  return std::ranges::any_of(p.curves, [](const Curve& c) { return std::ranges::count(c.x, 0.0) > 0; });
}

// "Deployment time", of "deployment time (s)".
std::string heading(const std::string& label) {
  std::string text = label.substr(0, label.rfind(" ("));
  if (text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

// A list may be given in any order; a curve runs from the left to the right.
std::vector<std::size_t> in_order(const std::vector<double>& numbers) {
  std::vector<std::size_t> order(numbers.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return numbers[a] < numbers[b]; });
  return order;
}

// Curves over axis `across`, one per value of the other axis where there is one.
Panel curve_panel(const SweepPlan& plan, const Sweep& sweep, std::size_t measure, std::size_t across) {
  constexpr std::array markers{Marker::circle, Marker::square, Marker::triangle, Marker::diamond};
  const SweepAxis& axis = plan.axes[across];
  Panel p;
  p.x.label = axis.title();
  p.x.log = axis.log;
  p.x.whole = axis.whole && !axis.log;
  p.y.label = plan.measures[measure].label;
  std::map<std::pair<std::string, std::string>, const std::vector<std::string>*> rows;
  for (const auto& row : sweep.table.rows)
    rows.try_emplace({row[across], plan.axes.size() == 2 ? row[1 - across] : ""}, &row);
  const std::size_t families = plan.axes.size() == 2 ? plan.axes[1 - across].values.size() : 1;
  for (std::size_t f = 0; f < families; ++f) {
    Curve c;
    c.color = static_cast<int>(f);
    c.marker = markers[f % markers.size()];
    if (families > 1) c.label = plan.axes[1 - across].title(f);
    for (const std::size_t i : in_order(axis.numbers)) {
      const auto row =
          rows.find({axis.values[i], plan.axes.size() == 2 ? plan.axes[1 - across].values[f] : ""});
      c.x.push_back(axis.numbers[i]);
      c.y.push_back(row == rows.end() ? nan : value_of(plan, *row->second, measure));
    }
    p.curves.push_back(std::move(c));
  }
  set_scale(p);
  return p;
}

// A row for every word of the axis `down`, the first at the top; a marker for every value of the other axis
// where there is one.
Panel word_panel(const SweepPlan& plan, const Sweep& sweep, std::size_t measure, std::size_t down) {
  const SweepAxis& axis = plan.axes[down];
  const std::size_t count = axis.values.size();
  SweepPlan turned = plan;  // the same with numbers: the place of each word from below
  turned.axes[down].numbers.clear();
  for (std::size_t i = 0; i < count; ++i)
    turned.axes[down].numbers.push_back(static_cast<double>(count - 1 - i));
  turned.axes[down].log = false;
  Panel p = curve_panel(turned, sweep, measure, down);
  const auto families = static_cast<double>(p.curves.size());
  for (std::size_t f = 0; f < p.curves.size(); ++f) {
    Curve& c = p.curves[f];
    std::swap(c.x, c.y);
    c.width = 0;
    const double aside = 0.5 * ((families - 1) / 2 - static_cast<double>(f)) / families;
    for (double& y : c.y) y += aside;  // what is the same lies below each other, not on each other
  }
  p.x = {.label = plan.measures[measure].label, .log = p.y.log && !has_zeros(p)};
  p.y = {.label = axis.title(), .min = -0.5, .max = static_cast<double>(count) - 0.5};
  for (std::size_t i = count; i-- > 0;) p.y.names.push_back(axis.word(i));
  return p;
}

plot::Field field_of(const SweepPlan& plan, const Sweep& sweep, std::size_t measure) {
  plot::Field field{plan.axes[0].numbers, plan.axes[1].numbers, {}};
  std::sort(field.x.begin(), field.x.end());
  std::sort(field.y.begin(), field.y.end());
  field.values.assign(field.x.size() * field.y.size(), nan);
  for (const auto& row : sweep.table.rows) {
    const auto at = [&](const std::vector<double>& axis, double x) {
      return static_cast<std::size_t>(std::lower_bound(axis.begin(), axis.end(), x) - axis.begin());
    };
    const std::size_t i = at(field.x, number_of(row[0])), j = at(field.y, number_of(row[1]));
    if (i < field.x.size() && j < field.y.size())
      field.values[i * field.y.size() + j] = value_of(plan, row, measure);
  }
  return field;
}

struct ValueRange {
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;
  double share(double v) const { return hi > lo ? (v - lo) / (hi - lo) : 0.5; }
};

ValueRange range_of(const plot::Field& field) {
  ValueRange range;
  for (const double v : field.values)
    if (!std::isnan(v)) range.lo = std::min(range.lo, v), range.hi = std::max(range.hi, v);
  return range;
}

// Every square of the grid in parts, of equal width on the axis as it is drawn: in between, values are
// bilinear there, and both the colours and the contour lines are those of the parts.
plot::Field in_parts(const plot::Field& field, bool log_x, bool log_y) {
  const auto parts_of = [](const std::vector<double>& axis) {
    return std::max<std::size_t>(1, 64 / std::max<std::size_t>(1, axis.size() - 1));
  };
  const auto knots = [&](const std::vector<double>& axis, bool log) {
    std::vector<double> all;
    const std::size_t parts = parts_of(axis);
    for (std::size_t i = 0; i + 1 < axis.size(); ++i)
      for (std::size_t k = 0; k < parts; ++k) {
        const double u = static_cast<double>(k) / static_cast<double>(parts);
        all.push_back(k == 0 ? axis[i]
                      : log  ? axis[i] * std::pow(axis[i + 1] / axis[i], u)
                             : axis[i] + u * (axis[i + 1] - axis[i]));
      }
    all.push_back(axis.back());
    return all;
  };
  plot::Field fine{knots(field.x, log_x), knots(field.y, log_y), {}};
  const std::size_t px = parts_of(field.x), py = parts_of(field.y);
  for (std::size_t i = 0; i < fine.x.size(); ++i)
    for (std::size_t j = 0; j < fine.y.size(); ++j) {
      const std::size_t a = std::min(i / px, field.x.size() - 2), b = std::min(j / py, field.y.size() - 2);
      fine.values.push_back(plot::interpolate(field, a, b,
                                              static_cast<double>(i - a * px) / static_cast<double>(px),
                                              static_cast<double>(j - b * py) / static_cast<double>(py)));
    }
  return fine;
}

void add_cells(const plot::Field& field, const ValueRange& range, Panel& p) {
  for (std::size_t i = 0; i + 1 < field.x.size(); ++i)
    for (std::size_t j = 0; j + 1 < field.y.size(); ++j) {
      const double value = plot::interpolate(field, i, j, 0.5, 0.5);
      if (!std::isnan(value))
        p.cells.push_back({field.x[i], field.y[j], field.x[i + 1], field.y[j + 1],
                           map_color(range.share(value)), exact_number(value)});
    }
}

// The points with a value of which no square of the grid has all four: i, j.
std::vector<std::pair<std::size_t, std::size_t>> lone_points(const plot::Field& field) {
  const auto whole = [&](std::size_t i, std::size_t j) {  // the square from there on
    return i + 1 < field.x.size() && j + 1 < field.y.size() &&
           !std::isnan(plot::interpolate(field, i, j, 0.5, 0.5));
  };
  std::vector<std::pair<std::size_t, std::size_t>> alone;
  for (std::size_t i = 0; i < field.x.size(); ++i)
    for (std::size_t j = 0; j < field.y.size(); ++j)
      if (!std::isnan(field.value(i, j)) && !whole(i, j) && !(i > 0 && whole(i - 1, j)) &&
          !(j > 0 && whole(i, j - 1)) && !(i > 0 && j > 0 && whole(i - 1, j - 1)))
        alone.push_back({i, j});
  return alone;
}

// A small square around each: a quarter of the way to its neighbours.
void add_lone_cells(const plot::Field& field, const ValueRange& range, Panel& p) {
  const auto towards = [](const std::vector<double>& axis, std::size_t from, std::size_t to, bool log) {
    return log ? axis[from] * std::pow(axis[to] / axis[from], 0.25)
               : axis[from] + 0.25 * (axis[to] - axis[from]);
  };
  const auto low = [&](const std::vector<double>& axis, std::size_t i, bool log) {
    return towards(axis, i, i > 0 ? i - 1 : i, log);
  };
  const auto high = [&](const std::vector<double>& axis, std::size_t i, bool log) {
    return towards(axis, i, std::min(i + 1, axis.size() - 1), log);
  };
  for (const auto& [i, j] : lone_points(field)) {
    const double value = field.value(i, j);
    p.cells.push_back({low(field.x, i, p.x.log), low(field.y, j, p.y.log), high(field.x, i, p.x.log),
                       high(field.y, j, p.y.log), map_color(range.share(value)), exact_number(value)});
  }
}

Panel color_bar(const ValueRange& range, const std::vector<double>& levels, std::string label) {
  Panel bar;
  bar.height = 0.07;
  bar.x.label = std::move(label);
  bar.x.min = range.lo;
  bar.x.max = range.hi;
  bar.y.min = 0;
  bar.y.max = 1;
  bar.y.shown = false;
  constexpr int parts = 128;
  const double width = (range.hi - range.lo) / parts;
  for (int i = 0; i < parts; ++i)
    bar.cells.push_back(
        {range.lo + width * i, 0, range.lo + width * (i + 1), 1, map_color((i + 0.5) / parts)});
  for (const double level : levels) {
    Curve c;
    c.x = {level, level};
    c.y = {0, 1};
    c.color = 6;
    c.width = 0.6f;
    bar.curves.push_back(std::move(c));
  }
  return bar;
}

// Where the map is known: a dot at every point of the grid that has a value.
Curve sample_points(const plot::Field& field) {
  Curve dots;
  dots.width = 0;
  dots.marker = Marker::circle;
  dots.marker_size = 0.4f;
  dots.color = 6;
  for (std::size_t j = 0; j < field.y.size(); ++j)  // along x: of many above each other a trace keeps four
    for (std::size_t i = 0; i < field.x.size(); ++i)
      if (!std::isnan(field.value(i, j))) dots.x.push_back(field.x[i]), dots.y.push_back(field.y[j]);
  return dots;
}

// What differs by rounding is the same, as it is for a curve.
bool varies(const ValueRange& range) {
  return range.hi - range.lo > 1e-12 * std::max(std::abs(range.lo), std::abs(range.hi));
}

// With as many digits as tell a level from its neighbours, and four at least.
std::string level_label(double level, const std::vector<double>& levels) {
  double digits = 4;
  if (levels.size() > 1) {
    const double apart = levels[1] - levels[0];
    const double largest = std::max(std::abs(levels.front()), std::abs(levels.back()));
    digits = std::clamp(std::ceil(std::log10(largest / apart)) + 1, 4.0, 16.0);
  }
  return plot::format_number(level, static_cast<int>(digits));
}

std::string map_caption(const SweepPlan& plan, const Sweep& sweep, std::size_t measure) {
  const std::string points = std::to_string(plan.axes[0].values.size()) + " x " +
                             std::to_string(plan.axes[1].values.size()) + " points (dots)";
  const plot::Field field = field_of(plan, sweep, measure);
  const ValueRange range = range_of(field);
  if (range.lo <= range.hi && !varies(range))
    return "The same at every dot: " + plan.measures[measure].label + " = " +
           plot::format_number(range.lo, 4) + ", computed on a grid of " + points + ". ";
  return "Colour and contour lines: " + plan.measures[measure].label + ", computed on a grid of " + points +
         ", interpolated bilinearly" +
         (lone_points(field).empty() ? ". "
                                     : "; small squares: points without neighbours that have a value. ");
}

Figure map_figure(const SweepPlan& plan, const Sweep& sweep, std::size_t measure) {
  const plot::Field field = field_of(plan, sweep, measure);
  const ValueRange range = range_of(field);
  Figure f;
  f.rows = 2;
  f.width_mm = 140;
  f.height_mm = 125;
  Panel map;
  map.x = {
      .label = plan.axes[0].title(), .log = plan.axes[0].log, .min = field.x.front(), .max = field.x.back()};
  map.y = {
      .label = plan.axes[1].title(), .log = plan.axes[1].log, .min = field.y.front(), .max = field.y.back()};
  map.x.whole = plan.axes[0].whole && !map.x.log;
  map.y.whole = plan.axes[1].whole && !map.y.log;
  std::vector<double> levels;
  plot::Field fine;
  if (varies(range)) {
    fine = in_parts(field, map.x.log, map.y.log);
    add_cells(fine, range, map);
    add_lone_cells(field, range, map);
    levels = plot::linear_ticks(range.lo, range.hi, 9).major;
  }
  for (const double level : levels) {
    plot::Segments lines = plot::contour(fine, level);
    Curve c;
    c.x = std::move(lines.x);
    c.y = std::move(lines.y);
    c.color = 6;
    c.width = 0.6f;
    c.label = level_label(level, levels);
    map.curves.push_back(std::move(c));
  }
  map.curves.push_back(sample_points(field));
  f.panels = {std::move(map)};
  if (varies(range)) f.panels.push_back(color_bar(range, levels, plan.measures[measure].label));
  if (f.panels.size() == 1) f.rows = 1;
  return f;
}

}  // namespace

std::vector<Figure> sweep_figures(const SweepPlan& plan, const Sweep& sweep, const std::string& scene) {
  std::vector<Figure> figures;
  const auto numeric = [&](std::size_t a) { return plan.axes[a].numbers.size() > 1; };
  const std::size_t axes = plan.axes.size();
  if (axes > 2 || sweep.table.rows.empty()) return figures;
  const bool map = axes == 2 && numeric(0) && numeric(1) &&
                   std::min(plan.axes[0].values.size(), plan.axes[1].values.size()) > 4;
  const std::size_t across =
      axes == 2 && (!numeric(0) || (numeric(1) && plan.axes[1].values.size() > plan.axes[0].values.size()))
          ? 1
          : 0;
  const auto few = [&](std::size_t a) { return axes == 1 || plan.axes[1 - a].values.size() <= most_curves; };
  const bool words = !map && !(numeric(across) && few(across));
  const std::size_t down = axes == 2 && plan.axes[1].values.size() > plan.axes[0].values.size() ? 1 : 0;
  if (words && (plan.axes[down].values.size() > most_words || !few(down))) return figures;
  for (std::size_t m = 0; m < plan.measures.size(); ++m) {
    if (is_flag(plan.measures[m])) continue;
    Figure f;
    if (map) {
      f = map_figure(plan, sweep, m);
      f.caption = map_caption(plan, sweep, m);
    } else if (words) {
      f.panels.push_back(word_panel(plan, sweep, m, down));
      f.height_mm = 45 + 7 * static_cast<double>(plan.axes[down].values.size());
    } else {
      f.panels.push_back(curve_panel(plan, sweep, m, across));
    }
    f.name = "sweep_" + file_name(plan.measures[m].name);
    while (std::ranges::any_of(figures, [&](const Figure& other) { return other.name == f.name; }))
      f.name += "_";
    f.title = heading(plan.measures[m].label) + ": " + scene;
    f.caption += count_sentence(plan, sweep) + undeployed_sentence(plan, sweep) +
                 endless_sentence(plan, sweep, m) + uniqueness_sentence(plan, sweep, m);
    if (f.panels[0].y.zeros_at_floor) {
      std::vector<double> drawn;
      for (const Curve& c : f.panels[0].curves) drawn.insert(drawn.end(), c.y.begin(), c.y.end());
      f.caption += zeros_sentence(drawn);
    }
    f.caption += plot::same_curves_sentence(f);
    figures.push_back(std::move(f));
  }
  return figures;
}

}  // namespace unfurl
