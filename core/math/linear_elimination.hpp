// Exact elimination of sparse linear constraints A q = b: q = q_0 + B z.
#pragma once

#include <string>
#include <vector>

#include "core/math/types.hpp"

namespace unfurl {

struct LinearElimination {
  SparseRows B;                       // [3n x nz]; each row of a free coordinate is a unit row
  VectorXd q0;                        // [3n]
  std::vector<int> free_coordinates;  // which entries of q are the entries of z
  std::vector<int> redundant;         // rows of A that follow from the others (consistent)
  std::vector<int> inconsistent;      // rows of A that contradict the others
};

// Gaussian elimination with the largest entry of each reduced row as pivot; a row whose entries all fall
// below tolerance * its original norm is dependent.
LinearElimination eliminate(const SparseRows& A, const ConstVec& b, double tolerance = 1e-11);

}  // namespace unfurl
