// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/camera_path.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "render/scene/pose_times.hpp"

namespace unfurl {
namespace {

constexpr int follow_samples = 64;  // of the camera's path
constexpr int follow_window = 6;    // samples before and behind a moment that its picture has room for
constexpr int directions = 24;      // around, that a moving camera is tried from

PointSource source_of(const std::vector<std::vector<Vec3>>& poses, std::size_t first, std::size_t end) {
  return [&poses, first, end](const std::function<void(const Vec3&)>& visit) {
    for (std::size_t i = first; i < end; ++i)
      for (const Vec3& p : poses[i]) visit(p);
  };
}

ViewAngles preset(const std::string& name, const MotionBounds& bounds) {
  if (name == "iso") return {-pi / 4, std::asin(1 / std::sqrt(3.0))};
  if (name == "front") return {-pi / 2, 0};
  if (name == "side") return {0, 0};
  if (name == "top") return {-pi / 2, pi / 2};
  return automatic_view(bounds);
}

// A value of the keys at a time, constant outside: smooth through each key and between two of them never
// beyond either (Fritsch and Carlson, SIAM J. Numer. Anal. 17, 1980: the slope is the harmonic mean of those
// beside it).
template <class Value>
double between(const std::vector<CameraKey>& keys, const Value& value, double t) {
  if (t <= keys.front().time) return value(keys.front());
  if (t >= keys.back().time) return value(keys.back());
  std::size_t i = 0;
  while (keys[i + 1].time <= t) ++i;
  const auto step = [&](std::size_t k) { return keys[k + 1].time - keys[k].time; };
  const auto rise = [&](std::size_t k) { return (value(keys[k + 1]) - value(keys[k])) / step(k); };
  const auto slope = [&](std::size_t k) {
    if (k == 0 || k + 1 == keys.size()) return 0.0;  // starts and ends at rest
    const double before = rise(k - 1), behind = rise(k);
    if (!(before * behind > 0)) return 0.0;
    const double a = step(k - 1) + 2 * step(k), b = 2 * step(k - 1) + step(k);
    return (a + b) / (a / before + b / behind);
  };
  const double h = step(i), u = (t - keys[i].time) / h, w = 1 - u;
  return value(keys[i]) * (1 + 2 * u) * w * w + slope(i) * h * u * w * w +
         value(keys[i + 1]) * (3 - 2 * u) * u * u - slope(i + 1) * h * w * u * u;
}

// Of a sample: the states within the window around it, first and end.
std::pair<std::size_t, std::size_t> window_of(const std::vector<double>& times, int sample) {
  const auto time = [&](int i) {
    const int k = std::clamp(i, 0, follow_samples - 1);
    return times.front() + (times.back() - times.front()) * k / (follow_samples - 1);
  };
  const auto first = std::ranges::lower_bound(times, time(sample - follow_window)) - times.begin();
  const auto end = std::ranges::upper_bound(times, time(sample + follow_window)) - times.begin();
  return {static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, first - 1)),
          std::min(times.size(), static_cast<std::size_t>(end) + 1)};
}

Camera mixed(const Camera& a, const Camera& b, float u) {
  Camera c = a;
  c.eye += u * (b.eye - a.eye);
  c.target += u * (b.target - a.target);
  c.near_plane += u * (b.near_plane - a.near_plane);
  c.far_plane += u * (b.far_plane - a.far_plane);
  c.parallel_height += u * (b.parallel_height - a.parallel_height);
  return c;
}

// Points that have between them where every node is in the states [first, end): those of all states, or of
// many the corners of each node's box in each of four parts.
std::vector<Vec3> reach_of(const std::vector<std::vector<Vec3>>& poses, std::size_t first, std::size_t end) {
  constexpr std::size_t parts = 4, corners = 8;
  std::vector<Vec3> points;
  if (end - first <= parts * corners) {
    for (std::size_t i = first; i < end; ++i) points.insert(points.end(), poses[i].begin(), poses[i].end());
    return points;
  }
  for (std::size_t part = 0; part < parts; ++part) {
    const std::size_t begin = first + part * (end - first) / parts,
                      stop = first + (part + 1) * (end - first) / parts;
    for (std::size_t node = 0; node < poses[begin].size(); ++node) {
      Eigen::AlignedBox3d box;
      for (std::size_t i = begin; i < stop; ++i) box.extend(poses[i][node]);
      for (int corner = 0; corner < static_cast<int>(corners); ++corner)
        points.push_back(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
    }
  }
  return points;
}

}  // namespace

bool moves_camera(const RenderOptions& options) {
  return options.camera_keys.size() > 1 || options.follow || options.orbit != 0 || options.turntable != 0;
}

ViewAngles first_angles(const RenderOptions& options, const MotionBounds& bounds) {
  return preset(options.camera, bounds);
}

double followed_radius(const std::vector<std::vector<Vec3>>& poses, const std::vector<double>& times) {
  double radius = 0;
  for (int k = 0; k < follow_samples; ++k) {
    const auto [first, end] = window_of(times, k);
    radius = std::max(radius, motion_bounds(source_of(poses, first, end)).radius);
  }
  return radius;
}

double most_shots(double end_time, const RenderOptions& o) {
  return (end_time / o.speed + o.easing + o.turntable + o.hold + o.hold_start + o.title_card) * o.fps;
}

namespace {

// Which moment of the motion a share of its film time shows.
class Pace {
 public:
  Pace(const Trajectory& run, const RenderOptions& o)
      : start_(run.start_time()),
        end_(run.end_time()),
        motion_((end_ - start_) / o.speed),
        ease_(std::min(o.easing, motion_)) {
    if (o.pace != "even" || !(end_ > start_)) return;
    const Deployment& deployment = run.structure().deployment;
    PosedMoments moments = posed_moments(run);
    const auto measure = [&](std::size_t i) -> VectorXd {
      if (deployment.empty()) return moments.poses[i];
      const System& system = run.model(run.state_before(moments.times[i])).system;
      const State state = run.state_at(moments.times[i]);
      VectorXd q(system.coordinates());
      system.expand(state.z, q);
      return VectorXd::Constant(1, deployment.fraction(q, state.angles));
    };
    VectorXd last = measure(0);
    for (std::size_t i = 0; i < moments.times.size(); ++i) {
      VectorXd now = measure(i);
      way_.push_back((way_.empty() ? 0.0 : way_.back()) + (now - last).norm());
      last = std::move(now);
    }
    times_ = std::move(moments.times);
    const double whole = way_.back();
    if (!(whole > 0)) way_.clear();
    for (std::size_t i = 0; i < way_.size(); ++i)  // what rests still passes, in a thousandth of the film
      way_[i] = (way_[i] / whole + 1e-3 * (times_[i] - start_) / (end_ - start_)) / 1.001;
  }
  double duration() const { return motion_ + ease_; }  // [s of film]
  double share(double film_time) const {               // of the way, 0..1
    if (!(motion_ > 0)) return 1;
    const auto eased = [this](double x) { return ease_ * x * x * x * (1 - 0.5 * x); };
    const double left = duration() - film_time;
    if (film_time < ease_) return eased(film_time / ease_) / motion_;
    if (left < ease_) return 1 - eased(left / ease_) / motion_;
    return (film_time - 0.5 * ease_) / motion_;
  }
  double time(double share) const {
    if (way_.empty()) return start_ + share * (end_ - start_);
    const auto next = std::upper_bound(way_.begin(), way_.end(), share);
    if (next == way_.begin()) return start_;
    if (next == way_.end()) return end_;
    const auto i = static_cast<std::size_t>(next - way_.begin());
    return times_[i - 1] + (share - way_[i - 1]) / (way_[i] - way_[i - 1]) * (times_[i] - times_[i - 1]);
  }

 private:
  double start_, end_, motion_, ease_;
  std::vector<double> times_, way_;  // of the posed moments
};

}  // namespace

std::vector<Shot> film_shots(const Trajectory& trajectory, const RenderOptions& o) {
  const double start = trajectory.start_time(), end = trajectory.end_time();
  const Pace pace(trajectory, o);
  std::vector<Shot> shots;
  const auto repeat = [&](const Shot& shot, double film_time) {
    shots.insert(shots.end(), static_cast<std::size_t>(std::lround(film_time * o.fps)), shot);
  };
  repeat({start, 0, 0, 0, true}, o.title_card);
  repeat({start, 0, 0}, o.hold_start);
  const std::size_t first = shots.size();
  // A frame within a thousandth of a gap of the end would be the same picture twice.
  for (long k = 0; static_cast<double>(k) < pace.duration() * o.fps - 1e-3; ++k) {
    const double share = pace.share(static_cast<double>(k) / o.fps);
    const bool plain = o.pace == "time" && o.easing == 0;
    shots.push_back(
        {plain ? start + static_cast<double>(k) * (o.speed / o.fps) : pace.time(share), share, 0});
  }
  shots.push_back({end, 1, 0});
  for (std::size_t i = first; i + 1 < shots.size(); ++i)
    shots[i].open = o.motion_blur * (shots[i + 1].t - shots[i].t);
  const auto turning = static_cast<long>(std::lround(o.turntable * o.fps));
  for (long k = 1; k <= turning; ++k)
    shots.push_back({end, 1, static_cast<double>(k) / static_cast<double>(turning)});
  const Shot last = shots.back();
  repeat(last, o.hold);
  return shots;
}

Shot shot_at(const Trajectory& trajectory, const RenderOptions& options, double t) {
  RenderOptions motion = options;
  motion.title_card = motion.hold_start = motion.turntable = motion.hold = 0;
  const std::vector<Shot> shots = film_shots(trajectory, motion);
  const auto next =
      std::upper_bound(shots.begin(), shots.end(), t, [](double x, const Shot& shot) { return x < shot.t; });
  if (next == shots.begin()) return shots.front();
  Shot shot = *std::prev(next);
  if (next == shots.end() || shot.t == t) return shot;
  shot.progress += (t - shot.t) / (next->t - shot.t) * (next->progress - shot.progress);
  shot.t = t;
  return shot;
}

CameraPath::CameraPath(std::vector<std::vector<Vec3>> poses, std::vector<double> times, MotionBounds bounds,
                       Framing framing, const RenderOptions& options)
    : poses_(std::move(poses)),
      times_(std::move(times)),
      bounds_(bounds),
      framing_(framing),
      start_(options.camera_keys.empty()
                 ? first_angles(options, bounds)
                 : ViewAngles{options.camera_keys.front().azimuth * radians_per_degree,
                              options.camera_keys.front().elevation * radians_per_degree}),
      orbit_(options.orbit * radians_per_degree),
      turntable_(options.turntable > 0),
      follow_(options.follow),
      keys_(options.camera_keys) {
  framing_.parallel = options.projection == "orthographic";
  framing_.zoom = options.zoom;
  const PointSource all = source_of(poses_, 0, poses_.size());
  still_ = frame_points(all, bounds_.center, bounds_, start_, framing_);
  const bool turning = !keys_.empty() || orbit_ != 0 || turntable_;
  if (follow_) turning ? prepare_turning_follow() : prepare_follow();
  if (!turning) return;
  for (const double elevation : elevations(times_.front(), times_.back()))
    for (int k = 0; k < directions; ++k)
      distance_ = std::max(
          distance_, centered_distance(all, bounds_.center,
                                       {start_.azimuth + 2 * pi * k / directions, elevation}, framing_));
}

// At each angle over the floor there is one view that needs most room; between two angles 2 d apart, no view
// needs more than 1 / cos d of what they need: here 2 % more, which the margins have.
std::vector<double> CameraPath::elevations(double from, double to) const {
  if (keys_.empty()) return {start_.elevation};
  constexpr int samples = 64;
  constexpr double apart = 22.5 * radians_per_degree;
  double low = elevation(from), high = low;
  const auto pass = [&](double t) { low = std::min(low, elevation(t)), high = std::max(high, elevation(t)); };
  for (int k = 1; k <= samples; ++k) pass(from + (to - from) * k / samples);
  for (const CameraKey& key : keys_)
    if (key.time > from && key.time < to) pass(key.time);
  std::vector<double> passed;
  const int steps = static_cast<int>(std::ceil((high - low) / apart));
  for (int k = 0; k < steps; ++k) passed.push_back(low + (high - low) * k / steps);
  passed.push_back(high);
  return passed;
}

// Each sample frames all that moves within the window around it. A moment's camera is the mean of those whose
// window has that moment; the condition of being in the picture is linear in the camera's place, so the mean
// fulfils it as they do.
void CameraPath::prepare_follow() {
  std::vector<Camera> fitted;
  for (int k = 0; k < follow_samples; ++k) {
    const auto [first, end] = window_of(times_, k);
    const PointSource window = source_of(poses_, first, end);
    fitted.push_back(frame_points(window, motion_bounds(window).center, bounds_, start_, framing_));
  }
  for (int k = 0; k < follow_samples; ++k) {
    Camera mean = fitted[static_cast<std::size_t>(k)];
    float count = 1;
    for (int i = k - follow_window + 1; i < k + follow_window; ++i) {
      if (i == k || i < 0 || i >= follow_samples) continue;
      mean = mixed(mean, fitted[static_cast<std::size_t>(i)], 1 / ++count);
    }
    follow_path_.push_back(mean);
  }
}

// A camera that turns while it follows sees, from any side, what moves within the window around a moment.
void CameraPath::prepare_turning_follow() {
  const double start = times_.front(), span = times_.back() - start;
  std::vector<Place> fitted;
  for (int k = 0; k < follow_samples; ++k) {
    const auto time = [&](int i) {
      return start + span * std::clamp(i, 0, follow_samples - 1) / (follow_samples - 1);
    };
    const std::size_t first = first_before(time(k - follow_window)),
                      end = std::min(poses_.size(), first_before(time(k + follow_window)) + 2);
    const std::vector<Vec3> points = reach_of(poses_, first, end);
    const PointSource window = [&](const std::function<void(const Vec3&)>& visit) {
      for (const Vec3& p : points) visit(p);
    };
    Place place{motion_bounds(window).center, 0};
    for (const double elevation : elevations(time(k - follow_window), time(k + follow_window)))
      for (int i = 0; i < directions; ++i)
        place.distance =
            std::max(place.distance,
                     centered_distance(window, place.center, {2 * pi * i / directions, elevation}, framing_));
    fitted.push_back(place);
  }
  for (int k = 0; k < follow_samples; ++k) {
    Place mean;
    double count = 0;
    for (int i = std::max(0, k - follow_window); i <= std::min(follow_samples - 1, k + follow_window); ++i) {
      mean.center += fitted[static_cast<std::size_t>(i)].center;
      mean.distance = std::max(mean.distance, fitted[static_cast<std::size_t>(i)].distance);
      ++count;
    }
    mean.center /= count;
    follow_places_.push_back(mean);
  }
}

std::size_t CameraPath::first_before(double t) const {
  const auto at = std::upper_bound(times_.begin(), times_.end(), t) - times_.begin();
  return static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, at - 1));
}

Camera CameraPath::following(double t) const {
  const double span = times_.back() - times_.front();
  const double at = span > 0 ? std::clamp((t - times_.front()) / span, 0.0, 1.0) * (follow_samples - 1) : 0.0;
  const auto i = std::min(static_cast<std::size_t>(at), follow_path_.size() - 2);
  return mixed(follow_path_[i], follow_path_[i + 1], static_cast<float>(at - static_cast<double>(i)));
}

double CameraPath::elevation(double t) const {
  return std::clamp(between(
                        keys_, [](const CameraKey& key) { return key.elevation; }, t),
                    -90.0, 90.0) *
         radians_per_degree;
}

ViewAngles CameraPath::angles(const Shot& shot) const {
  ViewAngles view = start_;
  if (!keys_.empty()) {
    view.azimuth = between(
                       keys_, [](const CameraKey& key) { return key.azimuth; }, shot.t) *
                   radians_per_degree;
    view.elevation = elevation(shot.t);
  }
  view.azimuth += orbit_ * shot.progress + 2 * pi * shot.turn;
  return view;
}

Camera CameraPath::at(const Shot& shot) const {
  const bool turning = orbit_ != 0 || turntable_ || !keys_.empty();
  if (follow_ && !turning) return following(shot.t);
  if (!turning) return still_;
  Framing framing = framing_;
  if (!keys_.empty())
    framing.zoom *= std::exp(between(
        keys_, [](const CameraKey& key) { return std::log(std::max(0.01, key.zoom)); }, shot.t));
  if (follow_places_.empty())
    return centered_camera(bounds_, bounds_.center, distance_, angles(shot), framing);
  const double span = times_.back() - times_.front();
  const double at =
      span > 0 ? std::clamp((shot.t - times_.front()) / span, 0.0, 1.0) * (follow_samples - 1) : 0.0;
  const auto i = std::min(static_cast<std::size_t>(at), follow_places_.size() - 2);
  const double u = at - static_cast<double>(i);
  const Place &a = follow_places_[i], &b = follow_places_[i + 1];
  return centered_camera(bounds_, a.center + u * (b.center - a.center),
                         a.distance + u * (b.distance - a.distance), angles(shot), framing);
}

}  // namespace unfurl
