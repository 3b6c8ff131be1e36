// SPDX-License-Identifier: BSD-3-Clause
#include "core/forces/offload.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/structure/structure_error.hpp"

namespace unfurl {
namespace {

class Offload final : public ForceBlock {
 public:
  Offload(const Structure& structure, const SparseRows& node_mass) {
    const auto n = static_cast<Index>(structure.nodes.size());
    VectorXd weight = node_mass * structure.gravity.replicate(n, 1);
    share_within_rods(structure, weight);
    const double size = structure.gravity.norm();
    const Vec3 down = size > 0 ? Vec3(structure.gravity / size) : Vec3::Zero();
    across_ = Mat3::Identity() - down * down.transpose();
    for (const Force& f : structure.forces) {
      if (f.kind != "offload") continue;
      const int node = f.nodes[0];
      const Vec3 w = weight.segment<3>(3 * static_cast<Index>(node));
      const bool given = f.trolley.allFinite();
      ropes_.push_back({node, w, w.norm() / f.rope,
                        given ? f.trolley : structure.nodes[static_cast<std::size_t>(node)].position});
    }
  }
  bool empty() const { return ropes_.empty(); }
  bool constant() const override { return false; }

  void add(const Moment&, const double* q, const double*, double scale, double* f) const override {
    for (const Rope& r : ropes_)
      Eigen::Map<Vec3>(f + 3 * static_cast<Index>(r.node)) -= scale * (r.weight + r.stiffness * aside(r, q));
  }
  double potential(const Moment&, const double* q) const override {
    double sum = 0;
    for (const Rope& r : ropes_)
      sum += r.weight.dot(node_vector(q, r.node)) + 0.5 * r.stiffness * aside(r, q).squaredNorm();
    return sum;
  }
  void derivatives(const Moment&, const double*, const double*, ForceDerivative& by_q,
                   ForceDerivative&) const override {
    for (const Rope& r : ropes_)
      for (int i = 0; i < 3 && r.stiffness > 0; ++i)
        for (int j = 0; j < 3; ++j)
          by_q.emplace_back(3 * r.node + i, 3 * r.node + j, -r.stiffness * across_(i, j));
  }

 private:
  struct Rope {
    int node;
    Vec3 weight;       // m g [N]
    double stiffness;  // k [N/m]
    Vec3 trolley;      // x_t [m]
  };
  // What the nodes within a rod that was cut weigh hangs on its ends, by the lever, where they have no ropes
  // of their own: half of a rod on either end, as of one that was not cut.
  static void share_within_rods(const Structure& structure, VectorXd& weight) {
    const auto hangs = [&](int node) {
      return std::ranges::any_of(structure.forces,
                                 [&](const Force& f) { return f.kind == "offload" && f.nodes[0] == node; });
    };
    const auto of = [&](int node) { return weight.segment<3>(3 * static_cast<Index>(node)); };
    for (std::size_t r = 0; r < structure.rods.size();) {
      const auto parts = static_cast<std::size_t>(std::max(structure.rods[r].parts, 1));
      for (std::size_t k = 1; k < parts; ++k) {
        const int within = structure.rods[r + k].a;
        if (hangs(within)) continue;
        const double share = static_cast<double>(k) / static_cast<double>(parts);
        of(structure.rods[r].a) += (1 - share) * of(within);
        of(structure.rods[r + parts - 1].b) += share * of(within);
      }
      r += parts;
    }
  }
  Vec3 aside(const Rope& r, const double* q) const { return across_ * (node_vector(q, r.node) - r.trolley); }

  Mat3 across_;  // P
  std::vector<Rope> ropes_;
};

}  // namespace

std::unique_ptr<ForceBlock> offload_block(const Structure& structure, const SparseRows& node_mass) {
  auto block = std::make_unique<Offload>(structure, node_mass);
  if (block->empty()) return nullptr;
  return block;
}

const std::vector<ParamSpec>& offload_params() {
  static const std::vector<ParamSpec> params = {
      choice_param("trolley", "fixed", {"fixed", "following"},
                   "stays where it is and pulls the node back below it, or is always above it"),
      only_with("trolley", {"fixed"},
                positive_param("length", "m", 10.0, "of the rope from the trolley to the node")),
      only_with("trolley", {"fixed"},
                vector_param("position", "m", {},
                             "of the trolley, three numbers of which the height does not matter; by default "
                             "above the node at t = 0"))};
  return params;
}

void fill_offload(const ParamSet& values, Force& force) {
  const bool follows = values.text("trolley") == "following";
  force.rope = follows ? std::numeric_limits<double>::infinity() : values.real("length");
  const auto& at = values.vector("position");
  if (at.empty()) return;
  if (at.size() != 3) throw StructureError("position", "must be three numbers, or left out");
  force.trolley = {at[0], at[1], at[2]};
}

}  // namespace unfurl
