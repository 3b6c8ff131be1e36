#include "render/scene/frame_builder.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace unfurl {
namespace {

// The rotation that turns gravity downwards; none without gravity.
Mat3 upright_rotation(const Vec3& gravity) {
  if (gravity.isZero()) return Mat3::Identity();
  return Eigen::Quaterniond::FromTwoVectors(-gravity, Vec3::UnitZ()).toRotationMatrix();
}

// The largest of 1, 2, 5, 10, ... (any power of ten) that is not above x > 0.
double round_length(double x) {
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  for (const double step : {5.0, 2.0}) {
    if (step * power <= x) return step * power;
  }
  return power;
}

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

// The width of a text in pixels, roughly; enough to space out a legend.
float about_width(const std::string& text, float height) {
  const auto letters = std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; });  // of UTF-8
  return 0.56f * height * static_cast<float>(letters);
}

}  // namespace

FrameBuilder::FrameBuilder(const Trajectory& trajectory, FrameStyle style)
    : trajectory_(trajectory), style_(std::move(style)), look_(find_look(style_.look)) {
  if (look_ == nullptr) throw std::invalid_argument("FrameBuilder: no look '" + style_.look + "'");
  if (trajectory_.empty()) throw std::invalid_argument("FrameBuilder: the trajectory has no state");
  upright_ = upright_rotation(trajectory_.structure().gravity);
  prepare_still();
}

void FrameBuilder::prepare_still() {
  const Structure& s = trajectory_.structure();
  const auto node_points = [this](const std::function<void(const Vec3&)>& visit) {
    for (std::size_t i = 0; i < trajectory_.size(); ++i) {
      const VectorXd whole = trajectory_.positions(i);
      for (Index k = 0; k < whole.size() / 3; ++k) visit(node(whole, static_cast<int>(k)));
    }
  };
  MotionBounds bounds = motion_bounds(node_points);
  if (bounds.radius <= 0) bounds.radius = 1;  // a single node that rests
  looks_ = appearance_of(s, bounds.radius);
  const double thickest = looks_.joint_radius.empty() ? 0.0 : *std::ranges::max_element(looks_.joint_radius);

  const double around = thickest + (style_.loads && !s.load_copies.empty() ? 0.5 * looks_.arrow_length : 0.0);
  const double aspect = static_cast<double>(style_.width) / style_.height;
  still_.camera = frame_motion(node_points, bounds, around, aspect, Margins{});
  still_.shading = look_->shading;
  still_.background_top = look_->background_top;
  still_.background_bottom = look_->background_bottom;
  still_.transparent = style_.transparent || look_->transparent;
  still_.stars = look_->stars;
  still_.depth_fade = look_->depth_fade;
  still_.hidden_gap = static_cast<float>(3 * thickest);
  still_.ground.shown = look_->ground;
  still_.center = bounds.center.cast<float>();
  still_.radius = static_cast<float>(bounds.radius + looks_.arrow_length + thickest);

  still_.ground.z = static_cast<float>(bounds.low.z() - thickest - 0.01 * bounds.radius);
  still_.ground.center = still_.center;
  still_.ground.cell = static_cast<float>(round_length(bounds.radius / 5));
  still_.ground.fade = static_cast<float>(3.2 * bounds.radius);
  // The key light comes from above the viewer's left shoulder.
  const Vec3 side = Vec3::UnitZ().cross(view_direction(bounds)).normalized();
  still_.light_direction = (0.70 * view_direction(bounds) - 0.42 * side + 1.15 * Vec3::UnitZ()).cast<float>();
}

DrawList FrameBuilder::build(double t) const {
  const double inside = std::clamp(t, trajectory_.start_time(), trajectory_.end_time());
  const VectorXd whole = trajectory_.positions_at(inside);
  DrawList list = still_;
  add_rods(whole, list);
  add_joints(whole, list);
  if (style_.loads) add_loads(whole, list);
  if (style_.labels) add_labels(inside, whole, list);
  return list;
}

void FrameBuilder::add_rods(const VectorXd& whole, DrawList& list) const {
  for (const RodCopy& rod : trajectory_.structure().rod_copies) {
    const auto source = static_cast<std::size_t>(rod.source);
    const double radius = looks_.rod_radius[source];
    const Vec3 a = node(whole, rod.a), b = node(whole, rod.b);
    const double length = (b - a).norm();
    const auto thick = static_cast<float>(radius);
    const auto group = static_cast<std::size_t>(looks_.rod_group[source]);
    list.tubes.push_back({a.cast<float>(), b.cast<float>(), thick, look_->group(group)});
    if (length <= 0) continue;
    const Vec3 fitted = (b - a) * (std::min(6.5 * radius, 0.2 * length) / length);  // from the joint's centre
    list.sleeves.push_back({a.cast<float>(), (a + fitted).cast<float>(), 1.32f * thick, look_->fitting});
    list.sleeves.push_back({b.cast<float>(), (b - fitted).cast<float>(), 1.32f * thick, look_->fitting});
  }
}

void FrameBuilder::add_joints(const VectorXd& whole, DrawList& list) const {
  for (std::size_t i = 0; i < looks_.joint_radius.size(); ++i) {
    if (looks_.joint_radius[i] <= 0) continue;
    const double scale = looks_.fixed[i] ? 1.5 : 1.0;
    const Vec3 at = node(whole, static_cast<int>(i));
    list.balls.push_back({at.cast<float>(), static_cast<float>(scale * looks_.joint_radius[i]),
                          looks_.fixed[i] ? look_->anchor : look_->joint,
                          looks_.fixed[i] ? Finish::paint : Finish::metal});
  }
}

void FrameBuilder::add_loads(const VectorXd& whole, DrawList& list) const {
  for (const LoadCopy& load : trajectory_.structure().load_copies) {
    if (load.force.isZero()) continue;
    const Vec3 tail = node(whole, load.node);
    const Vec3 head = tail + upright_ * load.force * (looks_.arrow_length / looks_.largest_force);
    list.arrows.push_back(
        {tail.cast<float>(), head.cast<float>(), static_cast<float>(looks_.arrow_radius), look_->load});
  }
}

// The solved nodes' coordinates, read off any of their copies.
VectorXd FrameBuilder::solved(const VectorXd& whole) const {
  const Structure& s = trajectory_.structure();
  VectorXd q = VectorXd::Zero(3 * static_cast<Index>(s.nodes.size()));
  for (std::size_t i = s.node_copies.size(); i-- > 0;) {  // backwards: the first copy has the last word
    const NodeCopy& copy = s.node_copies[i];
    q.segment<3>(3 * copy.source) =
        copy.map.inverse() * (whole.segment<3>(3 * static_cast<Index>(i)) - copy.offset);
  }
  return q;
}

void FrameBuilder::add_labels(double t, const VectorXd& whole, DrawList& list) const {
  const auto width = static_cast<float>(style_.width), height = static_cast<float>(style_.height);
  const float unit = std::max(0.55f, std::min(height / 720.0f, width / 1280.0f));
  const float edge = 30 * unit, small = std::round(21 * unit), large = std::round(28 * unit);
  const float low = height - edge - small;
  if (!style_.title.empty())
    list.labels.push_back({edge, 0.8f * edge, large, look_->ink, style_.title, 0, true});
  std::string status = time_text(t, trajectory_.end_time() - trajectory_.start_time());
  const Deployment& deployment = trajectory_.structure().deployment;
  if (!deployment.empty()) status += "    " + deployed_text(deployment.fraction(solved(whole)));
  list.labels.push_back({edge, low, small, look_->ink, status});

  std::vector<std::pair<std::string, Color>> legend;
  if (looks_.groups.size() > 1) {
    for (std::size_t i = 0; i < looks_.groups.size(); ++i) {
      legend.emplace_back("\u25A0 " + looks_.groups[i], look_->group(i));
    }
  }
  if (!list.arrows.empty()) legend.emplace_back("\u2192 load", look_->load);
  float right = width - edge;
  for (auto entry = legend.rbegin(); entry != legend.rend(); ++entry) {
    list.labels.push_back({right, low, small, entry->second, entry->first, 1});
    right -= about_width(entry->first, small) + 1.2f * small;
  }
}

std::vector<double> frame_times(const Trajectory& trajectory, double fps, double speed) {
  const double start = trajectory.start_time(), end = trajectory.end_time(), gap = speed / fps;
  std::vector<double> times;
  // A frame within a thousandth of a gap of the end would be the same picture twice.
  for (long k = 0; start + static_cast<double>(k) * gap < end - 1e-3 * gap; ++k) {
    times.push_back(start + static_cast<double>(k) * gap);
  }
  times.push_back(end);
  return times;
}

}  // namespace unfurl
