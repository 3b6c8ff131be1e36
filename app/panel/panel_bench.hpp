// SPDX-License-Identifier: BSD-3-Clause
// How fast the panel is: frames a second while the view turns and the motion plays, and where the time goes.
#pragma once

#include <functional>

#include "app/panel/control_panel.hpp"

namespace unfurl {

// Prints a line for each of: the view turns, the motion plays, both, each for so many seconds. The panel must
// have been made with PanelOptions::measured. `show` brings a picture to the screen; its time counts.
void measure_panel(ControlPanel& panel, const std::function<void()>& show, double seconds = 3);

}  // namespace unfurl
