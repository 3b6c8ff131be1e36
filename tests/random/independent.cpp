// SPDX-License-Identifier: BSD-3-Clause
#include "tests/random/independent.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/random/quantities.hpp"

namespace unfurl::random {

namespace {

// The state with what each switch stands at.
struct Moment {
  double t = 0;
  Vector q, v;
};

class Solver {
 public:
  Solver(const Mechanism& m, const IndependentOptions& options)
      : m_(m), options_(options), M_(mass_matrix(m)) {
    for (std::size_t i = 0; i < m.points.size(); ++i)
      for (int k = 0; k < 3 && !m.points[i].fixed; ++k) free_.push_back(3 * static_cast<int>(i) + k);
    const auto n = static_cast<Eigen::Index>(free_.size());
    Matrix Mf(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j)
        Mf(i, j) = M_(free_[static_cast<std::size_t>(i)], free_[static_cast<std::size_t>(j)]);
    L_ = Eigen::LLT<Matrix>(Mf).matrixL();
    start_.q.resize(3 * static_cast<Eigen::Index>(m.points.size()));
    start_.v.setZero(start_.q.size());
    for (std::size_t i = 0; i < m.points.size(); ++i) {
      start_.q.segment<3>(3 * static_cast<Eigen::Index>(i)) = m.points[i].position;
      if (!m.points[i].fixed) start_.v.segment<3>(3 * static_cast<Eigen::Index>(i)) = m.points[i].velocity;
    }
    for (const Bar& bar : m.bars)
      lengths_.push_back((point(start_.q, bar.a) - point(start_.q, bar.b)).norm());
    for (const LinearRow& row : m.rows) row_values_.push_back(linear(row, start_.q));
    for (const Drive& d : m.drives)
      drive_values_.push_back(measure(d.length, d.nodes, d.direction, start_.q));
    held_.assign(m.stops.size(), false);
    for (const Twist& twist : m.twists) angles_.push_back(terms_of(twist, start_.q, 0).angle);
  }

  IndependentRun run(const std::vector<double>& times) {
    IndependentRun out;
    Moment now = start_;
    if (options_.perturbation > 0) perturb(now);
    project(now);
    if (const Rows rows = rows_at(now); rows.G.rows() > 0) {
      const double off = std::max(rows.phi.lpNorm<Eigen::Infinity>(),
                                  (rows.G * gather(now.v) - rows.rate).lpNorm<Eigen::Infinity>());
      if (off > 1e-12) why_ = "the constraints contradict one another";
    }
    signs_ = signs(now);
    std::vector<double> knots = knots_before(times.back());
    double h = 0.02;
    for (const double t : times) {
      while (now.t < t && why_.empty()) {
        double limit = t;
        for (const double knot : knots)
          if (knot > now.t + 1e-14) {
            limit = std::min(limit, knot);
            break;
          }
        h = advance(now, limit, std::min(h, 0.05));
      }
      if (!why_.empty()) break;
      out.states.push_back({now.t, now.q, now.v});
    }
    out.ok = why_.empty();
    out.why = why_;
    out.switches = switches_;
    return out;
  }

 private:
  double linear(const LinearRow& row, const Vector& x) const {
    double sum = 0;
    for (std::size_t i = 0; i < row.nodes.size(); ++i) sum += row.coefficients[i].dot(point(x, row.nodes[i]));
    return sum;
  }
  static double measure(bool length, const std::vector<int>& nodes, const Vec3& direction, const Vector& q) {
    return length ? (point(q, nodes[1]) - point(q, nodes[0])).norm() : direction.dot(point(q, nodes[0]));
  }
  static double measure_rate(bool length, const std::vector<int>& nodes, const Vec3& direction,
                             const Moment& s) {
    if (!length) return direction.dot(point(s.v, nodes[0]));
    const Vec3 d = point(s.q, nodes[1]) - point(s.q, nodes[0]);
    return d.dot(point(s.v, nodes[1]) - point(s.v, nodes[0])) / d.norm();
  }

  void perturb(Moment& now) {
    Dice dice(99);
    for (const int i : free_) now.v[i] += options_.perturbation * dice.between(-1, 1);
  }

  std::vector<double> knots_before(double end) const {
    std::vector<double> knots;
    for (const Load& load : m_.loads) knots.insert(knots.end(), load.times.begin(), load.times.end());
    for (const Drive& d : m_.drives)
      for (const double t : d.motion.knots()) knots.push_back(t);
    std::sort(knots.begin(), knots.end());
    knots.erase(std::remove_if(knots.begin(), knots.end(), [&](double t) { return t <= 0 || t >= end; }),
                knots.end());
    return knots;
  }

  // Rows of the constraints: residual, gradient, target rate, and what the acceleration must be along it.
  struct Rows {
    Matrix G;  // m x free
    Vector phi, rate, acceleration;
  };
  Rows rows_at(const Moment& s) const {
    const auto count = static_cast<Eigen::Index>(m_.bars.size() + m_.rows.size() + m_.drives.size()) +
                       std::count(held_.begin(), held_.end(), true);
    Rows r{Matrix::Zero(count, start_.q.size()), Vector(count), Vector(count), Vector(count)};
    Eigen::Index k = 0;
    // Half the square of a distance, as a length: (d^2 - l^2) / (2 l_0).
    const auto distance_row = [&](int a, int b, double l, double l1, double l2) {
      const Vec3 d = point(s.q, b) - point(s.q, a), u = point(s.v, b) - point(s.v, a);
      r.G.block<1, 3>(k, 3 * b) += d.transpose() / l;
      r.G.block<1, 3>(k, 3 * a) -= d.transpose() / l;
      r.phi[k] = (d.squaredNorm() - l * l) / (2 * l);
      r.rate[k] = l1;
      r.acceleration[k++] = (l1 * l1 - u.squaredNorm()) / l + l2;
    };
    for (std::size_t i = 0; i < m_.bars.size(); ++i)
      distance_row(m_.bars[i].a, m_.bars[i].b, lengths_[i], 0, 0);
    const auto linear_row = [&](const std::vector<int>& nodes, const std::vector<Vec3>& c, double phi,
                                double rate, double acceleration) {
      for (std::size_t i = 0; i < nodes.size(); ++i) r.G.block<1, 3>(k, 3 * nodes[i]) += c[i].transpose();
      r.phi[k] = phi, r.rate[k] = rate, r.acceleration[k++] = acceleration;
    };
    for (std::size_t i = 0; i < m_.rows.size(); ++i)
      linear_row(m_.rows[i].nodes, m_.rows[i].coefficients, linear(m_.rows[i], s.q) - row_values_[i], 0, 0);
    for (std::size_t i = 0; i < m_.drives.size(); ++i) {
      const Drive& d = m_.drives[i];
      const double value = drive_values_[i] + d.motion.value(s.t), first = d.motion.first(s.t),
                   second = d.motion.second(s.t);
      if (d.length)
        distance_row(d.nodes[0], d.nodes[1], value, first, second);
      else
        linear_row(d.nodes, {d.direction}, measure(false, d.nodes, d.direction, s.q) - value, first, second);
    }
    for (std::size_t i = 0; i < m_.stops.size(); ++i) {
      const Stop& stop = m_.stops[i];
      if (!held_[i]) continue;
      if (stop.length)
        distance_row(stop.nodes[0], stop.nodes[1], stop.limit, 0, 0);
      else
        linear_row(stop.nodes, {stop.direction}, measure(false, stop.nodes, stop.direction, s.q) - stop.limit,
                   0, 0);
    }
    Matrix free(count, static_cast<Eigen::Index>(free_.size()));
    for (std::size_t j = 0; j < free_.size(); ++j) free.col(static_cast<Eigen::Index>(j)) = r.G.col(free_[j]);
    r.G = free;
    return r;
  }

  Vector force(const Moment& s) const {
    Vector f = Vector::Zero(s.q.size());
    Vector g(s.q.size());
    for (Eigen::Index i = 0; i < g.size(); i += 3) g.segment<3>(i) = m_.gravity;
    f += M_ * g;
    for (std::size_t i = 0; i < m_.springs.size(); ++i) {
      const Spring& spring = m_.springs[i];
      if (spring.cable && !pulls(i)) continue;
      const Vec3 d = point(s.q, spring.b) - point(s.q, spring.a);
      const Vec3 pull = tension(spring, s) * d / d.norm();
      f.segment<3>(3 * spring.a) += pull;
      f.segment<3>(3 * spring.b) -= pull;
    }
    for (std::size_t i = 0; i < m_.twists.size(); ++i) {
      const Twist& twist = m_.twists[i];
      const TwistTerms terms = terms_of(twist, s.q, angles_[i]);
      const Vec3 hinge = -(terms.by_a + terms.by_b);
      const double rate = terms.by_a.dot(point(s.v, twist.a)) + terms.by_b.dot(point(s.v, twist.b)) +
                          hinge.dot(point(s.v, twist.hinge));
      const double torque = twist.stiffness * (terms.angle - twist.free_angle) + twist.damping * rate;
      f.segment<3>(3 * twist.a) -= torque * terms.by_a;
      f.segment<3>(3 * twist.b) -= torque * terms.by_b;
      f.segment<3>(3 * twist.hinge) -= torque * hinge;
    }
    for (const Load& load : m_.loads) f.segment<3>(3 * load.node) += load_factor(load, s.t) * load.force;
    for (const Follower& follower : m_.followers) {
      const Bar& bar = m_.bars[static_cast<std::size_t>(follower.bar)];
      f.segment<3>(3 * bar.b) += follower.force * (point(s.q, bar.b) - point(s.q, bar.a)).normalized();
    }
    for (const Drag& drag : m_.drags) f.segment<3>(3 * drag.node) -= drag.damping * point(s.v, drag.node);
    return f;
  }
  static double stretch(const Spring& spring, const Moment& s) {
    return (point(s.q, spring.b) - point(s.q, spring.a)).norm() - spring.free_length;
  }
  static double tension(const Spring& spring, const Moment& s) {
    return spring.stiffness * stretch(spring, s) +
           spring.damping * measure_rate(true, {spring.a, spring.b}, Vec3::Zero(), s);
  }

  Vector gather(const Vector& x) const {
    Vector out(static_cast<Eigen::Index>(free_.size()));
    for (std::size_t i = 0; i < free_.size(); ++i) out[static_cast<Eigen::Index>(i)] = x[free_[i]];
    return out;
  }
  void scatter_add(const Vector& x, Vector& out) const {
    for (std::size_t i = 0; i < free_.size(); ++i) out[free_[i]] += x[static_cast<Eigen::Index>(i)];
  }

  // In u = L^T a the mass is one: W = G L^-T, u = f + W^+ (acceleration - W f).
  using Decomposition = Eigen::CompleteOrthogonalDecomposition<Matrix>;
  Decomposition decompose(const Matrix& G, Matrix& W) const {
    W = L_.triangularView<Eigen::Lower>().solve(G.transpose()).transpose();
    Decomposition cod;
    cod.setThreshold(1e-7);
    cod.compute(W);
    return cod;
  }
  // Pivots between certain rank and certain dependence: a pose too near a singular one to say.
  void look_at_rank(const Decomposition& cod) {
    const Vector pivots = cod.matrixQTZ().diagonal().cwiseAbs();
    const double largest = pivots.size() > 0 ? pivots.maxCoeff() : 1;
    for (Eigen::Index i = 0; i < pivots.size(); ++i)
      if (pivots[i] < 3e-3 * largest && pivots[i] > 1e-11 * largest) why_ = "near a singular pose";
    if (rank_ >= 0 && cod.rank() != rank_) why_ = "the rank changes";
    rank_ = cod.rank();
  }
  Vector to_velocity(const Vector& u) const { return L_.transpose().triangularView<Eigen::Upper>().solve(u); }

  Vector acceleration(const Moment& s, Vector* multipliers = nullptr) const {
    const Rows rows = rows_at(s);
    const Vector f = L_.triangularView<Eigen::Lower>().solve(gather(force(s)));
    if (rows.G.rows() == 0) return to_velocity(f);
    Matrix W;
    const Decomposition cod = decompose(rows.G, W);
    const Vector change = cod.solve(rows.acceleration - W * f);
    if (multipliers) *multipliers = Decomposition(W.transpose()).solve(change);
    return to_velocity(f + change);
  }

  // Nearest point of the constraints and nearest velocity that keeps them, in the mass metric.
  void project(Moment& s) {
    for (int it = 0;; ++it) {
      const Rows rows = rows_at(s);
      if (rows.G.rows() == 0) return;
      Matrix W;
      const Decomposition cod = decompose(rows.G, W);
      if (it == 0) look_at_rank(cod);
      if (rows.phi.lpNorm<Eigen::Infinity>() < 1.2e-15 || it == 4) {
        if (rows.phi.lpNorm<Eigen::Infinity>() > 1e-9) why_ = "the constraints contradict one another";
        scatter_add(to_velocity(cod.solve(rows.rate - rows.G * gather(s.v))), s.v);
        return;
      }
      scatter_add(to_velocity(cod.solve(-rows.phi)), s.q);
    }
  }

  // Switches: what is positive or negative where. A cable has two (its stretch and its tension), a stop one:
  // its gap while it is free, its push while it is held.
  std::vector<double> switch_values(const Moment& s) const {
    std::vector<double> values;
    for (const Spring& spring : m_.springs) {
      if (!spring.cable) continue;
      values.push_back(stretch(spring, s));
      if (spring.damping > 0) values.push_back(tension(spring, s));
    }
    for (std::size_t i = 0; i < m_.stops.size(); ++i) values.push_back(held_[i] ? push(i, s) : gap(i, s));
    return values;
  }
  std::vector<bool> signs(const Moment& s) const {
    std::vector<bool> out;
    for (const double value : switch_values(s)) out.push_back(value > 0);
    return out;
  }
  bool pulls(std::size_t spring) const {
    std::size_t at = 0;
    for (std::size_t i = 0; i < spring; ++i)
      if (m_.springs[i].cable) at += m_.springs[i].damping > 0 ? 2 : 1;
    return signs_[at] && (m_.springs[spring].damping == 0 || signs_[at + 1]);
  }
  std::size_t first_stop() const { return signs_.size() - m_.stops.size(); }
  double gap(std::size_t i, const Moment& s) const {
    const Stop& stop = m_.stops[i];
    return (stop.lower ? 1 : -1) * (measure(stop.length, stop.nodes, stop.direction, s.q) - stop.limit);
  }
  double push(std::size_t i, const Moment& s) const {
    Vector multipliers;
    acceleration(s, &multipliers);
    const auto behind = std::count(held_.begin() + static_cast<std::ptrdiff_t>(i), held_.end(), true);
    return (m_.stops[i].lower ? 1 : -1) * multipliers[multipliers.size() - behind];
  }

  // One step, cut at the first switch; what the next step should be.
  double advance(Moment& now, double limit, double h) {
    const bool last = now.t + h >= limit * (1 - 1e-15);
    if (last) h = limit - now.t;
    double error = 0;
    Moment next = extrapolate(now, h, error);
    if (!(error <= 1)) {
      if (h < 1e-9) return why_ = "the step vanishes", h;
      return 0.5 * h * std::max(0.2, std::min(1.0, 0.9 * std::pow(std::max(error, 1e-3), -1.0 / 13)));
    }
    if (!signs_.empty())
      if (const auto hit = first_switch(now, next, h)) return pass(now, *hit), h;
    next.t = last ? limit : next.t;
    now = next;
    project(now);
    follow_angles(now);
    return h * std::min(2.0, 0.9 * std::pow(std::max(error, 1e-9), -1.0 / 13));
  }

  void follow_angles(const Moment& now) {
    for (std::size_t i = 0; i < m_.twists.size(); ++i) {
      angles_[i] = terms_of(m_.twists[i], now.q, angles_[i]).angle;
      if (m_.twists[i].axis.isZero() && (angles_[i] < 0.1 || angles_[i] > M_PI - 0.1))
        why_ = "a torsion spring near 0 or 180 deg";
    }
  }

  // Modified midpoint with n = 2, 4, ... 14 steps, extrapolated in 1/n^2 (Aitken and Neville): order 14.
  // `error` is relative to what is allowed.
  Moment extrapolate(const Moment& from, double h, double& error) const {
    const Vector y0 = pack(from), f0 = slope(from);
    std::vector<Vector> above, row;
    for (int j = 1; j <= 7; ++j) {
      row = {midpoint(from.t, y0, f0, h, 2 * j)};
      for (int k = 1; k < j; ++k) {
        const double ratio = static_cast<double>(j) / (j - k);
        row.push_back(row.back() +
                      (row.back() - above[static_cast<std::size_t>(k - 1)]) / (ratio * ratio - 1));
      }
      above = row;
    }
    const Vector& y = row.back();
    error = y.allFinite() ? (y - row[row.size() - 2]).lpNorm<Eigen::Infinity>() / options_.tolerance : 1e9;
    Moment to;
    to.t = from.t + h;
    unpack(y, from, to);
    return to;
  }

  Vector midpoint(double t, const Vector& y0, const Vector& f0, double h, int n) const {
    const double part = h / n;
    Vector before = y0, at = y0 + part * f0;
    Moment s;
    for (int i = 1; i < n; ++i) {
      s.t = t + i * part;
      unpack(at, start_, s);
      const Vector after = before + 2 * part * slope(s);
      before = at;
      at = after;
    }
    s.t = t + h;
    unpack(at, start_, s);
    return 0.5 * (at + before + part * slope(s));
  }

  Vector slope(const Moment& s) const {
    Vector f(2 * static_cast<Eigen::Index>(free_.size()));
    f << gather(s.v), acceleration(s);
    return f;
  }
  Vector pack(const Moment& s) const {
    Vector y(2 * static_cast<Eigen::Index>(free_.size()));
    y << gather(s.q), gather(s.v);
    return y;
  }
  void unpack(const Vector& y, const Moment& fixed, Moment& s) const {
    s.q = fixed.q;
    s.v = Vector::Zero(fixed.q.size());
    for (std::size_t i = 0; i < free_.size(); ++i) {
      s.q[free_[i]] = y[static_cast<Eigen::Index>(i)];
      s.v[free_[i]] = y[static_cast<Eigen::Index>(free_.size() + i)];
    }
  }

  struct Hit {
    std::size_t which;
    double step;
  };
  // The first switch that changes within the step: looked for at its eighths, so that two changes are seen.
  std::optional<Hit> first_switch(const Moment& from, const Moment& to, double h) const {
    std::optional<Hit> first;
    constexpr int parts = 8;
    double begin = 0;
    for (int k = 1; k <= parts && !first; ++k) {
      const double end = h * k / parts;
      double unused = 0;
      const auto values = switch_values(k == parts ? to : extrapolate(from, end, unused));
      for (std::size_t i = 0; i < values.size(); ++i) {
        if ((values[i] > 0) == signs_[i]) continue;
        const double at = root(from, i, begin, end);
        if (!first || at < first->step) first = Hit{i, at};
      }
      begin = end;
    }
    return first;
  }
  // Bisection and secants (Illinois) to round-off.
  double root(const Moment& from, std::size_t which, double low, double high) const {
    const auto value = [&](double step) {
      double unused = 0;
      return switch_values(step > 0 ? extrapolate(from, step, unused) : from)[which];
    };
    double at_low = value(low), at_high = value(high);
    if ((at_low > 0) == (at_high > 0)) return low;  // it was on the edge when the step began
    for (int it = 0; it < 80 && high - low > 1e-15; ++it) {
      const double middle = it % 4 == 3
                                ? 0.5 * (low + high)
                                : std::clamp((low * at_high - high * at_low) / (at_high - at_low), low, high);
      const double at = value(middle);
      if (std::abs(at) < 1e-16) return middle;
      if ((at > 0) == (at_low > 0))
        low = middle, at_low = at, at_high *= 0.5;
      else
        high = middle, at_high = at, at_low *= 0.5;
    }
    return high;
  }

  void pass(Moment& now, const Hit& hit) {
    double unused = 0;
    if (hit.step > 0) {
      now = extrapolate(now, hit.step, unused);
      project(now);
    }
    if (++switches_ > 60) why_ = "more than 60 switches";
    const std::size_t stops = first_stop();
    if (hit.which < stops) {
      signs_[hit.which] = !signs_[hit.which];
      return;
    }
    const std::size_t i = hit.which - stops;
    if (held_[i]) {
      held_[i] = false;  // it lets go; its gap opens from here
      rank_ = -1;
      signs_[hit.which] = true;
      return;
    }
    if (std::count(held_.begin(), held_.end(), true) > 0) why_ = "an impact while another stop is held";
    impact(i, now);
  }

  // J along the gap's gradient n, constraints answering: v+ = v + (1 + e) u / (n . r) r, r the response to n.
  void impact(std::size_t i, Moment& s) {
    const Stop& stop = m_.stops[i];
    Vector n = Vector::Zero(s.q.size());
    const double sign = stop.lower ? 1 : -1;
    if (stop.length) {
      const Vec3 d = (point(s.q, stop.nodes[1]) - point(s.q, stop.nodes[0])).normalized();
      n.segment<3>(3 * stop.nodes[1]) += sign * d;
      n.segment<3>(3 * stop.nodes[0]) -= sign * d;
    } else {
      n.segment<3>(3 * stop.nodes[0]) += sign * stop.direction;
    }
    const Rows rows = rows_at(s);
    Vector r = L_.triangularView<Eigen::Lower>().solve(gather(n));
    const double whole = r.squaredNorm();
    if (rows.G.rows() > 0) {
      Matrix W;
      const Decomposition cod = decompose(rows.G, W);
      r -= cod.solve(W * r);
    }
    if (r.squaredNorm() < 1e-6 * whole) why_ = "a stop that hardly anything can move";
    const double approach = -sign * measure_rate(stop.length, stop.nodes, stop.direction, s);
    if (approach < 5e-2) why_ = "a grazing contact";
    scatter_add((1 + stop.restitution) * approach / r.squaredNorm() * to_velocity(r), s.v);
    if (stop.restitution * approach > 5e-3) return;
    if (stop.restitution > 0) why_ = "a rebound too slow to be told from rest";
    held_[i] = true;
    rank_ = -1;
    project(s);
    if (!(push(i, s) > 1e-3)) why_ = "a stop on the edge of letting go";
  }

  const Mechanism& m_;
  IndependentOptions options_;
  Matrix M_, L_;
  std::vector<int> free_;
  Moment start_;
  std::vector<double> lengths_, row_values_, drive_values_, angles_;
  std::vector<bool> held_, signs_;
  Eigen::Index rank_ = -1;
  int switches_ = 0;
  std::string why_;
};

}  // namespace

IndependentRun solve_independently(const Mechanism& mechanism, const std::vector<double>& times,
                                   const IndependentOptions& options) {
  return Solver(mechanism, options).run(times);
}

}  // namespace unfurl::random
