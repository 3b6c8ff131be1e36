// SPDX-License-Identifier: BSD-3-Clause
// Numbers that depend on the pose alone, as functions of s along a path.
#pragma once

#include <deque>
#include <string>

#include "core/math/chebyshev.hpp"
#include "core/path/path.hpp"

namespace unfurl {

// Values at a pose: q its node coordinates, dq = dq/ds. Angles that count their turns are given as they were
// at a pose nearby, and left as they are here.
class PathFunctions {
 public:
  virtual ~PathFunctions() = default;
  virtual Index size() const = 0;
  virtual VectorXd first_angles() const = 0;  // at s = 0, or near there
  // scale: what counts as large, of each value; its round-off is some 1e-16 of that.
  virtual void evaluate(const VectorXd& q, const VectorXd& dq, VectorXd& angles, VectorXd& value,
                        VectorXd& scale) const = 0;
  // Whose a function is that is not smooth, behind "what acts is not smooth"; empty: nobody's in particular.
  virtual std::string whose(Index) const { return ""; }
};

// Tabulated piece by piece as it is asked for, outwards from s = 0, in parts of pieces where it takes such.
class PathTable {
 public:
  struct Segment {
    double a = 0.0, b = 0.0;
    MatrixXd c;      // [points x functions]: a column of coefficients each
    VectorXd scale;  // of the functions
    VectorXd noise;  // what they may be off by, more than round-off next to singular poses
    double x_of(double s) const { return (2 * s - (a + b)) / (b - a); }
    const double* of(Index function) const { return c.data() + function * c.rows(); }
    ValueAndSlope at(Index function, double s) const;  // the slope by s
  };

  PathTable(const Path& path, const PathFunctions& functions);

  // Throws PathRefused where a function is not smooth; nullptr where the path cannot be followed so far.
  const Segment* segment(double s);
  // nullptr in both cases: of trial steps, which may look further than the motion gets.
  const Segment* segment_within_reach(double s);
  void refuse_rough() const;  // throws PathRefused where a function was not smooth that was asked for
  ValueAndSlope at(Index function, double s);  // NaN where the path does not go
  const Path& path() const { return path_; }
  const PathFunctions& functions() const { return functions_; }

 private:
  struct Side {
    std::deque<Segment> segments;  // outwards
    VectorXd angles;               // at its end
    long pieces = 0;
    Index rough = -1;  // the function that is not smooth at its end, where it ends
  };
  struct Cut {
    int depth = 0;
    double before = std::numeric_limits<double>::infinity();  // tail of what was cut
  };
  void refuse_rough(const Side& side) const;
  bool extend(Side& side, bool forward);
  bool tabulate(const PathPiece& piece, double from, double to, Cut cut, Side& side, bool forward);

  const Path& path_;
  const PathFunctions& functions_;
  Side forward_, backward_;
  const Segment* last_ = nullptr;
};

}  // namespace unfurl
