// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/frame_builder.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/export/upright.hpp"
#include "core/math/drawing_origin.hpp"
#include "render/plot/text_metrics.hpp"
#include "render/scene/frame_overlay.hpp"

namespace unfurl {
namespace {

constexpr std::size_t trail_points = 20000;  // of a trail at most
constexpr double trail_error = 1e-3;         // of the structure's size: less than a pixel

// Where dimension lines may end: beside the corners of the box around a pose.
void add_dimension_ends(std::vector<Vec3>& pose, double gap) {
  if (pose.empty()) return;
  Vec3 low = pose.front(), high = low;
  for (const Vec3& p : pose) low = low.cwiseMin(p), high = high.cwiseMax(p);
  for (const double z : {low.z(), high.z()})
    for (const double x : {low.x(), high.x()})
      for (const double y : {low.y(), high.y()}) {
        pose.emplace_back(x + (x == low.x() ? -gap : gap), y, z);
        pose.emplace_back(x, y + (y == low.y() ? -gap : gap), z);
      }
  pose.emplace_back(0.5 * (low.x() + high.x()), 0.5 * (low.y() + high.y()), low.z() - gap);
}

MotionBounds bounds_of(const std::vector<std::vector<Vec3>>& poses) {
  return motion_bounds([&](const std::function<void(const Vec3&)>& visit) {
    for (const auto& pose : poses)
      for (const Vec3& p : pose) visit(p);
  });
}

std::vector<Vec3> edge_of(const ShownSurface& shown, const std::vector<Vec3>& pose) {
  std::vector<Vec3> edge;
  for (const int n : shown.nodes) edge.push_back(pose[static_cast<std::size_t>(n)]);
  return edge;
}

// What reaches beyond the nodes: the bottom of a dish, the foot of a support.
void add_shown(std::vector<Vec3>& pose, const std::vector<ShownSurface>& surfaces, double support_depth,
               const Appearance& looks) {
  for (const ShownSurface& shown : surfaces) {
    const std::vector<Vec3> edge = edge_of(shown, pose);
    pose.push_back(skin_of(shown.surface, edge, shown.plan).vertices.front().at.cast<double>());
  }
  for (std::size_t n = 0; support_depth > 0 && n < looks.fixed.size(); ++n)
    if (looks.fixed[n] && looks.joint_radius[n] > 0) pose.push_back(pose[n] - support_depth * Vec3::UnitZ());
}

}  // namespace

FrameBuilder::FrameBuilder(const Trajectory& trajectory, FrameStyle style)
    : trajectory_(trajectory), style_(std::move(style)), look_(find_look(style_.options.look)) {
  if (look_ == nullptr) throw std::invalid_argument("FrameBuilder: no look '" + style_.options.look + "'");
  if (trajectory_.empty()) throw std::invalid_argument("FrameBuilder: the trajectory has no state");
  upright_ = upright_rotation(trajectory_.structure().gravity);
  const RenderOptions& options = style_.options;
  if (options.colour_by != "group" && style_.run && style_.diagnostics)
    field_ = std::make_unique<RodField>(
        rod_field(options.colour_by, options.colour_range, *style_.run, *style_.diagnostics));
  PosedMoments moments = posed_moments(trajectory_);
  choose_origin(moments.poses);
  prepare_ghosts(moments);
  prepare_trails(moments);
  prepare_still(prepare_camera(std::move(moments)));
  thin_trails();
}
FrameBuilder::~FrameBuilder() = default;
FrameBuilder::FrameBuilder(FrameBuilder&&) noexcept = default;

VectorXd FrameBuilder::placed(VectorXd whole) const {
  if (!style_.origin.isZero())
    for (Index k = 0; k < whole.size() / 3; ++k) whole.segment<3>(3 * k) -= style_.origin;
  return whole;
}

// All that is drawn is in single precision.
void FrameBuilder::choose_origin(const std::vector<VectorXd>& poses) {
  const MotionBounds bounds = motion_bounds([&](const std::function<void(const Vec3&)>& visit) {
    for (const VectorXd& whole : poses)
      for (Index k = 0; k < whole.size() / 3; ++k) visit(node(whole, static_cast<int>(k)));
  });
  style_.origin =
      upright_.transpose() * drawing_origin(bounds.center, bounds.radius, upright_ * style_.origin);
}

void FrameBuilder::bound(const std::vector<std::vector<Vec3>>& poses, const std::vector<double>& times) {
  bounds_ = bounds_of(poses);
  if (bounds_.radius <= 0) bounds_.radius = 1;  // a single node that rests
  shown_radius_ = bounds_.radius;
  if (!style_.options.follow) return;
  const double followed = followed_radius(poses, times);
  if (followed > 0) shown_radius_ = std::min(followed, bounds_.radius);
}

double FrameBuilder::prepare_camera(PosedMoments moments) {
  const Structure& s = trajectory_.structure();
  std::vector<std::vector<Vec3>> poses;
  std::vector<double>& times = moments.times;
  for (VectorXd& pose : moments.poses) {
    const VectorXd whole = placed(std::move(pose));
    poses.emplace_back();
    for (Index k = 0; k < whole.size() / 3; ++k) poses.back().push_back(node(whole, static_cast<int>(k)));
  }
  for (ShownSurface& shown : style_.surfaces)
    shown.plan = plan_of(shown.surface, edge_of(shown, poses.front()), edge_of(shown, poses.back()));
  bound(poses, times);
  looks_ = appearance_of(s, shown_radius_, style_.options.rod_scale);
  const double thickest = looks_.joint_radius.empty() ? 0.0 : *std::ranges::max_element(looks_.joint_radius);
  overlay_ = std::make_unique<FrameOverlay>(trajectory_, style_, *look_, looks_, field_.get(), upright_);
  prepare_hardware(poses, times);
  for (auto& pose : poses) add_shown(pose, style_.surfaces, hardware_->support_depth(), looks_);
  bound(poses, times);
  Framing framing;
  framing.around = thickest + (style_.loads && !s.load_copies.empty() ? 0.5 * looks_.arrow_length : 0.0);
  const bool dimensions = look_->dimensions || style_.options.dimensions;
  if (dimensions)
    for (auto& pose : poses)
      add_dimension_ends(pose, 1.15 * dimension_gap * drawn_radius(shown_radius_, thickest));
  framing.parallel = style_.options.projection == "orthographic";
  framing.aspect = static_cast<double>(style_.width) / style_.height;
  const auto all = [&](const std::function<void(const Vec3&)>& visit) {
    for (const auto& pose : poses)
      for (const Vec3& p : pose) visit(p);
  };
  const ViewAngles view = first_angles(style_.options, bounds_);
  make_room(all, view, dimensions, framing);
  fitting_aspect_ = std::clamp(unfurl::fitting_aspect(all, view, framing), 0.4, 2.5);
  path_ = std::make_unique<CameraPath>(std::move(poses), std::move(times), bounds_, framing, style_.options);
  return thickest;
}

// Joints are read off a few poses. What would be smaller than a pixel is left out.
void FrameBuilder::prepare_hardware(const std::vector<std::vector<Vec3>>& poses,
                                    const std::vector<double>& times) {
  constexpr std::size_t most = 33;
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < std::min(most, poses.size()); ++k)
    chosen.push_back(poses.size() <= most ? k : k * (poses.size() - 1) / (most - 1));
  std::vector<std::vector<Vec3>> samples;
  std::vector<double> sample_times;
  for (const std::size_t k : chosen) {
    if (!sample_times.empty() && times[k] <= sample_times.back()) continue;  // an impulse: two at one time
    samples.push_back(poses[k]);
    sample_times.push_back(times[k]);
  }
  const Structure& s = trajectory_.structure();
  std::vector<double> radius;
  double thickest = 0;
  for (const RodCopy& rod : s.rod_copies) {
    radius.push_back(looks_.rod_radius[static_cast<std::size_t>(rod.source)]);
    thickest = std::max(thickest, radius.back());
  }
  if (s.rod_copies.empty()) thickest = looks_.bare_radius;
  const double pixels = thickest / shown_radius_ * 0.45 * std::min(style_.width, style_.height);
  const bool lit = look_->shading == Shading::studio || look_->shading == Shading::space;
  auto joints = std::make_unique<const Joints>(s, std::move(sample_times), samples, radius, bounds_.center,
                                               bounds_.plane_normal);
  hardware_ = std::make_unique<Hardware>(s, looks_, *look_, style_.options, std::move(joints), samples,
                                         upright_, lit && pixels > 0.8);
}

double FrameBuilder::drawn_radius(double of_nodes, double thickest) const {
  return of_nodes + looks_.arrow_length + thickest;
}

void FrameBuilder::prepare_still(double thickest) {
  still_.camera = path_->at({trajectory_.start_time(), 0, 0});
  still_.shading = look_->shading;
  still_.background_top = look_->background_top;
  still_.background_bottom = look_->background_bottom;
  still_.transparent = style_.options.transparent || look_->transparent;
  still_.stars = look_->stars;
  still_.depth_fade = look_->depth_fade;
  still_.hidden_gap = static_cast<float>(3 * thickest);
  still_.center = bounds_.center.cast<float>();
  still_.radius = static_cast<float>(drawn_radius(bounds_.radius, thickest));
  still_.framed_center = still_.center;
  still_.framed_radius = static_cast<float>(drawn_radius(shown_radius_, thickest));

  still_.ground.shown = look_->ground;
  still_.ground.z = static_cast<float>(bounds_.low.z() - thickest - 0.01 * bounds_.radius);
  still_.ground.center = still_.center;
  still_.ground.cell = static_cast<float>(round_length(bounds_.radius / 5));
  still_.ground.fade = static_cast<float>(3.2 * bounds_.radius);
  still_.ground.lines = look_->grid;
  still_.ground.shadow = look_->shadow;
  if (look_->earth && !still_.transparent) {  // its limb a fifth of the picture below the middle
    still_.planet_half_angle = static_cast<float>(62 * radians_per_degree);
    const double limb = -path_->first_view().elevation - 0.24 * 28 * radians_per_degree;
    const double down = limb - 62 * radians_per_degree, azimuth = path_->first_view().azimuth + pi + 0.16;
    still_.planet =
        Vec3(std::cos(azimuth) * std::cos(down), std::sin(azimuth) * std::cos(down), std::sin(down))
            .cast<float>();
  }
  // The key light comes from above the viewer's left shoulder.
  ViewAngles view = path_->first_view();
  view.elevation = std::min(view.elevation, 0.9);
  still_.light_direction =
      (0.70 * view.direction() - 0.42 * view.right() + 1.15 * Vec3::UnitZ()).cast<float>();
}

void FrameBuilder::prepare_ghosts(const PosedMoments& moments) {
  if (style_.options.ghosts <= 0) return;
  for (const std::size_t i : equal_steps(moments.poses, static_cast<std::size_t>(style_.options.ghosts)))
    ghosts_.push_back({moments.times[i], placed(moments.poses[i])});
}

namespace {

// Those of the points of a way between which it is straight but for so much.
std::vector<std::size_t> corners_of(const std::vector<Vec3>& way, double off) {
  constexpr std::size_t most = 64;  // points that one line leaves out
  const auto straight = [&](std::size_t a, std::size_t b) {
    const Vec3 line = way[b] - way[a];
    for (std::size_t i = a + 1; i < b; ++i) {
      const Vec3 from = way[i] - way[a];
      const double share = std::clamp(from.dot(line) / std::max(line.squaredNorm(), 1e-300), 0.0, 1.0);
      if ((from - share * line).norm() > off) return false;
    }
    return true;
  };
  std::vector<std::size_t> corners{0};
  for (std::size_t i = 2; i < way.size(); ++i)
    if (i - corners.back() > most || !straight(corners.back(), i)) corners.push_back(i - 1);
  if (way.size() > 1) corners.push_back(way.size() - 1);
  return corners;
}

}  // namespace

void FrameBuilder::prepare_trails(const PosedMoments& moments) {
  if (style_.trails.empty()) return;
  for (const int k : style_.trails) trails_.push_back({k, {}, {}});
  for (const std::size_t i : equal_steps(moments.poses, trail_points)) {
    const VectorXd whole = placed(moments.poses[i]);
    for (Trail& trail : trails_) {
      trail.t.push_back(moments.times[i]);
      trail.points.push_back(node(whole, trail.node));
    }
  }
}

void FrameBuilder::thin_trails() {
  for (Trail& trail : trails_) {
    const std::vector<std::size_t> corners = corners_of(trail.points, trail_error * shown_radius_);
    for (std::size_t k = 0; k < corners.size(); ++k)
      trail.t[k] = trail.t[corners[k]], trail.points[k] = trail.points[corners[k]];
    trail.t.resize(corners.size());
    trail.points.resize(corners.size());
  }
}

// A camera that follows is aimed at a window of the motion: bring its focus to where what it follows is.
void FrameBuilder::aim(const std::vector<Vec3>& at, DrawList& list) const {
  Vec3 low = at.front(), high = low;
  for (const Vec3& p : at) low = low.cwiseMin(p), high = high.cwiseMax(p);
  Camera& camera = list.camera;
  const Vec3f forward = (camera.target - camera.eye).normalized();
  const float depth = forward.dot((0.5 * (low + high)).cast<float>() - camera.eye);
  if (depth > camera.near_plane) camera.target = camera.eye + depth * forward;
  list.framed_center = camera.target;
}

bool FrameBuilder::writes_by_camera() const {
  const RenderOptions& o = style_.options;
  return style_.labels &&
         (look_->dimensions || o.dimensions || o.scale_bar || o.axes || o.node_labels || o.rod_labels);
}

DrawList FrameBuilder::build(double t, const Led& led) const {
  const double span = trajectory_.end_time() - trajectory_.start_time();
  const double progress = span > 0 ? std::clamp((t - trajectory_.start_time()) / span, 0.0, 1.0) : 0.0;
  return build(Shot{t, progress, 0}, led);
}

DrawList FrameBuilder::build(const Shot& shot, const Led& led) const {
  const double inside = std::clamp(shot.t, trajectory_.start_time(), trajectory_.end_time());
  const VectorXd whole = placed(trajectory_.positions_at(inside));
  DrawList list = still_;
  list.camera = path_->at({inside, shot.progress, shot.turn});
  if (shot.card) {
    add_card(list);
    return list;
  }
  std::vector<Vec3> at;
  for (Index k = 0; k < whole.size() / 3; ++k) at.push_back(node(whole, static_cast<int>(k)));
  if (style_.options.follow && !at.empty()) aim(at, list);
  if (led) list.camera = led(list);
  add_bodies(inside, at, list);
  add_lines(inside, whole, list);
  if (style_.loads && style_.options.loads) add_loads(whole, list);
  add_ghosts(inside, list);
  add_trails(inside, whole, list);
  if (style_.labels) overlay_->add(inside, whole, list);
  return list;
}

DrawList FrameBuilder::key_ground(double t) const {
  DrawList list = still_;
  list.arrows = build(t).arrows;
  return list;
}

DrawList FrameBuilder::key(double t) const {
  DrawList list = key_ground(t);
  overlay_->add_key(t, list);
  list.arrows.clear();
  return list;
}

FrameBuilder::Banner FrameBuilder::banner(double t, bool title, bool thickness, bool legend,
                                          int width) const {
  Banner out{0, key_ground(t)};
  out.list.background_bottom = out.list.background_top;  // that of the pictures goes on below
  out.list.ground.shown = false;
  out.list.planet_half_angle = 0;
  out.height = overlay_->add_banner(t, title, thickness, legend, width, out.list);
  out.list.arrows.clear();
  return out;
}

// The title in the middle of an empty picture. Where one line of it has no room it is broken, as headings
// are; what is longer than the picture is high ends in dots.
void FrameBuilder::add_card(DrawList& list) const {
  list.ground.shown = false;
  if (style_.title.empty()) return;
  constexpr float bold = 1.12f, line = 1.35f;
  const auto w = static_cast<float>(style_.width), h = static_cast<float>(style_.height);
  const auto fine = static_cast<float>(std::max(style_.options.supersample, 1));
  const auto one = static_cast<float>(plot::text_width(style_.title, 1.0));
  const float side = std::min(w, h), room = 0.8f * w;
  const float least = std::max(0.055f * side, 7 * fine);
  const float size = std::round(std::max(least, std::min(0.09f * side, room / std::max(1.0f, bold * one))));
  if (room < 4 * size) return;  // of dots alone
  const auto wide = static_cast<double>(size * bold / static_cast<float>(plot::line_height));
  std::vector<std::string> lines = plot::wrap_text(style_.title, wide, static_cast<double>(room));
  const auto most = static_cast<std::size_t>(std::max(1.0f, 0.8f * h / (line * size)));
  if (lines.size() > most) {
    lines[most - 1] =
        plot::shorten_text(lines[most - 1] + ' ' + lines[most], wide, static_cast<double>(room));
    lines.resize(most);
  }
  const float down = 0.5f * line * size * static_cast<float>(lines.size() - 1);
  float y = 0.5f * h - 0.75f * size - down;
  for (const std::string& text : lines) {
    list.labels.push_back({0.5f * w, y, size, look_->ink, text, 0.5f, true});
    y += line * size;
  }
  const Color rule = look_->groups->front();
  const float below = 0.5f * h + down;
  list.areas.push_back({0.44f * w, below + 0.6f * size, 0.56f * w, below + 0.66f * size, rule});
}

Color FrameBuilder::rod_color(double t, const RodCopy& rod) const {
  if (field_) return field_->color(field_->at(t, rod.source));
  return look_->group(static_cast<std::size_t>(looks_.rod_group[static_cast<std::size_t>(rod.source)]));
}

Color FrameBuilder::line_color(double t, std::size_t line) const {
  const std::string& group = trajectory_.structure().lines[line].group;
  if (!field_ || field_->lines.cols() == 0) return look_->line_color(group, field_ && field_->diverging);
  const double force = field_->of_line(t, line);
  return force == 0 ? look_->slack_color() : field_->color(force);
}

// Cables and nets: thinner than any rod, so that what they hang on shows; where their colour tells a force,
// so that it does.
void FrameBuilder::add_lines(double t, const VectorXd& whole, DrawList& list) const {
  const bool by_force = field_ && field_->lines.cols() > 0;
  double thinnest = 0.004 * shown_radius_;
  for (const double radius : looks_.rod_radius) thinnest = std::min(thinnest, radius);
  const std::vector<ShownLine>& lines = trajectory_.structure().lines;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const ShownLine& line = lines[i];
    const double share = line.group == "net" ? 0.2 : 0.4;
    list.tubes.push_back({node(whole, line.a).cast<float>(), node(whole, line.b).cast<float>(),
                          static_cast<float>((by_force ? 1.7 : 1) * share * thinnest), line_color(t, i),
                          Finish::paint});
  }
}

void FrameBuilder::add_bodies(double t, const std::vector<Vec3>& at, DrawList& list) const {
  std::vector<Color> colors, springs;
  if (field_)
    for (const RodCopy& rod : trajectory_.structure().rod_copies) colors.push_back(rod_color(t, rod));
  for (Index k = 0; field_ && k < field_->springs.cols(); ++k) {
    const double force = field_->of_spring(t, static_cast<std::size_t>(k));
    springs.push_back(std::isfinite(force) && force != 0 ? field_->color(force) : Color{0, 0, 0, 0});
  }
  hardware_->add(t, at, colors, springs, list);
  for (const ShownSurface& shown : style_.surfaces) {
    const std::vector<Vec3> edge = edge_of(shown, at);
    list.skins.push_back(skin_of(shown.surface, edge, shown.plan));
  }
}

namespace {

// Arrows side by side stay apart: no thicker than a fifth of the way to the next one, down to a third of what
// they would be. Beyond some hundreds they are too small to be told apart at any thickness.
void thin_crowded(std::vector<Arrow>& arrows) {
  constexpr std::size_t most = 400;
  if (arrows.size() > most) return;
  for (Arrow& arrow : arrows) {
    float apart = 5 * arrow.radius;
    for (const Arrow& other : arrows)
      if (other.tail != arrow.tail && (other.head - other.tail).dot(arrow.head - arrow.tail) > 0)
        apart = std::min(apart, (other.tail - arrow.tail).norm());
    arrow.radius = std::max(0.2f * apart, arrow.radius / 3);
  }
}

}  // namespace

void FrameBuilder::add_loads(const VectorXd& whole, DrawList& list) const {
  const Color color = look_->load_color(field_ && field_->diverging);
  for (const LoadCopy& load : trajectory_.structure().load_copies) {
    if (load.force == Vec3::Zero()) continue;
    const Vec3 arrow = upright_ * load.force * (looks_.arrow_length / looks_.largest_force);
    Vec3 tail = node(whole, load.node);
    // From the surface of a body that would hide half of it, a canister or a large joint.
    if (const double body = looks_.joint_radius[static_cast<std::size_t>(load.node)]; arrow.norm() < 2 * body)
      tail += body * arrow.normalized();
    const Vec3 head = tail + arrow;
    list.arrows.push_back(
        {tail.cast<float>(), head.cast<float>(), static_cast<float>(looks_.arrow_radius), color});
  }
  thin_crowded(list.arrows);
}

void FrameBuilder::add_ghosts(double t, DrawList& list) const {
  for (const Ghost& ghost : ghosts_) {
    if (ghost.t >= t) break;
    for (const RodCopy& rod : trajectory_.structure().rod_copies) {
      Color color = mixed(rod_color(ghost.t, rod), look_->background_bottom, 0.25f);
      color.a = 0.30f;
      list.ghosts.push_back(
          {node(ghost.whole, rod.a).cast<float>(), node(ghost.whole, rod.b).cast<float>(),
           0.7f * static_cast<float>(looks_.rod_radius[static_cast<std::size_t>(rod.source)]), color});
    }
  }
}

void FrameBuilder::add_trails(double t, const VectorXd& whole, DrawList& list) const {
  for (const Trail& trail : trails_) {
    const double joint = looks_.joint_radius[static_cast<std::size_t>(trail.node)];
    const auto thick = static_cast<float>(0.3 * (joint > 0 ? joint : 0.01 * shown_radius_));
    Color color = trail_color(*look_, looks_);
    color.a = 0.85f;
    Vec3 last = trail.points.front();
    for (std::size_t i = 1; i <= trail.points.size(); ++i) {
      const bool ends = i == trail.points.size() || trail.t[i] >= t;
      const Vec3 next = ends ? node(whole, trail.node) : trail.points[i];
      list.ghosts.push_back({last.cast<float>(), next.cast<float>(), thick, color});
      if (ends) break;
      last = next;
    }
  }
}

std::vector<double> frame_times(const Trajectory& trajectory, double fps, double speed) {
  RenderOptions options;
  options.fps = fps;
  options.speed = speed;
  options.hold = 0;
  std::vector<double> times;
  for (const Shot& shot : film_shots(trajectory, options)) times.push_back(shot.t);
  return times;
}

}  // namespace unfurl
