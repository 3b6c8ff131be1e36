// SPDX-License-Identifier: BSD-3-Clause
// Crossings of margins whose zeros are known in closed form.
#include "core/simulate/crossing.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace unfurl;

namespace crossing_test {

namespace {

using Function = double (*)(double);
struct Margin {
  Function value, rate;  // rate: null where none is known
};

constexpr double unit = 1e10;  // one tenth of a nanometre counts as zero

// A step of `length` whose solutions are these functions of time.
struct Motion {
  std::vector<Margin> margins;
  double length = 1;
  double solvable = std::numeric_limits<double>::infinity();  // steps up to here
  int solves = 0;

  Probe probe(double t) const {
    Probe p;
    p.at = t;
    p.state.t = t;
    p.margins.resize(static_cast<Index>(margins.size()));
    p.rates.resize(p.margins.size());
    for (Index i = 0; i < p.margins.size(); ++i) {
      const Margin& m = margins[static_cast<std::size_t>(i)];
      p.margins[i] = unit * m.value(t);
      p.rates[i] = m.rate ? unit * m.rate(t) : std::numeric_limits<double>::quiet_NaN();
    }
    return p;
  }
  std::optional<Crossing> first(int parts = 7) {
    solves = 0;
    MatrixXd between(static_cast<Index>(margins.size()), parts);
    for (Index k = 0; k < parts; ++k)
      between.col(k) = probe(length * static_cast<double>(k + 1) / (parts + 1)).margins;
    return first_crossing(probe(0), probe(length), between, [&](double t, Probe& p) {
      ++solves;
      if (t > solvable) return false;
      p = probe(t);
      return true;
    });
  }
};

using Which = std::vector<std::size_t>;

// Zero at acos(0.2) / 3 = 0.456 s.
const Margin falling{[](double t) { return std::cos(3 * t) - 0.2; },
                     [](double t) { return -3 * std::sin(3 * t); }};
// A parabola below zero from 0.32 s to 0.42 s.
const Margin dip{[](double t) { return 4 * (t - 0.37) * (t - 0.37) - 0.01; },
                 [](double t) { return 8 * (t - 0.37); }};
const Margin above{[](double t) { return 4 * (t - 0.37) * (t - 0.37) + 1e-6; },
                   [](double t) { return 8 * (t - 0.37); }};
const Margin thrown{[](double t) { return t * (0.6 - t); }, [](double t) { return 0.6 - 2 * t; }};

Margin without_rate(Margin m) {
  m.rate = nullptr;
  return m;
}

}  // namespace

TEST_CASE("a margin's zero is found to what counts as zero, by a few steps") {
  const double zero = std::acos(0.2) / 3;
  Motion motion{{falling}};
  auto found = motion.first();
  REQUIRE(found);
  CHECK(std::abs(found->probe.at - zero) <= 0.02 / unit);
  CHECK(found->probe.state.t == found->probe.at);
  CHECK(found->which == Which{0});
  // Newton's iteration doubles the digits of a cubic's guess, some two, up to twelve.
  CHECK(motion.solves <= 5);
  // Regula falsi gains a factor 1.44 in digits with every one of them, and has less of a guess.
  Motion values{{without_rate(falling)}};
  found = values.first();
  REQUIRE(found);
  CHECK(std::abs(found->probe.at - zero) <= 0.02 / unit);
  CHECK(values.solves <= 14);
  // Nothing is below zero before it.
  Motion earlier{{falling}};
  earlier.length = 0.45;
  CHECK_FALSE(earlier.first());
}

TEST_CASE("of several margins the first to cross is found, and all that cross with it") {
  const Margin later{[](double t) { return 0.71 - t; }, [](double) { return -1.0; }};
  const Margin twice{[](double t) { return 2.3 * (std::cos(3 * t) - 0.2); },
                     [](double t) { return -6.9 * std::sin(3 * t); }};
  const Margin never{[](double t) { return 0.3 + t; }, [](double) { return 1.0; }};
  const double zero = std::acos(0.2) / 3;
  for (const bool rates : {true, false}) {
    Motion motion{{never, later, falling, without_rate(later)}};
    if (!rates)
      for (Margin& m : motion.margins) m = without_rate(m);
    auto found = motion.first();
    REQUIRE(found);
    CHECK(found->which == Which{2});
    CHECK(std::abs(found->probe.at - zero) <= 0.02 / unit);
    motion.margins = {later, twice, never, falling};
    found = motion.first();
    REQUIRE(found);
    CHECK(found->which == Which{1, 3});
    CHECK(std::abs(found->probe.at - zero) <= 0.02 / unit);
  }
  // The first of many is looked for first: no others are closed in on.
  const auto late = [](double t) { return 0.9 - t * t; };
  Motion many{std::vector<Margin>(6, Margin{late, nullptr})};
  many.margins.insert(many.margins.end(), {{[](double t) { return 0.8 - t * t; }, nullptr},
                                           {[](double t) { return 0.7 - t * t; }, nullptr},
                                           {[](double t) { return 0.6 - t * t; }, nullptr},
                                           {[](double t) { return 0.5 - t * t; }, nullptr},
                                           falling});
  REQUIRE(many.first());
  const int of_many = many.solves;
  Motion alone{{falling}};
  REQUIRE(alone.first());
  CHECK(of_many == alone.solves);
  // One that looks later from the ends (a straight line falls to zero at 0.97) and is earlier.
  const Margin sagging{[](double t) { return 0.3 * (0.6 - t) * (1.05 - t); }, nullptr};
  Motion motion{{later, sagging}};
  const auto found = motion.first();
  REQUIRE(found);
  CHECK(found->which == Which{1});
  CHECK(std::abs(found->probe.at - 0.6) <= 0.1 / unit);
}

TEST_CASE("a margin that dips below zero inside a step is not missed, one that stays above is left alone") {
  for (const bool rates : {true, false})
    for (const int parts : {3, 7, 12}) {
      INFO(parts << " parts" << (rates ? ", rates" : ""));
      Motion motion{{rates ? dip : without_rate(dip)}};
      const auto found = motion.first(parts);
      REQUIRE(found);
      CHECK(std::abs(found->probe.at - 0.32) <= 0.1 / unit);
      CHECK(found->which == Which{0});
      CHECK(motion.solves <= 40);
      Motion clear{{rates ? above : without_rate(above)}};
      CHECK_FALSE(clear.first(parts));
      CHECK(clear.solves <= 40);
    }
}

// Below zero where the cosine is above 0.9: around 0.24 s and 0.87 s (10 / s), the second time deeper.
TEST_CASE("of several dips the first that is below zero is found, and those before it are passed") {
  const Margin twice{[](double t) { return 0.9 + 0.2 * (0.2 - t) - std::cos(10 * (t - 0.24)); },
                     [](double t) { return -0.2 + 10 * std::sin(10 * (t - 0.24)); }};
  const Margin second{[](double t) { return 1.01 + 0.2 * (0.2 - t) - std::cos(10 * (t - 0.24)); },
                      [](double t) { return -0.2 + 10 * std::sin(10 * (t - 0.24)); }};
  const auto zero = [](const Margin& m, double low, double high) {  // by bisection, m(low) > 0 > m(high)
    for (int k = 0; k < 60; ++k) (m.value(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
    return low;
  };
  for (const bool rates : {true, false})
    for (const double length : {1.0, 0.9}) {  // its end is above zero or below
      INFO((rates ? "rates, " : "") << length << " s");
      Motion motion{{rates ? twice : without_rate(twice)}};
      motion.length = length;
      auto found = motion.first(15);
      REQUIRE(found);
      CHECK(std::abs(found->probe.at - zero(twice, 0.1, 0.24)) <= 0.1 / unit);
      motion.margins = {rates ? second : without_rate(second)};
      found = motion.first(15);
      REQUIRE(found);
      CHECK(std::abs(found->probe.at - zero(second, 0.6, 0.87)) <= 0.1 / unit);
    }
}

TEST_CASE("a dip next to an end of the step shows by the rate there") {
  // Parts are 1/16 s. From 0.02 s to 0.04 s, and from 0.96 s to 0.98 s.
  const Margin first{[](double t) { return 30 * (t - 0.02) * (t - 0.04); },
                     [](double t) { return 60 * (t - 0.03); }};
  const Margin last{[](double t) { return 30 * (t - 0.96) * (t - 0.98); },
                    [](double t) { return 60 * (t - 0.97); }};
  for (const auto& [margin, at] : {std::pair{first, 0.02}, std::pair{last, 0.96}}) {
    Motion motion{{margin}};
    const auto found = motion.first(15);
    REQUIRE(found);
    CHECK(std::abs(found->probe.at - at) <= 0.1 / unit);
  }
}

TEST_CASE("a margin that begins at zero crosses at once if it falls, and later if it rises first") {
  const Margin sinking{[](double t) { return -0.4 * t; }, [](double) { return -0.4; }};
  for (const bool rates : {true, false}) {
    Motion down{{rates ? sinking : without_rate(sinking)}};
    auto found = down.first();
    REQUIRE(found);
    CHECK(found->probe.at == 0);
    CHECK(found->which == Which{0});
    Motion up{{rates ? thrown : without_rate(thrown)}};
    found = up.first();
    REQUIRE(found);
    CHECK(std::abs(found->probe.at - 0.6) <= 0.1 / unit);
    CHECK(found->which == Which{0});
  }
  // Both begin at zero: the one that rises does not cross with the one that falls.
  Motion both{{thrown, sinking}};
  both.length = 0.9;
  const auto found = both.first();
  REQUIRE(found);
  CHECK(found->probe.at == 0);
  CHECK(found->which == Which{1});
  // All that fall at once cross together, and nothing that crosses later.
  const Margin faster{[](double t) { return -0.7 * t - t * t; }, [](double t) { return -0.7 - 2 * t; }};
  for (const Margin& other : {faster, without_rate(faster)}) {
    Motion several{{falling, sinking, thrown, other}};
    const auto all = several.first();
    REQUIRE(all);
    CHECK(all->probe.at == 0);
    CHECK(all->which == Which{1, 3});
  }
}

TEST_CASE("a margin that begins at zero and is back within a part of the step has crossed at once") {
  // Parts are 1/8 s; below zero until 0.05 s. Where it comes back its rate may not be known.
  const auto value = [](double t) { return t * (t - 0.05); };
  const Margin known{value, [](double t) { return 2 * t - 0.05; }};
  const Margin at_ends{value, [](double t) {
                         return t > 0 && t < 0.06 ? std::numeric_limits<double>::quiet_NaN() : 2 * t - 0.05;
                       }};
  for (const Margin& margin : {known, at_ends}) {
    Motion motion{{margin}};
    const auto found = motion.first();
    REQUIRE(found);
    CHECK(found->probe.at == 0);
    CHECK(found->which == Which{0});
  }
}

TEST_CASE("a margin that begins at zero with a rate of rounding alone and rises is not passed at once") {
  // Back at zero after 0.6 s; with the rate alone, by both ends, it were after 1e-20 s.
  Motion motion{{Margin{[](double t) { return t * t * (0.6 - t) + 1e-20 * t; },
                        [](double t) { return 1.2 * t - 3 * t * t + 1e-20; }}}};
  const auto found = motion.first();
  REQUIRE(found);
  CHECK(std::abs(found->probe.at - 0.6) <= 0.1 / unit);
}

TEST_CASE("a crossing is found before where steps cannot be solved") {
  Motion motion{{falling}};
  motion.solvable = 0.6;
  const auto found = motion.first();
  REQUIRE(found);
  CHECK(std::abs(found->probe.at - std::acos(0.2) / 3) <= 0.02 / unit);
}

}  // namespace crossing_test
