// SPDX-License-Identifier: BSD-3-Clause
// A quantity of every rod over time, as colours over a range that stays the same through a film. Axial forces
// are those of cables, nets and springs, too.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.hpp"
#include "render/scene/draw_list.hpp"

namespace unfurl {

struct RodField {
  std::string label;      // with its unit: "axial force (N), tension > 0"
  std::vector<double> t;  // of the rows [s]
  MatrixXd values;        // [states x solved rods]; NaN where it is not known
  // Of axial forces, those of [states x Structure::lines] and [states x Structure::forces] that are springs.
  MatrixXd lines, springs;
  std::string unknown = "not known";  // what the colour of NaN stands for
  double low = 0, high = 1;
  bool below = false, above = false;  // some values lie outside of the range and have the colour of its end
  bool known = true;                  // at least one value is
  bool diverging = false;             // around zero
  bool log = false;

  // Linear between the states; NaN at a state where it is not known, and between two of them.
  double at(double time, int rod) const { return between(values, time, rod); }
  double of_line(double time, std::size_t line) const {
    return between(lines, time, static_cast<Index>(line));
  }
  double of_spring(double time, std::size_t force) const {
    return between(springs, time, static_cast<Index>(force));
  }
  Color color(double value) const;      // where it is not finite one that no value has
  double position(double value) const;  // along the colour bar, 0..1

 private:
  double between(const MatrixXd& columns, double time, Index column) const;
};

// by: "axial_force", "stress", "buckling" (not known where a rod has no modulus), "speed" (of the rod's
// middle) or "constraint_error" (|distance of the ends - length that it is held at|, not known where a rod is
// elastic). range: low and high, or equal ends for the run's own range. Throws std::invalid_argument for
// another name.
RodField rod_field(const std::string& by, std::array<double, 2> range, const Simulation& run,
                   const Diagnostics& diagnostics);

}  // namespace unfurl
