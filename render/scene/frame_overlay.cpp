// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/frame_overlay.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "render/plot/text_metrics.hpp"
#include "render/scene/view.hpp"

namespace unfurl {
namespace {

std::string time_text(double t, double span) {
  char text[64];
  std::snprintf(text, sizeof text, "t = %.*f s", span < 0.5 ? 4 : 2, t);
  return text;
}

std::string deployed_text(double fraction) {
  char text[64];
  std::snprintf(text, sizeof text, "deployed %.0f %%", std::max(0.0, std::round(100 * fraction)));
  return text;
}

std::string number_text(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x == 0 ? 0.0 : x);
  std::string out = text;
  if (out.starts_with("-")) out.replace(0, 1, "\u2212");
  return out;
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
    std::snprintf(text, sizeof text, x < 9.95 ? "%.1f" : "%.0f", x);
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
      unit_(std::max(0.55f, std::min(height_ / 720.0f, width_ / 1280.0f))),
      edge_(30 * unit_),
      small_(std::round(21 * unit_)),
      large_(std::round(28 * unit_)) {
  prepare_inset();
}

void FrameOverlay::add(double t, const VectorXd& whole, DrawList& list) const {
  const RenderOptions& options = style_.options;
  if (look_.dimensions || options.dimensions) add_dimensions(whole, list);
  add_names(whole, list);
  add_heading(t, list);
  if (options.time) add_status(t, whole, list);
  if (options.legend) {
    if (field_) add_color_bar(list);
    add_legend(list);
  }
  if (options.scale_bar) add_scale_bar(list);
  if (options.axes) add_axes(list);
  add_inset(t, list);
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
  if (list.transparent) return label;
  const float down = (label.y + 0.5f * label.height) / height_;
  const Color &a = look_.background_top, &b = look_.background_bottom;
  label.backing = {a.r + down * (b.r - a.r), a.g + down * (b.g - a.g), a.b + down * (b.b - a.b), 0.84f};
  return label;
}

void FrameOverlay::add_heading(double t, DrawList& list) const {
  float y = 0.8f * edge_;
  if (!style_.title.empty() && style_.options.title) {
    list.labels.push_back(quiet(list, {edge_, y, large_, look_.ink, style_.title, 0, true}));
    y += 1.35f * large_;
  }
  const float line = std::round(0.85f * small_);
  if (const std::string note = scale_text(looks_); !note.empty() && style_.options.legend) {
    list.labels.push_back(quiet(list, {edge_, y, small_, look_.ink, note}));
    y += 1.3f * small_;
  }
  if (style_.options.method && style_.run) {
    const SolverOptions& solver = style_.run->options;
    std::string text = solver.method;
    if (solver.method == "dvm") text += ", s = " + std::to_string(solver.stages);
    list.labels.push_back(
        quiet(list, {edge_, y, line, look_.ink, text + ", h = " + number_text(solver.step) + " s"}));
    y += 1.3f * line;
  }
  if (style_.options.errors && style_.diagnostics) {
    const Diagnostics& d = *style_.diagnostics;
    list.labels.push_back(quiet(
        list, {edge_, y, line, look_.ink,
               "so far: constraints " + number_text(largest_until(d, "constraint_max_m", t)) +
                   " m, energy balance " + number_text(largest_until(d, "energy_balance_J", t)) + " J"}));
  }
}

void FrameOverlay::add_status(double t, const VectorXd& whole, DrawList& list) const {
  std::string status = time_text(t, trajectory_.end_time() - trajectory_.start_time());
  const Deployment& deployment = trajectory_.structure().deployment;
  if (!deployment.empty()) status += "    " + deployed_text(deployment.fraction(solved(whole)));
  list.labels.push_back(quiet(list, {edge_, height_ - edge_ - small_, small_, look_.ink, status}));
}

// A square in the colour, framed in ink: a colour as light as the ground has an edge on it.
void FrameOverlay::add_swatch(DrawList& list, float x, float y, const Color& color) const {
  const float side = std::round(0.66f * small_), frame = std::max(1.0f, std::round(0.06f * small_));
  const float top = y + 0.5f * (small_ - side), inside = side - frame;
  list.areas.push_back({x, top, x + side, top + side, look_.ink});
  list.areas.push_back({x + frame, top + frame, x + inside, top + inside, color});
}

// The name in ink, which can be read on any ground, behind a sign in the colour.
void FrameOverlay::add_legend(DrawList& list) const {
  struct Entry {
    bool arrow;
    std::string name;
    Color color;
  };
  std::vector<Entry> legend;
  if (!field_ && looks_.groups.size() > 1)
    for (std::size_t i = 0; i < looks_.groups.size(); ++i)
      legend.push_back({false, looks_.groups[i], look_.group(i)});
  std::set<std::string> lines;
  for (const ShownLine& line : trajectory_.structure().lines)
    if (lines.insert(line.group).second)
      legend.push_back({false, line.group, look_.line_color(line.group, field_ && field_->diverging)});
  if (!list.arrows.empty()) legend.push_back({true, "load", list.arrows.front().color});
  if (!style_.trails.empty()) legend.push_back({false, "trail", look_.group(3)});
  const float bar = field_ ? 4.1f * std::round(0.8f * small_) + 12 * unit_ : 0;  // with its texts
  const float y = height_ - edge_ - small_ - bar, sign_width = 0.95f * small_;
  float right = width_ - edge_;
  for (auto entry = legend.rbegin(); entry != legend.rend(); ++entry) {
    const auto wide = static_cast<float>(plot::text_width(entry->name, static_cast<double>(small_)));
    const TextLabel name = quiet(list, {right, y, small_, look_.ink, entry->name, 1});
    const float left = right - wide - sign_width, room = 0.25f * small_;
    if (name.backing.a > 0)
      list.areas.push_back({left - room, y, right + room, y + small_, name.backing, room});
    list.labels.push_back({left + sign_width, y, small_, look_.ink, entry->name, 0});
    if (entry->arrow)
      list.labels.push_back({left, y, small_, entry->color, "\u2192", 0});
    else
      add_swatch(list, left, y, entry->color);
    right = left - 1.0f * small_;
  }
}

namespace {

// Where the colours end before the values do.
std::string end_mark(const RodField& field, double u) {
  if (u == 0.0 && field.below) return "\u2264 ";
  if (u == 1.0 && field.above) return "\u2265 ";
  return {};
}

}  // namespace

void FrameOverlay::add_color_bar(DrawList& list) const {
  constexpr int steps = 64;
  const float length = 280 * unit_, thick = 12 * unit_, line = std::round(0.8f * small_);
  const float x = width_ - edge_ - length, y = height_ - edge_ - 1.25f * line - thick;
  const double low = field_->low, high = field_->high;
  const auto value = [&](double u) {
    return field_->log ? low * std::pow(high / low, u) : low + u * (high - low);
  };
  for (int k = 0; k < steps; ++k) {
    const float a = x + length * static_cast<float>(k) / steps,
                b = x + length * static_cast<float>(k + 1) / steps;
    list.areas.push_back({a, y, b, y + thick, field_->color(value((k + 0.5) / steps))});
  }
  for (const double u : {0.0, 0.5, 1.0}) {
    const float at = x + length * static_cast<float>(u);
    list.lines.push_back({at, y + thick, at, y + thick + 4 * unit_, 1.5f * unit_, look_.ink});
    list.labels.push_back(quiet(list, {at, y + thick + 5 * unit_, line, look_.ink,
                                       end_mark(*field_, u) + number_text(value(u)), static_cast<float>(u)}));
  }
  const bool longer = about_width(field_->label, line) > length;  // it then ends where the bar ends
  list.labels.push_back(quiet(list, {longer ? x + length : x, y - 1.35f * line, line, look_.ink,
                                     field_->label, longer ? 1.0f : 0.0f}));
}

}  // namespace unfurl
