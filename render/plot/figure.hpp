// SPDX-License-Identifier: BSD-3-Clause
// A plot as data: painted to pixels through OpenGL or to SVG.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace unfurl {

struct FigureColor {
  float r = 0, g = 0, b = 0, a = 1;
};

enum class Dash { solid, dashed, dotted, dash_dot, long_dashed, dash_dot_dot };
enum class Marker { none, circle, square, triangle, diamond };

struct Curve {
  std::string label;         // legend entry; empty: none
  std::vector<double> x, y;  // NaN breaks the line
  int color = 0;             // index into the colour-blind-safe palette; see palette()
  Dash dash = Dash::solid;
  Marker marker = Marker::none;
  float width = 1.2f;       // [points]; 0: markers only
  float marker_size = 1;    // of the usual one
  bool right_axis = false;  // drawn against the panel's second y axis
};

// The region between two curves over the same x ("from the smallest to the largest force of the group").
struct Band {
  std::string label;
  std::vector<double> x, lower, upper;
  int color = 0;
};

// A horizontal or vertical reference line ("round-off of the rod length").
struct ReferenceLine {
  double value = 0;
  bool horizontal = true;
  std::string label;
  int color = 7;
  bool pale =
      false;  // one of many: thin and light, and none where the one before is too near to be told apart
};

struct Axis {
  std::string label;  // with its unit: "time (s)"
  bool log = false;
  double min = 0, max = 0;  // min == max: from the data
  bool shown = true;        // false: no tick labels and no axis label (a panel that shares the one below)
  bool degrees = false;     // ticks at multiples of 15, 30, 45, ...
  bool whole = false;       // a count: ticks at whole numbers
  // Words in the place of numbers: the k-th at k and about it, each with its tick.
  std::vector<std::string> names = {};
  // Log axes leave out values <= 0. True: exact zeros are drawn at the bottom edge instead; say so in the
  // caption.
  bool zeros_at_floor = false;
};

// A rod of a pose, already projected to the panel's plane.
struct Segment {
  double x0, y0, x1, y1;
  double depth = 0;  // larger is nearer
  int color = 0;
  float width = 2.0f;  // [points]
  // What colour and width show, for the table of the figure's numbers; NaN: nothing.
  double value = std::numeric_limits<double>::quiet_NaN();
};

// A joint of a pose.
struct Dot {
  double x, y;
  double depth = 0;
  int color = 6;
  float radius = 1.0f;  // [points]
};

// A filled rectangle in data units, below everything else: of maps and atlases.
struct Cell {
  double x0, y0, x1, y1;
  FigureColor fill;
  std::string stands_for = {};  // a value or a verdict, for the table of the figure's numbers; empty: nothing
};

struct Panel {
  std::string title;
  Axis x, y, y2;
  std::vector<Cell> cells;  // give the axes limits of their own: cells do not count for them
  std::vector<Band> bands;
  std::vector<Curve> curves;
  std::vector<ReferenceLine> lines;
  std::vector<Segment> segments;  // for poses; drawn by depth
  std::vector<Dot> dots;
  bool equal_scale = false;  // one unit is as long in x as in y
  bool bare = false;         // no axes, ticks or grid
  double scale_bar = 0;      // its length in data units; 0: none
  std::string scale_bar_label;
  double height = 1;  // relative to the other rows; the first panel of a row decides
};

struct Figure {
  std::string name;  // "constraint_error": the file's stem
  std::string title;
  std::string caption;  // one or two sentences with the numbers of this run
  int rows = 1, columns = 1;
  std::vector<Panel> panels;  // row by row
  double width_mm = 160, height_mm = 100;
};

// Colour i of the palette (i counts modulo its size). 0 blue, 1 vermilion, 2 green, 3 purple, 4 ochre, 5 sky,
// 6 ink, 7 grey: told apart with every kind of colour blindness, each with a contrast of 3 or more on white.
FigureColor palette(int i);
inline constexpr int palette_size = 8;
// From this index on colours are those of groups of rods, as pictures before a pale ground have them, but
// none paler than a contrast of 3 on white.
inline constexpr int first_group_color = 64 * palette_size;

// A colour for u in [0, 1] on a map of values: from dark blue over green to yellow, evenly in lightness
// ("viridis").
FigureColor map_color(double u);

}  // namespace unfurl
