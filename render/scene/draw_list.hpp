// A picture as data: what the frame builder makes and the renderer draws. Testable without GL.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace unfurl {

using Vec3f = Eigen::Vector3f;

struct Color {
  float r = 0, g = 0, b = 0, a = 1;  // sRGB-encoded, 0..1
};

// How light meets a surface; the colour is the rest.
enum class Finish { paint, anodised, metal };

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

struct Camera {
  Vec3f eye = Vec3f(0, -10, 3), target = Vec3f::Zero(), up = Vec3f::UnitZ();
  float vertical_field_of_view = 0.5f;  // [rad]
  float near_plane = 0.1f, far_plane = 100.0f;
};

struct TextLabel {     // drawn over the picture, in pixels from the top left
  float x = 0, y = 0;  // of the upper edge
  float height = 16;   // [pixels]
  Color color;
  std::string text;
  float align = 0;  // 0 left, 0.5 centre, 1 right
  bool bold = false;
};

struct Ground {
  bool shown = true;
  float z = 0;      // height [m]
  float cell = 1;   // grid spacing [m]
  float fade = 20;  // distance from the centre at which the grid has faded out [m]
  Vec3f center = Vec3f::Zero();
};

struct DrawList {
  Camera camera;
  std::vector<Tube> tubes;
  std::vector<Sleeve> sleeves;
  std::vector<Ball> balls;
  std::vector<Arrow> arrows;
  std::vector<TextLabel> labels;
  Ground ground;
  // A sphere around everything that casts a shadow. Keep it still through a film, or the shadows' edges
  // crawl.
  Vec3f center = Vec3f::Zero();
  float radius = 1;                          // [m]
  Vec3f light_direction{0.4f, -0.5f, 1.0f};  // towards the light
  Color background_top{0.80f, 0.85f, 0.90f, 1}, background_bottom{0.95f, 0.96f, 0.97f, 1};
};

}  // namespace unfurl
