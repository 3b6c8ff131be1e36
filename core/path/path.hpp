// SPDX-License-Identifier: BSD-3-Clause
// The one way that a structure of mobility one can go: its poses as a curve z(s), traced once.
//
// s is the length of the curve in the mass metric, ds^2 = dz^T M dz [m kg^1/2]. With the unit tangent
// t = dz/ds the inertia along the path is m(s) = t^T M t = 1, so that with any forces F
//
//     L = 1/2 s'^2 - V(s),      s'' = Q = t^T F.
//
// Round a pose z_a with tangent t_a a piece is found by pseudo-arclength (Keller 1977): the poses with
//
//     Phi(z) = 0,    t_a^T M (z - z_a) = u
//
// for u at Chebyshev points, by Newton's method with the saddle-point matrix [M G^T; G 0] alone, whose
// redundant rows and poses without full rank its solver takes: the least correction -Phi of the constraints,
// then along the tangent, the projection of t_a on the null space of G. Where G loses rank the poses on both
// sides determine the curve; of several that meet there it goes on smoothly, as inertia does.
#pragma once

#include <deque>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>

#include "core/simulate/trajectory.hpp"
#include "core/text/error.hpp"

namespace unfurl {

// What a scene asks of the path that it cannot do; what() says why.
struct PathRefused : Error {
  using Error::Error;
};

// Chebyshev series between two poses, as functions of x in [-1, 1], s = middle + x * half.
struct PathPiece {
  double a = 0.0, b = 0.0;        // s at its ends
  MatrixXd z, tangent;            // [solved coordinates x points]: coefficients
  double noise = 0.0;             // of the tangent, as a share of it: next to singular poses, else 0
  MatrixXd q, dq;                 // [node coordinates x points]: values at the points, dq = dq/ds
  VectorXd bend(double x) const;  // d tangent / ds
  double at(double x) const { return 0.5 * (a + b) + 0.5 * (b - a) * x; }
  double x_of(double s) const { return (2 * s - (a + b)) / (b - a); }
};

class Path {
 public:
  static constexpr int degree = 24;  // of a piece's series

  // Through the pose z of a system without driven rows, where s = 0. Throws PathRefused.
  Path(std::shared_ptr<const System> system, const VectorXd& z);
  ~Path();

  const System& system() const { return *system_; }
  // What s is compared with where a number is asked for: it moves the fastest node by the structure's size at
  // the start [m kg^1/2].
  double unit() const { return unit_; }
  // Pieces follow each other; number 0 begins at s = 0, negative ones lie before it. They are traced when
  // they are asked for, the same whoever asks and in whatever order; threads may share a path. nullptr: the
  // path cannot be followed so far.
  const PathPiece* piece(long number) const;
  // The number of the piece that holds s; nothing where the path cannot be followed so far.
  std::optional<long> piece_of(double s) const;
  bool point(double s, VectorXd& z, VectorXd& tangent) const;  // false: not that far

  // s of a pose on the path, looked for up to `most` pieces either way; nothing where it lies further from
  // the path than rounding.
  std::optional<double> locate(const VectorXd& z, long most) const;

 private:
  class Tracer;
  struct Side {
    std::deque<PathPiece> pieces;  // outwards from s = 0
    VectorXd z, tangent;           // of its end, the tangent outwards
    double length = 0.0;           // tried next [m kg^1/2]
    bool ended = false;
  };
  const PathPiece* outward(Side& side, double sign, std::size_t number) const;

  std::shared_ptr<const System> system_;
  std::unique_ptr<Tracer> tracer_;
  mutable std::mutex mutex_;
  mutable Side forward_, backward_;
  double unit_ = 0.0;
};

}  // namespace unfurl
