// SPDX-License-Identifier: BSD-3-Clause
// What a person can ask for by a key or by its name.
#pragma once

#include <span>
#include <string_view>

#include "app/panel/input_event.hpp"
#include "app/panel/live_session.hpp"

namespace unfurl {

struct Action {
  Key key;  // none: only by its name
  bool control, shift;
  std::string_view keys, help;  // for the list of keys and the palette
  void (*act)(LiveSession&);
};
std::span<const Action> actions();

// The box that lies above all others; false: none is open.
bool close_box(PanelState& state);

// Does what the key stands for; nothing where it stands for nothing.
void press(LiveSession& session, const InputEvent& event);

}  // namespace unfurl
