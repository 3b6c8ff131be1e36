// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <imgui.h>

#include <span>
#include <string_view>

#include "app/panel/input_event.hpp"
#include "app/panel/panel_state.hpp"

namespace unfurl {

// What a key does.
struct Shortcut {
  Key key;
  bool control, shift;
  std::string_view name, help;  // for the list of keys; a name of "" is in another row's list entry
  void (*act)(PanelState&);
};
std::span<const Shortcut> shortcuts();

// Does what the key stands for; nothing where it stands for nothing.
void press(PanelState& state, const InputEvent& event);

void map_keys(ImGuiIO& io);  // tell ImGui where in KeysDown a Key is

}  // namespace unfurl
