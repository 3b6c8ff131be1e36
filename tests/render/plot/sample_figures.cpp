// SPDX-License-Identifier: BSD-3-Clause
#include "tests/render/plot/sample_figures.hpp"

#include <cmath>
#include <limits>

namespace unfurl {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// A fixed sequence in [0, 1) that looks random.
struct Noise {
  unsigned state = 12345;
  double operator()() {
    state = state * 1664525u + 1013904223u;
    return static_cast<double>(state >> 8) / 16777216.0;
  }
};

template <class F>
Curve curve(std::string label, int n, double end, int color, F f) {
  Curve c;
  c.label = std::move(label);
  c.color = color;
  for (int i = 0; i < n; ++i) {
    const double x = n > 1 ? end * i / (n - 1) : end;
    c.x.push_back(x);
    c.y.push_back(f(x));
  }
  return c;
}

Figure figure(std::string name, std::string title, std::vector<Panel> panels, int rows, int columns,
              double height) {
  Figure f;
  f.name = std::move(name);
  f.title = std::move(title);
  f.caption =
      "Made-up data for the tests: the caption is long enough to need a second line, which has to stay "
      "inside the "
      "figure and below the label of the time axis.";
  f.rows = rows;
  f.columns = columns;
  f.panels = std::move(panels);
  f.height_mm = height;
  return f;
}

Panel panel(std::string y_label, std::vector<Curve> curves) {
  Panel p;
  p.x.label = "time (s)";
  p.y.label = std::move(y_label);
  p.curves = std::move(curves);
  return p;
}

Figure sines() {
  Panel p =
      panel("angle (\u00B0)",
            {curve("sine", 400, 10, 0, [](double t) { return 40 * std::sin(t); }),
             curve("cosine", 400, 10, 1, [](double t) { return 40 * std::cos(t); }),
             curve("damped", 400, 10, 2, [](double t) { return 40 * std::exp(-t / 3) * std::cos(3 * t); })});
  p.curves[1].dash = Dash::dashed;
  p.curves[2].dash = Dash::dash_dot;
  p.lines.push_back({7.3, false, "event", 7});
  p.title = "(a) three curves";
  return figure("sines", "Sine curves", {p}, 1, 1, 80);
}

Figure two_axes() {
  Curve angle = curve("", 300, 4.92, 0, [](double t) { return 90 * std::cos(t * 0.319); });
  Curve fraction = curve("", 300, 4.92, 1, [](double t) { return 1 - std::cos(t * 0.319); });
  fraction.right_axis = true;
  fraction.dash = Dash::dashed;
  Panel p = panel("fold angle (\u00B0)", {angle, fraction});
  p.y.degrees = true;
  p.y2.label = "deployed fraction";
  p.lines.push_back({4.92, false, "deployed", 7});
  return figure("two_axes", "Two axes", {p}, 1, 1, 75);
}

Figure round_off() {
  Noise noise;
  Curve dense =
      curve("100 000 points", 100000, 5, 0, [&](double) { return 1e-17 * std::pow(10.0, 2.8 * noise()); });
  Curve zeros =
      curve("with exact zeros", 200, 5, 1, [&](double) { return noise() < 0.2 ? 0.0 : 1e-15 * noise(); });
  Panel top = panel("relative error", {dense, zeros});
  top.y.log = top.y.zeros_at_floor = true;
  top.x.shown = false;
  top.lines.push_back({2.220446049250313e-16, true, "2\u207B\u2075\u00B2, round-off", 7});
  Panel bottom = panel("velocity error (m/s)",
                       {curve("", 500, 5, 2, [&](double t) { return 1e-14 * noise() * (1 + t * t); })});
  bottom.y.log = true;
  return figure("round_off", "Errors near round-off", {top, bottom}, 2, 1, 110);
}

Figure degenerate() {
  std::vector<Panel> panels;
  panels.push_back(panel("all zero", {curve("zero", 50, 5, 0, [](double) { return 0.0; })}));
  panels.push_back(panel("constant", {curve("constant", 50, 5, 1, [](double) { return 200.0; })}));
  panels.push_back(panel("one point", {curve("a point", 1, 2, 2, [](double) { return 3.5; })}));
  panels.push_back(panel("no data", {}));
  panels.push_back(panel("not numbers", {curve("NaN", 20, 5, 3, [](double) { return nan; })}));
  panels.push_back(panel("gaps", {curve("gaps", 300, 5, 4, [](double t) {
                           return std::sin(3 * t) > 0.9 ? nan : std::sin(3 * t);
                         })}));
  panels.push_back(panel("log of zero", {curve("zero", 30, 5, 5, [](double) { return 0.0; })}));
  panels.back().y.log = panels.back().y.zeros_at_floor = true;
  panels.push_back(
      panel("infinities", {curve("poles", 300, 5, 0, [](double t) { return t < 2 ? 1 / 0.0 : t; })}));
  panels.push_back(
      panel("log of negative", {curve("sine", 300, 5, 1, [](double t) { return std::sin(3 * t); })}));
  panels.back().y.log = true;
  for (std::size_t i = 0; i < panels.size(); ++i)
    panels[i].title = "(" + std::string(1, static_cast<char>('a' + i)) + ") " + panels[i].y.label;
  return figure("degenerate", "Hostile data", panels, 3, 3, 140);
}

Figure magnitudes() {
  std::vector<Panel> panels;
  panels.push_back(panel("huge", {curve("", 200, 5, 0, [](double t) { return 1e300 * std::sin(t); })}));
  panels.push_back(
      panel("tiny", {curve("", 200, 5e-9, 1, [](double t) { return 1e-300 * std::cos(1e9 * t); })}));
  panels.push_back(
      panel("force (N)", {curve("", 200, 5e7, 2, [](double t) { return 1.2e6 * std::sin(t * 1e-7); })}));
  panels.push_back(panel("nearly constant",
                         {curve("", 200, 5, 3, [](double t) { return 1234.5678 + 1e-7 * std::sin(t); })}));
  panels.push_back(
      panel("wide log", {curve("", 200, 5, 4, [](double t) { return std::pow(10.0, -280 + 110 * t); })}));
  panels.back().y.log = true;
  panels.push_back(panel("negative", {curve("", 200, 5, 5, [](double t) { return -3e-4 - 1e-5 * t; })}));
  return figure("magnitudes", "Very large and very small numbers", panels, 2, 3, 110);
}

Figure crowded() {
  Noise noise;
  Panel p = panel("axial force of every rod, a label that does not fit beside its axis in one line (N)", {});
  for (int k = 0; k < 9; ++k) {
    p.curves.push_back(curve("rod group number " + std::to_string(k + 1), 600, 5, k,
                             [&](double t) { return 100 * std::sin(2 * t + k) + 300 * (noise() - 0.5); }));
    p.curves.back().dash = static_cast<Dash>(k % 4);
  }
  p.lines.push_back({0, true, "zero <&> \"slack\"", 7});
  Panel band = panel("force (N)", {});
  Band b;
  b.label = "all chords";
  b.color = 0;
  for (int i = 0; i <= 200; ++i) {
    b.x.push_back(i * 0.025);
    b.lower.push_back(i % 60 == 59 ? nan : -50 - i + 10 * noise());
    b.upper.push_back(60 + 0.5 * i + 10 * noise());
  }
  band.bands.push_back(b);
  band.curves.push_back(curve("posts", 60, 5, 1, [](double t) { return 20 * t; }));
  band.curves.back().marker = Marker::circle;
  return figure("crowded", "Many noisy curves & a band", {p, band}, 2, 1, 150);
}

Figure markers() {
  Panel p = panel("error (m)", {});
  p.x.label = "step (s)";
  p.x.log = p.y.log = true;
  for (int k = 0; k < 4; ++k) {
    Curve c = curve("order " + std::to_string(2 * k + 2), 5, 1, k, [](double) { return 0.0; });
    for (std::size_t i = 0; i < 5; ++i) {
      c.x[i] = 0.1 * std::pow(0.5, static_cast<double>(i));
      c.y[i] = std::pow(c.x[i], 2.0 * k + 2);
    }
    c.marker = static_cast<Marker>(k + 1);
    p.curves.push_back(c);
  }
  return figure("markers", "Orders of convergence", {p}, 1, 1, 90);
}

Figure poses() {
  std::vector<Panel> panels;
  for (int k = 0; k < 6; ++k) {
    Panel p;
    p.title = "t = " + std::to_string(k) + " s";
    p.bare = p.equal_scale = true;
    p.x.min = p.y.min = -6, p.x.max = p.y.max = 6;
    for (int i = 0; i < 12; ++i) {
      const double a = i * 0.5236, b = (i + 1) * 0.5236, r = 1 + k;
      p.segments.push_back({r * std::cos(a), 0.4 * r * std::sin(a), r * std::cos(b), 0.4 * r * std::sin(b),
                            -std::sin(a), 0, 1.5f});
      p.segments.push_back({r * std::cos(a), 0.4 * r * std::sin(a), r * std::cos(a),
                            0.4 * r * std::sin(a) + 1.2, -std::sin(a), 1, 1.5f});
      p.dots.push_back({r * std::cos(a), 0.4 * r * std::sin(a), -std::sin(a), 6, 1.2f});
    }
    if (k == 0)
      p.curves = {curve("chord", 0, 0, 0, [](double) { return 0.0; }),
                  curve("post", 0, 0, 1, [](double) { return 0.0; })};
    if (k == 3) p.scale_bar = 2, p.scale_bar_label = "2 m";
    panels.push_back(p);
  }
  return figure("poses", "Six poses", panels, 2, 3, 100);
}

std::string group_name(int k) {
  return "pendulum number " + std::to_string(k) + " (1 rod)";
}

Figure many_curves() {
  Panel p = panel("axial force (N), tension > 0", {});
  for (int k = 0; k < 60; ++k)
    p.curves.push_back(
        curve(group_name(k), 200, 5, k, [&](double t) { return 100 * std::sin((2 + 0.1 * k) * t + k); }));
  Panel lower = p;
  lower.curves.resize(4);  // its legend has no place inside, either
  for (Panel* each : {&p, &lower}) each->lines.push_back({0, true, "", 7});
  return figure("many_curves", "A legend that is longer than the page", {p, lower}, 2, 1, 110);
}

Figure many_groups() {
  Figure f = poses();
  f.name = "many_groups", f.height_mm = 70;
  f.panels.front().curves.clear();
  for (int k = 0; k < 90; ++k)
    f.panels.front().curves.push_back(curve(group_name(k), 0, 0, k, [](double) { return 0.0; }));
  return f;
}

Figure long_caption() {
  Figure f = sines();
  f.name = "long_caption";
  for (int k = 0; k < 60; ++k)
    f.caption += " Event \u201Cstop number " + std::to_string(k) + "\u201D at 1.25 s.";
  return f;
}

}  // namespace

std::vector<Figure> sample_figures() {
  return {sines(),   two_axes(), round_off(),   degenerate(),  magnitudes(),  crowded(),
          markers(), poses(),    many_curves(), many_groups(), long_caption()};
}

}  // namespace unfurl
