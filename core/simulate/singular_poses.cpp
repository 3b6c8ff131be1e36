// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/singular_poses.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "core/integrators/independent_parts.hpp"
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

const SparseRows& JacobianInPoses::at(const ConstVec& z) {
  if (z_.size() == z.size() && std::equal(z.begin(), z.end(), z_.begin())) return G_;
  z_ = z;
  system_.expand(z, q_);
  system_.jacobian(q_, G_, scratch_);
  return G_;
}

SmallestSingularValue::SmallestSingularValue(std::shared_ptr<JacobianInPoses> jacobian, SparsePart part,
                                             Index redundant, Index count)
    : whole_(std::move(jacobian)),
      part_(std::move(part)),
      count_(count),
      G_(part_.of(whole_->pattern())),
      saddle_(identity(G_.cols()), G_, most_columns, shift, SaddleSolver::Order::sparse_first) {
  by_rows_ = G_.rows() <= G_.cols();
  zeros_ = by_rows_ ? redundant : redundant + G_.cols() - G_.rows();
  SparseRows places = whole_->pattern();
  std::iota(places.valuePtr(), places.valuePtr() + places.nonZeros(), 0.0);
  const SparseRows of_part = part_.of(places);
  from_.assign(of_part.valuePtr(), of_part.valuePtr() + of_part.nonZeros());
  const Index size = std::min(G_.rows(), G_.cols());
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
  const double* const whole = whole_->at(z).valuePtr();
  for (std::size_t k = 0; k < from_.size(); ++k) G_.valuePtr()[k] = whole[from_[k]];
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
    const SparseRows& whole = whole_->pattern();
    Pair pair{sigma_[k], VectorXd::Zero(whole.rows()), VectorXd::Zero(whole.cols()),
              VectorXd::Ones(whole.rows())};
    pair.u(part_.rows()) = by_rows_ ? here : there;
    pair.v(part_.columns()) = by_rows_ ? there : here;
    pair.lengths(part_.rows()) = lengths_;
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

double SmallestSingularValue::between(const Pair& pair, const ConstVec& z) {
  jacobian(z);
  return pair.u(part_.rows()).dot(G_ * pair.v(part_.columns()));
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

namespace {

Index rank_of_rows(SparseRows G) {
  scale_rows(G);
  return rank_within(MatrixXd(G), no_rank);
}

}  // namespace

Index rank_at(JacobianInPoses& jacobian, const SparsePart& part, const ConstVec& z) {
  return rank_of_rows(part.of(jacobian.at(z)));
}

std::vector<SparsePart> parts_with_rows(const JacobianInPoses& jacobian) {
  const System& system = jacobian.system();
  const IndependentParts parts(system);
  std::vector<std::vector<Index>> members(static_cast<std::size_t>(parts.count()));
  std::vector<bool> any_row(members.size(), false);
  std::vector<SparsePart> out;
  for (Index i = 0; i < system.solved_coordinates(); ++i)
    members[static_cast<std::size_t>(parts.of(i))].push_back(i);
  for (Index r = 0; r < system.constraints(); ++r) any_row[static_cast<std::size_t>(parts.of_row(r))] = true;
  for (std::size_t p = 0; p < members.size(); ++p)
    if (any_row[p] && !members[p].empty()) out.emplace_back(jacobian.pattern(), std::move(members[p]));
  return out;
}

namespace {

// The largest rank of a few states of [first, last], of what `part` takes of the Jacobian.
Index usual_rank(JacobianInPoses& jacobian, const auto& part, const Trajectory& trajectory, std::size_t first,
                 std::size_t last) {
  Index rank = 0;
  constexpr int samples = 5;
  for (int k = 0; k < samples; ++k) {
    const std::size_t i = first + (last - first) * static_cast<std::size_t>(k) / (samples - 1);
    rank = std::max(rank, rank_of_rows(part(jacobian.at(trajectory.state(i).z))));
  }
  return rank;
}

}  // namespace

Index structural_redundancy(const Trajectory& trajectory, std::size_t first, std::size_t last) {
  const System& system = trajectory.model(first).system;
  if (system.constraints() == 0) return 0;  // all rods give
  JacobianInPoses jacobian(system);
  return system.constraints() - usual_rank(
                                    jacobian, [](const SparseRows& G) { return G; }, trajectory, first, last);
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

// Of the fastest rod [rad/s].
double spin(const Trajectory& trajectory, std::size_t i) {
  double fastest = 0;
  const VectorXd v = trajectory.node_velocities(i);
  for (const Rod& rod : trajectory.structure().rods)
    fastest = std::max(fastest, (v.segment<3>(3 * rod.b) - v.segment<3>(3 * rod.a)).norm() / rod.length);
  return fastest;
}

// The times of states [first, last], and times between them where rods turn far in a step; fewer where there
// are very many. `last` may become less.
std::vector<double> sample_times(const Trajectory& trajectory, std::size_t first, std::size_t& last) {
  const System& system = trajectory.model(first).system;
  const auto size = static_cast<double>(system.constraints() + system.solved_coordinates());
  const double most = std::max(3.0, most_work / (100 * size));  // sparse factors, some right sides
  std::vector<double> spins, times;
  for (std::size_t i = first; i <= last; ++i) spins.push_back(spin(trajectory, i));
  // How far a rod turns in the step that follows state i, by the faster of its ends [rad].
  const auto turn = [&](std::size_t i) {
    return (trajectory.time(i + 1) - trajectory.time(i)) * std::max(spins[i - first], spins[i + 1 - first]);
  };
  // What turns a rod ten times round in a step has not been solved: nothing lies between the step's ends,
  // nor behind it.
  double turned = 0;
  for (std::size_t i = first; i < last; ++i)
    if (turn(i) <= 20 * pi)
      turned += turn(i);
    else
      last = i;
  const double states = static_cast<double>(last - first + 1);
  const auto stride = static_cast<std::size_t>(std::ceil(std::max(1.0, states / most)));
  const double each = std::max(most_turn, turned / std::max(1.0, most - states));
  for (std::size_t i = first; i < last; i += stride) {
    const double t = trajectory.time(i), h = trajectory.time(i + 1) - t;
    const int parts_of_step = stride > 1 ? 1 : static_cast<int>(std::ceil(std::max(1.0, turn(i) / each)));
    for (int k = 0; k < parts_of_step; ++k) times.push_back(t + h * k / parts_of_step);
  }
  times.push_back(trajectory.time(last));
  return times;
}

VectorXd pose(const Trajectory& trajectory, std::size_t last, double t) {
  const std::size_t i = trajectory.state_before(t);
  return i < last && t > trajectory.time(i) ? trajectory.state_at(t).z
                                            : trajectory.state(std::min(i, last)).z;
}

// Between states of one model, the last one of them `last`, at times that increase: of some coordinates.
class DipSearch {
 public:
  DipSearch(const Trajectory& trajectory, std::size_t last, const std::vector<double>& times,
            const std::shared_ptr<JacobianInPoses>& jacobian, const SparsePart& part, Index redundant)
      : trajectory_(trajectory), last_(last), times_(times), sigma_(jacobian, part, redundant) {
    if (sigma_.all_zeros()) return;
    for (std::size_t quarter = 1; quarter <= 3; ++quarter)
      if (const double s = exact(quarter * (times_.size() - 1) / 4); s > largest_) largest_ = s;
  }

  bool all_zeros() const { return sigma_.all_zeros(); }
  // A pass over all samples, in their order: the first one, the second time with the largest sigma of the
  // first, the third without skipping, as long as none was good enough.
  void begin() { values_.clear(), kept_.clear(), way_ = 0, least_ = no_limit, bad_ = false; }
  // sigma at a sample; with `skip` not at those that are too near to the last one for a dip, which are
  // samples no more.
  void look(std::size_t k, const VectorXd& z, bool skip) {
    if (bad_) return;
    if (ways_.size() == k) ways_.push_back(sigma_.moved(z));
    way_ += ways_[k];
    const double sigma = values_.empty() ? 0.0 : values_.back();
    if (skip && k + 1 < times_.size() && way_ < 0.5 * (sigma - far_from_dips * largest_)) {
      least_ = std::min(least_, sigma - way_);
      return;
    }
    way_ = 0;
    const bool near = !kept_.empty() && kept_.back() == times_[k - 1];
    values_.push_back(near || !skip ? sigma_.estimate(z) : sigma_.at(z));
    kept_.push_back(times_[k]);
    bad_ = !std::isfinite(values_.back());
    if (!bad_) largest_ = std::max(largest_, values_.back());
  }
  // False where too much was passed over, as the largest sigma shows afterwards, or where sigma is not
  // finite.
  bool end() {
    if (bad_ || least_ <= 2 * dip * largest_) return false;
    times_ = std::move(kept_);
    return true;
  }

  void find(std::vector<Event>& events, const std::function<bool()>& cancelled) {
    if (values_.size() < 3) return;
    const double largest =
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

  double exact(std::size_t k) { return between(times_[k]); }
  double between(double t) { return sigma_.at(pose(trajectory_, last_, t)); }

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
  std::size_t last_;
  std::vector<double> times_, values_, kept_;  // of the samples; kept_: of those that had a look in this pass
  std::vector<double> ways_;                   // that the Jacobian moves from one of all samples to the next
  SmallestSingularValue sigma_;
  double largest_ = 0, way_ = 0, least_ = no_limit;  // least_: that a sigma passed over may have
  bool bad_ = false;
};

// In states [first, last] of one model, in each part of it.
void find_dips(const Trajectory& trajectory, std::size_t first, std::size_t last, std::vector<Event>& events,
               const std::function<bool()>& cancelled) {
  const auto jacobian = std::make_shared<JacobianInPoses>(trajectory.model(first).system);
  const std::size_t end = last;
  const std::vector<double> times = sample_times(trajectory, first, last);
  std::vector<std::unique_ptr<DipSearch>> searches, open;
  for (const SparsePart& part : parts_with_rows(*jacobian)) {
    if (std::max(std::ssize(part.rows()), std::ssize(part.columns())) > max_singular_size) continue;
    const Index rank = usual_rank(
        *jacobian, [&](const SparseRows& G) { return part.of(G); }, trajectory, first, end);
    open.push_back(
        std::make_unique<DipSearch>(trajectory, last, times, jacobian, part, std::ssize(part.rows()) - rank));
    if (open.back()->all_zeros()) open.pop_back();
  }
  for (int pass = 0; pass < 3 && !open.empty(); ++pass) {
    for (const auto& search : open) search->begin();
    for (std::size_t k = 0; k < times.size() && !(cancelled && cancelled()); ++k) {
      const VectorXd z = pose(trajectory, last, times[k]);
      for (const auto& search : open) search->look(k, z, pass < 2);
    }
    const auto done =
        std::stable_partition(open.begin(), open.end(), [](const auto& s) { return !s->end(); });
    std::move(done, open.end(), std::back_inserter(searches));
    open.erase(done, open.end());
  }
  std::vector<Event> found;
  for (const auto& search : searches) search->find(found, cancelled);
  std::ranges::stable_sort(found, {}, &Event::t);
  // Parts that are alike and go alike come to one time.
  const double alike = 0.01 * trajectory.options().step;
  for (Event& event : found)
    if (events.empty() || event.t > events.back().t + alike) events.push_back(std::move(event));
}

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
    if (last < first + 2 || system.constraints() == 0) continue;
    if (system.solved_coordinates() == 0) continue;  // nothing can move
    find_dips(trajectory, first, last, found, cancelled);
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
