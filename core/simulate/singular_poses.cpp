#include "core/simulate/singular_poses.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/singular_values.hpp"

namespace unfurl {
namespace {

constexpr double dip = 1e-2;  // of the largest sigma of the run
// Of the largest singular value; what poses of real structures keep is far above (1e-7 in a ring of a
// thousand units).
constexpr double no_rank = 1e-11;
// e: far below the sigma^2 of poses that are not singular, so that the iteration tells them apart, far above
// round-off.
constexpr double shift = 1e-8;
constexpr int most_iterations = 30;
constexpr double converged = 1e-4, lost = 1e-9;  // of sigma, and what squares below it lose to round-off
constexpr double most_work = 3e8;                // multiplications for all states; below a second

SparseRows identity(Index n) {
  SparseRows one(n, n);
  one.setIdentity();
  return one;
}

void scale_rows(SparseRows& G) {
  for (Index r = 0; r < G.rows(); ++r)
    if (const double norm = G.row(r).norm(); norm > 0) G.row(r) /= norm;
}

}  // namespace

SmallestSingularValue::SmallestSingularValue(const System& system, Index redundant)
    : system_(system),
      redundant_(redundant),
      G_(system.jacobian_pattern()),
      saddle_(identity(system.solved_coordinates()), G_, 1, shift),
      q_(system.coordinates()) {
  block_.resize(system.constraints(), std::min(system.constraints(), redundant + 2));
  for (Index c = 0; c < block_.cols(); ++c) stir(c);
}

// A column that no symmetry makes orthogonal to what is looked for.
void SmallestSingularValue::stir(Index column) {
  for (Index i = 0; i < block_.rows(); ++i)
    block_(i, column) = std::sin(1.0 + static_cast<double>((i + 1) * (7 * column + 3)) * 0.7548776662466927);
}

double SmallestSingularValue::at(const ConstVec& z) {
  system_.expand(z, q_);
  system_.jacobian(q_, G_, scratch_);
  scale_rows(G_);
  if (!saddle_.factorise(G_)) return std::numeric_limits<double>::quiet_NaN();
  stir(block_.cols() - 1);  // the last pose's vectors may all be orthogonal to this one's
  double before = -1;
  for (int i = 0; i < most_iterations; ++i) {
    improve();
    const double now = sigma_[redundant_];
    if (!(std::abs(now - before) > converged * now + lost)) break;
    before = now;
  }
  return sigma_[redundant_];
}

// [I G^T; G -e] [x; y] = [0; -b] is y = (G G^T + e)^-1 b. Columns are kept in the order of their sigma, so
// that those of redundant rows, which grow most, are orthogonalised first.
void SmallestSingularValue::improve() {
  const Index columns = block_.cols();
  for (Index c = 0; c < columns; ++c) {
    rest_.setZero(G_.cols());
    block_.col(c) *= -1;
    saddle_.apply(rest_.data(), block_.col(c).data(), 1);
  }
  const Eigen::HouseholderQR<MatrixXd> qr(block_);
  const MatrixXd basis = qr.householderQ() * MatrixXd::Identity(block_.rows(), columns);
  const MatrixXd image = G_.transpose() * basis;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> ritz(image.transpose() * image);
  block_ = basis * ritz.eigenvectors();
  sigma_ = ritz.eigenvalues().cwiseMax(0.0).cwiseSqrt();
}

Index structural_redundancy(const Trajectory& trajectory, std::size_t first, std::size_t last) {
  const System& system = trajectory.model(first).system;
  SparseRows G = system.jacobian_pattern();
  std::vector<double> scratch;
  VectorXd q(system.coordinates());
  Index rank = 0;
  constexpr int samples = 5;
  for (int k = 0; k < samples; ++k) {
    const std::size_t i = first + (last - first) * static_cast<std::size_t>(k) / (samples - 1);
    system.expand(trajectory.state(i).z, q);
    system.jacobian(q, G, scratch);
    scale_rows(G);
    const VectorXd values = singular_values(MatrixXd(G));
    rank = std::max(rank, Index((values.array() > no_rank * values[0]).count()));
  }
  return G.rows() - rank;
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

  void run(std::vector<Event>& events) {
    const System& system = trajectory_.model(first_).system;
    const auto size = static_cast<double>(system.constraints() + system.solved_coordinates());
    const double work = 100 * size * static_cast<double>(last_ - first_);  // sparse factors, some right sides
    stride_ = static_cast<std::size_t>(std::ceil(std::max(1.0, work / most_work)));
    double largest = 0;
    for (std::size_t i = first_; i <= last_; i += stride_) {
      values_.push_back(sigma_.at(trajectory_.state(i).z));
      if (!std::isfinite(values_.back())) return;
      largest = std::max(largest, values_.back());
    }
    for (std::size_t k = 1; k + 1 < values_.size(); ++k) {
      if (!(values_[k] <= values_[k - 1] && values_[k] < values_[k + 1] && values_[k] < 0.7 * largest))
        continue;
      const Event event = refined(first_ + k * stride_, k);
      if (event.singular_value <= dip * largest) events.push_back(event);
    }
  }

 private:
  // Vertex of the parabola through sigma^2 at three times: exact where sigma = c |t - t*|, and where it turns
  // round at a distance, sigma^2 = c^2 (t - t*)^2 + d^2.
  static double vertex(const double (&t)[3], const double (&s)[3]) {
    const double a = t[0] - t[1], b = t[2] - t[1], fa = s[0] * s[0] - s[1] * s[1],
                 fb = s[2] * s[2] - s[1] * s[1];
    const double bottom = 2 * (a * fb - b * fa);
    const double move = bottom != 0 ? (a * a * fb - b * b * fa) / bottom : 0.0;
    return t[1] + std::clamp(move, a, b);
  }

  Event refined(std::size_t i, std::size_t k) {
    const std::size_t before = i - stride_, after = i + stride_;
    const double low = trajectory_.time(before), high = trajectory_.time(after);
    double t = vertex({low, trajectory_.time(i), high}, {values_[k - 1], values_[k], values_[k + 1]});
    for (double reach = 0.05 * (high - low); reach > 1e-4 * (high - low); reach *= 0.05) {
      const double times[3] = {std::max(low, t - reach), t, std::min(high, t + reach)};
      t = vertex(times, {between(times[0]), between(times[1]), between(times[2])});
    }
    Event event{"singular pose", t};
    event.singular_value = between(t);
    return event;
  }

  // At any time, by cubic Hermite interpolation of the solved coordinates.
  double between(double t) {
    std::size_t i = first_, j = last_;
    while (j - i > 1) {
      const std::size_t middle = (i + j) / 2;
      (trajectory_.time(middle) > t ? j : i) = middle;
    }
    const State &p = trajectory_.state(i), &r = trajectory_.state(j);
    const double h = r.t - p.t, u = (t - p.t) / h, v = 1 - u;
    return sigma_.at((1 + 2 * u) * v * v * p.z + u * v * v * h * p.w + u * u * (3 - 2 * u) * r.z -
                     u * u * v * h * r.w);
  }

  const Trajectory& trajectory_;
  std::size_t first_, last_, stride_ = 1;
  SmallestSingularValue sigma_;
  std::vector<double> values_;  // at every stride_-th state
};

}  // namespace

void record_singular_poses(Simulation& run) {
  const Trajectory& trajectory = run.trajectory;
  std::vector<Event> found;
  for (std::size_t first = 0, last = 0; first < trajectory.size(); first = last + 1) {
    const System& system = trajectory.model(first).system;
    for (last = first; last + 1 < trajectory.size() &&
                       &trajectory.model(last + 1) == &trajectory.model(first) &&
                       trajectory.time(last + 1) > trajectory.time(last);)
      ++last;
    const Index size = std::max(system.constraints(), system.solved_coordinates());
    if (last < first + 2 || system.constraints() == 0 || size > max_singular_size) continue;
    DipSearch(trajectory, first, last).run(found);
  }
  run.events.insert(run.events.end(), found.begin(), found.end());
  std::stable_sort(run.events.begin(), run.events.end(),
                   [](const Event& a, const Event& b) { return a.t < b.t; });
}

}  // namespace unfurl
