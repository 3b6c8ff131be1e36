// SPDX-License-Identifier: BSD-3-Clause
// A picture as data: what the frame builder makes and the renderer draws. Testable without GL.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "render/plot/figure.hpp"

namespace unfurl {

using Vec3f = Eigen::Vector3f;

struct Color {
  float r = 0, g = 0, b = 0, a = 1;  // sRGB-encoded, 0..1
};
inline Color mixed(const Color& a, const Color& b, float u) {
  return {a.r + u * (b.r - a.r), a.g + u * (b.g - a.g), a.b + u * (b.b - a.b), a.a};
}

// How light meets a surface; the colour is the rest.
enum class Finish { paint, anodised, metal, carbon, foil };

// How a picture is painted: lit as in a room, by a hard light in the dark, as a line drawing with hidden
// lines, or in flat colours.
enum class Shading { studio, space, outline, flat };

struct Tube {  // a round rod with round ends
  Vec3f a, b;
  float radius;  // [m]
  Color color;
  Finish finish = Finish::anodised;
};

struct Sleeve {  // a short cylinder with flat, bevelled ends: end fittings, collars
  Vec3f a, b;
  float radius;  // [m]
  Color color;
  Finish finish = Finish::metal;
};

struct Plate {  // flat, round around a: the lug of a hinge
  Vec3f a, b;
  Vec3f side;                        // across it, of unit length: the axis of the pin at a
  float half_width, half_thickness;  // [m]
  Color color;
  Finish finish = Finish::metal;
};

struct Ball {
  Vec3f center;
  float radius;  // [m]
  Color color;
  Finish finish = Finish::metal;
};

struct Arrow {  // from tail to head
  Vec3f tail, head;
  float radius;  // of the shaft; the head is wider [m]
  Color color;
};

// What a surface is made of.
enum class Weave { mesh, net, film, cells };

struct SkinVertex {
  Vec3f at, normal;
  Eigen::Vector2f cell;  // its place in the pattern, lines of which are where a coordinate is whole
};

// A surface with a pattern, seen from both sides.
struct Skin {
  std::vector<SkinVertex> vertices;
  std::vector<std::uint32_t> triangles;
  Weave weave = Weave::mesh;
  Color front, back;    // the front is where normals point
  float opacity = 1;    // of what is between the lines, seen straight on
  bool square = false;  // the pattern has squares, not triangles
};

// Perspective, or parallel where parallel_height > 0.
struct Camera {
  Vec3f eye = Vec3f(0, -10, 3), target = Vec3f::Zero(), up = Vec3f::UnitZ();
  float vertical_field_of_view = 0.5f;  // [rad]
  float near_plane = 0.1f, far_plane = 100.0f;
  float parallel_height = 0;  // what a parallel projection shows from the lower edge to the upper one [m]
};

struct TextLabel {     // drawn over the picture, in pixels from the top left
  float x = 0, y = 0;  // of the upper edge
  float height = 16;   // [pixels]
  Color color;
  std::string text;
  float align = 0;  // 0 left, 0.5 centre, 1 right
  bool bold = false;
  Color backing{0, 0, 0, 0};  // of a box behind the text
};

struct OverlayLine {  // drawn over the picture, under the labels [pixels]
  float x0, y0, x1, y1;
  float width;
  Color color;
};

struct OverlayArea {  // a filled rectangle over the picture, under the lines [pixels]
  float x0, y0, x1, y1;
  Color color;
  float round = 0;  // radius of its corners
};

struct Inset {  // a figure over the picture; null: none
  std::shared_ptr<const Figure> figure;
  float x = 0, y = 0, width = 0, height = 0;  // [pixels]
  double pixels_per_point = 1;
};

struct Ground {
  bool shown = true;
  bool grid = true;  // else only the shadow tells where it is
  float z = 0;       // height [m]
  float cell = 1;    // grid spacing [m]
  float fade = 20;   // distance from the centre at which the grid has faded out [m]
  Vec3f center = Vec3f::Zero();
  Color lines{0.36f, 0.44f, 0.54f, 0.34f}, shadow{0.045f, 0.10f, 0.20f, 0.50f};
};

struct DrawList {
  Camera camera;
  std::vector<Tube> tubes;
  std::vector<Sleeve> sleeves;
  std::vector<Plate> plates;
  std::vector<Ball> balls;
  std::vector<Arrow> arrows;
  std::vector<Skin> skins;
  std::vector<Tube> ghosts;  // as transparent as their colour says; without shadow
  std::vector<OverlayArea> areas;
  std::vector<OverlayLine> lines;
  std::vector<TextLabel> labels;
  Inset inset;
  Ground ground;
  // A sphere around everything that casts a shadow. Keep it still through a film, or the shadows' edges
  // crawl.
  Vec3f center = Vec3f::Zero();
  float radius = 1;  // [m]
  // A sphere around what the camera shows at once: the same, or less of a motion that it follows.
  Vec3f framed_center = Vec3f::Zero();
  float framed_radius = 1;                   // [m]
  Vec3f light_direction{0.4f, -0.5f, 1.0f};  // towards the light
  Shading shading = Shading::studio;
  bool transparent = false;     // no background; shadows are as transparent as they are light
  Vec3f planet{0, 0, -1};       // the direction to the middle of the Earth,
  float planet_half_angle = 0;  // and half of how wide it is there; 0: it is not there [rad]
  float stars = 0;              // brightness of stars in the background, 0..1
  // The share of the background in what is as far as the far side of the framed sphere; none at its near
  // side.
  float depth_fade = 0;
  float hidden_gap =
      0;  // a line is hidden where something is nearer by more than this [m] (Shading::outline)
  Color background_top{0.80f, 0.85f, 0.90f, 1}, background_bottom{0.95f, 0.96f, 0.97f, 1};
};

}  // namespace unfurl
