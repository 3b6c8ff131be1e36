// How fast the panel is: frames a second while the view turns and the motion plays, and where the time goes.
#pragma once

#include <functional>
#include <string>

#include "app/panel/control_panel.hpp"

namespace unfurl {

// A line for a person for each of: the view turns, the motion plays, both. The panel must have been made with
// PanelOptions::measured. `show` brings a picture to the screen; its time counts.
std::string measure_panel(ControlPanel& panel, const std::function<void()>& show, int frames = 60);

}  // namespace unfurl
