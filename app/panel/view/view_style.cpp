// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/view/view_style.hpp"

#include "render/scene/film_style.hpp"

namespace unfurl {

FrameStyle view_style(const PanelState& state, RenderOptions picture, std::vector<SceneProblem>* problems) {
  picture.transparent = false;
  picture.supersample = 1;
  if (!state.view.labels) picture.title = picture.time = false;
  const LiveRun& run = *state.shown;
  Scene scene = run.scene;
  scene.render = std::move(picture);
  const auto styled = [&] {
    FrameStyle style = film_style(scene, run.simulation, run.diagnostics);
    style.width = state.view_place.width;
    style.height = state.view_place.height;
    style.words = state.view_place.words;
    style.covered = state.view_place.heading;
    style.loads = style.loads && state.view.loads;
    return style;
  };
  try {
    return styled();
  } catch (const SceneError& error) {
    if (problems) *problems = error.problems();
    scene.render.inset = scene.render.trails = "";
    return styled();
  }
}

}  // namespace unfurl
