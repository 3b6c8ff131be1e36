// SPDX-License-Identifier: BSD-3-Clause
#include "core/constraints/measure_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/constraints/linear_rows.hpp"
#include "core/structure/measure.hpp"

namespace unfurl {
namespace {

// From one of a measure's nodes to another one, at t = 0 [m].
double edge_of(const Structure& structure, const Measure& measure, std::size_t a, std::size_t b) {
  const auto at = [&](std::size_t k) -> const Vec3& {
    return structure.nodes[static_cast<std::size_t>(measure.nodes[k])].position;
  };
  return (at(b) - at(a)).norm();
}

}  // namespace

double row_arm(const Structure& structure, const Measure& measure) {
  constexpr double none = 1e-9;  // of that
  const double whole = reference_length(structure);
  double shortest = std::numeric_limits<double>::infinity();
  const auto edge = [&](std::size_t a, std::size_t b) {
    if (const double length = edge_of(structure, measure, a, b); length > none * whole)
      shortest = std::min(shortest, length);
  };
  if (measure.kind == MeasureKind::angle || measure.kind == MeasureKind::dihedral) edge(0, 1), edge(2, 3);
  for (const MeasureTerm& term : measure.terms)
    shortest = std::min(shortest, row_arm(structure, term.measure));
  return std::isfinite(shortest) ? shortest : whole;
}

namespace {

struct Measured {
  std::string name;
  int source;  // index in Structure::constraints
  MeasureFunction measure;
  TimeFunction target;
  double scale;   // l
  double length;  // that errors are relative to [m]
  int followed;   // the first of its angles among those that count turns; -1: at the nearest turn
};

class MeasureRows final : public ConstraintBlock {
 public:
  explicit MeasureRows(std::vector<Measured> rows) : rows_(std::move(rows)) {}
  int rows() const override { return static_cast<int>(rows_.size()); }
  bool linear() const override { return false; }
  bool rheonomic() const override { return true; }
  std::string name(int row) const override { return at(row).name; }
  int source(int row) const override { return at(row).source; }
  double length(int row) const override { return at(row).length; }
  std::vector<int> stencil(int row) const override { return at(row).measure.stencil(); }

  void value(const double* q, double* phi) const override {
    for (const Measured& row : rows_) *phi++ = row.scale * row.measure.value(q);
  }
  void value_at(const Moment& at, const double* q, double* phi) const override {
    for (const Measured& row : rows_) *phi++ = row.scale * row.measure.value(q, at, row.followed);
  }
  bool changes(int poses, const double* q0, const double* moves, double* phi) const override {
    if (poses != 1) return false;
    for (const Measured& row : rows_) *phi++ = row.scale * row.measure.change(q0, moves);
    return true;
  }
  void list_drives(std::vector<Drive>& drives) const override {
    for (std::size_t r = 0; r < rows_.size(); ++r)
      if (rows_[r].target.moves())
        drives.push_back({rows_[r].name, rows_[r].source, static_cast<int>(r), rows_[r].scale,
                          rows_[r].measure.is_angle(), rows_[r].target});
  }
  void add_target(int order, double t, double scale, double* out) const override {
    for (const Measured& row : rows_) {
      double target = row.target.derivative(order, t);
      // Turns go before the two meet: what is left has the digits of one turn, however many there were.
      const bool turns = order == 0 && row.measure.wraps();
      if (turns) target = std::remainder(target, 2 * pi);
      *out += scale * row.scale * target;
      if (turns) *out = std::remainder(*out, 2 * pi * row.scale);
      ++out;
    }
  }
  void jacobian(const double* q, double* g) const override {
    for (const Measured& row : rows_) {
      const std::size_t size = row.measure.stencil().size();
      row.measure.value_and_gradient(q, g);
      for (std::size_t i = 0; i < size; ++i) g[i] *= row.scale;
      g += size;
    }
  }
  void add_force(const double* q, const double* lambda, double scale, double* f) const override {
    std::vector<double> g;
    for (const Measured& row : rows_) {
      const auto& stencil = row.measure.stencil();
      g.resize(stencil.size());
      row.measure.value_and_gradient(q, g.data());
      for (std::size_t i = 0; i < stencil.size(); ++i) f[stencil[i]] += scale * *lambda * row.scale * g[i];
      ++lambda;
    }
  }
  void bias(const double* q, const double* v, double* phi_dd) const override {
    for (const Measured& row : rows_) *phi_dd++ = row.scale * row.measure.curvature_along(q, v);
  }
  void add_curvature(const double* q, const double* lambda,
                     std::vector<Eigen::Triplet<double>>& entries) const override {
    for (const Measured& row : rows_) row.measure.add_hessian(q, *lambda++ * row.scale, entries);
  }
  void curvature(const double* q, const double* lambda, double* hess) const override {
    for (const Measured& row : rows_) {
      const std::size_t entries = row.measure.stencil().size() * row.measure.stencil().size();
      row.measure.hessian(q, hess);
      for (std::size_t i = 0; i < entries; ++i) hess[i] *= *lambda * row.scale;
      hess += entries;
      ++lambda;
    }
  }

 private:
  const Measured& at(int row) const { return rows_[static_cast<std::size_t>(row)]; }
  std::vector<Measured> rows_;
};

}  // namespace

std::unique_ptr<ConstraintBlock> measure_block(const Structure& structure) {
  std::vector<Measured> rows;
  const double length = reference_length(structure);
  const std::vector<int> followed = followed_angles(structure).of_constraint;
  for (std::size_t i = 0; i < structure.constraints.size(); ++i) {
    const Constraint& c = structure.constraints[i];
    if (c.kind != "measure") continue;
    MeasureFunction measure(c.measure, structure.deployment);
    const bool angle = measure.is_angle();
    const double own = angle ? row_arm(structure, c.measure) : length, scale = angle ? own : 1.0;
    double terms = 1;  // a row of large coefficients is as large, where these have no unit
    const auto turns = [](const MeasureTerm& term) { return unfurl::is_angle(term.measure); };
    const auto rotor = [&](const MeasureTerm& term) {
      return term.measure.kind == MeasureKind::coordinate &&
             structure.nodes[static_cast<std::size_t>(term.measure.nodes[0])].ghost;
    };
    const bool turns_rotor =  // whose coordinate is an angle, beside that of its joint
        std::ranges::any_of(c.measure.terms, rotor) && std::ranges::any_of(c.measure.terms, turns);
    double sum = 0;  // of lengths, as of a cable's: known to what rounding it leaves
    if (angle || std::ranges::none_of(c.measure.terms, turns))
      for (const MeasureTerm& term : c.measure.terms) {
        terms = std::max(terms, std::abs(term.coefficient));
        if (term.measure.kind == MeasureKind::length)
          sum += std::abs(term.coefficient) * edge_of(structure, term.measure, 0, 1);
      }
    rows.push_back({c.name, static_cast<int>(i), std::move(measure), c.target, scale,
                    std::max(terms * (turns_rotor ? 1.0 : own), sum), followed[i]});
  }
  if (rows.empty()) return nullptr;
  return std::make_unique<MeasureRows>(std::move(rows));
}

}  // namespace unfurl
