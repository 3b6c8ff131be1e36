// SPDX-License-Identifier: BSD-3-Clause
// --plan: what a verb would write and how long it would take, without writing it.
#pragma once

#include "app/command.hpp"
#include "core/scene/scene.hpp"

namespace unfurl {

// Of run (film = false) and render. Simulates for some seconds and draws two frames to know. Returns an
// ExitCode.
int show_plan(const Scene& scene, const Arguments& arguments, bool film);

}  // namespace unfurl
