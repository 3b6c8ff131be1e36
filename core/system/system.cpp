// SPDX-License-Identifier: BSD-3-Clause
#include "core/system/system.hpp"

#include <algorithm>
#include <numeric>

#include "core/constraints/linear_rows.hpp"
#include "core/forces/constant_forces.hpp"
#include "core/structure/node_positions.hpp"
#include "core/system/elimination_choice.hpp"
#include "core/system/mass_matrix.hpp"
#include "core/system/system_data.hpp"

namespace unfurl {
namespace {

int total_rows(const ConstraintBlocks& blocks) {
  return std::accumulate(blocks.begin(), blocks.end(), 0,
                         [](int sum, const auto* b) { return sum + b->rows(); });
}

std::size_t jacobian_entries(const ConstraintBlocks& blocks) {
  std::size_t count = 0;
  for (const ConstraintBlock* block : blocks)
    for (int r = 0; r < block->rows(); ++r) count += block->stencil(r).size();
  return count;
}

std::vector<int> sources_of(const ConstraintBlocks& blocks) {
  std::vector<int> sources;
  for (const ConstraintBlock* block : blocks)
    for (int r = 0; r < block->rows(); ++r) sources.push_back(block->source(r));
  return sources;
}

// out += scale * (derivative of g of this order) over all rows.
void add_targets(const ConstraintBlocks& blocks, int order, double t, double scale, MutVec out) {
  double* row = out.data();
  for (const ConstraintBlock* block : blocks) {
    if (block->rheonomic()) block->add_target(order, t, scale, row);
    row += block->rows();
  }
}

void values_at(const ConstraintBlocks& blocks, const Moment& at, const ConstVec& q, MutVec phi) {
  double* row = phi.data();
  for (const ConstraintBlock* block : blocks) {
    block->value_at(at, q.data(), row);
    if (block->rheonomic()) block->add_target(0, at.t, -1.0, row);
    row += block->rows();
  }
}

// Jacobian of `blocks` in node coordinates at q.
SparseRows node_jacobian(const ConstraintBlocks& blocks, const double* q, Index n) {
  std::vector<Eigen::Triplet<double>> entries;
  int row = 0;
  for (const ConstraintBlock* block : blocks) {
    std::vector<double> values(jacobian_entries({block}));
    block->jacobian(q, values.data());
    std::size_t e = 0;
    for (int r = 0; r < block->rows(); ++r, ++row)
      for (int c : block->stencil(r)) entries.emplace_back(row, c, values[e++]);
  }
  SparseRows G(row, n);
  G.setFromTriplets(entries.begin(), entries.end());
  return G;
}

}  // namespace

// Constraints with a massless node are eliminated in any case: such a node has no equation of motion and can
// only follow from others (a pin, the middle of a rod).
void System::Data::build_blocks(const Structure& structure, bool eliminate_linear) {
  const auto massless = [&](int node) { return !(node_mass.coeff(3 * node, 3 * node) > 0); };
  const auto follows = [&](const Constraint& c) {
    return std::any_of(c.nodes.begin(), c.nodes.end(), massless);
  };
  if (eliminate_linear || std::none_of(structure.constraints.begin(), structure.constraints.end(), follows))
    return add_blocks(structure, eliminate_linear);
  Structure rest = structure, following;
  following.nodes = structure.nodes;
  following.constraints = structure.constraints;
  for (std::size_t i = 0; i < structure.constraints.size();
       ++i)  // no kind: no row, but the others keep their index
    (follows(structure.constraints[i]) ? rest : following).constraints[i].kind.clear();
  add_blocks(following, true);
  add_blocks(rest, false);
}

void System::Data::add_blocks(const Structure& structure, bool eliminate_linear) {
  for (const ConstraintKind& kind : constraint_kinds()) {
    auto block = kind.make(structure);
    if (!block) continue;
    all.push_back(block.get());
    if (block->linear()) linear.push_back(block.get());
    (block->linear() && eliminate_linear ? leaving : kept).push_back(block.get());
    owned.push_back(std::move(block));
  }
}

void System::Data::build_coordinates() {
  linear_rows = total_rows(linear);
  eliminated = !leaving.empty();
  if (eliminated) {
    const VectorXd zero = VectorXd::Zero(coordinates);
    VectorXd phi(total_rows(leaving));
    Index at = 0;
    for (const ConstraintBlock* block : leaving) {
      block->value(zero.data(), phi.data() + at);
      at += block->rows();
    }
    LinearElimination e = choose_elimination(node_jacobian(leaving, zero.data(), coordinates), -phi,
                                             node_mass, node_jacobian(kept, start.data(), coordinates));
    if (!e.kept.empty()) {
      owned.push_back(linear_rows_of(leaving, e.kept, coordinates));
      kept.insert(kept.begin(), owned.back().get());
    }
    B = std::move(e.B);
    q0 = std::move(e.q0);
    free_coordinates = std::move(e.free_coordinates);
  } else {
    B.resize(coordinates, coordinates);
    B.setIdentity();
    q0 = VectorXd::Zero(coordinates);
    free_coordinates.resize(static_cast<std::size_t>(coordinates));
    std::iota(free_coordinates.begin(), free_coordinates.end(), 0);
  }
  B.makeCompressed();
  B_transposed = B.transpose();
  of_solved = RowSums(B);
  rows = total_rows(kept);
  int first = 0;
  for (const ConstraintBlock* block : kept) {
    const std::size_t before = drives.size();
    block->list_drives(drives);
    for (std::size_t d = before; d < drives.size(); ++d) drives[d].row += first;
    first += block->rows();
  }
  rheonomic = std::any_of(kept.begin(), kept.end(), [](const auto* block) { return block->rheonomic(); });
  lengths.resize(rows);
  Index row = 0;
  for (const ConstraintBlock* block : kept)
    for (int r = 0; r < block->rows(); ++r, ++row) {
      names.push_back(block->name(r));
      lengths[row] = block->length(r);
    }
  mass = SparseRows(B.transpose() * node_mass) * B;
  mass.makeCompressed();
  move_origin();
}

void System::Data::build_forces(const Structure& structure) {
  unloaded_force = VectorXd::Zero(coordinates);
  for (const ForceKind& kind : force_kinds()) {
    auto block = kind.make(structure, node_mass);
    if (!block) continue;
    if (const auto* rods = dynamic_cast<const ElasticRods*>(block.get())) elastic_rods = rods;
    if (!block->constant())
      forces.push_back(std::move(block));
    else if (kind.make != nodal_load_block)
      block->add(0.0, start.data(), start.data(), 1.0, unloaded_force.data());
  }
  gravity_force = node_mass * structure.gravity.replicate(coordinates / 3, 1);
  for (const int ghost : ghosts) gravity_force.segment<3>(3 * ghost).setZero();
  find_integrators(structure);
}

void System::Data::find_constraint_rows(std::size_t constraints) {
  constraint_rows.assign(constraints, -1);
  const std::vector<int> sources = sources_of(kept);
  for (std::size_t r = sources.size(); r-- > 0;)
    if (sources[r] >= 0) constraint_rows[static_cast<std::size_t>(sources[r])] = static_cast<int>(r);
}

// G_z = G B, entry by entry, so that evaluating it is one pass over precomputed sums.
void System::Data::build_jacobian_map() {
  struct Term {
    int row, column, source;
    double coefficient;
  };
  std::vector<Term> terms;
  int row = 0, source = 0;
  for (const ConstraintBlock* block : kept)
    for (int r = 0; r < block->rows(); ++r, ++row, row_ends.push_back(source))
      for (int c : block->stencil(r)) {
        for (SparseRows::InnerIterator it(B, c); it; ++it)
          terms.push_back({row, static_cast<int>(it.col()), source, it.value()});
        ++source;
      }
  std::stable_sort(terms.begin(), terms.end(), [](const Term& a, const Term& b) {
    return a.row != b.row ? a.row < b.row : a.column < b.column;
  });
  std::vector<Eigen::Triplet<double>> places;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    if (i == 0 || terms[i].row != terms[i - 1].row || terms[i].column != terms[i - 1].column) {
      places.emplace_back(terms[i].row, terms[i].column, 0.0);
      sums.begin_row();
    }
    sums.add(terms[i].source, terms[i].coefficient);
  }
  pattern.resize(rows, B.cols());
  pattern.setFromTriplets(places.begin(), places.end());
  pattern.makeCompressed();
  entries = static_cast<std::size_t>(source);
  for (const ConstraintBlock* block : kept) block_entries.push_back(jacobian_entries({block}));
}

void System::Data::build_stencils() {
  for (const ConstraintBlock* block : all) {
    const std::size_t before = all_columns.size();
    for (int r = 0; r < block->rows(); ++r) {
      const std::vector<int> stencil = block->stencil(r);
      all_columns.insert(all_columns.end(), stencil.begin(), stencil.end());
      all_row_ends.push_back(all_columns.size());
    }
    all_block_entries.push_back(all_columns.size() - before);
  }
}

System::System(const Structure& structure, bool eliminate_linear) {
  auto data = std::make_unique<Data>();
  data->coordinates = 3 * static_cast<Index>(structure.nodes.size());
  data->start = node_positions(structure);
  for (std::size_t i = 0; i < structure.nodes.size(); ++i)
    if (structure.nodes[i].ghost) data->ghosts.push_back(static_cast<int>(i));
  data->node_mass = node_mass_matrix(structure);
  data->build_blocks(structure, eliminate_linear);
  data->build_coordinates();
  data->check_kinds(structure);
  data->find_constraint_rows(structure.constraints.size());
  data->check_mass(structure);
  data->build_forces(structure);
  for (const Measure& angle : unfurl::followed_angles(structure).measures)
    data->followed.emplace_back(angle, structure.deployment);
  data->build_jacobian_map();
  data->build_stencils();
  data->rod_rows.assign(structure.rods.size(), -1);
  int row = static_cast<int>(data->rows);
  for (std::size_t i = structure.rods.size(); i-- > 0;)  // rods are the last kept block
    if (!structure.rods[i].gives) data->rod_rows[i] = --row;
  for (std::size_t i = 0; i < structure.rods.size(); ++i)
    if (structure.rods[i].gives) data->giving.push_back(static_cast<int>(i));
  data_ = std::move(data);
  set_loads(structure);
  std::vector<double> scratch;
  find_implied_rows();
  jacobian(data_->start, data_->pattern, scratch);  // tells which entries are large
}

System::~System() = default;
System::System(const System&) = default;
System::System(System&&) noexcept = default;

Index System::coordinates() const {
  return data_->coordinates;
}
const std::vector<int>& System::ghosts() const {
  return data_->ghosts;
}
Index System::integrals() const {
  return std::ssize(data_->integrators);
}
Index System::solved_coordinates() const {
  return data_->B.cols();
}
Index System::constraints() const {
  return data_->rows;
}
Index System::linear_constraints() const {
  return data_->linear_rows;
}
bool System::eliminated() const {
  return data_->eliminated;
}
void System::fill_mass() {
  SparseRows& mass = data_->mass;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(mass.rows() * mass.cols()));
  for (int i = 0; i < mass.rows(); ++i)
    for (int j = 0; j < mass.cols(); ++j) entries.emplace_back(i, j, mass.coeff(i, j));
  mass.setFromTriplets(entries.begin(), entries.end());
}

const SparseRows& System::mass() const {
  return data_->mass;
}
const SparseRows& System::node_mass() const {
  return data_->node_mass;
}
const VectorXd& System::constraint_lengths() const {
  return data_->lengths;
}
const std::vector<std::string>& System::constraint_names() const {
  return data_->names;
}
int System::constraint_row(int constraint) const {
  return data_->constraint_rows[static_cast<std::size_t>(constraint)];
}
const std::vector<int>& System::rod_rows() const {
  return data_->rod_rows;
}

void System::expand(const ConstVec& z, MutVec q) const {
  if (!data_->eliminated) {
    q = z;
    return;
  }
  if (data_->origin.size() == 0)
    data_->of_solved.of(z.data(), q.data());
  else
    data_->of_solved.of(VectorXd(z - data_->origin).data(), q.data());
  q = data_->q0 + q;
}

void System::expand_rate(const ConstVec& w, MutVec v) const {
  if (!data_->eliminated)
    v = w;
  else
    data_->of_solved.of(w.data(), v.data());
}

VectorXd System::reduce(const ConstVec& q) const {
  VectorXd z(solved_coordinates());
  for (Index i = 0; i < z.size(); ++i) z[i] = q[data_->free_coordinates[static_cast<std::size_t>(i)]];
  return z;
}

VectorXd System::reduce_rate(const ConstVec& v) const {
  return reduce(v);
}

void System::reduce_force(const ConstVec& f, MutVec r) const {
  if (!data_->eliminated)
    r = f;
  else
    r.noalias() = data_->B.transpose() * f;
}

void System::add_applied_force(double t, const ConstVec& q, const ConstVec& v, double scale, MutVec f) const {
  f += scale * constant_->force;
  for (const auto& block : data_->forces) block->add(moment(t), q.data(), v.data(), scale, f.data());
}

bool System::constant_forces() const {
  return data_->forces.empty();
}

void System::constraint(double t, const ConstVec& q, MutVec phi) const {
  values_at(data_->kept, moment(t), q, phi);
  for (const int row : data_->implied) phi[row] = 0;
}

bool System::rheonomic() const {
  return data_->rheonomic;
}

void System::target_rate(double t, MutVec rate) const {
  rate.setZero();
  if (data_->rheonomic) add_targets(data_->kept, 1, t, 1.0, rate);
}

void System::add_constraint_force(const ConstVec& q, const ConstVec& lambda, double scale, MutVec f) const {
  const double* in = lambda.data();
  for (const ConstraintBlock* block : data_->kept) {
    block->add_force(q.data(), in, scale, f.data());
    in += block->rows();
  }
}

void System::constraint_bias(double t, const ConstVec& q, const ConstVec& v, MutVec bias) const {
  double* out = bias.data();
  for (const ConstraintBlock* block : data_->kept) {
    block->bias(q.data(), v.data(), out);
    out += block->rows();
  }
  if (data_->rheonomic) add_targets(data_->kept, 2, t, -1.0, bias);
  for (const int row : data_->implied) bias[row] = 0;
}

SparseRows System::jacobian_pattern() const {
  return data_->pattern;
}

void System::jacobian(const ConstVec& q, SparseRows& G, std::vector<double>& scratch) const {
  scratch.resize(data_->entries);
  double* out = scratch.data();
  for (std::size_t b = 0; b < data_->kept.size(); ++b) {
    data_->kept[b]->jacobian(q.data(), out);
    out += data_->block_entries[b];
  }
  data_->sums.of(scratch.data(), G.valuePtr());
  if (data_->eliminated) data_->clear_rounding(scratch, G);
}

SparseRows System::curvature(const ConstVec& q, const ConstVec& lambda) const {
  std::vector<Eigen::Triplet<double>> entries;
  Index row = 0;
  for (const ConstraintBlock* block : data_->kept) {
    block->add_curvature(q.data(), lambda.data() + row, entries);
    row += block->rows();
  }
  SparseRows K(coordinates(), coordinates());
  K.setFromTriplets(entries.begin(), entries.end());
  return SparseRows(data_->B.transpose() * K) * data_->B;
}

const std::vector<Drive>& System::drives() const {
  return data_->drives;
}

void System::force_derivatives(double t, const ConstVec& q, const ConstVec& v, SparseRows& by_z,
                               SparseRows& by_w) const {
  ForceDerivative by_q, by_v;
  for (const auto& block : data_->forces) block->derivatives(moment(t), q.data(), v.data(), by_q, by_v);
  by_z = data_->reduced_forces(by_q);
  by_w = data_->reduced_forces(by_v);
}

Index System::all_constraints() const {
  return total_rows(data_->all);
}

void System::all_constraint_values(double t, const ConstVec& q, MutVec phi) const {
  values_at(data_->all, moment(t), q, phi);
}

void System::all_constraint_rates(double t, const ConstVec& q, const ConstVec& v, MutVec rate,
                                  std::vector<double>& scratch) const {
  scratch.resize(data_->all_columns.size());
  std::size_t entry = 0;
  for (std::size_t b = 0; b < data_->all.size(); ++b) {
    data_->all[b]->jacobian(q.data(), scratch.data() + entry);
    entry += data_->all_block_entries[b];
  }
  entry = 0;
  for (std::size_t r = 0; r < data_->all_row_ends.size(); ++r) {
    double sum = 0;
    for (; entry < data_->all_row_ends[r]; ++entry) sum += scratch[entry] * v[data_->all_columns[entry]];
    rate[static_cast<Index>(r)] = sum;
  }
  add_targets(data_->all, 1, t, -1.0, rate);
}

SparseRows System::all_jacobian(const ConstVec& q) const {
  return node_jacobian(data_->all, q.data(), coordinates());
}

std::vector<std::string> System::all_names() const {
  std::vector<std::string> names;
  for (const ConstraintBlock* block : data_->all)
    for (int r = 0; r < block->rows(); ++r) names.push_back(block->name(r));
  return names;
}

std::vector<int> System::implied_rows(const ConstVec& q) const {
  std::vector<int> rows;
  int first = 0;
  for (const ConstraintBlock* block : data_->all) {
    for (const int row : block->implied_rows(q.data())) rows.push_back(first + row);
    first += block->rows();
  }
  return rows;
}

std::vector<int> System::all_sources() const {
  return sources_of(data_->all);
}
std::vector<int> System::sources() const {
  return sources_of(data_->kept);
}

VectorXd System::all_lengths() const {
  VectorXd lengths(all_constraints());
  Index row = 0;
  for (const ConstraintBlock* block : data_->all)
    for (int r = 0; r < block->rows(); ++r) lengths[row++] = block->length(r);
  return lengths;
}

}  // namespace unfurl
