// SPDX-License-Identifier: BSD-3-Clause
// The part of the overlay that is a figure: one column of the run's series, drawn as far as the film has
// come.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "core/diagnostics/force_round_off.hpp"
#include "core/text/nearest_name.hpp"
#include "render/plot/limits.hpp"
#include "render/plot/style.hpp"
#include "render/scene/frame_overlay.hpp"

namespace unfurl {

namespace {

// Columns that follow from rod forces.
bool of_rods(std::string_view column) {
  return column.starts_with("axial_force_m") || column.starts_with("axial_stress_m") ||
         column == "stress_ratio_max" || column == "buckling_ratio_max";
}

}  // namespace

constexpr float inset_width = 330, inset_height = 200;  // in units

// Beside the structure, above it in pictures that are higher than wide, or as that one has no room; none
// where neither has.
FrameOverlay::InsetRoom FrameOverlay::inset_room() const {
  if (!inset_) return {};
  const double right = 0.96 * static_cast<double>((inset_width * unit_ + edge_) / width_),
               top = static_cast<double>((inset_height * unit_ + 0.8f * edge_) / height_);
  const bool beside = right <= 0.45, above = top <= 0.4 && inset_width * unit_ + 2 * edge_ <= width_;
  if (above && (!beside || height_ > width_)) return {0, top};
  return beside ? InsetRoom{right, 0} : InsetRoom{};
}

void FrameOverlay::prepare_inset() {
  const std::string& column = style_.options.inset;
  if (column.empty() || !style_.diagnostics) return;
  const Series* series = style_.diagnostics->find(column);
  if (series == nullptr) throw std::invalid_argument("FrameBuilder: no column '" + column + "'");
  inset_ = std::make_shared<Figure>();
  Panel panel;
  panel.x.label = "time (s)";
  panel.y.label = series->label + (series->unit.empty() ? "" : " (" + series->unit + ")");
  Curve curve;
  curve.x = style_.diagnostics->t;
  curve.y = series->values;
  curve.width = 1.6f;
  if (of_rods(column) && style_.run && only_round_off(*style_.run, *style_.diagnostics))
    for (double& value : curve.y) value = std::isnan(value) ? value : 0.0;
  panel.curves.push_back(std::move(curve));
  const plot::Limits x = plot::axis_limits(panel, plot::AxisOf::x),
                     y = plot::axis_limits(panel, plot::AxisOf::y);
  panel.x.min = x.lo, panel.x.max = x.hi, panel.y.min = y.lo, panel.y.max = y.hi;
  inset_->panels.push_back(std::move(panel));
  if (const InsetRoom room = inset_room(); room.right + room.top <= 0) inset_.reset();
}

void FrameOverlay::add_inset(double t, DrawList& list) const {
  if (!inset_) return;
  const float wide = std::round(inset_width * unit_), high = std::round(inset_height * unit_);
  const double pixels_per_point = 1.75 * static_cast<double>(unit_);
  auto figure = std::make_shared<Figure>(*inset_);
  figure->width_mm = static_cast<double>(wide) / pixels_per_point / plot::points_per_mm;
  figure->height_mm = static_cast<double>(high) / pixels_per_point / plot::points_per_mm;
  Curve& curve = figure->panels[0].curves[0];
  auto shown =
      static_cast<std::size_t>(std::upper_bound(curve.x.begin(), curve.x.end(), t) - curve.x.begin());
  if (shown > 0 && shown < curve.x.size() &&
      curve.x[shown - 1] < t) {  // between two states, on a straight line
    const double from = curve.x[shown - 1], u = (t - from) / (curve.x[shown] - from),
                 y = (1 - u) * curve.y[shown - 1] + u * curve.y[shown];
    if (std::isfinite(y)) curve.x[shown] = t, curve.y[shown] = y, ++shown;
  }
  curve.x.resize(shown), curve.y.resize(shown);
  if (shown > 0) {  // a dot where the film is
    Curve here;
    here.x = {curve.x.back()}, here.y = {curve.y.back()};
    here.color = 1;
    here.marker = Marker::circle;
    figure->panels[0].curves.push_back(std::move(here));
  }
  list.inset = {std::move(figure), width_ - edge_ - wide, 0.8f * edge_, wide, high, pixels_per_point};
}

}  // namespace unfurl
