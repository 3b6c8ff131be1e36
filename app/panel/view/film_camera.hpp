// SPDX-License-Identifier: BSD-3-Clause
// The camera that was led by hand, as keys of the film: [[render.camera_keys]].
#pragma once

#include "app/panel/runs/simulator.hpp"
#include "app/panel/view/orbit_camera.hpp"

namespace unfurl {

// Its direction and how near it is, for a film of the run that looks as `picture` says; what it looks at is
// the film's own affair: the middle of the motion. `others`: keys beside it, whose zooms are taken along
// where the film's distance changes by the new one.
std::vector<CameraKey> keys_with(std::vector<CameraKey> others, const LiveRun& run,
                                 const RenderOptions& picture, const OrbitCamera& orbit, double t);

// Where the film's own camera is at a time, with its distance as keys mean it.
OrbitCamera film_view(const LiveRun& run, const RenderOptions& picture, double t);
bool moves_camera(const RenderOptions& picture);

// The document with the key at the time t, beside those that there are or (`only`) in place of them; what
// moves the camera otherwise is switched off.
SceneDocument with_camera(SceneDocument document, const LiveRun& run, const RenderOptions& picture,
                          const OrbitCamera& orbit, double t, bool only);

}  // namespace unfurl
