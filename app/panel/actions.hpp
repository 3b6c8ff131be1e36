// SPDX-License-Identifier: BSD-3-Clause
// What a person can ask for by a key.
#pragma once

#include <span>
#include <string_view>

#include "app/panel/input_event.hpp"
#include "app/panel/live_session.hpp"

namespace unfurl {

struct Action {
  Key key;
  bool control, shift;
  std::string_view keys, help;  // for the list of keys; keys of "": in another row's list entry
  void (*act)(LiveSession&);
};
std::span<const Action> actions();

// Does what the key stands for; nothing where it stands for nothing.
void press(LiveSession& session, const InputEvent& event);

}  // namespace unfurl
