// SPDX-License-Identifier: BSD-3-Clause
#include "core/structure/angle_sides.hpp"

#include "core/structure/change.hpp"

namespace unfurl {

UnitVector::UnitVector(const Vec3& d) : t(Vec3::Zero()), length(d.norm()), first(Mat3::Zero()) {
  if (!(length > 0)) return;
  t = d / length;
  first = (Mat3::Identity() - t * t.transpose()) / length;
}

Mat3 UnitVector::second(const Vec3& x) const {
  if (!(length > 0)) return Mat3::Zero();
  return (t.dot(x) * (3 * t * t.transpose() - Mat3::Identity()) - x * t.transpose() - t * x.transpose()) /
         (length * length);
}

AngleSides::AngleSides(const double* q, const std::vector<int>& stencil)
    : q_(q), stencil_(stencil), nodes_(static_cast<int>(stencil.size()) / 6) {
  for (int s = 0; s < 2; ++s) {
    Side& side = sides_[static_cast<std::size_t>(s)];
    if (!bends()) {
      side.d = part(q, s, 0);
      side.by[0] = -Mat3::Identity(), side.by[1] = Mat3::Identity();
      continue;
    }
    const UnitVector one(part(q, s, 0)), two(part(q, s, 1));
    side.d = share[0] * one.t + share[1] * two.t;
    side.by[0] = -share[0] * one.first, side.by[2] = share[1] * two.first;
    side.by[1] = -side.by[0] - side.by[2];
  }
}

Vec3 AngleSides::part(const double* x, int side, int k) const {
  const auto at = [&](Index i) -> Vec3 {
    const int c = stencil_[static_cast<std::size_t>(3 * i)];
    return {x[c], x[c + 1], x[c + 2]};
  };
  return at(node(side, k + 1)) - at(node(side, k));
}

void AngleSides::gradient(const Vec6& g, Eigen::Ref<VectorXd> out) const {
  for (int s = 0; s < 2; ++s)
    for (int k = 0; k < nodes_; ++k)
      out.segment<3>(3 * node(s, k)) =
          sides_[static_cast<std::size_t>(s)].by[static_cast<std::size_t>(k)] * g.segment<3>(3 * s);
}

void AngleSides::hessian(const Vec6& g, const Mat6& h, Eigen::Ref<MatrixXd> out) const {
  const auto by = [this](int s, int k) -> const Mat3& {
    return sides_[static_cast<std::size_t>(s)].by[static_cast<std::size_t>(k)];
  };
  for (int s = 0; s < 2; ++s)
    for (int r = 0; r < 2; ++r)
      for (int k = 0; k < nodes_; ++k)
        for (int l = 0; l < nodes_; ++l)
          out.block<3, 3>(3 * node(s, k), 3 * node(r, l)) = by(s, k) * h.block<3, 3>(3 * s, 3 * r) * by(r, l);
  if (!bends()) return;
  for (int s = 0; s < 2; ++s)
    for (int k = 0; k < 2; ++k) {
      const Mat3 own =
          share[static_cast<std::size_t>(k)] * UnitVector(part(q_, s, k)).second(g.segment<3>(3 * s));
      const Index a = 3 * node(s, k), b = 3 * node(s, k + 1);
      out.block<3, 3>(a, a) += own;
      out.block<3, 3>(b, b) += own;
      out.block<3, 3>(a, b) -= own;
      out.block<3, 3>(b, a) -= own;
    }
}

Vec6 AngleSides::rate(const double* v) const {
  Vec6 out;
  for (int s = 0; s < 2; ++s) {
    const auto& by = sides_[static_cast<std::size_t>(s)].by;
    out.segment<3>(3 * s) = bends() ? Vec3(by[2] * part(v, s, 1) - by[0] * part(v, s, 0)) : part(v, s, 0);
  }
  return out;
}

// Of t = d / |d|: (d + u) / |d + u| - d / |d| = (u - t (|d + u| - |d|)) / |d + u|
Vec6 AngleSides::change(const double* u) const {
  Vec6 out;
  for (int s = 0; s < 2; ++s) {
    if (!bends()) {
      out.segment<3>(3 * s) = part(u, s, 0);
      continue;
    }
    out.segment<3>(3 * s).setZero();
    for (int k = 0; k < 2; ++k) {
      const Vec3 d = part(q_, s, k), by = part(u, s, k);
      const Change length = root(dot_change(d, by, d, by));
      if (!(length.value + length.change > 0)) continue;  // a side that is not cut
      out.segment<3>(3 * s) += share[static_cast<std::size_t>(k)] * (by - UnitVector(d).t * length.change) /
                               (length.value + length.change);
    }
  }
  return out;
}

Vec6 AngleSides::second_rate(const double* v) const {
  Vec6 out = Vec6::Zero();
  for (int s = 0; s < 2 && bends(); ++s)
    for (int k = 0; k < 2; ++k) {
      const Vec3 along = part(v, s, k);
      out.segment<3>(3 * s) +=
          share[static_cast<std::size_t>(k)] * (UnitVector(part(q_, s, k)).second(along) * along);
    }
  return out;
}

}  // namespace unfurl
