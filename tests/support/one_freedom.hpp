// Released at rest, a mechanism of one degree of freedom whose loads depend on its pose alone moves as energy
// tells.
#pragma once

#include <cmath>
#include <functional>

namespace unfurl::exact {

// The coordinate x >= 0 counts from the pose of release. With the kinetic energy I(x) x'^2 / 2 and the work
// W(x) done since the release
//
//     x'^2 = 2 W / I,      t(x) = integral_0^x sqrt(I / (2 W)) dx = integral_0^sqrt(x) 2 u sqrt(I / (2 W))
//     du,  x = u^2
//
// where the substitution removes the singularity at rest (W ~ x there). W must be free of cancellation near x
// = 0.
struct OneFreedom {
  std::function<double(double)> inertia;  // I(x)
  std::function<double(double)> work;     // W(x)

  double rate(double x) const { return std::sqrt(2 * work(x) / inertia(x)); }

  // Composite Gauss-Legendre quadrature with 10 points, panels halved until nothing changes above round-off.
  double time(double x) const {
    const double end = std::sqrt(x);
    double previous = -1, sum = 0;
    for (int panels = 4; panels <= 4096; panels *= 2) {
      sum = 0;
      for (int p = 0; p < panels; ++p) sum += panel(end * p / panels, end * (p + 1) / panels);
      if (std::abs(sum - previous) < 2e-15 * sum) break;
      previous = sum;
    }
    return sum;
  }

 private:
  double integrand(double u) const { return 2 * u / rate(u * u); }
  double panel(double lo, double hi) const {
    static const double x[5] = {0.1488743389816312, 0.4333953941292472, 0.6794095682990244,
                                0.8650633666889845, 0.9739065285171717};
    static const double w[5] = {0.2955242247147529, 0.2692667193099963, 0.2190863625159820,
                                0.1494513491505806, 0.0666713443086881};
    const double m = 0.5 * (lo + hi), r = 0.5 * (hi - lo);
    double sum = 0;
    for (int i = 0; i < 5; ++i) sum += w[i] * (integrand(m - r * x[i]) + integrand(m + r * x[i]));
    return r * sum;
  }
};

}  // namespace unfurl::exact
