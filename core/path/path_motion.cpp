// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/path_motion.hpp"

#include <algorithm>
#include <cmath>

#include "core/simulate/run_words.hpp"

namespace unfurl {

PathLaw::PathLaw(const Path& path, const Structure& structure, bool separately)
    : path_(path),
      forces_(structure, path.system(), separately),
      pulling_(forces_.cables().size(), 0),
      slips_(forces_.frictions().size(), 0) {}

void PathLaw::tabulate() {
  table_.emplace(path_, forces_);
}

bool PathLaw::timed() const {
  return std::any_of(forces_.sources().begin(), forces_.sources().end(),
                     [](const PathForces::Source& source) { return source.timed; });
}

void PathLaw::look_from(double s) {
  if (low_ < high_ && s > low_ + 0.3 * (high_ - low_) && s < high_ - 0.3 * (high_ - low_)) return;
  const auto here = path_.piece_of(s);
  if (!here) return;
  const auto reach = [&](long number) {
    const PathPiece* piece = path_.piece(number);
    return piece ? piece : path_.piece(*here);
  };
  low_ = reach(*here - 1)->a;
  high_ = reach(*here + 1)->b;
}

ScalarLaw::Value PathLaw::at(double s, double v, double t) const {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const PathTable::Segment* here = in_reach(s);
  if (!here) return {nan, nan, nan, nan, nan};
  Value out;
  const auto add = [&](Index position, Index damping, double size) {
    const ValueAndSlope p = here->at(position, s), c = here->at(damping, s);
    out.Q += size * p.value - c.value * v;
    out.by_s += size * p.slope - c.slope * v;
    out.by_v -= c.value;
    out.scale += std::abs(size) * here->scale[position] + std::abs(c.value * v);
    out.noise += std::abs(size) * here->noise[position] + std::abs(v) * here->noise[damping];
  };
  add(0, 1, 1.0);
  for (const PathForces::Source& source : forces_.sources()) {
    if (source.timed) {
      add(source.position, source.damping, source.size(t));
      out.noise += source.size_noise(t) * std::abs(here->at(source.position, s).value);
    }
    if (source.cable >= 0 && pulling_[static_cast<std::size_t>(source.cable)])
      add(source.position, source.damping, 1.0);
    if (source.friction < 0) continue;
    const auto i = static_cast<std::size_t>(source.friction);
    if (slips_[i] != 0) add(source.position, source.damping, slips_[i] * forces_.frictions()[i].kinetic);
  }
  return out;
}

double PathLaw::holding(double s) const {
  double most = 0;
  for (const PathForces::Source& source : forces_.sources())
    if (source.friction >= 0)
      most += forces_.frictions()[static_cast<std::size_t>(source.friction)].holding *
              std::abs(table_->at(source.position, s).value);
  return most;
}

void PathMotion::advance(PathLaw& law, double latest) {
  from_ = t_;
  if (drive_.there()) {
    t_ = latest;
    on_drive(t_, s_, v_);
    return;
  }
  constexpr double unit = 1e-15;  // steps this short, as a share of the time, are not told from none
  if (latest - t_ <= unit * std::abs(latest)) {
    s_ += (latest - t_) * v_;
    t_ = latest;
    return;
  }
  law.look_from(s_);
  if (!(h_ > 0)) h_ = 0.01 * (latest - t_);
  ScalarStep step;
  if (!scalar_step(law, t_, s_, v_, latest, h_, step)) {
    if (law.table().rough()) throw PathRefused("what acts on the structure is not smooth along its path");
    throw PathRefused("at t = " + seconds(t_) +
                      ": the path cannot be followed any further, or the motion on it not be resolved");
  }
  const bool last = step.end() >= latest - unit * std::abs(latest);
  t_ = last ? latest : step.end();
  step.at(step.end(), s_, v_);
  iterations_ += step.iterations;
  steps_.push_back(step);
}

void PathMotion::cut(double t) {
  double s = s_, v = v_;
  at(t, s, v);
  t_ = t, s_ = s, v_ = v;
  while (!steps_.empty() && steps_.back().t0 >= t) steps_.pop_back();
}

void PathMotion::at(double t, double& s, double& v) const {
  if (drive_.there()) return on_drive(t, s, v);
  if (t >= t_ || steps_.empty()) {
    s = s_, v = v_;
    return;
  }
  const auto behind = std::partition_point(steps_.begin(), steps_.end(),
                                           [&](const ScalarStep& step) { return step.t0 <= t; });
  const ScalarStep& step = behind == steps_.begin() ? steps_.front() : *(behind - 1);
  step.at(std::clamp(t, step.t0, step.end()), s, v);
}

// Newton's method from where it was last.
void PathMotion::on_drive(double t, double& s, double& v) const {
  const double wanted = drive_.target(t);
  s = s_;
  for (int it = 0; it < 40; ++it) {
    const ValueAndSlope m = law_->table().at(drive_.column, s);
    const double change = (wanted - m.value) / m.slope;
    if (!std::isfinite(change) || std::abs(m.slope) < 1e-9)
      throw PathRefused("at t = " + seconds(t) + ": the drive does not determine the motion along the path");
    s += change;
    if (std::abs(change) <= 4e-16 * (1 + std::abs(s)) || (it > 8 && std::abs(change) < 1e-13)) break;
  }
  v = drive_.target.derivative(1, t) / law_->table().at(drive_.column, s).slope;
}

}  // namespace unfurl
