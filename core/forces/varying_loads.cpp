// SPDX-License-Identifier: BSD-3-Clause
#include "core/forces/varying_loads.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace unfurl {
namespace {

std::vector<Force> forces_of(const Structure& structure, std::string_view kind) {
  std::vector<Force> found;
  for (const Force& f : structure.forces)
    if (f.kind == kind) found.push_back(f);
  return found;
}

class LoadsOverTime final : public ForceBlock {
 public:
  explicit LoadsOverTime(std::vector<Force> loads) : loads_(std::move(loads)) {}
  bool constant() const override { return false; }
  bool has_power() const override { return true; }
  void add(const Moment& at, const double*, const double*, double scale, double* f) const override {
    for (const Force& load : loads_)
      Eigen::Map<Vec3>(f + 3 * static_cast<Index>(load.nodes[0])) += scale * load.size(at.t) * load.direction;
  }
  double power(const Moment& at, const double*, const double* v) const override {
    double sum = 0;
    for (const Force& load : loads_)
      sum += load.size(at.t) * load.direction.dot(node_vector(v, load.nodes[0]));
    return sum;
  }

 private:
  std::vector<Force> loads_;
};

class Followers final : public ForceBlock {
 public:
  explicit Followers(std::vector<Force> loads) : loads_(std::move(loads)) {}
  bool constant() const override { return false; }
  bool has_power() const override { return true; }
  void add(const Moment& at, const double* q, const double*, double scale, double* f) const override {
    for (const Force& load : loads_)
      Eigen::Map<Vec3>(f + 3 * static_cast<Index>(load.nodes[1])) += scale * load.size(at.t) * along(load, q);
  }
  double power(const Moment& at, const double* q, const double* v) const override {
    double sum = 0;
    for (const Force& load : loads_)
      sum += load.size(at.t) * along(load, q).dot(node_vector(v, load.nodes[1]));
    return sum;
  }
  // d/dx of the unit vector n of d = sum c_k x_k: (I - n n^T) c_k / |d|
  void derivatives(const Moment& at, const double* q, const double*, ForceDerivative& by_q,
                   ForceDerivative&) const override {
    for (const Force& load : loads_) {
      const Vec3 d = line(load, q), n = d.normalized();
      const Mat3 turn = load.size(at.t) / d.norm() * (Mat3::Identity() - n * n.transpose());
      for (std::size_t k = 0; k < load.nodes.size(); ++k)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            by_q.emplace_back(3 * load.nodes[1] + i, 3 * load.nodes[k] + j, share(load, k) * turn(i, j));
    }
  }

 private:
  // The line of the last part, and where a part is before it the tangent at the end of the parabola through
  // the three nodes.
  static double share(const Force& load, std::size_t k) {
    constexpr std::array line{-1.0, 1.0, 0.0}, tangent{-2.0, 1.5, 0.5};
    return load.nodes.size() == 3 ? tangent[k] : line[k];
  }
  static Vec3 line(const Force& load, const double* q) {
    Vec3 d = Vec3::Zero();
    for (std::size_t k = 0; k < load.nodes.size(); ++k) d += share(load, k) * node_vector(q, load.nodes[k]);
    return d;
  }
  static Vec3 along(const Force& load, const double* q) { return line(load, q).normalized(); }
  std::vector<Force> loads_;
};

ParamSpec times_param() {
  return vector_param(
      "times", "s", {},
      "with values: the size over time, straight lines between the points; a time that stands twice is a "
      "jump");
}
ParamSpec values_param() {
  return vector_param("values", "", {}, "factors of the load at the times");
}
ParamSpec table_param() {
  return text_param("table", "", "CSV file beside the scene, in place of times and values: t,value");
}

// What stands in place of a table, for all loads over time.
std::vector<ParamSpec> with_sine(std::vector<ParamSpec> params) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  params.push_back(
      positive_param("frequency", "Hz", std::numeric_limits<double>::quiet_NaN(),
                     "in place of times and values: the load goes as sin(360 deg frequency (t - start))"));
  params.push_back(only_given(
      "frequency", real_param("start", "s", 0.0, 0.0, infinity, "of the sine: before it there is no load")));
  params.push_back(only_given("frequency", real_param("ramp", "s", 0.0, 0.0, infinity,
                                                      "of the sine: how long it takes to grow to its size")));
  return params;
}

TimeFunction sine_load(const ParamSet& values, double size) {
  TimeFunction f;
  f.kind = TimeFunction::Kind::sine;
  f.duration = 1 / values.real("frequency");
  f.rate = size * 2 * pi / f.duration;
  f.start = values.real("start");
  f.ramp = values.real("ramp");
  return f;
}

// `size` times the factor over time, which is 1 where neither a table nor a frequency is given.
TimeFunction over_time(const ParamSet& values, double size) {
  if (std::isfinite(values.real("frequency"))) return sine_load(values, size);
  TimeFunction f;
  f.offset = size;
  if (values.vector("times").empty()) return f;
  f.kind = TimeFunction::Kind::linear;
  f.offset = 0;
  f.times = values.vector("times");
  f.values = values.vector("values");
  for (double& x : f.values) x *= size;
  return f;
}

}  // namespace

std::unique_ptr<ForceBlock> load_over_time_block(const Structure& structure, const SparseRows&) {
  auto loads = forces_of(structure, "load_over_time");
  if (loads.empty()) return nullptr;
  return std::make_unique<LoadsOverTime>(std::move(loads));
}

std::unique_ptr<ForceBlock> follower_block(const Structure& structure, const SparseRows&) {
  auto loads = forces_of(structure, "follower");
  if (loads.empty()) return nullptr;
  return std::make_unique<Followers>(std::move(loads));
}

const std::vector<ParamSpec>& load_over_time_params() {
  static const std::vector<ParamSpec> params = with_sine(
      {required(vector_param("force", "N", {0, 0, 0}, "on each node, times the factor of the time")),
       times_param(), values_param(), table_param()});
  return params;
}

void fill_load_over_time(const ParamSet& values, Force& force) {
  const auto& f = values.vector("force");
  force.direction = {f[0], f[1], f[2]};
  force.size = over_time(values, 1.0);
}

void fill_follower(const ParamSet& values, Force& force) {
  force.size = over_time(values, values.real("force"));
}

const std::vector<ParamSpec>& follower_params() {
  static const std::vector<ParamSpec> params = [] {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return with_sine(
        {required(real_param("force", "N", 0.0, -infinity, infinity,
                             "on the second node of the rod, along the rod and away from the first")),
         times_param(), values_param(), table_param()});
  }();
  return params;
}

}  // namespace unfurl
