// SPDX-License-Identifier: BSD-3-Clause
// What is under the pointer, and what there is to say about it.
#pragma once

#include <string>
#include <vector>

#include "app/panel/document/selection.hpp"
#include "app/panel/runs/simulator.hpp"
#include "render/scene/draw_list.hpp"

namespace unfurl {

struct PickView {
  Camera camera;
  int width = 0, height = 0;        // [pixels]
  Mat3 upright = Mat3::Identity();  // scene -> picture: of x - origin
  Vec3 origin = Vec3::Zero();       // [m of the scene]
};

// The node, or else the rod, whose picture is nearest to a pixel and within `reach` pixels.
// `pose`: another than the run's own at t [3 N].
Selection pick(const LiveRun& run, double t, const PickView& view, float x, float y, float reach,
               const VectorXd* pose = nullptr);

// Where it is in the picture: two ends of a rod, twice the same point of a node; `found` false: the structure
// has no such part.
struct PickedPlace {
  bool found = false;
  Vec3f a, b;  // pixels, and depth [m]
};
PickedPlace place_of(const Selection& selection, const LiveRun& run, double t, const PickView& view);

struct Reading {
  std::string label, value;
};
// Length, axial force, length error (not of an elastic one) of a rod; position and speed of a node; at time
// t.
std::vector<Reading> readings(const Selection& selection, const LiveRun& run, double t);

}  // namespace unfurl
