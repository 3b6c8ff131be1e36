// SPDX-License-Identifier: BSD-3-Clause
#include "core/diagnostics/driven_tables.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/math/quadrature.hpp"

namespace unfurl {
namespace {

// Whether three Gauss points integrate f' and f' f'' over the step, which are what work against a constant
// force and of inertia are.
bool is_followed(const TimeFunction& f, double from, double to) {
  constexpr double enough = 1e-7;  // of the way of the largest rate, and of its square
  static const Quadrature gauss = gauss_legendre(3);
  const double h = to - from, at_start = f.derivative(1, from), at_end = f.derivative(1, to);
  double way = f(from) - f(to), gain = 0.5 * (at_start * at_start - at_end * at_end);
  double fastest = std::max(std::abs(at_start), std::abs(at_end));
  for (Index i = 0; i < gauss.nodes.size(); ++i) {
    const double t = from + gauss.nodes[i] * h, rate = f.derivative(1, t), weight = h * gauss.weights[i];
    way += weight * rate;
    gain += weight * rate * f.derivative(2, t);
    fastest = std::max(fastest, std::abs(rate));
  }
  return std::abs(way) <= enough * h * fastest && std::abs(gain) <= enough * fastest * fastest;
}

// Points that cut a sine into parts that three Gauss points do tell; where a step spans so many waves that it
// cannot follow them, none.
void add_parts_of_waves(const TimeFunction& f, double from, double to, std::vector<double>& out) {
  constexpr double parts = 8, most_waves = 4;
  if (to - from > most_waves * f.duration) return;
  const double length = f.duration / parts;
  for (double k = std::max(0.0, std::floor((from - f.start) / length)); f.start + k * length < to; ++k)
    if (f.start + k * length > from) out.push_back(f.start + k * length);
}

}  // namespace

DrivenTables::DrivenTables(const Structure& structure) {
  const auto add = [&](const std::string& name, const TimeFunction& f) {
    if ((f.kind == TimeFunction::Kind::spline || f.kind == TimeFunction::Kind::sine) &&
        std::ranges::none_of(tables_, [&](const Table& table) { return table.f == f; }))
      tables_.push_back({name, f});
  };
  for (const Constraint& c : structure.constraints) add(c.name, c.target);
  for (const Stop& stop : structure.stops)
    if (stop.reeled) add(stop.name, stop.reel);
  for (const Rod& rod : structure.rods)
    if (rod.expansion != 0 && !rod.gives) add(rod.name + "'s temperature", rod.warming);
}

std::vector<double> DrivenTables::points_within(double from, double to) const {
  std::vector<double> out;
  for (const Table& table : tables_) {
    if (table.f.kind == TimeFunction::Kind::sine) {
      if (!is_followed(table.f, from, to)) add_parts_of_waves(table.f, from, to, out);
      continue;
    }
    const std::vector<double>& times = table.f.times;
    const auto first = std::upper_bound(times.begin(), times.end(), from),
               last = std::lower_bound(first, times.end(), to);
    if (first != last && !is_followed(table.f, from, to)) out.insert(out.end(), first, last);
  }
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

bool DrivenTables::only_sines() const {
  return std::ranges::all_of(tables_, [](const Table& t) { return t.f.kind == TimeFunction::Kind::sine; });
}

std::string DrivenTables::words(double step) const {
  const Table* finest = nullptr;
  double spacing = (1 - 1e-9) * step;
  for (const Table& table : tables_)
    for (std::size_t i = 1; i < table.f.times.size(); ++i)
      if (const double own = table.f.times[i] - table.f.times[i - 1]; own < spacing)
        spacing = own, finest = &table;
  if (!finest) return "";
  std::ostringstream text;
  text.precision(3);
  text << "the table of " << finest->name << " has " << std::lround(step / spacing)
       << " points within a step: solver.step = " << spacing << " follows them";
  return text.str();
}

}  // namespace unfurl
