// SPDX-License-Identifier: BSD-3-Clause
#include "core/forces/rod_couples.hpp"

#include <algorithm>

#include "core/forces/damping.hpp"

namespace unfurl {
namespace {

// Of a rod that was cut to bend, from its first node `hinge`: its last one.
int end_of_whole(const Structure& structure, const Rod& rod, int hinge, int other) {
  if (rod.whole.empty()) return other;
  const Rod *first = nullptr, *last = nullptr;
  for (const Rod& part : structure.rods) {
    if (part.whole != rod.whole) continue;
    if (!first) first = &part;
    last = &part;
  }
  return first->a == hinge ? last->b : last->b == hinge ? first->a : other;
}

// Is some node a point of it by relations?
bool carries_a_pin(const Structure& structure, int rod) {
  std::vector<int> held;
  for (const Constraint& c : structure.constraints)
    if (c.kind == "relation") held.insert(held.end(), c.nodes.begin(), c.nodes.end());
  std::ranges::sort(held);
  held.erase(std::unique(held.begin(), held.end()), held.end());
  return std::ranges::any_of(held, [&](int node) {
    return std::ranges::any_of(rods_at_joint(structure, node), [&](const RodAtJoint& at) {
      return at.rod == static_cast<std::size_t>(rod) && at.from != node;
    });
  });
}

}  // namespace

RodCouples::Line::Line(const Structure& structure, int rod, int from) : hinge(from) {
  const Rod& r = structure.rods[static_cast<std::size_t>(rod)];
  other = r.a == hinge ? r.b : r.a;
  end = end_of_whole(structure, r, hinge, other);
}

bool RodCouples::Line::tells(const Measure& angle, std::size_t from) const {
  const int a = angle.nodes[from], b = angle.nodes[from + 1];
  return along(a, b) || along(b, a);
}

bool RodCouples::Line::tells(const Measure& measure) const {
  if (measure.kind == MeasureKind::angle) return tells(measure, 0) || tells(measure, 2);
  return std::ranges::any_of(measure.terms, [this](const MeasureTerm& term) { return tells(term.measure); });
}

bool RodCouples::Line::beside(const Measure& measure, const Deployment& deployment) const {
  const auto both = [this](const std::vector<int>& nodes) {
    return std::ranges::find(nodes, hinge) != nodes.end() && std::ranges::find(nodes, other) != nodes.end();
  };
  if (measure.kind == MeasureKind::dihedral) return both(measure.nodes);
  if (measure.kind == MeasureKind::fold)
    return both(deployment.fold_sine.nodes) || both(deployment.fold_cosine.nodes);
  return std::ranges::any_of(measure.terms,
                             [&](const MeasureTerm& term) { return beside(term.measure, deployment); });
}

RodCouples::RodCouples(const Structure& bare, const SparseRows& node_mass, const Rows& rows, int rod,
                       int hinge, const std::vector<char>& apart)
    : nodes_(static_cast<int>(bare.nodes.size())), line_(bare, rod, hinge) {
  for (std::size_t i = 0; i < bare.forces.size(); ++i) {
    const Force& force = bare.forces[i];
    if (apart[i]) {
      Measure measure = force.measure;
      Told told;
      tell(measure, told);
      if (!told.ends.empty())
        measures_.push_back({std::move(told), MeasureFunction(measure, bare.deployment), i});
    } else if (force.kind == "joint_damping") {
      Force damper = force;  // as joint_damping_block() has it
      damper.kind = "torsion_spring";
      damper.stiffness = 0;
      for (const Measure& angle : angles_at_joint(bare, force.nodes[0])) {
        damper.measure = angle;
        add_force(bare, node_mass, i, damper);
      }
    } else {
      add_force(bare, node_mass, i, force);
    }
  }
  add_rows(bare, rows, rod);
}

void RodCouples::add_force(const Structure& bare, const SparseRows& node_mass, std::size_t index,
                           const Force& force) {
  Force own = force;
  Told told;
  if (force.kind == "bending")
    told = tell_bending(force.nodes);
  else
    tell(own.measure, told);
  if (told.ends.empty()) return;
  Structure alone = bare;  // the others keep their places, but are of no kind
  for (Force& f : alone.forces) f.kind.clear();
  alone.forces[index] = std::move(own);
  for (const ForceKind& kind : force_kinds())
    if (kind.kind == force.kind)
      if (auto block = kind.make(alone, node_mass)) forces_.push_back({std::move(told), std::move(block)});
}

void RodCouples::add_rows(const Structure& bare, const Rows& rows, int rod) {
  const bool carries = carries_a_pin(bare, rod);
  int before = -1;  // the constraint of the last row
  Index row = -1;
  for (const auto& block : rows)
    for (int k = 0; k < block->rows(); ++k) {
      ++row;
      if (block->source(k) < 0 || block->source(k) == before) continue;
      before = block->source(k);
      Constraint own = bare.constraints[static_cast<std::size_t>(before)];
      Told told;
      if (own.kind == "measure") tell(own.measure, told);
      if (holds_on_rod(bare, own, carries)) told.ends.push_back({line_.hinge, -1.0});
      if (told.ends.empty()) continue;
      Structure alone = bare;
      alone.constraints = {own};
      for (const int node : told.nodes)  // a row of angles is as long as the edges that these begin with
        alone.nodes.push_back(bare.nodes[static_cast<std::size_t>(node)]);
      for (const ConstraintKind& kind : constraint_kinds())
        if (kind.kind == own.kind) rows_.push_back({std::move(told), kind.make(alone), row});
    }
}

// Does it hold a node on R?
bool RodCouples::holds_on_rod(const Structure& bare, const Constraint& c, bool carries) const {
  const auto has = [&](int node) { return std::ranges::find(c.nodes, node) != c.nodes.end(); };
  if (c.nodes.size() < 3 || !has(line_.hinge) || !has(line_.other)) return false;
  if (c.kind == "relation") return carries && !c.symmetry;
  if (c.kind != "collinear") return false;
  // A rod along the line through its first two nodes is it; else R is, on that line.
  const int a = c.nodes[0], b = c.nodes[1];
  return (c.nodes[2] != line_.hinge && c.nodes[2] != line_.other) ||
         std::ranges::none_of(bare.rods, [&](const Rod& rod) {
           return (rod.a == a && rod.b == b) || (rod.a == b && rod.b == a);
         });
}

// Gives nodes of their own to angles, and says which of them R tells.
void RodCouples::tell(Measure& measure, Told& told) const {
  for (MeasureTerm& term : measure.terms) tell(term.measure, told);
  if (measure.kind != MeasureKind::angle) return;
  const int first = nodes_ + static_cast<int>(told.nodes.size());
  for (const int from : {0, 2}) {
    if (!line_.tells(measure, static_cast<std::size_t>(from))) continue;
    const bool outwards = measure.nodes[static_cast<std::size_t>(from)] == line_.hinge;
    told.ends.push_back({first + from + (outwards ? 1 : 0), 1.0});
  }
  told.nodes.insert(told.nodes.end(), measure.nodes.begin(), measure.nodes.end());
  measure.nodes = {first, first + 1, first + 2, first + 3};
}

// Nothing else of it acts on its outer nodes.
RodCouples::Told RodCouples::tell_bending(const std::vector<int>& n) const {
  Told told;
  for (const auto& [outer, middle] : {std::pair{n[0], n[1]}, std::pair{n[2], n[1]}}) {
    if (outer == line_.hinge && middle == line_.other) told.ends.push_back({outer, -1.0});
    if (outer == line_.other && middle == line_.hinge) told.ends.push_back({outer, 1.0});
  }
  return told;
}

VectorXd RodCouples::with_own(const double* x, const Told& told) const {
  const auto own = std::ssize(told.nodes);
  VectorXd out(3 * (nodes_ + own));
  out.head(3 * nodes_) = Eigen::Map<const VectorXd>(x, 3 * nodes_);
  for (Index i = 0; i < own; ++i)
    out.segment<3>(3 * (nodes_ + i)) = node_vector(x, told.nodes[static_cast<std::size_t>(i)]);
  return out;
}

Vec3 RodCouples::of_forces(const Moment& at, const double* q, const double* v) const {
  Vec3 sum = Vec3::Zero();
  for (const OfForce& f : forces_) {
    const VectorXd x = with_own(q, f.told), rate = with_own(v, f.told);
    VectorXd force = VectorXd::Zero(x.size());
    f.block->add(at, x.data(), rate.data(), 1.0, force.data());
    for (const End& end : f.told.ends) sum += end.sign * node_vector(force.data(), end.node);
  }
  return sum;
}

Vec3 RodCouples::of_rows(const double* q, const VectorXd& lambda) const {
  Vec3 sum = Vec3::Zero();
  for (const OfRow& r : rows_) {
    const VectorXd x = with_own(q, r.told);
    VectorXd force = VectorXd::Zero(x.size());
    r.block->add_force(x.data(), &lambda[r.row], 1.0, force.data());
    for (const End& end : r.told.ends) sum -= end.sign * node_vector(force.data(), end.node);
  }
  return sum;
}

Vec3 RodCouples::of_measure(std::size_t force, const double* q) const {
  Vec3 sum = Vec3::Zero();
  for (const OfMeasure& m : measures_) {
    if (m.force != force) continue;
    const VectorXd x = with_own(q, m.told);
    const std::vector<int>& stencil = m.measure.stencil();
    VectorXd gradient(std::ssize(stencil)), along = VectorXd::Zero(x.size());
    m.measure.value_and_gradient(x.data(), gradient.data());
    for (std::size_t i = 0; i < stencil.size(); ++i) along[stencil[i]] += gradient[static_cast<Index>(i)];
    for (const End& end : m.told.ends) sum += end.sign * node_vector(along.data(), end.node);
  }
  return sum;
}

}  // namespace unfurl
