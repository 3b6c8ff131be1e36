// SPDX-License-Identifier: BSD-3-Clause
// The part of the overlay that measures and names: scale bar, axes, dimensions, names of nodes and rods.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/text/wrapped.hpp"
#include "render/plot/text_metrics.hpp"
#include "render/plot/ticks.hpp"
#include "render/scene/frame_overlay.hpp"
#include "render/scene/view.hpp"

namespace unfurl {
double round_length(double x) {
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  for (const double step : {5.0, 2.0})
    if (step * power <= x) return step * power;
  return power;
}

namespace {

// To three digits, or to a tenth of a metre; of what is very large or small a power of ten.
std::string length_text(double metres) {
  if (metres < 1e-3 || metres >= 1e5) return plot::format_number(metres, 3) + " m";
  char text[32];
  std::snprintf(text, sizeof text, metres < 10 ? "%#.3g m" : "%.1f m", metres);
  return text;
}

// The axes of the picture in the world.
struct Screen {
  Vec3f forward, right, up;
  explicit Screen(const Camera& c)
      : forward((c.target - c.eye).normalized()),
        right(forward.cross(c.up).normalized()),
        up(right.cross(forward)) {}
};

Color clear_backing(const Look& look) {
  Color c = look.background_bottom;
  c.a = 0.75f;
  return c;
}

}  // namespace

// A scale bar stands beside the time, or above it where there is no room.
double FrameOverlay::footing_top() const {
  const RenderOptions& options = style_.options;
  float up = options.time ? edge_ + small_ : 0;
  if (options.scale_bar) {
    const auto wide = [&](const std::string& text) {
      return static_cast<float>(plot::text_width(text, static_cast<double>(small_) / plot::line_height));
    };
    const std::string time =
        trajectory_.structure().deployment.empty() ? "t = 10.00 s" : "t = 10.00 s    deployed 99.9 %";
    const float bar = std::max(0.16f * width_, wide("0.5 m in the middle"));
    const bool beside = !options.time || edge_ + wide(time) < 0.5f * (width_ - bar);
    up = std::max(up, edge_ + 1.35f * small_ + (beside ? 0 : small_ + 12 * unit_));
  }
  return static_cast<double>(up / height_);
}

// As long as it is in the middle of what the camera shows; in perspective what is nearer is larger, which it
// says.
void FrameOverlay::add_scale_bar(Boxes& taken, DrawList& list) const {
  const Screen screen(list.camera);
  const Vec3f &middle = list.camera.target, beside = middle + list.framed_radius * screen.right;
  const Vec3f a = project(list.camera, style_.width, style_.height, middle);
  const Vec3f b = project(list.camera, style_.width, style_.height, beside);
  const double pixels = std::abs(b.x() - a.x()) / list.framed_radius;  // of a metre
  if (!(pixels > 0 && std::isfinite(pixels))) return;
  const double metres = round_length(0.16 * static_cast<double>(width_) / pixels);
  const auto length = static_cast<float>(pixels * metres);
  const std::string text =
      plot::format_number(metres, 1) + (list.camera.parallel_height > 0 ? " m" : " m in the middle");
  const float x = 0.5f * (width_ - length), tick = 5 * unit_, thick = 2 * unit_;
  const auto words =
      static_cast<float>(plot::text_width(text, static_cast<double>(small_) / plot::line_height));
  const float half = 0.5f * std::max(length, words);
  Box box{0.5f * width_ - half, height_ - edge_ - 1.35f * small_, 0.5f * width_ + half,
          height_ - edge_ + tick};
  const float up = lifted(box, taken), y = height_ - edge_ - up;
  box.y0 -= up, box.y1 -= up;
  taken.push_back(box);
  list.lines.push_back({x, y, x + length, y, thick, look_.ink});
  for (const float end : {x, x + length})
    list.lines.push_back({end, y - tick, end, y + tick, thick, look_.ink});
  list.labels.push_back(quiet(list, {x + 0.5f * length, y - 1.35f * small_, small_, look_.ink, text, 0.5f}));
}

void FrameOverlay::add_axes(Boxes& taken, DrawList& list) const {
  const Screen screen(list.camera);
  const float length = 42 * unit_, line = fine_ * std::round(0.8f * small_ / fine_);
  const float x = edge_ + 1.2f * length, y = height_ - edge_ - 2.2f * small_ - 1.2f * length;
  const float reach = 1.28f * length + 0.5f * line;
  taken.push_back({x - reach, y - reach, x + reach, y + reach});
  const Color colors[] = {{0.80f, 0.30f, 0.00f, 1}, {0.00f, 0.58f, 0.42f, 1}, {0.15f, 0.50f, 0.85f, 1}};
  const char* names[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k) {
    const Vec3f axis = upright_.col(k).cast<float>();
    const float dx = length * axis.dot(screen.right), dy = -length * axis.dot(screen.up);
    list.lines.push_back({x, y, x + dx, y + dy, 2.5f * unit_, colors[k]});
    list.labels.push_back(
        quiet(list, {x + 1.28f * dx, y + 1.28f * dy - 0.5f * line, line, look_.ink, names[k], 0.5f}));
  }
}

namespace {

// Whether a straight line passes through a box.
bool passes(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Eigen::Vector2f& low,
            const Eigen::Vector2f& high) {
  float enters = 0, leaves = 1;
  for (int k = 0; k < 2; ++k) {
    const float way = b[k] - a[k];
    if (std::abs(way) < 1e-6f) {
      if (a[k] < low[k] || a[k] > high[k]) return false;
      continue;
    }
    const float first = (low[k] - a[k]) / way, second = (high[k] - a[k]) / way;
    enters = std::max(enters, std::min(first, second));
    leaves = std::min(leaves, std::max(first, second));
  }
  return enters <= leaves;
}

}  // namespace

// Where on a dimension line from p to q its number stands, as a fraction: in the middle, or as near to it as
// rods and arrows leave a box of half this size free.
float FrameOverlay::number_place(const Eigen::Vector2f& p, const Eigen::Vector2f& q,
                                 const Eigen::Vector2f& half, const DrawList& list) const {
  const auto place = [&](const Vec3f& x) {
    return Eigen::Vector2f(project(list.camera, style_.width, style_.height, x).head<2>());
  };
  std::vector<std::pair<Eigen::Vector2f, Eigen::Vector2f>> drawn;
  for (const Tube& tube : list.tubes) drawn.emplace_back(place(tube.a), place(tube.b));
  for (const Arrow& arrow : list.arrows) drawn.emplace_back(place(arrow.tail), place(arrow.head));
  const Eigen::Vector2f room = half + Eigen::Vector2f::Constant(5 * unit_);
  for (const float off : {0.0f, -0.08f, 0.08f, -0.16f, 0.16f, -0.24f, 0.24f, -0.32f, 0.32f}) {
    const Eigen::Vector2f at = p + (0.5f + off) * (q - p);
    if (std::ranges::none_of(
            drawn, [&](const auto& line) { return passes(line.first, line.second, at - room, at + room); }))
      return 0.5f + off;
  }
  return 0.5f;
}

// A line beside a and b, moved by `away`, with a slash at its ends and its length where there is room.
void FrameOverlay::add_dimension(const Vec3& a, const Vec3& b, const Vec3& away, DrawList& list) const {
  const double metres = (b - a).norm();
  const auto place = [&](const Vec3& p) {
    return project(list.camera, style_.width, style_.height, p.cast<float>());
  };
  const Vec3f p = place(a + away), q = place(b + away);
  const float length = (q - p).head<2>().norm(), line = std::round(0.8f * small_);
  if (p.z() <= 0 || q.z() <= 0 || length < 3 * line) return;
  const float thick = 1.2f * unit_, tick = 5 * unit_;
  const std::string text = length_text(metres);
  // The line leaves its number free.
  const Eigen::Vector2f along = (q - p).head<2>() / length;
  const float wide = 0.32f * line * static_cast<float>(characters_in(text)) + 0.25f * line,
              tall = 0.75f * line;
  const float part = number_place(p.head<2>(), q.head<2>(), {wide, 0.5f * line}, list);
  const Eigen::Vector2f middle = p.head<2>() + part * (q - p).head<2>();
  const float free =
      std::min(wide / std::max(std::abs(along.x()), 1e-3f), tall / std::max(std::abs(along.y()), 1e-3f));
  for (const auto& [end, sign] : {std::pair(p, -1.0f), std::pair(q, 1.0f)}) {
    if (free >= (sign < 0 ? part : 1 - part) * length) continue;
    const Eigen::Vector2f from = middle + sign * free * along;
    list.lines.push_back({from.x(), from.y(), end.x(), end.y(), thick, look_.ink});
  }
  for (const auto& [end, at] : {std::pair(p, a), std::pair(q, b)}) {
    list.lines.push_back(
        {end.x() - tick, end.y() + tick, end.x() + tick, end.y() - tick, 1.4f * thick, look_.ink});
    const Vec3f from = place(at + 0.25 * away), to = place(at + 1.15 * away);
    Color pale = look_.ink;
    pale.a = 0.45f;
    list.lines.push_back({from.x(), from.y(), to.x(), to.y(), 0.8f * thick, pale});
  }
  list.labels.push_back(
      {middle.x(), middle.y() - 0.5f * line, line, look_.ink, text, 0.5f, false, clear_backing(look_)});
}

// Of the box around what there is, in the axes of the picture: the two lower edges towards the viewer, and
// the leftmost upright one.
void FrameOverlay::add_dimensions(const VectorXd& whole, DrawList& list) const {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  for (Index k = 0; k < whole.size() / 3; ++k) {
    const Vec3 p = upright_ * whole.segment<3>(3 * k);
    low = low.cwiseMin(p), high = high.cwiseMax(p);
  }
  const Vec3 back = (list.camera.eye - list.camera.target).cast<double>().normalized();
  const double gap = dimension_gap * static_cast<double>(list.framed_radius);
  const Vec3 near(back.x() > 0 ? high.x() : low.x(), back.y() > 0 ? high.y() : low.y(), low.z());
  // Outward along the floor, or down where that is straight towards the viewer.
  const auto outward = [&](const Vec3& away) {
    const bool seen = (away - back * back.dot(away)).norm() > 0.5 * gap;
    return seen ? away : Vec3(0, 0, -gap);
  };
  const Vec3 outward_x = outward({back.x() > 0 ? gap : -gap, 0, 0}),
             outward_y = outward({0, back.y() > 0 ? gap : -gap, 0});
  const double flat = 0.02 * static_cast<double>(list.framed_radius);
  if (high.x() - low.x() > flat)
    add_dimension({low.x(), near.y(), low.z()}, {high.x(), near.y(), low.z()}, outward_y, list);
  if (high.y() - low.y() > flat)
    add_dimension({near.x(), low.y(), low.z()}, {near.x(), high.y(), low.z()}, outward_x, list);
  if (high.z() - low.z() <= flat) return;
  const Vec3 right = Screen(list.camera).right.cast<double>();
  const Vec3 left(right.x() > 0 ? low.x() : high.x(), right.y() > 0 ? low.y() : high.y(), low.z());
  add_dimension(left, {left.x(), left.y(), high.z()}, -gap * right, list);
}

void FrameOverlay::add_names(const VectorXd& whole, const std::vector<Piece>& written, DrawList& list) const {
  const Structure& s = trajectory_.structure();
  const auto node = [&](int i) { return Vec3(upright_ * whole.segment<3>(3 * i)); };
  std::vector<std::pair<const std::string*, Vec3>> names;
  if (style_.options.node_labels)
    for (std::size_t i = 0; i < s.node_copies.size(); ++i)
      names.emplace_back(&s.node_copies[i].name, node(static_cast<int>(i)));
  if (style_.options.rod_labels)
    for (std::size_t i = 0; i < s.rod_copies.size(); ++i) {
      const RodCopy& copy = s.rod_copies[i];
      const Rod& rod = s.rods[static_cast<std::size_t>(copy.source)];
      if (rod.whole.empty()) {
        names.emplace_back(&copy.name, 0.5 * (node(copy.a) + node(copy.b)));
        continue;
      }
      // One that was cut has its name once, in the middle; its parts stand in a row.
      std::size_t first = i;
      while (first > 0 && s.rods[static_cast<std::size_t>(s.rod_copies[first - 1].source)].whole == rod.whole)
        --first;
      if (i - first != static_cast<std::size_t>(rod.parts / 2)) continue;
      names.emplace_back(&rod.whole,
                         rod.parts % 2 == 0 ? node(copy.a) : Vec3(0.5 * (node(copy.a) + node(copy.b))));
    }
  // What is nearer chooses its place first.
  const Vec3 back = (list.camera.eye - list.camera.target).cast<double>();
  std::stable_sort(names.begin(), names.end(),
                   [&](const auto& a, const auto& b) { return back.dot(a.second) > back.dot(b.second); });
  // Of the line of the time, which changes its width, all.
  std::vector<Box> taken{{0, height_ - edge_ - 1.5f * small_, width_, height_}};
  const float gap = 4 * unit_;
  for (const Piece& piece : written) {
    const Box& b = piece.box;
    taken.push_back({b.x0 - gap, b.y0 - gap, b.x1 + gap, b.y1 + gap});
  }
  for (const auto& [name, at] : names) add_name(*name, at, taken, list);
}

// At the first of eight places around the point that is free; left out where none is.
void FrameOverlay::add_name(const std::string& name, const Vec3& at, std::vector<Box>& taken,
                            DrawList& list) const {
  const Vec3f p = project(list.camera, style_.width, style_.height, at.cast<float>());
  const float line = std::round(0.72f * small_),
              wide = 0.66f * line * static_cast<float>(characters_in(name));
  if (p.z() <= 0) return;
  for (const float reach : {14 * unit_, 26 * unit_}) {
    for (int k = 0; k < 8; ++k) {
      const float angle = 0.7854f * static_cast<float>(k + 1);
      const float dx = std::cos(angle), dy = -std::sin(angle);
      const float x = p.x() + reach * dx + 0.5f * wide * dx, y = p.y() + reach * dy;
      const Box box{x - 0.5f * wide, y - 0.5f * line, x + 0.5f * wide, y + 0.5f * line};
      const bool inside = box.x0 > 0 && box.y0 > 0 && box.x1 < width_ && box.y1 < height_;
      if (!inside || std::ranges::any_of(taken, [&](const Box& b) { return b.overlaps(box); })) continue;
      taken.push_back(box);
      Color pale = look_.ink;
      pale.a = 0.5f;
      list.lines.push_back(
          {p.x(), p.y(), p.x() + 0.85f * reach * dx, p.y() + 0.85f * reach * dy, unit_, pale});
      list.labels.push_back({x, box.y0, line, look_.ink, name, 0.5f, false, clear_backing(look_)});
      return;
    }
  }
}

}  // namespace unfurl
