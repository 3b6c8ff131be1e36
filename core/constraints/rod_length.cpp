// SPDX-License-Identifier: BSD-3-Clause
#include "core/constraints/rod_length.hpp"

#include <algorithm>

#include "core/math/interleaved.hpp"

namespace unfurl {
namespace {

class RodLength final : public ConstraintBlock {
 public:
  explicit RodLength(const Structure& structure) {
    for (const Rod& rod : structure.rods) {
      if (rod.gives) continue;
      if (rod.expansion != 0) warmed_.push_back({static_cast<int>(a_.size()), rod});
      a_.push_back(3 * rod.a);
      b_.push_back(3 * rod.b);
      length_.push_back(rod.length);
      name_.push_back("rod " + rod.name);
    }
  }
  int rows() const override { return static_cast<int>(a_.size()); }
  bool linear() const override { return false; }
  std::string name(int row) const override { return name_[static_cast<std::size_t>(row)]; }
  int source(int) const override { return -1; }
  double length(int row) const override { return length_[static_cast<std::size_t>(row)]; }
  std::vector<int> stencil(int row) const override {
    const int a = a_[static_cast<std::size_t>(row)], b = b_[static_cast<std::size_t>(row)];
    return {a, a + 1, a + 2, b, b + 1, b + 2};
  }

  void value(const double* q, double* phi) const override {
    for (std::size_t r = 0; r < a_.size(); ++r) {
      const double* xa = q + a_[r];
      const double* xb = q + b_[r];
      const double dx = xb[0] - xa[0], dy = xb[1] - xa[1], dz = xb[2] - xa[2], l = length_[r];
      phi[r] = (dx * dx + dy * dy + dz * dz - l * l) / (2.0 * l);
    }
  }

  void jacobian(const double* q, double* g) const override {
    for (std::size_t r = 0; r < a_.size(); ++r, g += 6) {
      const double inverse = 1.0 / length_[r];
      for (int k = 0; k < 3; ++k) {
        const double d = (q[b_[r] + k] - q[a_[r] + k]) * inverse;
        g[k] = -d;
        g[k + 3] = d;
      }
    }
  }

  void add_force(const double* q, const double* lambda, double scale, double* f) const override {
    for (std::size_t r = 0; r < a_.size(); ++r) {
      const double c = scale * lambda[r] / length_[r];
      for (int k = 0; k < 3; ++k) {
        const double d = c * (q[b_[r] + k] - q[a_[r] + k]);
        f[a_[r] + k] -= d;
        f[b_[r] + k] += d;
      }
    }
  }

  // A warmed rod has the length l (1 + e), e = alpha dT(t), and the row |d|^2 / 2l - l (1 + e)^2 / 2 = 0:
  // g = l (e + e^2 / 2), the axial force lambda (1 + e).
  bool rheonomic() const override { return !warmed_.empty(); }
  void add_target(int order, double t, double scale, double* out) const override {
    for (const auto& [row, rod] : warmed_) {
      const double e = rod.warmed(t), e1 = rod.warmed(t, 1);
      const double g = order == 0   ? e + 0.5 * e * e
                       : order == 1 ? (1 + e) * e1
                                    : (1 + e) * rod.warmed(t, 2) + e1 * e1;
      out[row] += scale * rod.length * g;
    }
  }

  bool values(int poses, const double* q, Index stride, double* phi) const override {
    if (!warmed_.empty()) return false;
    with_wide_columns(poses, [=, this](auto k) { values_of<k()>(q, stride, phi); });
    return true;
  }

  bool changes(int poses, const double* q0, const double* moves, double* phi) const override {
    if (!warmed_.empty()) return false;
    with_wide_columns(poses, [=, this](auto k) { changes_of<k()>(q0, moves, phi); });
    return true;
  }

  bool add_forces(int poses, const double* q, Index stride, const double* lambda, const double* scale,
                  double* f) const override {
    with_wide_columns(poses, [=, this](auto k) { add_forces_of<k()>(q, stride, lambda, scale, f); });
    return true;
  }

  void bias(const double*, const double* v, double* phi_dd) const override {
    for (std::size_t r = 0; r < a_.size(); ++r) {
      double square = 0;
      for (int k = 0; k < 3; ++k) {
        const double d = v[b_[r] + k] - v[a_[r] + k];
        square += d * d;
      }
      phi_dd[r] = square / length_[r];
    }
  }

  void curvature(const double*, const double* lambda, double* hess) const override {
    for (std::size_t r = 0; r < a_.size(); ++r, hess += 36) {
      const double c = lambda[r] / length_[r];
      std::fill(hess, hess + 36, 0.0);
      for (int k = 0; k < 3; ++k) {
        hess[7 * k] = hess[7 * (k + 3)] = c;
        hess[k * 6 + k + 3] = hess[(k + 3) * 6 + k] = -c;
      }
    }
  }

 private:
  template <LaneCount K>
  void values_of(const double* q, Index stride, double* phi) const {
    for (std::size_t r = 0; r < a_.size(); ++r, phi += K) {
      const double* const xa = q + a_[r] * stride;
      const double* const xb = q + b_[r] * stride;
      const Lanes<K> dx = Lanes<K>(xb) - Lanes<K>(xa), dy = Lanes<K>(xb + stride) - Lanes<K>(xa + stride),
                     dz = Lanes<K>(xb + 2 * stride) - Lanes<K>(xa + 2 * stride);
      const double l = length_[r];
      ((dx * dx + dy * dy + dz * dz - Lanes<K>::all(l * l)) / Lanes<K>::all(2.0 * l)).store(phi);
    }
  }

  // |d + u|^2 / 2l - |d|^2 / 2l = (d + u / 2) . u / l.
  template <LaneCount K>
  void changes_of(const double* q0, const double* moves, double* phi) const {
    for (std::size_t r = 0; r < a_.size(); ++r, phi += K) {
      const double* const from_a = moves + static_cast<Index>(a_[r]) * K;
      const double* const from_b = moves + static_cast<Index>(b_[r]) * K;
      Lanes<K> sum = Lanes<K>::all(0.0);
      for (int k = 0; k < 3; ++k) {
        const Lanes<K> u = Lanes<K>(from_b + k * K) - Lanes<K>(from_a + k * K);
        sum = sum + (Lanes<K>::all(q0[b_[r] + k] - q0[a_[r] + k]) + 0.5 * u) * u;
      }
      (sum / Lanes<K>::all(length_[r])).store(phi);
    }
  }

  template <LaneCount K>
  void add_forces_of(const double* q, Index stride, const double* lambda, const double* scale,
                     double* f) const {
    const Lanes<K> scales(scale);
    for (std::size_t r = 0; r < a_.size(); ++r, lambda += K) {
      const Lanes<K> tension = scales * Lanes<K>(lambda) / Lanes<K>::all(length_[r]);
      const double* const xa = q + a_[r] * stride;
      const double* const xb = q + b_[r] * stride;
      double* const fa = f + static_cast<Index>(a_[r]) * K;
      double* const fb = f + static_cast<Index>(b_[r]) * K;
      for (int k = 0; k < 3; ++k) {
        const Lanes<K> d = tension * (Lanes<K>(xb + k * stride) - Lanes<K>(xa + k * stride));
        (Lanes<K>(fa + k * K) - d).store(fa + k * K);
        (Lanes<K>(fb + k * K) + d).store(fb + k * K);
      }
    }
  }

  std::vector<int> a_, b_;  // first coordinate of each end
  std::vector<double> length_;
  std::vector<std::string> name_;
  std::vector<std::pair<int, Rod>> warmed_;  // row, rod
};

}  // namespace

std::unique_ptr<ConstraintBlock> rod_length_block(const Structure& structure) {
  const bool all_give =
      std::all_of(structure.rods.begin(), structure.rods.end(), [](const Rod& rod) { return rod.gives; });
  return all_give ? nullptr : std::make_unique<RodLength>(structure);
}

}  // namespace unfurl
