// SPDX-License-Identifier: BSD-3-Clause
// The camera that was led by hand, as keys of the film: [[render.camera_keys]].
#pragma once

#include "app/panel/panel_state.hpp"

namespace unfurl {

// Where the film's own camera is at the present time, with its distance as keys mean it, in a picture of the
// view's size.
OrbitCamera film_view(const PanelState& state);

// The document with a key at the present time, beside those that there are or (`only`) in place of them: the
// camera's direction, and its zoom: how much nearer it is than one that sees the whole motion in the view.
// What it looks at is the film's own affair: the middle of the motion. What moves the camera otherwise is
// switched off; zooms of other keys are taken along where the film's distance changes by the new one.
SceneDocument with_camera(const PanelState& state, const OrbitCamera& orbit, bool only);

}  // namespace unfurl
