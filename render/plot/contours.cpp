// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot/contours.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace unfurl::plot {
namespace {

struct Corner {
  double x, y, value;
};

void add(Segments& out, const Corner& a, const Corner& b, double level) {
  const double u = (level - a.value) / (b.value - a.value);
  out.x.push_back(a.x + u * (b.x - a.x));
  out.y.push_back(a.y + u * (b.y - a.y));
}

}  // namespace

Segments contour(const Field& field, double level) {
  Segments out;
  for (std::size_t i = 0; i + 1 < field.x.size(); ++i)
    for (std::size_t j = 0; j + 1 < field.y.size(); ++j) {
      const auto corner = [&](std::size_t a, std::size_t b) {
        return Corner{field.x[a], field.y[b], field.value(a, b)};
      };
      // Around the square; edges whose ends lie on different sides are crossed, 0, 2 or 4 of them.
      const std::array corners{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)};
      if (std::isnan(corners[0].value + corners[1].value + corners[2].value + corners[3].value)) continue;
      int crossings = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        const Corner &a = corners[k], &b = corners[(k + 1) % 4];
        if ((a.value < level) == (b.value < level)) continue;
        add(out, a, b, level);
        if (++crossings % 2 == 0) {
          out.x.push_back(std::numeric_limits<double>::quiet_NaN());
          out.y.push_back(std::numeric_limits<double>::quiet_NaN());
        }
      }
    }
  return out;
}

double interpolate(const Field& field, std::size_t i, std::size_t j, double u, double v) {
  const auto part = [&](double weight, std::size_t a, std::size_t b) {
    return weight == 0 ? 0.0 : weight * field.value(a, b);
  };
  return part((1 - u) * (1 - v), i, j) + part((1 - u) * v, i, j + 1) + part(u * (1 - v), i + 1, j) +
         part(u * v, i + 1, j + 1);
}

}  // namespace unfurl::plot
