// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <initializer_list>
#include <sstream>
#include <string>

namespace unfurl::testing {

// For scenes: reads back as the same double.
inline std::string number(double x) {
  std::ostringstream text;
  text.precision(17);
  text << x;
  return text.str();
}

// What is drawn within a list is drawn in the order written, by every compiler; operands of + are not.
inline std::string joined(std::initializer_list<std::string> parts) {
  std::string text;
  for (const std::string& part : parts) text += part;
  return text;
}

}  // namespace unfurl::testing
