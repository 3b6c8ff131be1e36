// SPDX-License-Identifier: BSD-3-Clause
// The renderer's bodies of one kind, each as finely faceted as its size in the picture asks for.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/scene/draw_list.hpp"
#include "render/scene/solid_mesh.hpp"

namespace unfurl {

enum class BodyKind { capsule, ball, cylinder, plate };

// The level of detail whose facets are nowhere farther than a third of a pixel from the round body: 0, the
// coarsest, to detail_levels - 1. radius: [pixels].
inline constexpr int detail_levels = 4;
int detail_level(float radius);
// Whether a body that thin, its axis at that cosine to the line of sight, is drawn as a flat ribbon, shaded
// as if it were round: one facet costs less than four or five of a pixel's width. Where its end would be seen
// as more than a line it has facets.
bool is_ribbon(BodyKind kind, float radius, float cosine);
Mesh detailed_mesh(BodyKind kind, int level);

// Needs a current context from construction to destruction.
class RendererBodies {
 public:
  explicit RendererBodies(BodyKind kind);
  ~RendererBodies();
  RendererBodies(const RendererBodies&) = delete;
  RendererBodies& operator=(const RendererBodies&) = delete;

  // What is drawn from now on, seen by that camera in a picture of that height [pixels]. Returns whether it
  // is anything else than before, if only in detail, which shadows have as well.
  bool set(std::vector<SolidInstance> bodies, const Camera& camera, int height);
  const std::vector<SolidInstance>& bodies() const { return bodies_; }
  void draw() const;
  void draw_shadow() const;  // coarser: nobody counts a shadow's corners

 private:
  struct Shape {  // a mesh, with a level's instances
    unsigned vertex_array = 0, vertices = 0, indices = 0;
    int index_count = 0;
  };
  struct Level {
    Shape picture, shadow;
    unsigned instances = 0;
    int count = 0;
  };
  static Shape make_shape(const Mesh& mesh, unsigned instances);
  static void destroy_shape(const Shape& shape);
  static void draw_shape(const Shape& shape, int count);
  void upload();

  BodyKind kind_;
  std::array<Level, detail_levels + 1> levels_;  // the last one: ribbons
  std::vector<SolidInstance> bodies_;
  std::vector<std::uint8_t> detail_;  // level of each body
};

}  // namespace unfurl
