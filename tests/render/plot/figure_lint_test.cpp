// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>
#include <chrono>
#include <tuple>

#include "render/plot/layout.hpp"
#include "render/plot/painter.hpp"
#include "render/plot/text_metrics.hpp"
#include "tests/render/plot/recording_canvas.hpp"
#include "tests/render/plot/sample_figures.hpp"

namespace unfurl {

using plot::faults;

TEST_CASE("no figure has text outside, overlapping, pale or out of size", "[figure]") {
  for (const Figure& figure : sample_figures()) CHECK(faults(figure) == std::vector<std::string>{});
}

TEST_CASE("figures of any data are in order in every style", "[figure]") {
  for (const FigureStyle& style : figure_styles())
    for (const Figure& figure : sample_figures()) {
      // Nine panels with titles and labels of their own are more than a slide or a column holds.
      if (figure.panels.size() > 6 && style.width_mm > 0) continue;
      CAPTURE(style.name);
      CHECK(faults(figure, style) == std::vector<std::string>{});
    }
}

TEST_CASE("styles differ in what they say they differ in", "[figure]") {
  const Figure figure = sample_figures().front();
  const auto texts = [&](const char* style) {
    plot::RecordingCanvas canvas;
    plot::paint(figure, plot::lay_out(figure, layout_options(figure, *find_figure_style(style))), canvas);
    std::vector<std::string> out;
    for (const auto& t : canvas.texts) out.push_back(t.text);
    return out;
  };
  const auto has_title = [&](const char* style) {
    const auto all = texts(style);
    return std::find(all.begin(), all.end(), figure.title) != all.end();
  };
  CHECK(has_title("screen"));
  CHECK(has_title("slide"));
  CHECK_FALSE(has_title("single-column"));
  CHECK(texts("screen").size() > texts("slide").size());  // the caption's lines
  CHECK(find_figure_style("poster") == nullptr);
}

TEST_CASE("curves alike but for their colour are found", "[figure]") {
  Figure figure;
  figure.name = "alike";
  figure.panels.resize(1);
  Curve c;
  c.x = {0, 1}, c.y = {0, 1}, c.label = "one";
  figure.panels[0].curves = {c, c};
  CHECK(plot::twins(figure).size() == 1);
  figure.panels[0].curves[1].dash = Dash::dotted;
  CHECK(plot::twins(figure).empty());
}

TEST_CASE("figures stay in order at other sizes", "[figure]") {
  for (Figure figure : sample_figures()) {
    figure.width_mm *= 0.75;
    CHECK(faults(figure) == std::vector<std::string>{});
    figure.width_mm *= 2;
    figure.height_mm *= 1.5;
    CHECK(faults(figure) == std::vector<std::string>{});
  }
}

TEST_CASE("the judge sees what is wrong", "[figure]") {
  plot::RecordingCanvas canvas;
  Figure figure = sample_figures().front();
  figure.height_mm = 12;  // no room for anything
  CHECK_FALSE(faults(figure).empty());
}

TEST_CASE("an empty figure and a figure of empty panels are painted", "[figure]") {
  Figure figure;
  figure.name = "empty";
  CHECK(faults(figure).empty());
  figure.panels.resize(5);
  figure.rows = 2, figure.columns = 3;
  CHECK(faults(figure).empty());
}

TEST_CASE("a million points are thinned to what a page can show", "[figure]") {
  Figure figure;
  figure.panels.resize(1);
  Curve c;
  for (long i = 0; i < 1000000; ++i)
    c.x.push_back(static_cast<double>(i)), c.y.push_back(static_cast<double>(i * 7919 % 10007));
  figure.panels[0].curves.push_back(c);
  const plot::FigureLayout layout = plot::lay_out(figure);
  plot::RecordingCanvas canvas;
  plot::paint(figure, layout, canvas);
  CHECK(static_cast<double>(canvas.points) < 4 * layout.width / plot::trace_column + 1000);
  CHECK(static_cast<double>(canvas.points) > 2 * layout.width / plot::trace_column);
}

TEST_CASE("curves keep their place: points land where the axes say", "[figure]") {
  Figure figure;
  figure.panels.resize(1);
  Curve c;
  c.x = {0, 1, 2}, c.y = {10, 30, 20};
  figure.panels[0].curves.push_back(c);
  figure.panels[0].x.max = 4;
  figure.panels[0].y.max = 40;
  const plot::FigureLayout layout = plot::lay_out(figure);
  const plot::PanelLayout& p = layout.panels[0];
  REQUIRE(p.curves[0].size() == 1);
  const auto& line = p.curves[0][0];
  CHECK(line[1].x == Approx(p.frame.x0 + 0.25 * p.frame.width()));
  CHECK(line[1].y == Approx(p.frame.y1 - 0.75 * p.frame.height()));
}

// What follows the unit says how signs are meant.
TEST_CASE("the label of a low axis is whole", "[figure]") {
  for (const char* label : {"axial stress (MPa), tension > 0", "axial force (N), tension > 0",
                            "largest bay second_membrane_support third_membrane_support"})
    for (const double height_mm : {60.0, 40.0, 34.0}) {
      if (height_mm < 50 && std::string(label).find('_') != std::string::npos)
        continue;  // a word has no room
      CAPTURE(label, height_mm);
      Figure figure;
      figure.height_mm = height_mm;
      figure.panels.resize(1);
      figure.panels[0].y.label = label;
      Curve c;
      c.x = {0, 1}, c.y = {-50, 100};
      figure.panels[0].curves.push_back(c);
      std::string said;
      const plot::FigureLayout layout = plot::lay_out(figure);
      for (const plot::Label& l : layout.panels[0].labels)
        if (l.style.upward) said += (said.empty() ? "" : " ") + l.text;
      CHECK(said == label);
    }
}

TEST_CASE("equal scales are equal", "[figure]") {
  Figure figure;
  figure.panels.resize(1);
  figure.panels[0].segments.push_back({0, 0, 3, 1});
  figure.panels[0].equal_scale = true;
  for (const bool bare : {false, true}) {
    figure.panels[0].bare = bare;
    const plot::FigureLayout layout = plot::lay_out(figure);
    const plot::PanelLayout& p = layout.panels[0];
    const double x = p.x.scale(1) - p.x.scale(0), y = p.y.scale(0) - p.y.scale(1);
    CHECK(x == Approx(y).epsilon(1e-12));
    CHECK(p.x.scale(3) <= p.frame.x1 + 1e-9);
  }
}

TEST_CASE("legends hide no data", "[figure]") {
  std::size_t inside = 0, above = 0;
  for (const Figure& figure : sample_figures()) {
    const plot::FigureLayout layout = plot::lay_out(figure);
    for (std::size_t i = 0; i < layout.panels.size(); ++i) {
      const auto& p = layout.panels[i];
      if (!p.legend) continue;
      CAPTURE(figure.name, i);
      if (!p.legend->inside) {
        CHECK(p.legend->box.y1 <= p.frame.y0);
        ++above;
        continue;
      }
      ++inside;
      CHECK(p.frame.contains(p.legend->box));
      for (const auto& pieces : p.curves)
        for (const auto& line : pieces)
          for (const auto& at : line) CHECK_FALSE(p.legend->box.contains({at.x, at.y, at.x, at.y}));
    }
  }
  CHECK(inside > 0);
  CHECK(above > 0);
}

// Without their legends' names the same panels have all the room that there is.
TEST_CASE("legends leave half of the room to what they explain", "[figure]") {
  const auto heights = [](const Figure& figure, const FigureStyle& style) {
    double sum = 0;
    for (const plot::PanelLayout& p : plot::lay_out(figure, layout_options(figure, style)).panels)
      sum += p.frame.height();
    return sum;
  };
  std::size_t cut = 0;
  for (const Figure& figure : sample_figures()) {
    Figure bare = figure;
    for (Panel& panel : bare.panels) {
      for (Curve& curve : panel.curves) curve.label.clear();
      for (Band& band : panel.bands) band.label.clear();
    }
    for (const FigureStyle& style : figure_styles()) {
      CAPTURE(figure.name, style.name);
      CHECK(heights(figure, style) >=
            0.499 * heights(bare, style));  // the rest: ticks that another frame has
      const plot::FigureLayout layout = plot::lay_out(figure, layout_options(figure, style));
      for (std::size_t i = 0; i < layout.panels.size(); ++i) {
        if (!layout.panels[i].legend) continue;
        // Every name is there, or counted.
        const auto& entries = layout.panels[i].legend->entries;
        const std::size_t named = figure.panels[i].curves.size() + figure.panels[i].bands.size();
        const bool all = entries.back().curve || entries.back().band;
        CHECK((all ? entries.size() == named
                   : entries.back().label.text ==
                         "and " + std::to_string(named - entries.size() + 1) + " more"));
        cut += all ? 0 : 1;
      }
    }
  }
  CHECK(cut > 0);
}

// Thirty events in a tenth of the run have no room for their names, eight over all of it do.
TEST_CASE("names of many events stand at no other event's line", "[figure]") {
  for (const bool close : {false, true}) {
    const int events = close ? 30 : 8;
    Figure figure;
    figure.width_mm = 160, figure.height_mm = 85;
    figure.panels.resize(1);
    Panel& panel = figure.panels[0];
    Curve c;
    c.x = {0, 10}, c.y = {0, 1};
    panel.curves.push_back(c);
    for (int k = 0; k < events; ++k)
      panel.lines.push_back({close ? 4 + 0.03 * k : 0.2 + 1.2 * k, false, "stop " + std::to_string(k), 7});
    const plot::PanelLayout layout = plot::lay_out(figure).panels.at(0);
    int named = 0;
    for (const plot::Label& label : layout.labels) {
      if (!label.text.starts_with("stop ")) continue;
      ++named;
      const plot::Rect box = plot::text_box(label.at, label.text, label.style);
      for (const ReferenceLine& line : panel.lines) {
        const double x = layout.x.scale(line.value);
        CAPTURE(label.text, line.label);
        CHECK((x < box.x0 || x > box.x1));
      }
    }
    if (close)
      CHECK((named >= 1 && named <= 2));  // beside the first line and beside the last one
    else
      CHECK(named == events);
  }
}

namespace {

// Of two events at 1.5 and another place of 10.
plot::PanelLayout two_events(const std::string& name, double second) {
  Figure figure;
  figure.width_mm = 89, figure.height_mm = 60;
  figure.panels.resize(1);
  Panel& panel = figure.panels[0];
  Curve c;
  c.x = {0, 10}, c.y = {0, 0};
  panel.curves.push_back(c);
  panel.y.min = -1, panel.y.max = 1;
  for (const double at : {1.5, second}) panel.lines.push_back({at, false, name, 7});
  return plot::lay_out(figure).panels.at(0);
}

}  // namespace

// To the first event's left there is no room, and to its right no more than for a part of the name.
TEST_CASE("a long name of an event stands in lines rather than across another event", "[figure]") {
  for (const auto& [name, second, lines] : {std::tuple{"slips the other way", 3.5, 2},
                                            {"slips the other way", 3.1, 3},
                                            {"gives way", 2.6, 2},
                                            {"pulls the", 2.6, 2}}) {
    const plot::PanelLayout layout = two_events(name, second);
    std::string all;
    int there = 0;
    for (const plot::Label& label : layout.labels) {
      if (label.text.find_first_of("-0123456789") != std::string::npos) continue;
      all += label.text + " ";
      ++there;
      CAPTURE(name, label.text);
      CHECK_FALSE(label.backed);
      const plot::Rect box = plot::text_box(label.at, label.text, label.style);
      for (const double at : {1.5, second})
        CHECK((layout.x.scale(at) < box.x0 || layout.x.scale(at) > box.x1));
    }
    CHECK(all == name + std::string(" ") + name + " ");
    CHECK(there == lines + 1);  // the second one has room in one
  }
}

}  // namespace unfurl
