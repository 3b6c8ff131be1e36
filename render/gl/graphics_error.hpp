// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace unfurl {

// There is nowhere to draw, or what is there cannot draw what we need. what() names the cause and the cure.
class GraphicsError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace unfurl
