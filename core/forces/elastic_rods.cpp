// SPDX-License-Identifier: BSD-3-Clause
#include "core/forces/elastic_rods.hpp"

#include <algorithm>

namespace unfurl {
namespace {

std::vector<Rod> giving_rods_of(const Structure& structure) {
  std::vector<Rod> rods;
  for (const Rod& rod : structure.rods)
    if (rod.gives) rods.push_back(rod);
  return rods;
}

bool any_warmed(const std::vector<Rod>& rods) {
  return std::any_of(rods.begin(), rods.end(), [](const Rod& rod) { return rod.expansion != 0; });
}

// From a to b of a rod: direction and distance.
struct Span {
  Vec3 along;
  double length;
};

Span span_of(const Rod& rod, const double* q) {
  const Vec3 d = node_vector(q, rod.b) - node_vector(q, rod.a);
  const double length = d.norm();
  return {length > 0 ? Vec3(d / length) : Vec3(Vec3::Zero()), length};
}

double length_rate(const Rod& rod, const Span& span, const double* v) {
  return span.along.dot(node_vector(v, rod.b) - node_vector(v, rod.a));
}

// e': warming stretches nothing.
double stretch_rate(const Rod& rod, double t, const Span& span, const double* v) {
  return length_rate(rod, span, v) - rod.rest_rate(t);
}

void pull(const Rod& rod, const Vec3& force, double* f) {
  Eigen::Map<Vec3>(f + 3 * static_cast<Index>(rod.a)) += force;
  Eigen::Map<Vec3>(f + 3 * static_cast<Index>(rod.b)) -= force;
}

// + K on the rod's own coordinates and - K across: K of the relative motion of its nodes, as -dF/dx.
void add_block_of(const Rod& rod, const Mat3& K, ForceDerivative& out) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int a = 3 * rod.a, b = 3 * rod.b;
      out.emplace_back(a + i, a + j, -K(i, j));
      out.emplace_back(b + i, b + j, -K(i, j));
      out.emplace_back(a + i, b + j, K(i, j));
      out.emplace_back(b + i, a + j, K(i, j));
    }
}

// x on b's coordinates of row r, -x on a's.
void add_row_of(const Rod& rod, int r, const Vec3& x, ForceDerivative& out) {
  for (int i = 0; i < 3; ++i) {
    out.emplace_back(r, 3 * rod.a + i, -x[i]);
    out.emplace_back(r, 3 * rod.b + i, x[i]);
  }
}

// With c = damping_time / C, N = c e' = c (n . u - l'), u = v_b - v_a the relative velocity and P = 1 - n
// n^T:
//     dN/dd = c P u / |d|
class RodDampers final : public ForceBlock {
 public:
  explicit RodDampers(std::vector<Rod> rods) : rods_(std::move(rods)), warmed_(any_warmed(rods_)) {}
  bool constant() const override { return false; }
  bool of_giving_rods() const override { return true; }
  bool has_power() const override { return true; }
  bool dissipative() const override { return !warmed_; }
  bool dissipates() const override { return true; }
  bool supplies() const override { return warmed_; }

  void add(const Moment& at, const double* q, const double* v, double scale, double* f) const override {
    for (const Rod& rod : rods_) {
      const Span span = span_of(rod, q);
      pull(rod, (scale * coefficient(rod) * stretch_rate(rod, at.t, span, v)) * span.along, f);
    }
  }
  // -c e'^2, and the part -N l' of N = c e': with the axial forces known, ElasticRods has all of that.
  double power(const Moment& at, const double* q, const double* v) const override {
    double sum = dissipation(at, q, v);
    if (at.tension) return sum;
    for (const Rod& rod : rods_)
      if (rod.expansion != 0)
        sum -= coefficient(rod) * stretch_rate(rod, at.t, span_of(rod, q), v) * rod.rest_rate(at.t);
    return sum;
  }
  double dissipation(const Moment& at, const double* q, const double* v) const override {
    double sum = 0;
    for (const Rod& rod : rods_) {
      const double rate = stretch_rate(rod, at.t, span_of(rod, q), v);
      sum -= coefficient(rod) * rate * rate;
    }
    return sum;
  }
  void derivatives(const Moment& at, const double* q, const double* v, ForceDerivative& by_q,
                   ForceDerivative& by_v) const override {
    for (const Rod& rod : rods_) {
      const Span span = span_of(rod, q);
      const Vec3 u = node_vector(v, rod.b) - node_vector(v, rod.a);
      const Mat3 along = span.along * span.along.transpose(), across = Mat3::Identity() - along;
      const double c = coefficient(rod), tension = c * stretch_rate(rod, at.t, span, v);
      add_block_of(rod, c * along, by_v);
      add_block_of(rod, (c * span.along * (across * u).transpose() + tension * across) / span.length, by_q);
    }
  }

 private:
  static double coefficient(const Rod& rod) { return rod.damping_time / rod.compliance(); }
  std::vector<Rod> rods_;
  bool warmed_;
};

}  // namespace

ElasticRods::ElasticRods(const Structure& structure)
    : rods_(giving_rods_of(structure)), warmed_(any_warmed(rods_)) {}

void ElasticRods::add(const Moment& at, const double* q, const double*, double scale, double* f) const {
  for (const Rod& rod : rods_) {
    const Span span = span_of(rod, q);
    pull(rod, (scale * (span.length - rod.rest_length(at.t)) / rod.compliance()) * span.along, f);
  }
}

double ElasticRods::potential(const Moment& at, const double* q) const {
  double sum = 0;
  for (const Rod& rod : rods_) {
    const double e = span_of(rod, q).length - rod.rest_length(at.t);
    sum += 0.5 * e * e / rod.compliance();
  }
  return sum;
}

// What the explicit dependence of V on time puts in; with the axial forces known, dampers' share too.
double ElasticRods::power(const Moment& at, const double* q, const double*) const {
  double sum = 0;
  for (std::size_t i = 0; i < rods_.size(); ++i) {
    const Rod& rod = rods_[i];
    if (rod.expansion == 0) continue;
    const double tension =
        at.tension ? at.tension[i] : (span_of(rod, q).length - rod.rest_length(at.t)) / rod.compliance();
    sum -= tension * rod.rest_rate(at.t);
  }
  return sum;
}

// dF/dd of the relative motion d: n n^T / C + N / |d| (1 - n n^T)
void ElasticRods::derivatives(const Moment& at, const double* q, const double*, ForceDerivative& by_q,
                              ForceDerivative&) const {
  for (const Rod& rod : rods_) {
    const Span span = span_of(rod, q);
    const double k = 1 / rod.compliance(), tension = k * (span.length - rod.rest_length(at.t));
    const Mat3 along = span.along * span.along.transpose();
    add_block_of(rod, k * along + tension / span.length * (Mat3::Identity() - along), by_q);
  }
}

void ElasticRods::stretches(double t, const double* q, const double* v, double* e) const {
  for (const Rod& rod : rods_) {
    const Span span = span_of(rod, q);
    *e++ = span.length - rod.rest_length(t) + rod.damping_time * stretch_rate(rod, t, span, v);
  }
}

void ElasticRods::directions(const double* q, ForceDerivative& by_q) const {
  int row = 0;
  for (const Rod& rod : rods_) add_row_of(rod, row++, span_of(rod, q).along, by_q);
}

void ElasticRods::row_derivatives(const double* q, const double* v, ForceDerivative& by_q,
                                  ForceDerivative& by_v) const {
  int row = 0;
  for (const Rod& rod : rods_) {
    const Span span = span_of(rod, q);
    const Vec3 u = node_vector(v, rod.b) - node_vector(v, rod.a);
    const Vec3 across = (u - span.along.dot(u) * span.along) / span.length;
    add_row_of(rod, row, span.along + rod.damping_time * across, by_q);
    if (rod.damping_time > 0) add_row_of(rod, row, rod.damping_time * span.along, by_v);
    ++row;
  }
}

void ElasticRods::turning(const double* q, const double* force, ForceDerivative& by_q) const {
  for (const Rod& rod : rods_) {
    const Span span = span_of(rod, q);
    const Mat3 across = Mat3::Identity() - span.along * span.along.transpose();
    add_block_of(rod, *force++ / span.length * across, by_q);
  }
}

void ElasticRods::forces(double t, const double* q, const double* v, double* force) const {
  stretches(t, q, v, force);
  for (const Rod& rod : rods_) *force++ /= rod.compliance();
}

void ElasticRods::add_forces(const double* q, const double* force, double scale, double* f) const {
  for (const Rod& rod : rods_) pull(rod, scale * *force++ * span_of(rod, q).along, f);
}

std::unique_ptr<ForceBlock> elastic_rods_block(const Structure& structure, const SparseRows&) {
  return giving_rods_of(structure).empty() ? nullptr : std::make_unique<ElasticRods>(structure);
}

std::unique_ptr<ForceBlock> rod_dampers_block(const Structure& structure, const SparseRows&) {
  std::vector<Rod> rods = giving_rods_of(structure);
  std::erase_if(rods, [](const Rod& rod) { return !(rod.damping_time > 0); });
  return rods.empty() ? nullptr : std::make_unique<RodDampers>(std::move(rods));
}

}  // namespace unfurl
