// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/frame_overlay.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>

#include "render/plot/text_metrics.hpp"
#include "render/plot/ticks.hpp"
#include "render/scene/view.hpp"

namespace unfurl {
namespace {

std::string time_text(double t, double span) {
  // As many decimals as tell a two hundredth of the run.
  const double fine = span > 0 && span < 0.5 ? std::ceil(-std::log10(span / 200)) : 2;
  char text[64];
  std::snprintf(text, sizeof text, "t = %.*f s",
                static_cast<int>(std::clamp(fine, span < 0.5 ? 4.0 : 2.0, 12.0)), t);
  return text;
}

std::string number_text(double x) {
  return plot::format_number(x, 3);
}

// The largest magnitude of a column up to a time.
double largest_until(const Diagnostics& d, std::string_view column, double t) {
  const Series* series = d.find(column);
  double most = 0;
  for (std::size_t i = 0; series && i < d.t.size() && d.t[i] <= t + 1e-12; ++i)
    if (std::isfinite(series->values[i])) most = std::max(most, std::abs(series->values[i]));
  return most;
}

// What is not to scale in the picture; empty where rods are drawn as thick as they are.
std::string scale_text(const Appearance& looks) {
  constexpr double visible = 0.05;
  const auto factor = [](double x) {
    char text[32];
    std::snprintf(text, sizeof text, x < 0.095 ? "%.1g" : x < 9.95 ? "%.1f" : "%.0f", x);
    return std::string(text) + " \u00D7";
  };
  const double least = looks.least_scale, largest = looks.largest_scale;
  if (std::abs(least - 1) < visible && std::abs(largest - 1) < visible) return {};
  const bool one = factor(least) == factor(largest);
  return "rods drawn " + (one ? "" : factor(least) + " to ") + factor(largest) + " as thick";
}

// The width of a text in pixels, roughly; enough to space out a legend.
float about_width(const std::string& text, float height) {
  const auto letters = std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; });  // of UTF-8
  return 0.56f * height * static_cast<float>(letters);
}

}  // namespace

FrameOverlay::FrameOverlay(const Trajectory& trajectory, const FrameStyle& style, const Look& look,
                           const Appearance& looks, const RodField* field, const Mat3& upright)
    : trajectory_(trajectory),
      style_(style),
      look_(look),
      looks_(looks),
      field_(field),
      upright_(upright),
      width_(static_cast<float>(style.width)),
      height_(static_cast<float>(style.height)),
      fine_(static_cast<float>(std::max(style.options.supersample, 1))),
      unit_(std::max(0.55f * fine_ * style.words, std::min(height_ / 720.0f, width_ / 1280.0f))),
      edge_(30 * unit_),
      small_(fine_ * std::round(21 * unit_ / fine_)),
      large_(fine_ * std::round(28 * unit_ / fine_)) {
  prepare_inset();
}

FrameOverlay::Parts FrameOverlay::wanted() const {
  const RenderOptions& options = style_.options;
  Parts parts;
  const auto want = [&](bool on, Part part) {
    if (on) parts.insert(part);
  };
  want(options.time, Part::status);
  want(!style_.title.empty() && options.title, Part::title);
  want(parts.contains(Part::title), Part::second_line);
  want(options.legend && field_ && has_colors(), Part::color_bar);
  want(options.legend, Part::legend);
  want(inset_ != nullptr, Part::inset);
  want(options.legend, Part::thickness);
  want(options.method && style_.run, Part::method);
  want(options.errors && style_.diagnostics, Part::errors);
  want(options.scale_bar && style_.measures, Part::scale_bar);
  want(options.axes && style_.measures, Part::axes);
  return parts;
}

void FrameOverlay::add(double t, const VectorXd& whole, DrawList& list) const {
  const std::size_t first = list.labels.size();
  if (look_.dimensions || style_.options.dimensions) add_dimensions(whole, list);
  const std::size_t numbers = list.labels.size();
  std::vector<Piece> written = write(t, whole, wanted(), list);
  for (std::size_t k = first; k < numbers; ++k) written.push_back({Part::scale_bar, box_of(list.labels[k])});
  add_names(whole, written, list);
}

void FrameOverlay::add_key(double t, DrawList& list) const {
  Parts wanted{Part::legend};
  if (field_ && has_colors()) wanted.insert(Part::color_bar);
  write(t, {}, wanted, list);
}

std::vector<FrameOverlay::Piece> FrameOverlay::write(double t, const VectorXd& whole, Parts wanted,
                                                     DrawList& list) const {
  const std::size_t areas = list.areas.size(), lines = list.lines.size(), labels = list.labels.size();
  for (;;) {
    std::vector<Piece> pieces = write_all(t, whole, wanted, list);
    const std::optional<Part> left_out = in_the_way(pieces);
    if (!left_out) return pieces;
    wanted.erase(*left_out);
    list.areas.resize(areas), list.lines.resize(lines), list.labels.resize(labels);
    list.inset = {};
  }
}

constexpr double bold = 1.12;  // of the bold face's width to that of the other

FrameOverlay::Box FrameOverlay::box_of(const TextLabel& l) {
  const auto wide = static_cast<float>(
      (l.bold ? bold : 1) * plot::text_width(l.text, static_cast<double>(l.height) / plot::line_height));
  const float x = l.x - l.align * wide;
  return {x, l.y, x + wide, l.y + l.height};
}

std::vector<FrameOverlay::Piece> FrameOverlay::write_all(double t, const VectorXd& whole, const Parts& wanted,
                                                         DrawList& list) const {
  std::vector<Piece> pieces;
  std::size_t labels = list.labels.size(), boxes = 0;
  Boxes taken;
  const auto placed = [&](Part part) {
    for (; boxes < taken.size(); ++boxes) pieces.push_back({part, taken[boxes]});
    for (; labels < list.labels.size(); ++labels) pieces.push_back({part, box_of(list.labels[labels])});
  };
  const auto add = [&](Part part, const auto& draw) {
    if (!wanted.contains(part)) return;
    draw();
    placed(part);
  };
  add_heading(t, wanted, placed, list);
  add(Part::status, [&] { add_status(t, whole, taken, list); });
  add(Part::axes, [&] { add_axes(taken, list); });
  add(Part::color_bar, [&] { add_color_bar(taken, list); });
  add(Part::scale_bar, [&] { add_scale_bar(taken, list); });
  add(Part::legend, [&] { add_legend(t, taken, list); });
  add(Part::inset, [&] {
    add_inset(t, list);
    const Inset& in = list.inset;
    taken.push_back({in.x, in.y, in.x + in.width, in.y + in.height});
  });
  return pieces;
}

std::optional<FrameOverlay::Part> FrameOverlay::in_the_way(const std::vector<Piece>& pieces) const {
  std::optional<Part> least;
  const auto out = [&](Part part) {
    if (part != Part::status && (!least || part > *least)) least = part;
  };
  constexpr float hair = 0.5f;  // of a pixel
  for (const Piece& p : pieces) {
    const Box& b = p.box;
    if (b.x0 < -hair || b.y0 < -hair || b.x1 > width_ + hair || b.y1 > height_ + hair) out(p.part);
    for (const Piece& q : pieces)
      if (p.part > q.part && b.overlaps(q.box)) out(p.part);
  }
  return least;
}

// The solved nodes' coordinates, read off any of their copies.
VectorXd FrameOverlay::solved(const VectorXd& whole) const {
  const Structure& s = trajectory_.structure();
  VectorXd q = VectorXd::Zero(3 * static_cast<Index>(s.nodes.size()));
  for (std::size_t i = s.node_copies.size(); i-- > 0;) {  // backwards: the first copy has the last word
    const NodeCopy& copy = s.node_copies[i];
    q.segment<3>(3 * copy.source) =
        copy.map.inverse() * (whole.segment<3>(3 * static_cast<Index>(i)) - copy.offset);
  }
  return q;
}

TextLabel FrameOverlay::quiet(const DrawList& list, TextLabel label) const {
  if (list.transparent || on_banner_) return label;
  const float down = (label.y + 0.5f * label.height) / height_;
  const Color &a = look_.background_top, &b = look_.background_bottom;
  label.backing = {a.r + down * (b.r - a.r), a.g + down * (b.g - a.g), a.b + down * (b.b - a.b), 0.84f};
  return label;
}

// In so many lines at most: what is longer ends in dots. The title is larger than the others, and bold.
void FrameOverlay::add_line_of_heading(Heading& heading, float size, const std::string& text, int most,
                                       DrawList& list) const {
  if (heading.room < 4 * size) return;  // of dots alone
  const bool title = size == large_;
  const double wide = static_cast<double>(size) / plot::line_height * (title ? bold : 1);
  const auto room = static_cast<double>(heading.room);
  std::vector<std::string> lines = plot::wrap_text(text, wide, room);
  if (std::ssize(lines) > most || most == 1) {
    const std::size_t first = most > 1 ? lines.front().size() + 1 : 0;
    lines.resize(static_cast<std::size_t>(most - 1));
    lines.push_back(
        plot::shorten_text(std::string_view(text).substr(std::min(first, text.size())), wide, room));
  }
  for (const std::string& line : lines) {
    list.labels.push_back(quiet(list, {edge_, heading.y, size, look_.ink, line, 0, title}));
    heading.y += (title ? 1.35f : 1.3f) * size;
  }
}

void FrameOverlay::add_heading(double t, const Parts& wanted, const std::function<void(Part)>& placed,
                               DrawList& list) const {
  // Beside the inset, or below it where there is no room.
  const bool inset = wanted.contains(Part::inset);
  Heading heading{0.8f * edge_, width_ - 2 * edge_};
  if (const float beside = heading.room - 360 * unit_; inset && beside > 8 * large_)
    heading.room = beside;
  else if (inset)
    heading.y += 215 * unit_;
  if (wanted.contains(Part::title)) {
    const std::size_t first = list.labels.size();
    add_line_of_heading(heading, large_, style_.title, wanted.contains(Part::second_line) ? 2 : 1, list);
    placed(list.labels.size() > first + 1 ? Part::second_line : Part::title);
  }
  const float line = fine_ * std::round(0.85f * small_ / fine_);
  const auto add = [&](Part part, float size, const std::string& text, int most = 1) {
    if (text.empty()) return;
    add_line_of_heading(heading, size, text, most, list);
    placed(part);
  };
  constexpr int factor_lines = 3;  // without its number the text says nothing
  if (wanted.contains(Part::thickness)) add(Part::thickness, small_, scale_text(looks_), factor_lines);
  if (wanted.contains(Part::method)) {
    const SolverOptions& solver = style_.run->options;
    std::string text = solver.method;
    if (solver.method == "dvm") text += ", s = " + std::to_string(solver.stages);
    text += (solver.adaptive ? ", h \u2264 " : ", h = ") + number_text(solver.step) + " s";
    add(Part::method, line, solved_as(*style_.run).name == "path" ? "solved along its path" : text);
  }
  if (wanted.contains(Part::errors)) {
    const Diagnostics& d = *style_.diagnostics;
    add(Part::errors, line,
        "so far: constraints " + number_text(largest_until(d, "constraint_max_m", t)) +
            " m, energy balance " + number_text(largest_until(d, "energy_balance_J", t)) + " J");
  }
}

float FrameOverlay::lifted(Box box, const Boxes& taken) const {
  const float gap = 6 * unit_;
  float up = 0;
  for (bool moved = true; moved;) {
    moved = false;
    for (const Box& other : taken) {
      const Box here{box.x0 - gap, box.y0 - up - gap, box.x1 + gap, box.y1 - up + gap};
      if (!here.overlaps(other)) continue;
      up = box.y1 + 1.01f * gap - other.y0;
      moved = true;
    }
  }
  return up;
}

void FrameOverlay::add_status(double t, const VectorXd& whole, Boxes& taken, DrawList& list) const {
  std::vector<std::string> lines{time_text(t, trajectory_.end_time() - trajectory_.start_time())};
  const Deployment& deployment = trajectory_.structure().deployment;
  const VectorXd angles = deployment.measured ? trajectory_.state_at(t).angles : VectorXd();
  if (!deployment.empty())
    lines.push_back("deployed " + plot::format_share(deployment.fraction(solved(whole), angles)));
  // In one line where there is room, each in its own where there is not, smaller where one has none.
  const float room = width_ - 2 * edge_;
  const auto width = [&](const std::string& text) {
    return static_cast<float>(plot::text_width(text, static_cast<double>(small_) / plot::line_height));
  };
  if (lines.size() == 2)
    if (const std::string both = lines[0] + "    " + lines[1]; width(both) <= room) lines = {both};
  float widest = 0;
  for (const std::string& line : lines) widest = std::max(widest, width(line));
  constexpr float least = 5;  // pixels: what has no room for those is cut off
  const float size =
      widest > room ? fine_ * std::max(least, std::floor(small_ * room / widest / fine_)) : small_;
  float y = height_ - edge_ - size - 1.2f * size * static_cast<float>(lines.size() - 1);
  for (const std::string& line : lines) {
    list.labels.push_back(quiet(list, {edge_, y, size, look_.ink, line}));
    taken.push_back({edge_, y, edge_ + about_width(line, size), y + size});
    y += 1.2f * size;
  }
}

// Of a cable or a net a line. Else a square in the colour, framed in ink: a colour as light as the ground has
// an edge on it.
void FrameOverlay::add_sample(DrawList& list, float x, float y, const LegendEntry& entry) const {
  const float side = std::round(0.66f * small_), frame = std::max(1.0f, std::round(0.06f * small_));
  if (const float middle = std::round(y + 0.5f * small_); entry.line > 0)
    return list.lines.push_back({x, middle, x + side, middle, entry.line, entry.color});
  const float top = y + 0.5f * (small_ - side), inside = side - frame;
  list.areas.push_back({x, top, x + side, top + side, look_.ink});
  list.areas.push_back({x + frame, top + frame, x + inside, top + inside, entry.color});
}

std::vector<FrameOverlay::LegendEntry> FrameOverlay::legend_entries(double t, const DrawList& list) const {
  std::vector<LegendEntry> legend;
  const auto add = [&](bool arrow, const std::string& name, const Color& color, float line = 0) {
    const double em = static_cast<double>(small_) / plot::line_height;
    const std::string text =
        plot::shorten_text(name, em, static_cast<double>(width_ - 2 * edge_ - 2 * small_));
    const auto wide = static_cast<float>(plot::text_width(text, em));
    legend.push_back({arrow, text, color, wide + 0.95f * small_, line});
  };
  if (!field_ && looks_.groups.size() > 1)
    for (std::size_t i = 0; i < looks_.groups.size(); ++i) add(false, looks_.groups[i], look_.group(i));
  if (field_ && field_->known)
    if (std::ranges::any_of(trajectory_.structure().rod_copies,
                            [&](const RodCopy& rod) { return !std::isfinite(field_->at(t, rod.source)); }) ||
        field_->lines.hasNaN())
      add(false, field_->unknown, field_->color(std::nan("")));
  // By their forces, as rods: then the colour that stands for none is named.
  const bool by_force = field_ && field_->lines.cols() > 0;
  std::set<std::string> lines;
  for (std::size_t i = 0; const ShownLine& line : trajectory_.structure().lines) {
    const bool named = !by_force || (field_->lines.col(static_cast<Index>(i)).array() == 0).any();
    ++i;
    if (named && lines.insert(line.group).second)
      add(false, line.group + (by_force ? ", slack" : ""),
          by_force ? look_.slack_color() : look_.line_color(line.group, field_ && field_->diverging),
          std::max((line.group == "net" ? 1 : 2) * fine_,
                   std::round((line.group == "net" ? 0.06f : 0.12f) * small_)));
  }
  const bool sized = style_.options.colour_by == "axial_force" && field_;
  if (!list.arrows.empty())
    add(true, sized ? "load, longest " + number_text(looks_.largest_force) + " N" : "load",
        list.arrows.front().color);
  if (!style_.trails.empty()) add(false, "trail", trail_color(look_, looks_));
  return legend;
}

// From the right to what is taken on the left, and from the last row up.
std::vector<FrameOverlay::LegendRow> FrameOverlay::legend_rows(std::vector<LegendEntry> entries, float y,
                                                               const Boxes& taken) const {
  std::vector<LegendRow> rows;
  for (; !entries.empty(); y -= 1.3f * small_) {
    float room = width_ - 2 * edge_;
    for (const Box& box : taken)
      if (box.y0 < y + 1.2f * small_ && box.y1 > y - 0.2f * small_)
        room = std::min(room, width_ - edge_ - (box.x1 + small_));
    LegendRow row{y, {}};
    while (!entries.empty() && (entries.back().width <= room || y < 0)) {
      room -= entries.back().width + small_;
      row.entries.push_back(std::move(entries.back()));
      entries.pop_back();
    }
    if (!row.entries.empty()) rows.push_back(std::move(row));
  }
  return rows;
}

// The name in ink, which can be read on any ground, behind a sign in the colour.
void FrameOverlay::add_legend(double t, Boxes& taken, DrawList& list) const {
  if (width_ - 2 * edge_ < 6 * small_) return;  // for signs without names
  const std::vector<LegendEntry> all = legend_entries(t, list);
  const float y = height_ - edge_ - small_, highest = on_banner_ ? 0 : 0.6f * height_;
  std::vector<LegendRow> rows = legend_rows(all, y, taken);
  for (std::size_t shown = all.size(); shown-- > 1 && rows.back().y < highest;) {
    std::vector<LegendEntry> some(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(shown));
    const std::string rest = "and " + std::to_string(all.size() - shown) + " more";
    some.push_back(
        {false,
         rest,
         {0, 0, 0, 0},
         static_cast<float>(plot::text_width(rest, static_cast<double>(small_) / plot::line_height)) +
             0.95f * small_});
    rows = legend_rows(std::move(some), y, taken);
  }
  if (!rows.empty() && rows.back().y < highest) return;  // where the structure is
  const float sign_width = 0.95f * small_, room = 0.25f * small_;
  for (const LegendRow& row : rows) {
    float right = width_ - edge_;
    for (const LegendEntry& entry : row.entries) {
      const float left = right - entry.width;
      taken.push_back({left, row.y, right, row.y + small_});
      const TextLabel name = quiet(list, {right, row.y, small_, look_.ink, entry.name, 1});
      if (name.backing.a > 0)
        list.areas.push_back({left - room, row.y, right + room, row.y + small_, name.backing, room});
      list.labels.push_back({left + sign_width, row.y, small_, look_.ink, entry.name, 0});
      if (entry.arrow)
        list.labels.push_back({left, row.y, small_, entry.color, "\u2192", 0});
      else if (entry.color.a > 0)
        add_sample(list, left, row.y, entry);
      right = left - 1.0f * small_;
    }
  }
}

namespace {

// Three numbers in so many digits that they stay apart by what they are apart, of three at least.
std::array<std::string, 3> bar_numbers(const std::array<double, 3>& values) {
  const double least = std::min(values[1] - values[0], values[2] - values[1]),
               most = std::max(std::abs(values[0]), std::abs(values[2]));
  const double beyond = least > 0 ? std::floor(std::log10(most / least)) : 0;  // digits that they share
  const int digits = static_cast<int>(std::clamp(beyond + 2, 3.0, 15.0));
  std::array<std::string, 3> out;
  for (std::size_t k = 0; k < 3; ++k) out[k] = plot::format_number(values[k], digits);
  return out;
}

// Where the colours end before the values do.
std::string end_mark(const RodField& field, double u) {
  if (u == 0.0 && field.below) return "\u2264 ";
  if (u == 1.0 && field.above) return "\u2265 ";
  return {};
}

}  // namespace

void FrameOverlay::add_color_bar(Boxes& taken, DrawList& list) const {
  constexpr int steps = 64;
  const float length = std::min(280 * unit_, width_ - 2 * edge_), thick = 12 * unit_,
              line = fine_ * std::round(0.8f * small_ / fine_);
  const double low = field_->known ? field_->low : 0, high = field_->known ? field_->high : 1;
  const auto value = [&](double u) {
    return field_->log ? low * std::pow(high / low, u) : low + u * (high - low);
  };
  const std::array<std::string, 3> numbers = bar_numbers({value(0), value(0.5), value(1)});
  std::array<float, 3> widths{};
  for (std::size_t k = 0; k < 3; ++k)
    widths[k] = static_cast<float>(plot::text_width(
        end_mark(*field_, 0.5 * static_cast<double>(k)) + numbers[k], static_cast<double>(line)));
  const float gap = 0.4f * line;
  if (field_->known && widths[0] + gap + widths[2] > length) return;  // no bar without numbers
  // Between the others where there is room.
  const bool middle = std::max(widths[0], widths[2]) + gap + 0.5f * widths[1] <= 0.5f * length;
  const std::vector<std::string> words =
      plot::wrap_text(field_->label, static_cast<double>(line), static_cast<double>(width_ - 2 * edge_));
  float label = 0;
  for (const std::string& text : words) label = std::max(label, about_width(text, line));
  label = std::min(label, width_ - 2 * edge_);  // they are wrapped
  const float wide = std::max(length, label), tall = 1.35f * line * static_cast<float>(words.size());
  const bool longer = label > length;  // it then ends where the bar ends
  const float x = width_ - edge_ - length;
  // The last line a little above a place.
  const auto add_words = [&](float right, float left, float below) {
    float y = below - tall;
    for (const std::string& text : words) {
      list.labels.push_back(
          quiet(list, {longer ? right : left, y, line, look_.ink, text, longer ? 1.0f : 0.0f}));
      y += 1.35f * line;
    }
  };
  if (!field_->known) {  // no scale of nothing
    Box box{width_ - edge_ - wide, height_ - edge_ - tall, width_ - edge_, height_ - edge_};
    const float up = lifted(box, taken);
    box.y0 -= up, box.y1 -= up;
    add_words(box.x1, box.x0, box.y1 + 0.35f * line);
    return taken.push_back(box);
  }
  Box box{width_ - edge_ - wide, height_ - edge_ - 1.25f * line - thick - tall, width_ - edge_,
          height_ - edge_};
  const float up = lifted(box, taken), y = height_ - edge_ - 1.25f * line - thick - up;
  box.y0 -= up, box.y1 -= up;
  taken.push_back(box);
  for (int k = 0; k < steps; ++k) {
    const float a = x + length * static_cast<float>(k) / steps,
                b = x + length * static_cast<float>(k + 1) / steps;
    list.areas.push_back({a, y, b, y + thick, field_->color(value((k + 0.5) / steps))});
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (k == 1 && !middle) continue;
    const double u = 0.5 * static_cast<double>(k);
    const float at = x + length * static_cast<float>(u);
    list.lines.push_back({at, y + thick, at, y + thick + 4 * unit_, 1.5f * unit_, look_.ink});
    list.labels.push_back(quiet(list, {at, y + thick + 5 * unit_, line, look_.ink,
                                       end_mark(*field_, u) + numbers[k], static_cast<float>(u)}));
  }
  add_words(x + length, x, y);
}

}  // namespace unfurl
