// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace unfurl::testing {

// 1 kg on a spring of 100 N/m along x, free at O + 2 m, with a friction of 1 N, let go 0.495 m aside; a scene
// without its [solver].
inline const std::string coulomb_oscillator = R"(
[structure]
kind = "custom"
nodes = [
  {name = "O", position = [0, 0, 0], fixed = true},
  {name = "A", position = [2.495, 0, 0], mass = 1}]
[[forces]]
kind = "spring"
nodes = ["O", "A"]
stiffness = 100
free_length = 2
[[forces]]
kind = "friction"
name = "pad"
nodes = ["A"]
direction = [1, 0, 0]
kinetic = 1
)";

}  // namespace unfurl::testing
