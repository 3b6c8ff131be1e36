// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/text/error.hpp"

namespace unfurl {

// There is nowhere to draw, or what is there cannot draw what we need. what() names the cause and the cure.
class GraphicsError : public Error {
 public:
  using Error::Error;
};

}  // namespace unfurl
