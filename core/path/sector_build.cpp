// SPDX-License-Identifier: BSD-3-Clause
#include "core/path/sector_build.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "core/forces/damping.hpp"
#include "core/math/linear_elimination.hpp"
#include "core/structure/node_positions.hpp"

namespace unfurl {
namespace {

class SectorBuilder {
 public:
  SectorBuilder(const Structure& whole, const System& system, const Symmetry& symmetry)
      : whole_(whole), system_(system), symmetry_(symmetry) {}

  SectorStructure build() {
    take_nodes();
    take_rods();
    take_constraints();
    take_forces();
    take_deployment();
    for (const Load& load : whole_.loads)
      if (const int node = out_.node_at[place(load.node)]; node >= 0)
        s().loads.push_back({node, load.force, load.shown});
    take_linear_rows();
    tie_images();
    s().kind = whole_.kind;
    s().gravity = whole_.gravity;
    s().lumped_mass = whole_.lumped_mass;
    s().notes = whole_.notes;
    show_as_solved(s());
    s().sectors = whole_.sectors * symmetry_.order;
    return std::move(out_);
  }

 private:
  static std::size_t place(int i) { return static_cast<std::size_t>(i); }
  Structure& s() { return out_.structure; }
  const TurnedImage& image(int node) const { return symmetry_.nodes[place(node)]; }

  void take_nodes() {
    out_.node_at.assign(whole_.nodes.size(), -1);
    for (std::size_t i = 0; i < whole_.nodes.size(); ++i) {
      if (symmetry_.nodes[i].turns != 0) continue;
      out_.node_at[i] = static_cast<int>(s().nodes.size());
      s().nodes.push_back(whole_.nodes[i]);
    }
  }

  // Of a node of the whole; an image is made where the sector has none yet.
  int node(int of_whole) {
    if (const int kept = out_.node_at[place(of_whole)]; kept >= 0) return kept;
    const auto [found, made] = images_.try_emplace(of_whole, static_cast<int>(s().nodes.size()));
    if (!made) return found->second;
    const Node& source = whole_.nodes[place(image(of_whole).source)];
    Node copy = whole_.nodes[place(of_whole)];
    copy.position = symmetry_.turned(source.position, image(of_whole).turns);
    copy.velocity = symmetry_.turn(image(of_whole).turns) * source.velocity;
    copy.mass = 0;
    s().nodes.push_back(std::move(copy));
    return found->second;
  }
  std::vector<int> nodes(std::vector<int> of_whole) {
    for (int& i : of_whole) i = node(i);
    return of_whole;
  }
  Measure measure(Measure of_whole) {
    of_whole.nodes = nodes(of_whole.nodes);
    for (MeasureTerm& term : of_whole.terms) term.measure = measure(term.measure);
    return of_whole;
  }

  void take_rods() {
    out_.rod_at.assign(whole_.rods.size(), -1);
    for (std::size_t i = 0; i < whole_.rods.size(); ++i) {
      if (symmetry_.rods[i].turns != 0) continue;
      out_.rod_at[i] = static_cast<int>(s().rods.size());
      Rod rod = whole_.rods[i];
      rod.a = node(rod.a);
      rod.b = node(rod.b);
      s().rods.push_back(std::move(rod));
    }
  }

  // On the whole ring act only measures that are the same in every sector's eyes.
  void require_fold(const Measure& measure, const std::string& name) const {
    if (measure.kind != MeasureKind::fold)
      throw SectorRefused(name + " acts on the whole ring, by something else than its fold angle");
  }

  void take_constraints() {
    out_.constraint_at.assign(whole_.constraints.size(), -1);
    for (std::size_t i = 0; i < whole_.constraints.size(); ++i) {
      const Constraint& c = whole_.constraints[i];
      if (is_linear(c) || symmetry_.constraints[i].turns != 0) continue;
      if (symmetry_.whole_constraint[i]) require_fold(c.measure, c.name);
      out_.constraint_at[i] = static_cast<int>(s().constraints.size());
      Constraint own = c;
      own.nodes = nodes(c.nodes);
      own.measure = measure(c.measure);
      s().constraints.push_back(std::move(own));
    }
  }

  void take_forces() {
    for (std::size_t i = 0; i < whole_.forces.size(); ++i) {
      const Force& f = whole_.forces[i];
      if (symmetry_.forces[i].turns != 0) continue;
      if (f.kind == "joint_damping") {
        take_joint(f);
        continue;
      }
      Force own = f;
      own.nodes = nodes(f.nodes);
      own.measure = measure(f.measure);
      if (symmetry_.whole_force[i]) {
        require_fold(f.measure, f.name);
        Motor& motor = own.motor;
        for (double* part : {&own.stiffness, &own.damping, &motor.stall, &motor.limit, &motor.proportional,
                             &motor.integral, &motor.derivative})
          *part /= symmetry_.order;
      }
      s().forces.push_back(std::move(own));
    }
  }

  // Between any two rods at the node, which in the sector do not all end there.
  void take_joint(const Force& joint) {
    for (const Measure& angle : angles_at_joint(whole_, joint.nodes[0])) {
      Force own = joint;
      own.kind = "torsion_spring";
      own.nodes.clear();
      own.measure = measure(angle);
      s().forces.push_back(std::move(own));
    }
  }

  // c . x of a node, as of its source: c . (centre + R (x - centre)).
  void add_turned(int of_whole, const Vec3& c, std::map<int, Vec3>& sum, double& offset) const {
    const auto& [source, turns] = image(of_whole);
    const Mat3 turn = symmetry_.turn(turns);
    sum.try_emplace(out_.node_at[place(source)], Vec3::Zero()).first->second += turn.transpose() * c;
    offset += c.dot(symmetry_.centre - turn * symmetry_.centre);
  }

  LinearForm form(const LinearForm& of_whole) const {
    LinearForm out;
    out.offset = of_whole.offset;
    std::map<int, Vec3> sum;
    for (std::size_t i = 0; i < of_whole.nodes.size(); ++i)
      add_turned(of_whole.nodes[i], of_whole.coefficients[i], sum, out.offset);
    for (const auto& [node, c] : sum) {
      out.nodes.push_back(node);
      out.coefficients.push_back(c);
    }
    return out;
  }

  void take_deployment() {
    const Deployment& d = whole_.deployment;
    Deployment& own = s().deployment;
    own = d;
    own.fold_sine = form(d.fold_sine);
    own.fold_cosine = form(d.fold_cosine);
    own.latches.clear();
    own.parts.clear();
    if (d.measured) own.measure = measure(d.measure);
  }

  // Rows of unit length for the sector's nodes, less those that follow from others.
  void take_linear_rows() {
    const VectorXd q = node_positions(whole_);
    const SparseRows all = system_.all_jacobian(q);
    VectorXd value(all.rows());
    system_.all_constraint_values(0.0, q, value);
    const std::vector<int> sources = system_.all_sources();
    std::vector<Constraint> found;
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t r = 0; r < sources.size(); ++r) {
      if (sources[r] < 0 || !is_linear(whole_.constraints[place(sources[r])])) continue;
      Constraint row = sector_row(all, static_cast<Index>(r), q, value[static_cast<Index>(r)]);
      if (row.nodes.empty()) continue;
      row.name = whole_.constraints[place(sources[r])].name;
      for (std::size_t i = 0; i < row.nodes.size(); ++i)
        for (int k = 0; k < 3; ++k)
          if (row.vectors[i][k] != 0)
            entries.emplace_back(static_cast<int>(found.size()), 3 * row.nodes[i] + k, row.vectors[i][k]);
      found.push_back(std::move(row));
    }
    if (found.empty()) return;
    SparseRows A(std::ssize(found), 3 * std::ssize(s().nodes));
    A.setFromTriplets(entries.begin(), entries.end());
    VectorXd b(A.rows());
    for (Index r = 0; r < b.size(); ++r) b[r] = found[static_cast<std::size_t>(r)].value;
    const LinearElimination rows = eliminate(A, b);
    if (!rows.inconsistent.empty())
      throw SectorRefused(found[place(rows.inconsistent.front())].name + " contradicts the symmetry");
    std::vector<char> follows(found.size(), 0);
    for (const int r : rows.redundant) follows[place(r)] = true;
    for (std::size_t r = 0; r < found.size(); ++r)
      if (!follows[r]) s().constraints.push_back(std::move(found[r]));
  }

  Constraint sector_row(const SparseRows& all, Index r, const VectorXd& q, double value) const {
    constexpr double nothing = 1e-12;  // left of a row of length 1 whose parts cancel
    std::map<int, Vec3> of_nodes, sum;
    double length = 0, b = -value, offset = 0;
    for (SparseRows::InnerIterator it(all, r); it; ++it) {
      of_nodes.try_emplace(static_cast<int>(it.col() / 3), Vec3::Zero()).first->second[it.col() % 3] +=
          it.value();
      b += it.value() * q[it.col()];
      length = std::max(length, std::abs(it.value()));
    }
    for (const auto& [node, c] : of_nodes) add_turned(node, c, sum, offset);
    Constraint out{"relation", "", {}, {}, b - offset, {}, {}};
    double longest = 0;
    for (auto& [node, c] : sum) {
      for (double& x : c)
        if (std::abs(x) <= nothing * length) x = 0;
      longest = std::max(longest, c.norm());
    }
    if (longest == 0) return out;
    for (const auto& [node, c] : sum) {
      if (c.isZero(0.0)) continue;
      out.nodes.push_back(node);
      out.vectors.push_back(c / longest);
    }
    out.value /= longest;
    return out;
  }

  void tie_images() {
    for (const auto& [of_whole, at] : images_) {
      const auto& [source, turns] = image(of_whole);
      const Mat3 turn = symmetry_.turn(turns);
      const Vec3 offset = symmetry_.centre - turn * symmetry_.centre;
      for (int k = 0; k < 3; ++k) {
        const Vec3 e = Vec3::Unit(k);
        s().constraints.push_back({"relation",
                                   whole_.nodes[place(of_whole)].name + " as an image, " + "xyz" [k],
                                   { at, out_.node_at[place(source)] },
                                   {e, -(turn.transpose() * e)},
                                   offset[k],
                                   {},
                                   {}});
      }
    }
  }

  const Structure& whole_;
  const System& system_;
  const Symmetry& symmetry_;
  SectorStructure out_;
  std::map<int, int> images_;  // of the whole -> of the sector
};

}  // namespace

SectorStructure build_sector_structure(const Structure& whole, const System& system,
                                       const Symmetry& symmetry) {
  return SectorBuilder(whole, system, symmetry).build();
}

}  // namespace unfurl
