// SPDX-License-Identifier: BSD-3-Clause
// How pairs of rods that meet at a node, with an end or with a pin between their ends, turn against each
// other along a path.
#pragma once

#include <string>
#include <vector>

#include "core/path/path_table.hpp"
#include "core/structure/structure.hpp"

namespace unfurl {

struct Hinge {
  std::string name;
  NodeCopy a_from, a_to, b_from, b_to;  // along both rods
};

// Of the whole structure; of a sector model those at one pin of every set of images: the others turn alike.
std::vector<Hinge> hinges_of(const Structure& structure);
double hinge_angle(const Hinge& hinge, const VectorXd& q);  // [0, pi]
// Of that angle, by what dq is by. It changes its sign where rods pass each other in line.
double hinge_rate(const Hinge& hinge, const VectorXd& q, const VectorXd& dq);

// (d angle / ds)^2 of each: smooth, also where rods pass each other in line or a hinge turns back.
class HingeRates final : public PathFunctions {
 public:
  explicit HingeRates(std::vector<Hinge> hinges) : hinges_(std::move(hinges)) {}
  Index size() const override { return std::ssize(hinges_); }
  VectorXd first_angles() const override { return {}; }
  void evaluate(const VectorXd& q, const VectorXd& dq, VectorXd& angles, VectorXd& value,
                VectorXd& scale) const override;

 private:
  std::vector<Hinge> hinges_;
};

}  // namespace unfurl
