// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <SDL2/SDL.h>

#include <optional>

#include "app/panel/input_event.hpp"

namespace unfurl {

// What the panel is told of an SDL event; nothing where it is none of its business. `pixels`: per unit of
// mouse coordinates.
std::optional<InputEvent> input_event(const SDL_Event& event, float pixels);

}  // namespace unfurl
