// SPDX-License-Identifier: BSD-3-Clause
// How the view draws the run that is shown.
#pragma once

#include "app/panel/panel_state.hpp"
#include "render/scene/frame_builder.hpp"

namespace unfurl {

// The style of the view's pictures, which look as `picture` says. Names in it that the run does not know are
// left out, and what is wrong with them goes to `problems`.
FrameStyle view_style(const PanelState& state, RenderOptions picture,
                      std::vector<SceneProblem>* problems = nullptr);

}  // namespace unfurl
