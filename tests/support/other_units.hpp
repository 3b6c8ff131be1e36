// SPDX-License-Identifier: BSD-3-Clause
// The same scene in other units of length, mass and time, powers of two of those that it has: products with
// them are exact, so that nothing may change, not even the last bit, unless a limit or a number somewhere has
// a unit that it does not say.
#pragma once

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <string_view>

#include "core/diagnostics/diagnostics.hpp"
#include "core/scene/build.hpp"
#include "core/scene/reader.hpp"
#include "core/scene/write.hpp"

namespace unfurl::testing {

// A metre is 2^length of the new units, and so on. `mass` is even: equations are scaled by its root.
struct OtherUnits {
  int length = 0, mass = 0, time = 0;

  // What numbers in a unit ("N m s/rad") are multiplied by.
  double factor(std::string_view unit) const {
    int power = 0, sign = 1;
    for (std::size_t i = 0; i < unit.size();) {
      if (unit[i] == ' ' || unit[i] == '/') {
        if (unit[i++] == '/') sign = -1;
        continue;
      }
      const std::string_view word = unit.substr(i, unit.find_first_of(" /^", i) - i);
      i += word.size();
      int times = sign;
      if (i < unit.size() && unit[i] == '^') times *= unit[i + 1] - '0', i += 2;
      power += times * power_of(word);
    }
    return std::ldexp(1.0, power);
  }

  int power_of(std::string_view word) const {
    const int force = mass + length - 2 * time;
    if (word == "m") return length;
    if (word == "kg") return mass;
    if (word == "s") return time;
    if (word == "N") return force;
    if (word == "Pa") return force - 2 * length;
    if (word == "J") return force + length;
    if (word == "W") return force + length - time;
    for (const char* same : {"1", "rad", "deg", "K", "A", "pixels", "frames"})
      if (word == same) return 0;
    FAIL("a unit that this test does not know: " << word);
    return 0;
  }

  // Of a column, "fold_rate_rad_s".
  double column_factor(std::string_view name) const {
    constexpr std::array<std::array<const char*, 2>, 11> units{{{"_rad_s", "rad/s"},
                                                                {"_deg_s", "rad/s"},
                                                                {"_N_m", "N m"},
                                                                {"_N_s", "N s"},
                                                                {"_m_s", "m/s"},
                                                                {"_m", "m"},
                                                                {"_s", "s"},
                                                                {"_N", "N"},
                                                                {"_J", "J"},
                                                                {"_Pa", "Pa"},
                                                                {"_W", "W"}}};
    for (const auto& [end, unit] : units)
      if (name.ends_with(end)) return factor(unit);
    return 1;
  }
};

// Units of keys that have one or another, by what their element acts on.
using UnitsOfKeys = std::map<std::string, std::string, std::less<>>;

// A line "key = number  # unit" or "key = [numbers]  # unit" in other units.
inline std::string line_in_other_units(const std::string& line, const OtherUnits& units,
                                       const UnitsOfKeys& more) {
  const std::size_t begin = line.find(" = "), note = std::min(line.rfind("  # "), line.size());
  if (begin == std::string::npos) return line;
  const auto known = more.find(line.substr(0, begin));
  if (note == line.size() && known == more.end()) return line;
  const double factor = units.factor(note == line.size() ? known->second : line.substr(note + 4));
  std::string out = line.substr(0, begin + 3);
  for (std::size_t i = begin + 3; i < note;) {
    double x = 0;
    const auto [end, error] = std::from_chars(line.data() + i, line.data() + note, x);
    if (error != std::errc()) {
      out += line[i++];
      continue;
    }
    std::array<char, 40> digits{};
    out.append(digits.data(),
               std::to_chars(digits.data(), digits.data() + digits.size(), x * factor,
                             std::isfinite(x) ? std::chars_format::scientific : std::chars_format::general)
                   .ptr);
    i = static_cast<std::size_t>(end - line.data());
  }
  return out;
}

// Every number that the scene has, those of defaults among them, as the program writes them with their units.
inline std::string in_other_units(const Scene& scene, const OtherUnits& units, const UnitsOfKeys& more) {
  std::istringstream lines(scene_text(scene));
  std::string out, line;
  while (std::getline(lines, line) && line != "[render]")
    out += line_in_other_units(line, units, more) + "\n";
  return out;
}

// One number of the one and of the other: to the last bit, or to what is left of it where it comes to lie
// below the smallest doubles; with a share, to that of the largest.
inline bool same_but_for_unit(double a, double factor, double b, double largest, double share) {
  return a * factor == b || (std::isnan(a) && std::isnan(b)) ||
         std::abs(a - b / factor) <= std::max(share, 1e-150) * largest;
}

inline void check_columns(const Diagnostics& a, const Diagnostics& b, const OtherUnits& units, double share) {
  REQUIRE(a.columns.size() == b.columns.size());
  for (std::size_t c = 0; c < a.columns.size(); ++c) {
    const auto &x = a.columns[c].values, &y = b.columns[c].values;
    const std::string& name = a.columns[c].name;
    INFO(name);
    REQUIRE(x.size() == y.size());
    // Nothing but round-off.
    if (share > 0 &&
        (name.starts_with("constraint_") || name == "newton_iterations" || name == "energy_balance_J"))
      continue;
    const double factor = units.column_factor(name);
    double largest = 0;
    for (const double one : x) largest = std::max(largest, std::isfinite(one) ? std::abs(one) : 0.0);
    std::size_t same = 0;
    while (same < x.size() && same_but_for_unit(x[same], factor, y[same], largest, share)) ++same;
    if (same == x.size()) continue;
    INFO("row " << same << ": " << x[same] << ", " << y[same] / factor);
    CHECK(same == x.size());
  }
  const double largest = a.axial_force.size() == 0 ? 0 : a.axial_force.cwiseAbs().maxCoeff();
  for (Index i = 0; i < a.axial_force.size(); ++i)
    if (!same_but_for_unit(a.axial_force.data()[i], units.factor("N"), b.axial_force.data()[i], largest,
                           share)) {
      INFO("axial force " << i);
      CHECK(a.axial_force.data()[i] * units.factor("N") == b.axial_force.data()[i]);
    }
  CHECK((a.force_unique == b.force_unique).all());
}

using Solved = Simulation(const std::shared_ptr<const Model>& model, const SolverOptions& options);
inline Simulation solved_in_full(const std::shared_ptr<const Model>& model, const SolverOptions& options) {
  return simulate(model, options);
}

// The scene runs alike in other units: to the last bit; with a share, to that of the largest number of a
// column.
inline void check_other_units(const Scene& scene, const OtherUnits& units, double share = 0,
                              const UnitsOfKeys& more = {}, Solved* solve = solved_in_full) {
  INFO("in units of 2^" << units.length << " m, 2^" << units.mass << " kg, 2^" << units.time << " s");
  const Scene same = read_scene_text(in_other_units(scene, {}, more), "s.toml"),
              other = read_scene_text(in_other_units(scene, units, more), "s.toml");
  const Simulation a = solve(build_model(same), same.solver), b = solve(build_model(other), other.solver);
  INFO(a.message << " | " << b.message);
  CHECK(a.status == b.status);
  REQUIRE(a.trajectory.size() == b.trajectory.size());
  // A default that does nothing is no default in other units, and warned of.
  const auto of_the_run = [](const Simulation& run) {
    return std::count_if(run.warnings.begin(), run.warnings.end(), [](const std::string& warning) {
      return warning.find("does nothing with") == std::string::npos;
    });
  };
  CHECK(of_the_run(a) == of_the_run(b));
  REQUIRE(a.events.size() == b.events.size());
  for (std::size_t e = 0; e < a.events.size(); ++e) {
    CHECK(same_but_for_unit(a.events[e].t, units.factor("s"), b.events[e].t, a.events[e].t, share));
    CHECK(a.events[e].kind == b.events[e].kind);
  }
  const auto& nodes = a.trajectory.structure().nodes;
  double apart = 0, largest = 0;
  for (std::size_t i = 0; i < a.trajectory.size(); ++i) {
    const VectorXd x = a.trajectory.node_positions(i), y = b.trajectory.node_positions(i) / units.factor("m");
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      if (nodes[k].ghost) continue;  // no length
      const auto at = 3 * static_cast<Index>(k);
      apart = std::max(apart, (x - y).segment<3>(at).lpNorm<Eigen::Infinity>());
      largest = std::max(largest, x.segment<3>(at).lpNorm<Eigen::Infinity>());
    }
  }
  CHECK(apart <= share * largest);
  check_columns(diagnose(a), diagnose(b), units, share);
}

}  // namespace unfurl::testing
