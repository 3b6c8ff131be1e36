// SPDX-License-Identifier: BSD-3-Clause
// What is written and drawn over a picture: labels, legend, colour bar, scale bar, axes, dimensions, inset.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "render/scene/frame_builder.hpp"

namespace unfurl {

class FrameOverlay {
 public:
  // Everything given must outlive the overlay. field: null where rods are coloured by group.
  FrameOverlay(const Trajectory& trajectory, const FrameStyle& style, const Look& look,
               const Appearance& looks, const RodField* field, const Mat3& upright);

  // whole: the positions of all nodes at the time t.
  void add(double t, const VectorXd& whole, DrawList& list) const;
  // What is written in the corners: at the top on the left, and legend and colours at the bottom on the
  // right; 0: nothing is.
  struct Words {
    CornerRoom heading, legend;
    double status = 0;  // how high time and share of the deployment reach from the bottom
  };
  Words words(bool loads) const;
  // As much of it that time and scale bar take at the bottom.
  double footing_top() const;
  // What an inset takes at the right of the structure, or above it, as shares of the picture; of the other 0.
  struct InsetRoom {
    double right = 0, top = 0;
  };
  InsetRoom inset_room() const;
  void add_key(double t, DrawList& list) const;  // what colours and signs of a picture stand for
  // Title, thickness and legend, as wanted, on a strip that is as wide as given and as high as they need;
  // returns that height, 0 where nothing is written [pixels].
  int add_banner(double t, bool title, bool thickness, bool legend, int width, DrawList& list) const;

 private:
  struct Box {  // a place that is taken [pixels]
    float x0, y0, x1, y1;
    bool overlaps(const Box& o) const { return x0 < o.x1 && o.x0 < x1 && y0 < o.y1 && o.y0 < y1; }
  };
  using Boxes = std::vector<Box>;
  struct LegendEntry {
    bool arrow;
    std::string name;
    Color color;
    float width;     // with its sign [pixels]
    float line = 0;  // of what is drawn as a line, its width [pixels]
  };
  struct LegendRow {
    float y;
    std::vector<LegendEntry> entries;
  };
  // What is written over the picture, the most important first: where texts lie on each other or leave the
  // picture, the less important ones are left out.
  enum class Part {
    status,
    title,
    color_bar,
    legend,
    second_line,  // of the title
    inset,
    thickness,
    method,
    errors,
    scale_bar,
    axes
  };
  using Parts = std::set<Part>;
  struct Piece {
    Part part;
    Box box;
  };
  // How far up a box has to go to be clear of those that are taken, all of them in the lower part.
  float lifted(Box box, const Boxes& taken) const;
  std::vector<LegendEntry> legend_entries(double t, const DrawList& list) const;
  std::vector<LegendRow> legend_rows(std::vector<LegendEntry> entries, float y, const Boxes& taken) const;
  struct Heading {
    float y, room;  // of the next line, and how wide that may be [pixels]
  };
  void add_line_of_heading(Heading& heading, float size, const std::string& text, int most,
                           DrawList& list) const;
  bool has_colors() const {  // something in the picture has those of the field
    return !trajectory_.structure().rod_copies.empty() || field_->lines.cols() > 0;
  }
  Parts wanted() const;
  // Everything that is wanted and has room.
  std::vector<Piece> write(double t, const VectorXd& whole, Parts wanted, DrawList& list) const;
  std::vector<Piece> write_all(double t, const VectorXd& whole, const Parts& wanted, DrawList& list) const;
  // The least important part that is in the way of another, or has no room in the picture.
  std::optional<Part> in_the_way(const std::vector<Piece>& pieces) const;
  VectorXd solved(const VectorXd& whole) const;
  void add_sample(DrawList& list, float x, float y, const LegendEntry& entry) const;
  // A text on ground as quiet as the background: what is behind shines through a little.
  TextLabel quiet(const DrawList& list, TextLabel label) const;
  void prepare_inset();
  // `placed` is told of every part behind it.
  void add_heading(double t, const Parts& wanted, const std::function<void(Part)>& placed,
                   DrawList& list) const;
  // These take their places in the lower part one after the other, and none that is taken.
  void add_status(double t, const VectorXd& whole, Boxes& taken, DrawList& list) const;
  void add_axes(Boxes& taken, DrawList& list) const;
  void add_color_bar(Boxes& taken, DrawList& list) const;
  void add_scale_bar(Boxes& taken, DrawList& list) const;
  void add_legend(double t, Boxes& taken, DrawList& list) const;
  void add_dimensions(const VectorXd& whole, DrawList& list) const;
  float number_place(const Eigen::Vector2f& p, const Eigen::Vector2f& q, const Eigen::Vector2f& half,
                     const DrawList& list) const;
  void add_dimension(const Vec3& a, const Vec3& b, const Vec3& away, DrawList& list) const;
  static Box box_of(const TextLabel& label);
  void add_names(const VectorXd& whole, const std::vector<Piece>& written, DrawList& list) const;
  void add_name(const std::string& name, const Vec3& at, std::vector<Box>& taken, DrawList& list) const;
  void add_inset(double t, DrawList& list) const;

  const Trajectory& trajectory_;
  const FrameStyle& style_;
  const Look& look_;
  const Appearance& looks_;
  const RodField* field_;
  const Mat3& upright_;
  // [pixels], of which supersampled pictures have more
  float width_, height_, fine_, unit_, edge_, small_, large_;
  bool on_banner_ = false;
  std::shared_ptr<Figure> inset_;  // of the whole run
};

// How far dimension lines are from what they measure, in radii of the picture
// (DrawList::framed_radius).
inline constexpr double dimension_gap = 0.09;

// The largest of 1, 2 and 5 times a power of ten that is not above x.
double round_length(double x);

}  // namespace unfurl
