// SPDX-License-Identifier: BSD-3-Clause
// The forces of a margin along the path, by source and with their factors, and the law of motion that
// follows.
#pragma once

#include <functional>
#include <map>

#include "core/path/path_motion.hpp"

namespace unfurl {

class MarginLaw final : public PathLaw {
 public:
  // What goes by one name: all that one entry of a scene has made.
  struct Group {
    std::string name, kind;
    double factor = 1.0;
    std::vector<std::size_t> sources;
  };
  // Throws StudyError for a factor of what is not there, or of two things of one name.
  MarginLaw(const Path& path, const Structure& structure, const std::map<std::string, double>& factors);

  const std::vector<Group>& groups() const { return groups_; }

  // The sense of motion, which friction and a jam oppose at every speed: a motion ends where its speed is
  // zero, and s'' is smooth until there.
  double going = 1.0;
  // A hinge that jams: its friction torque and |d angle / ds|.
  double jam_torque = 0.0;
  std::function<ValueAndSlope(double s)> jam_turn;
  double looseness = 0.0;  // steps resolve no less than this share of what acts

  Value at(double s, double v, double t) const override;
  // Of a group, in motion.
  double force(std::size_t group, double s, double v, double t) const;

  // Whether its force depends on the speed there, cables as if they pulled.
  bool damps(std::size_t group, double s) const;

  // At rest: cables pull where they are stretched, and friction holds up to `hold`, which is not among Q.
  Value at_rest(std::size_t group, double s, double t) const;
  Value at_rest(double s, double t) const;
  double hold(std::size_t group, double s) const;
  double slip(std::size_t group, double s) const;  // what friction takes as soon as it moves
  double hold(double s) const;

 private:
  // pulls: of a cable.
  Value value_of(const PathTable::Segment& here, std::size_t k, double s, double v, double t,
                 bool pulls) const;
  const PathForces::Friction* friction_of(std::size_t k) const;
  double friction(std::size_t group, double s, double PathForces::Friction::*size) const;
  bool stretched(const PathTable::Segment& here, std::size_t k, double s) const;

  std::vector<Group> groups_;
  std::vector<double> factors_;  // of the sources
};

}  // namespace unfurl
