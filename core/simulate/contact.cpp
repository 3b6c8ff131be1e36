#include "core/simulate/contact.hpp"

#include <algorithm>
#include <cmath>

namespace unfurl {
namespace {

// Root of f between low and high, where its signs differ.
template <class Function>
double illinois(const Function& f, double low, double at_low, double high, double at_high, double small,
                double shortest) {
  for (int it = 0; it < 60 && high - low > shortest; ++it) {
    const double middle = (low * at_high - high * at_low) / (at_high - at_low), at = f(middle);
    if (std::abs(at) <= small) return middle;
    if ((at > 0) == (at_low > 0))
      low = middle, at_low = at, at_high *= 0.5;
    else
      high = middle, at_high = at, at_low *= 0.5;
  }
  return low;
}

// Could a cubic with these values and rates at its ends fall below zero, with a tenth of what its slopes span
// to spare?
bool may_dip(double gap_from, double rate_from, double gap_to, double rate_to, double h) {
  if (!(rate_from < 0 && rate_to > 0)) return false;
  double least = std::min(gap_from, gap_to);
  for (int k = 1; k < 32; ++k) {
    const double u = k / 32.0, v = 1 - u;
    least = std::min(least, v * v * (1 + 2 * u) * gap_from + h * u * v * v * rate_from +
                                u * u * (1 + 2 * v) * gap_to - h * u * u * v * rate_to);
  }
  return least < 0.1 * h * (rate_to - rate_from);
}

}  // namespace

std::optional<double> time_to_contact(const Stops& stops, std::size_t i, const System& system,
                                      const State& from, const State& to, double h, const StateAfter& after) {
  const auto gap_after = [&](double step) {
    const auto state = after(step);
    return state ? stops.gap(i, system, *state) : -1.0;
  };
  const auto rate_after = [&](double step) {
    const auto state = after(step);
    return state ? stops.gap_rate(i, system, *state) : 0.0;
  };
  double high = h;
  const double gap = stops.gap(i, system, to);
  if (gap >= -stops.touching()) {
    const double rate_from = stops.gap_rate(i, system, from), rate_to = stops.gap_rate(i, system, to);
    if (!may_dip(stops.gap(i, system, from), rate_from, gap, rate_to, h)) return std::nullopt;
    high = illinois(rate_after, 0, rate_from, h, rate_to, 1e-9 * (rate_to - rate_from), 1e-9 * h);
    if (gap_after(high) >= -stops.touching()) return std::nullopt;
  }
  double at_high = gap_after(high), low = high, at_low = at_high;
  while (at_low <= 0 && low > 1e-6 * h) at_low = gap_after(low *= 0.5);
  if (at_low <= 0) return 0.0;
  if (low < high) high = 2 * low, at_high = gap_after(high);
  return illinois(gap_after, low, at_low, high, at_high, 0.01 * stops.touching(), 1e-15 * h);
}

}  // namespace unfurl
