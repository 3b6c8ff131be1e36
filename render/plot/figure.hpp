// A plot as data: painted to pixels through OpenGL or to SVG.
#pragma once

#include <string>
#include <vector>

namespace unfurl {

struct FigureColor {
  float r = 0, g = 0, b = 0, a = 1;
};

enum class Dash { solid, dashed, dotted, dash_dot };
enum class Marker { none, circle, square, triangle, diamond };

struct Curve {
  std::string label;  // legend entry; empty: none
  std::vector<double> x, y;  // NaN breaks the line
  int color = 0;             // index into the colour-blind-safe palette; see palette()
  Dash dash = Dash::solid;
  Marker marker = Marker::none;
  float width = 1.5f;        // [points]
  bool right_axis = false;   // drawn against the panel's second y axis
};

// A horizontal or vertical reference line ("round-off of the rod length").
struct ReferenceLine {
  double value = 0;
  bool horizontal = true;
  std::string label;
  int color = 7;
};

struct Axis {
  std::string label;  // with its unit: "time (s)"
  bool log = false;
  double min = 0, max = 0;  // min == max: from the data
  bool shown = true;
};

// A rod of a pose, already projected to the panel's plane.
struct Segment {
  double x0, y0, x1, y1;
  double depth = 0;  // larger is nearer
  int color = 0;
  float width = 2.0f;  // [points]
};

struct Panel {
  std::string title;
  Axis x, y, y2;
  std::vector<Curve> curves;
  std::vector<ReferenceLine> lines;
  std::vector<Segment> segments;  // for poses; drawn with equal scales on both axes
  bool equal_scale = false;
};

struct Figure {
  std::string name;     // "constraint_error": the file's stem
  std::string title;
  std::string caption;  // one or two sentences with the numbers of this run
  int rows = 1, columns = 1;
  std::vector<Panel> panels;  // row by row
  double width_mm = 160, height_mm = 100;
};

}  // namespace unfurl
