// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/singular_poses.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/determined_rows.hpp"
#include "core/math/factors.hpp"
#include "core/math/singular_values.hpp"

namespace unfurl {
namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();
constexpr double dip = 1e-2;  // of the largest sigma of the run
// Of the largest sigma: poses that are known to have more need no closer look.
constexpr double far_from_dips = 0.1;
// Of the largest singular value; what poses of real structures keep is far above (1e-7 in a ring of a
// thousand units).
constexpr double no_rank = 1e-11;
// e: far below the sigma^2 of poses that are not singular, so that the iteration tells them apart, far above
// round-off.
constexpr double shift = 1e-8;
constexpr int most_iterations = 30;
constexpr double converged = 1e-4, lost = 1e-9;  // of sigma, and what squares below it lose to round-off
constexpr double much = 0.2;                     // a change of sigma from one state to the next
constexpr double most_turn = 0.15;               // of a rod from sample to sample [rad]
constexpr double most_work = 3e8;                // multiplications for all states; below a second

SparseRows identity(Index n) {
  SparseRows one(n, n);
  one.setIdentity();
  return one;
}

VectorXd scale_rows(SparseRows& G) {
  VectorXd lengths = VectorXd::Zero(G.rows());
  double* const value = G.valuePtr();
  const int* const start = G.outerIndexPtr();
  for (Index r = 0; r < G.rows(); ++r) {
    double square = 0;
    for (int p = start[r]; p < start[r + 1]; ++p) square += value[p] * value[p];
    if (square == 0) continue;
    lengths[r] = std::sqrt(square);
    for (int p = start[r]; p < start[r + 1]; ++p) value[p] /= lengths[r];
  }
  return lengths;
}

}  // namespace

SmallestSingularValue::SmallestSingularValue(const System& system, Index redundant, Index count)
    : system_(system),
      by_rows_(system.constraints() <= system.solved_coordinates()),
      zeros_(by_rows_ ? redundant : redundant + system.solved_coordinates() - system.constraints()),
      count_(count),
      G_(system.jacobian_pattern()),
      saddle_(identity(system.solved_coordinates()), G_, most_columns, shift,
              SaddleSolver::Order::sparse_first),
      q_(system.coordinates()) {
  const Index size = std::min(system.constraints(), system.solved_coordinates());
  block_.resize(size, std::min(size, zeros_ + count_ + 1));
  for (Index c = 0; c < block_.cols(); ++c) stir(c);
}

// A column that no symmetry makes orthogonal to what is looked for.
void SmallestSingularValue::stir(Index column) {
  for (Index i = 0; i < block_.rows(); ++i)
    block_(i, column) = std::sin(1.0 + static_cast<double>((i + 1) * (7 * column + 3)) * 0.7548776662466927);
}

void SmallestSingularValue::jacobian(const ConstVec& z) {
  if (z_.size() == z.size() && std::equal(z.begin(), z.end(), z_.begin())) return;
  z_ = z;
  system_.expand(z, q_);
  system_.jacobian(q_, G_, scratch_);
  lengths_ = scale_rows(G_);
}

bool SmallestSingularValue::place(const ConstVec& z) {
  jacobian(z);
  return saddle_.factorise(G_);
}

double SmallestSingularValue::moved(const ConstVec& z) {
  jacobian(z);
  const Eigen::Map<const VectorXd> now(G_.valuePtr(), G_.nonZeros());
  const double way = seen_.size() == now.size() ? (now - seen_).norm() : no_limit;
  seen_ = now;
  return way;
}

double SmallestSingularValue::settle(double tolerance) {
  stir(block_.cols() - 1);  // the last pose's vectors may all be orthogonal to this one's
  const Index count = std::min(count_, block_.cols() - zeros_);
  VectorXd before = VectorXd::Constant(count, -1);
  for (int i = 0; i < most_iterations; ++i) {
    improve();
    const auto now = sigma_.segment(zeros_, count);
    if (!(((now - before).cwiseAbs() - tolerance * now).maxCoeff() > lost)) break;
    before = now;
  }
  return sigma_[zeros_];
}

double SmallestSingularValue::at(const ConstVec& z) {
  return place(z) ? settle(converged) : std::numeric_limits<double>::quiet_NaN();
}

double SmallestSingularValue::estimate(const ConstVec& z) {
  if (sigma_.size() == 0) return at(z);
  const double before = sigma_[zeros_];
  if (!place(z)) return std::numeric_limits<double>::quiet_NaN();
  stir(block_.cols() - 1);
  improve();
  if (std::abs(sigma_[zeros_] - before) <= much * before) return sigma_[zeros_];
  return settle(0.01);
}

std::vector<SmallestSingularValue::Pair> SmallestSingularValue::pairs() const {
  std::vector<Pair> pairs;
  for (Index k = zeros_; k < std::min(zeros_ + count_, block_.cols()); ++k) {
    const VectorXd here = block_.col(k),
                   there = (by_rows_ ? VectorXd(G_.transpose() * here) : VectorXd(G_ * here)).normalized();
    pairs.push_back({sigma_[k], by_rows_ ? here : there, by_rows_ ? there : here, lengths_});
  }
  return pairs;
}

double SmallestSingularValue::between(const Pair& pair, const ConstVec& z) {
  jacobian(z);
  return pair.u.dot(G_ * pair.v);
}

// With b in the place of f or of g, [I G^T; G -e] [x; y] = [f; g] has the solutions
//     f = 0:  y = -(G G^T + e)^-1 g,      g = 0:  x = e (G^T G + e)^-1 f.
// Columns of zeros grow most, and are orthogonalised first.
void SmallestSingularValue::improve() {
  const Index columns = block_.cols();
  for (Index c = 0; c < columns; c += most_columns) {
    const Index count = std::min<Index>(most_columns, columns - c);
    rows_.setZero(G_.rows(), count);
    columns_.setZero(G_.cols(), count);
    Interleaved& known = by_rows_ ? rows_ : columns_;
    known = block_.middleCols(c, count);
    saddle_.apply(columns_.data(), rows_.data(), static_cast<int>(count));
    block_.middleCols(c, count) = by_rows_ ? rows_ : columns_;
  }
  const MatrixXd basis = orthonormal_columns(block_);
  const MatrixXd image = by_rows_ ? MatrixXd(G_.transpose() * basis) : MatrixXd(G_ * basis);
  const SymmetricEigen ritz = symmetric_eigen(image.transpose() * image);
  block_ = basis * ritz.vectors;
  sigma_ = ritz.values.cwiseMax(0.0).cwiseSqrt();
}

Index rank_at(const System& system, const ConstVec& z) {
  SparseRows G = system.jacobian_pattern();
  std::vector<double> scratch;
  VectorXd q(system.coordinates());
  system.expand(z, q);
  system.jacobian(q, G, scratch);
  scale_rows(G);
  return rank_within(MatrixXd(G), no_rank);
}

Index structural_redundancy(const Trajectory& trajectory, std::size_t first, std::size_t last) {
  const System& system = trajectory.model(first).system;
  if (system.constraints() == 0) return 0;  // all rods give
  Index rank = 0;
  constexpr int samples = 5;
  for (int k = 0; k < samples; ++k) {
    const std::size_t i = first + (last - first) * static_cast<std::size_t>(k) / (samples - 1);
    rank = std::max(rank, rank_at(system, trajectory.state(i).z));
  }
  return system.constraints() - rank;
}

bool singular_at_end(const Trajectory& trajectory, double flat) {
  constexpr double counts = 1e-6;  // with determined_rows, for Jacobians of any size
  const System& system = trajectory.last_model().system;
  const bool large = std::max(system.constraints(), system.solved_coordinates()) > max_singular_size;
  if (large && flat > counts) return true;
  std::size_t last = trajectory.size() - 1, first = last;
  while (first > 0 && &trajectory.model(first - 1) == &trajectory.model(last)) --first;
  SparseRows G = system.jacobian_pattern();
  std::vector<double> scratch;
  const auto determined = [&](std::size_t state) {
    system.jacobian(trajectory.node_positions(state), G, scratch);
    return std::ranges::count(determined_rows(G), 1);
  };
  if (large) return determined(last) < determined((first + last) / 2);
  system.jacobian(trajectory.node_positions(last), G, scratch);
  scale_rows(G);
  return G.rows() - rank_within(MatrixXd(G), flat) > structural_redundancy(trajectory, first, last);
}

bool regular_when_deployed(Trajectory& trajectory, const State& event) {
  constexpr double next_to = 1e-3;  // of a dead centre [rad], and of the largest singular value
  const Deployment& deployment = trajectory.structure().deployment;
  if (deployment.folds() && std::abs(std::sin(deployment.deployed_fold_angle)) < next_to) return false;
  trajectory.append(event, {});
  const bool singular = singular_at_end(trajectory, next_to);
  trajectory.pop_back();
  return !singular;
}

namespace {

// States [first, last] of one model, at times that increase.
class DipSearch {
 public:
  DipSearch(const Trajectory& trajectory, std::size_t first, std::size_t last)
      : trajectory_(trajectory),
        first_(first),
        last_(last),
        sigma_(trajectory.model(first).system, structural_redundancy(trajectory, first, last)) {}

  void run(std::vector<Event>& events, const std::function<bool()>& cancelled) {
    if (sigma_.all_zeros()) return;
    place_samples();
    double largest = 0;
    for (std::size_t quarter = 1; quarter <= 3; ++quarter)
      if (const double sigma = exact(quarter * (times_.size() - 1) / 4); sigma > largest) largest = sigma;
    bool followed = false;  // the second time with the largest sigma of the first, the third without skipping
    for (int pass = 0; pass < 3 && !followed; ++pass) followed = follow(pass < 2, largest, cancelled);
    if (!followed) return;
    if (values_.size() < 3) return;
    largest =
        exact(static_cast<std::size_t>(std::max_element(values_.begin(), values_.end()) - values_.begin()));
    for (std::size_t k = 1; k + 1 < values_.size() && !(cancelled && cancelled()); ++k) {
      if (!(values_[k] <= values_[k - 1] && values_[k] < values_[k + 1] && values_[k] < 0.7 * largest) ||
          !stands_out(k))
        continue;
      const Event event = refined(k);
      if (event.singular_value <= dip * largest) events.push_back(event);
    }
  }

 private:
  // sigma at the samples; with `skip` not at those that are too near to the last one for a dip, which are
  // samples no more. False where too much was passed over, as the largest sigma shows afterwards, or where
  // sigma is not finite.
  bool follow(bool skip, double& largest, const std::function<bool()>& cancelled) {
    values_.clear();
    std::vector<double> times;
    double way = 0, least = no_limit;  // least: that a sigma passed over may have
    for (std::size_t k = 0; k < times_.size() && !(cancelled && cancelled()); ++k) {
      const VectorXd z = pose(times_[k]);
      if (ways_.size() == k) ways_.push_back(sigma_.moved(z));
      way += ways_[k];
      const double sigma = values_.empty() ? 0.0 : values_.back();
      if (skip && k + 1 < times_.size() && way < 0.5 * (sigma - far_from_dips * largest)) {
        least = std::min(least, sigma - way);
        continue;
      }
      way = 0;
      const bool near = !times.empty() && times.back() == times_[k - 1];
      values_.push_back(near || !skip ? sigma_.estimate(z) : sigma_.at(z));
      times.push_back(times_[k]);
      if (!std::isfinite(values_.back())) return false;
      largest = std::max(largest, values_.back());
    }
    if (least <= 2 * dip * largest) return false;
    times_ = std::move(times);
    return true;
  }

  // The states' own times, and times between them where rods turn far in a step; fewer where there are very
  // many.
  void place_samples() {
    const System& system = trajectory_.model(first_).system;
    const auto size = static_cast<double>(system.constraints() + system.solved_coordinates());
    const double most = std::max(3.0, most_work / (100 * size));  // sparse factors, some right sides
    std::vector<double> spins;
    for (std::size_t i = first_; i <= last_; ++i) spins.push_back(spin(i));
    // How far a rod turns in the step that follows state i, by the faster of its ends [rad].
    const auto turn = [&](std::size_t i) {
      return (trajectory_.time(i + 1) - trajectory_.time(i)) *
             std::max(spins[i - first_], spins[i + 1 - first_]);
    };
    // What turns a rod ten times round in a step has not been solved: nothing lies between the step's ends,
    // nor behind it.
    double turned = 0;
    for (std::size_t i = first_; i < last_; ++i)
      if (turn(i) <= 20 * pi)
        turned += turn(i);
      else
        last_ = i;
    const double states = static_cast<double>(last_ - first_ + 1);
    const auto stride = static_cast<std::size_t>(std::ceil(std::max(1.0, states / most)));
    const double each = std::max(most_turn, turned / std::max(1.0, most - states));
    for (std::size_t i = first_; i < last_; i += stride) {
      const double t = trajectory_.time(i), h = trajectory_.time(i + 1) - t;
      const int parts_of_step = stride > 1 ? 1 : static_cast<int>(std::ceil(std::max(1.0, turn(i) / each)));
      for (int k = 0; k < parts_of_step; ++k) times_.push_back(t + h * k / parts_of_step);
    }
    times_.push_back(trajectory_.time(last_));
  }

  // Of the fastest rod [rad/s].
  double spin(std::size_t i) const {
    double fastest = 0;
    const VectorXd v = trajectory_.node_velocities(i);
    for (const Rod& rod : trajectory_.structure().rods)
      fastest = std::max(fastest, (v.segment<3>(3 * rod.b) - v.segment<3>(3 * rod.a)).norm() / rod.length);
    return fastest;
  }

  // Half as low as the heights on both sides that part it from what is lower: what is not is rounding.
  bool stands_out(std::size_t k) const {
    const auto height = [&](auto first, auto last) {
      double top = 0;
      for (auto it = first; it != last && *it >= values_[k]; ++it) top = std::max(top, *it);
      return top;
    };
    const auto at = static_cast<std::ptrdiff_t>(k);
    const double before = height(values_.rbegin() + (std::ssize(values_) - at), values_.rend());
    const double after = height(values_.begin() + at + 1, values_.end());
    return values_[k] <= 0.5 * std::min(before, after);
  }

  VectorXd pose(double t) const {
    const std::size_t i = trajectory_.state_before(t);
    return i < last_ && t > trajectory_.time(i) ? trajectory_.state_at(t).z
                                                : trajectory_.state(std::min(i, last_)).z;
  }
  double exact(std::size_t k) { return between(times_[k]); }
  double between(double t) { return sigma_.at(pose(t)); }

  // Vertex of the parabola through sigma^2 at three times: exact where sigma = c |t - t*|, and where it turns
  // round at a distance, sigma^2 = c^2 (t - t*)^2 + d^2.
  static double vertex(const double (&t)[3], const double (&s)[3]) {
    const double a = t[0] - t[1], b = t[2] - t[1], fa = s[0] * s[0] - s[1] * s[1],
                 fb = s[2] * s[2] - s[1] * s[1];
    const double bottom = 2 * (a * fb - b * fa);
    const double move = bottom != 0 ? (a * a * fb - b * b * fa) / bottom : 0.0;
    return t[1] + std::clamp(move, a, b);
  }

  Event refined(std::size_t k) {
    const double low = times_[k - 1], high = times_[k + 1];
    double t = vertex({low, times_[k], high}, {exact(k - 1), exact(k), exact(k + 1)});
    // Closer and closer, but where the bottom lies outside: another singular value was the smaller one there.
    int moves = 40;
    for (double reach = 0.05 * (high - low); reach > 1e-4 * (high - low) && moves > 0; --moves) {
      const double times[3] = {std::max(low, t - reach), t, std::min(high, t + reach)};
      t = vertex(times, {between(times[0]), between(times[1]), between(times[2])});
      if (times[0] < t && t < times[2]) reach *= 0.05;
    }
    Event event{.name = "singular pose", .t = t, .kind = "singular_pose"};
    event.singular_value = between(t);
    return event;
  }

  const Trajectory& trajectory_;
  std::size_t first_, last_;
  SmallestSingularValue sigma_;
  std::vector<double> times_, values_;  // of the samples
  std::vector<double> ways_;            // that the Jacobian moves from one of all samples to the next
};

}  // namespace

std::vector<Event> find_singular_poses(const Trajectory& trajectory, const std::function<bool()>& cancelled) {
  std::vector<Event> found;
  for (std::size_t first = 0, last = 0; first < trajectory.size() && !(cancelled && cancelled());
       first = last + 1) {
    const System& system = trajectory.model(first).system;
    for (last = first; last + 1 < trajectory.size() &&
                       &trajectory.model(last + 1) == &trajectory.model(first) &&
                       trajectory.time(last + 1) > trajectory.time(last);)
      ++last;
    const Index size = std::max(system.constraints(), system.solved_coordinates());
    if (last < first + 2 || system.constraints() == 0 || size > max_singular_size) continue;
    if (system.solved_coordinates() == 0) continue;  // nothing can move
    DipSearch(trajectory, first, last).run(found, cancelled);
  }
  return found;
}

void record_singular_poses(Simulation& run, const std::function<bool()>& cancelled) {
  record_singular_poses(run, find_singular_poses(run.trajectory, cancelled));
}

void record_singular_poses(Simulation& run, const std::vector<Event>& found) {
  run.events.insert(run.events.end(), found.begin(), found.end());
  std::stable_sort(run.events.begin(), run.events.end(),
                   [](const Event& a, const Event& b) { return a.t < b.t; });
}

}  // namespace unfurl
