// SPDX-License-Identifier: BSD-3-Clause
#include "core/simulate/stretched.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/integrators/index1.hpp"
#include "core/math/determined_rows.hpp"
#include "core/math/lagrange.hpp"
#include "core/math/saddle_solver.hpp"
#include "core/simulate/elastic_sharing.hpp"

namespace unfurl {
namespace {

// Of one model, along its states.
class Stretch {
 public:
  Stretch(const Model& model, const VectorXd& q)
      : model_(model),
        system_(model.system),
        G_(system_.jacobian_pattern()),
        compliance_(row_compliance(model)),
        index1_(system_, true),
        saddle_(system_.mass(), G_) {
    system_.jacobian(q, G_, scratch_);
    const std::vector<char> rigidly = determined_rows(G_);
    sharing_.emplace(model, std::find(rigidly.begin(), rigidly.end(), 0) == rigidly.end());
  }

  // False where the state's pose has no displacement of its own.
  bool at(const State& state, bool singular, VectorXd& u) {
    if (singular || compliance_.size() == 0) return false;
    VectorXd acceleration(state.w.size()), lambda = state.lambda;
    system_.follow(state);
    return index1_.evaluate(state, acceleration, lambda) && by(state, lambda, u);
  }

  // The same, by multipliers from which what the step left of the constraints is taken; and what round-off in
  // them may change of it [m]: the displacement divides that by the weakest direction once more.
  bool closely(const State& state, VectorXd& u, double& doubt) {
    VectorXd acceleration, lambda, of_forces;
    system_.follow(state);
    if (!index1_.evaluate_closely(state, acceleration, lambda, of_forces) || !by(state, lambda, u))
      return false;
    VectorXd rows(lambda.size()), weakest(lambda.size()), x(state.z.size()), change(u.size());
    for (Index r = 0; r < rows.size(); ++r) rows[r] = std::cos(1.0 + static_cast<double>(r));
    answer(rows, x, weakest);
    for (Index r = 0; r < rows.size(); ++r) of_forces[r] = std::copysign(of_forces[r], weakest[r]);
    if (!expand(of_forces, change)) return false;
    doubt = change.lpNorm<Eigen::Infinity>();
    return true;
  }

  // The largest coordinate of what the constraints' second order in u moves the state on by [m].
  double second_order(const State& state, const VectorXd& u) {
    VectorXd q(u.size()), rows(G_.rows()), there(G_.rows()), x(state.z.size());
    system_.follow(state);
    system_.expand(state.z, q);
    system_.jacobian(q, G_, scratch_);
    if (!saddle_.factorise(G_)) return std::numeric_limits<double>::infinity();
    system_.constraint(state.t, q, rows);
    for (const VectorXd& end : {VectorXd(q + u), VectorXd(q - u)}) {
      system_.constraint(state.t, end, there);
      rows -= 0.5 * there;
    }
    answer(rows, x, there);
    system_.expand_rate(x, q);
    return q.lpNorm<Eigen::Infinity>();
  }

 private:
  // Without what redundant rows hold of it.
  void answer(VectorXd& rows, VectorXd& x, VectorXd& y) {
    const VectorXd none = VectorXd::Zero(x.size());
    saddle_.solve(none, rows, x, y);
    rows.noalias() = G_ * x;
    saddle_.solve(none, rows, x, y);
  }

  bool by(const State& state, VectorXd& lambda, VectorXd& u) {
    VectorXd q(system_.coordinates());
    system_.expand(state.z, q);
    sharing_->share(state.t, q, false, lambda);
    compliance_ = row_compliance(model_, state.t);
    system_.jacobian(q, G_, scratch_);
    return saddle_.factorise(G_) && expand(lambda, u);
  }

  // u of G u = C lambda.
  bool expand(const VectorXd& lambda, VectorXd& u) {
    VectorXd x(system_.solved_coordinates()), y(lambda.size());
    saddle_.solve(VectorXd::Zero(x.size()), compliance_.cwiseProduct(lambda), x, y);
    if (!x.allFinite()) return false;
    VectorXd q(system_.coordinates());
    system_.expand_rate(x, q);
    u = q;
    return true;
  }

  const Model& model_;
  System system_;  // follows the states
  SparseRows G_;
  std::vector<double> scratch_;
  VectorXd compliance_;
  Index1 index1_;
  SaddleSolver saddle_;
  std::optional<ElasticSharing> sharing_;
};

// The displacements of a run's states, found in their order.
class StretchedRun {
  static constexpr double rough = 1e-6;

 public:
  explicit StretchedRun(const Trajectory& trajectory)
      : trajectory_(trajectory), u_(trajectory.size()), good_(trajectory.size(), 0) {}

  std::vector<VectorXd> find() {
    VectorXd u = VectorXd::Zero(trajectory_.model().system.coordinates());
    for (std::size_t i = 0; i < u_.size(); ++i) {
      good_[i] = at(i).at(trajectory_.state(i), trajectory_.report(i).singular_event, u);
      u_[i] = u;
    }
    const std::vector<char> own = good_;
    std::vector<std::pair<std::size_t, double>> odd;
    for (std::size_t i = 0; i < u_.size(); ++i) {
      double doubt = std::numeric_limits<double>::infinity();
      if (!good_[i] || smooth(i)) continue;
      if (at(i).closely(trajectory_.state(i), u, doubt) && doubt <= rough * size(i)) continue;
      odd.emplace_back(i, doubt);
      if (doubt < std::numeric_limits<double>::infinity()) u_[i] = u;
    }
    for (const auto& [i, doubt] : odd) good_[i] = 0;
    for (const auto& [i, doubt] : odd) interpolate(i, doubt);
    for (std::size_t i = 1; i < u_.size(); ++i)
      if (!own[i]) u_[i] = limit(i);
    bool small = true;
    for (std::size_t i = 0; i < u_.size(); ++i)
      if (small = is_small(i, small); !small) u_[i].setZero();
    return std::move(u_);
  }

 private:
  Stretch& at(std::size_t i) {
    if (model_ != &trajectory_.model(i)) {
      model_ = &trajectory_.model(i);
      stretch_ = std::make_unique<Stretch>(*model_, trajectory_.node_positions(i));
    }
    return *stretch_;
  }

  // Nothing is smooth across an impact, a jump of what acts, a change of the model.
  bool joined(std::size_t before, std::size_t after) const {
    return &trajectory_.model(before) == &trajectory_.model(after) &&
           trajectory_.time(before) < trajectory_.time(after);
  }

  // The nearest good states on one side: the second as far behind the first as that is, where there is one,
  // so that it tells more than round-off.
  std::vector<std::size_t> beside(std::size_t i, int way, std::size_t most) const {
    std::vector<std::size_t> out;
    const auto apart = [&](std::size_t a, std::size_t b) {
      return std::abs(trajectory_.time(a) - trajectory_.time(b));
    };
    for (std::size_t j = i; way < 0 ? j > 0 : j + 1 < u_.size();) {
      const std::size_t next = way < 0 ? j - 1 : j + 1;
      if (!joined(std::min(j, next), std::max(j, next))) break;
      j = next;
      if (!good_[j] || (!out.empty() && apart(j, out.front()) < 0.9 * apart(out.front(), i))) continue;
      out.push_back(j);
      if (out.size() == most) break;
    }
    return out;
  }

  // The polynomial through the states, at that of state i.
  VectorXd through(const std::vector<std::size_t>& states, std::size_t i) const {
    const auto time = [&](std::size_t k) { return trajectory_.time(states[k]); };
    VectorXd out = VectorXd::Zero(u_[i].size());
    for (std::size_t k = 0; k < states.size(); ++k)
      out += lagrange_weight(k, states.size(), trajectory_.time(i), time) * u_[states[k]];
    return out;
  }

  bool smooth(std::size_t i) const {
    std::vector<std::size_t> states = beside(i, -1, 2), behind = beside(i, +1, 2);
    states.insert(states.end(), behind.begin(), behind.end());
    return states.size() == 4 && (through(states, i) - u_[i]).lpNorm<Eigen::Infinity>() <= rough * size(i);
  }

  // At the ends, where nothing is known behind: as the nearest. What differs by more than the doubt is no
  // answer, as beside a displacement that is infinite.
  void interpolate(std::size_t i, double doubt) {
    std::vector<std::size_t> states = beside(i, -1, 2);
    const std::vector<std::size_t> behind = beside(i, +1, 2);
    if (states.empty() && behind.empty()) return;
    if (states.empty() || behind.empty())
      states = {states.empty() ? behind.front() : states.front()};
    else
      states.insert(states.end(), behind.begin(), behind.end());
    VectorXd u = through(states, i);
    if ((u - u_[i]).lpNorm<Eigen::Infinity>() <= doubt) u_[i] = std::move(u);
  }

  // Of a singular pose, which has no displacement of its own, what those of the motion before it tend to: the
  // polynomial through six poses on the way to it, at the distance at which the last of them changes it
  // least. That of the state before where none tells, as beside forces that have no bound.
  VectorXd limit(std::size_t i) {
    constexpr std::size_t points = 6;
    constexpr double sum_of_weights = 63, told = 0.1;  // of the displacement
    const VectorXd& lambda = trajectory_.state(i).lambda;
    VectorXd best = u_[i - 1];
    if (!joined(i - 1, i) || !lambda.allFinite()) return best;
    std::size_t first = i - 1;
    while (first > 0 && i - first < 64 && joined(first - 1, first)) --first;
    const double end = trajectory_.time(i), step = end - trajectory_.time(i - 1);
    double least = told * size(i - 1);
    for (double apart = step / 256; static_cast<double>(points) * apart < end - trajectory_.time(first);
         apart *= 2) {
      std::vector<VectorXd> near(points);
      double worst = 0;
      for (std::size_t k = 0; k < points; ++k) {
        double doubt = 0;
        if (!at(i).closely(trajectory_.state_at(end - apart * static_cast<double>(k + 1)), near[k], doubt))
          return best;
        worst = std::max(worst, doubt);
      }
      const auto time = [&](std::size_t k) { return -static_cast<double>(k + 1); };
      const auto through = [&](std::size_t count) {
        VectorXd u = VectorXd::Zero(best.size());
        for (std::size_t k = 0; k < count; ++k) u += lagrange_weight(k, count, 0.0, time) * near[k];
        return u;
      };
      VectorXd u = through(points);
      const double off = (u - through(points - 1)).lpNorm<Eigen::Infinity>() + sum_of_weights * worst;
      if (off < least) least = off, best = std::move(u);
      if (least <= rough * size(i - 1)) break;
    }
    return best;
  }

  // Of first order: what the second order of the displacement adds is less than that. Next to a pose in which
  // rods lie in line, where the displacement is 1 / sine, it is more. It is looked at where turning makes a
  // rod longer by some part of what rods give: turns add up along a mast, and are none there. A singular pose
  // is as the one before it, from which its displacement comes.
  bool is_small(std::size_t i, bool before) {
    constexpr double negligible = 0.01;
    const VectorXd q = trajectory_.node_positions(i);
    double first = 0, second = 0;
    for (const Rod& rod : trajectory_.model(i).structure.rods) {
      const Vec3 along = q.segment<3>(3 * rod.b) - q.segment<3>(3 * rod.a),
                 u = u_[i].segment<3>(3 * rod.b) - u_[i].segment<3>(3 * rod.a);
      const double longer = along.normalized().dot(u);
      first = std::max(first, std::abs(longer));
      second = std::max(second, (u.squaredNorm() - longer * longer) / (2 * along.norm()));
    }
    if (second <= negligible * first) return true;
    if (trajectory_.report(i).singular_event) return before;
    return at(i).second_order(trajectory_.state(i), u_[i]) <= size(i);
  }

  double size(std::size_t i) const { return u_[i].lpNorm<Eigen::Infinity>(); }

  const Trajectory& trajectory_;
  std::vector<VectorXd> u_;
  std::vector<char> good_;
  const Model* model_ = nullptr;
  std::unique_ptr<Stretch> stretch_;
};

}  // namespace

void add_stretch(Trajectory& trajectory) {
  std::vector<VectorXd> u = StretchedRun(trajectory).find();
  for (std::size_t i = 0; i < u.size(); ++i) trajectory.add_stretch(i, std::move(u[i]));
}

}  // namespace unfurl
