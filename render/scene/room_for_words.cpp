// SPDX-License-Identifier: BSD-3-Clause
// The place that a picture has beside what is written in its corners.
#include <algorithm>

#include "render/scene/frame_overlay.hpp"
#include "render/scene/view.hpp"

namespace unfurl {

FrameOverlay::Words FrameOverlay::words(bool loads) const {
  Parts parts = wanted();
  parts.erase(Part::scale_bar), parts.erase(Part::axes);  // where these stand the camera says
  DrawList list;
  list.arrows.resize(loads ? 1 : 0);  // for the legend
  Words out;
  const auto take = [](CornerRoom& corner, float wide, float high) {
    corner = {std::max(corner.wide, static_cast<double>(wide)),
              std::max(corner.high, static_cast<double>(high))};
  };
  for (const Piece& p : write(trajectory_.start_time(), trajectory_.positions(0), parts, list)) {
    if (p.part == Part::legend || p.part == Part::color_bar)
      take(out.legend, (width_ - p.box.x0) / width_, (height_ - p.box.y0) / height_);
    else if (p.part == Part::status)
      out.status = std::max(out.status, static_cast<double>((height_ - p.box.y0) / height_));
    else if (p.part != Part::inset)
      take(out.heading, p.box.x1 / width_, p.box.y1 / height_);
  }
  return out;
}

namespace {

// Is one of the points, with its room, in that corner of a camera's picture?
bool reaches_into(const PointSource& points, const Camera& camera, const Framing& framing, bool top_left,
                  const CornerRoom& corner) {
  const Eigen::Matrix4f to_clip = view_projection(camera, static_cast<float>(framing.aspect));
  const Vec3f forward = (camera.target - camera.eye).normalized(),
              right = forward.cross(camera.up).normalized(), up = right.cross(forward);
  const Vec3f out = static_cast<float>(framing.around) * (top_left ? Vec3f(up - right) : Vec3f(right - up));
  bool found = false;
  points([&](const Vec3& point) {
    if (found) return;
    const Vec3f p = point.cast<float>() + out;
    const Eigen::Vector4f clip = to_clip * Eigen::Vector4f(p.x(), p.y(), p.z(), 1);
    if (!(clip.w() > 0)) return;
    const double x = 0.5 + 0.5 * static_cast<double>(clip.x() / clip.w()),
                 y = 0.5 - 0.5 * static_cast<double>(clip.y() / clip.w());  // down
    found = top_left ? x < corner.wide && y < corner.high : x > 1 - corner.wide && y > 1 - corner.high;
  });
  return found;
}

}  // namespace

// Headings may stand beside what is in the middle, but not beside dimension lines, nor in pictures that bring
// everything everywhere. So may legends.
void FrameBuilder::make_room(const PointSource& points, const ViewAngles& view, bool dimensions,
                             Framing& framing) const {
  Margins& margins = framing.margins;
  const FrameOverlay::InsetRoom inset = overlay_->inset_room();
  if (inset.right > 0) margins.right = std::max(inset.right, 0.27);  // the least: of large pictures
  margins.top = std::max(margins.top, inset.top);
  const bool loads = style_.loads && style_.options.loads && !trajectory_.structure().load_copies.empty();
  const FrameOverlay::Words words = overlay_->words(loads);
  margins.bottom = std::clamp(std::max(overlay_->footing_top(), words.status), margins.bottom, 0.5);
  const auto in_the_way = [&](bool top_left, const CornerRoom& corner) {
    const Camera camera = frame_points(points, bounds_.center, bounds_, view, framing);
    return style_.labels && reaches_into(points, camera, framing, top_left, corner);
  };
  const CornerRoom &heading = words.heading, &legend = words.legend;
  constexpr double beside = 0.16, most = 0.4;
  if (heading.high > margins.top)
    if (dimensions || style_.options.follow || heading.high > beside || in_the_way(true, heading))
      margins.top = std::max(margins.top, std::min(heading.high, most));
  // A camera that turns about the middle would lose as much below it.
  const bool turns = moves_camera(style_.options);
  if (!turns && style_.covered.high > margins.top && in_the_way(true, style_.covered))
    margins.top = std::min(style_.covered.high, most);
  if (legend.high > margins.bottom && in_the_way(false, legend)) margins.bottom = std::min(legend.high, most);
}

}  // namespace unfurl
