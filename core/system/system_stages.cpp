// SPDX-License-Identifier: BSD-3-Clause
// What System offers to the steps of methods: kernels that work on all stages of a step at once, sizes, and
// the forces of rods that give.
#include "core/system/system_data.hpp"

#include <algorithm>
#include <cmath>

namespace unfurl {

const std::vector<int>& System::giving_rods() const {
  return data_->giving;
}
void System::giving_rod_forces(double t, const ConstVec& q, const ConstVec& v, MutVec force) const {
  if (data_->elastic_rods) data_->elastic_rods->forces(t, q.data(), v.data(), force.data());
}
void System::add_giving_rod_forces(const ConstVec& q, const ConstVec& force, double scale, MutVec f) const {
  if (data_->elastic_rods) data_->elastic_rods->add_forces(q.data(), force.data(), scale, f.data());
}

const ElasticRods* System::elastic_rods() const {
  return data_->elastic_rods;
}

void System::add_other_force(double t, const ConstVec& q, const ConstVec& v, const ConstVec& tension,
                             double scale, MutVec f) const {
  f += scale * constant_->force;
  const Moment at = moment(t, tension.data());
  for (const auto& block : data_->forces)
    if (!block->of_giving_rods()) block->add(at, q.data(), v.data(), scale, f.data());
}

bool System::by_tension() const {
  return std::any_of(data_->forces.begin(), data_->forces.end(),
                     [](const auto& block) { return block->by_tension(); });
}

SparseRows System::tension_derivatives(double t, const ConstVec& q, const ConstVec& v,
                                       const ConstVec& tension) const {
  ForceDerivative entries;
  for (const auto& block : data_->forces)
    block->tension_derivatives(moment(t, tension.data()), q.data(), v.data(), entries);
  SparseRows A(coordinates(), std::ssize(data_->giving));
  A.setFromTriplets(entries.begin(), entries.end());
  return SparseRows(data_->B_transposed * A);
}

SparseRows System::Data::reduced_forces(const ForceDerivative& derivative) const {
  return SparseRows(B_transposed * reduced_rows(derivative, coordinates));
}

SparseRows System::Data::reduced_rows(const ForceDerivative& derivative, Index count) const {
  SparseRows A(count, coordinates);
  A.setFromTriplets(derivative.begin(), derivative.end());
  return SparseRows(A * B);
}

void System::force_derivatives(double t, const ConstVec& q, const ConstVec& v,
                               ForceDerivatives& found) const {
  ForceDerivative &by_q = found.by_z.begin(data_->B), &by_v = found.by_w.begin(data_->B);
  for (const auto& block : data_->forces) block->derivatives(moment(t), q.data(), v.data(), by_q, by_v);
}

SparseRows System::felt_coordinates() const {
  return felt({});
}

SparseRows System::felt_coordinates(double t, const ConstVec& q, const ConstVec& v) const {
  ForceDerivative by_nodes;
  by_nodes.keeps_places = true;
  for (const auto& block : data_->forces)
    block->derivatives(moment(t), q.data(), v.data(), by_nodes, by_nodes);
  return felt(std::move(by_nodes));
}

SparseRows System::felt(ForceDerivative by_nodes) const {
  for (int i = 0; i < data_->coordinates; ++i) by_nodes.emplace_back(i, i, 1.0);
  std::vector<Eigen::Triplet<double>> whole;  // coordinates stand with the others of their node
  for (const auto& e : by_nodes)
    for (int k = 0; k < 3; ++k) whole.emplace_back(e.row(), e.col() - e.col() % 3 + k, 1.0);
  SparseRows A(data_->coordinates, data_->coordinates);
  A.setFromTriplets(whole.begin(), whole.end());
  return data_->B_transposed * A;
}

SparseRows System::giving_rod_directions(const ConstVec& q) const {
  ForceDerivative by_q;
  if (data_->elastic_rods) data_->elastic_rods->directions(q.data(), by_q);
  return data_->reduced_rows(by_q, std::ssize(data_->giving));
}

void System::giving_rod_rows(const ConstVec& q, const ConstVec& v, SparseRows& by_z, SparseRows& by_w) const {
  ForceDerivative by_q, by_v;
  if (data_->elastic_rods) data_->elastic_rods->row_derivatives(q.data(), v.data(), by_q, by_v);
  by_z = data_->reduced_rows(by_q, std::ssize(data_->giving));
  by_w = data_->reduced_rows(by_v, std::ssize(data_->giving));
}

void System::force_derivatives(double t, const ConstVec& q, const ConstVec& v, const ConstVec& tension,
                               SparseRows& by_z, SparseRows& by_w) const {
  ForceDerivative by_q, by_v;
  for (const auto& block : data_->forces)
    if (!block->of_giving_rods())
      block->derivatives(moment(t, tension.data()), q.data(), v.data(), by_q, by_v);
  if (data_->elastic_rods) data_->elastic_rods->turning(q.data(), tension.data(), by_q);
  by_z = data_->reduced_forces(by_q);
  by_w = data_->reduced_forces(by_v);
}

void System::reduce_sizes(const ConstVec& f, MutVec r) const {
  r.setZero();
  for (int i = 0; i < data_->B.outerSize(); ++i)
    for (SparseRows::InnerIterator it(data_->B, i); it; ++it) r[it.col()] += std::abs(it.value() * f[i]);
}

void System::expand_stages(const Interleaved& from_origin, Index first, Interleaved& Q) const {
  const SparseRows& B = data_->B;
  Interleaved moved;
  if (data_->origin.size() > 0) moved = from_origin.colwise() - data_->origin;
  const Interleaved& z = data_->origin.size() > 0 ? moved : from_origin;
  const Index stride = Q.cols();
  with_wide_columns(static_cast<int>(z.cols()), [&B, stride, from = z.data(), q0 = data_->q0.data(),
                                                 first_row = Q.data() + first](auto k) {
    constexpr LaneCount K = k();
    double* to = first_row;
    for (Index i = 0, rows = B.rows(); i < rows; ++i, to += stride)
      (Lanes<K>::all(q0[i]) + row_times<K>(B, i, from)).store(to);
  });
}

void System::reduce_force_stages(const Interleaved& f, Interleaved& r) const {
  with_wide_columns(static_cast<int>(f.cols()), [&B = data_->B_transposed, from = f.data(),
                                                 to = r.data()](auto k) { multiply<k()>(B, from, to); });
}

void System::constraint_stages(const double* t, const Interleaved& Q, Index first, Interleaved& phi,
                               StageScratch& scratch) const {
  const auto poses = static_cast<int>(phi.cols());
  Index row = 0;
  for (const ConstraintBlock* block : data_->kept) {
    const Index rows = block->rows();
    if (!block->values(poses, Q.data() + first, Q.cols(), phi.data() + row * poses)) {
      scratch.row.resize(rows);
      for (int c = 0; c < poses; ++c) {
        scratch.q = Q.col(first + c);
        block->value_at(moment(t[c]), scratch.q.data(), scratch.row.data());
        if (block->rheonomic()) block->add_target(0, t[c], -1.0, scratch.row.data());
        phi.col(c).segment(row, rows) = scratch.row;
      }
    }
    row += rows;
  }
  for (const int implied : data_->implied) phi.row(implied).setZero();
}

bool System::constraint_changes(const ConstVec& q0, const Interleaved& D, Interleaved& phi,
                                StageScratch& scratch) const {
  const auto poses = static_cast<int>(phi.cols());
  scratch.moves.resize(coordinates(), poses);
  with_wide_columns(poses, [&B = data_->B, from = D.data(), to = scratch.moves.data()](auto k) {
    multiply<k()>(B, from, to);
  });
  Index row = 0;
  for (const ConstraintBlock* block : data_->kept) {
    if (!block->changes(poses, q0.data(), scratch.moves.data(), phi.data() + row * poses)) return false;
    row += block->rows();
  }
  for (const int implied : data_->implied) phi.row(implied).setZero();
  return true;
}

void System::put_changes(const ConstVec& q0, const ConstVec& u, MutVec change) const {
  double* out = change.data();
  for (const ConstraintBlock* block : data_->kept) {
    block->changes(1, q0.data(), u.data(), out);
    out += block->rows();
  }
}

void System::add_constraint_force_stages(const Interleaved& Q, Index first, const Interleaved& lambda,
                                         const double* scale, Interleaved& f, StageScratch& scratch) const {
  const auto poses = static_cast<int>(lambda.cols());
  Index row = 0;
  for (const ConstraintBlock* block : data_->kept) {
    const Index rows = block->rows();
    if (!block->add_forces(poses, Q.data() + first, Q.cols(), lambda.data() + row * poses, scale, f.data()))
      for (int c = 0; c < poses; ++c) {
        scratch.q = Q.col(first + c);
        scratch.row = lambda.col(c).segment(row, rows);
        scratch.f = f.col(c);
        block->add_force(scratch.q.data(), scratch.row.data(), scale[c], scratch.f.data());
        f.col(c) = scratch.f;
      }
    row += rows;
  }
}

}  // namespace unfurl
