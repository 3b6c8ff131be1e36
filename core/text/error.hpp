// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace unfurl {

// The one base of all that a person can cause and mend: an impossible structure, a mistake in a scene, a file
// that cannot be written, a question without an answer. what() names the place and the cure. Whatever else is
// thrown is a defect of the program, a want of memory, or the wish to stop.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// What a person asked of a study cannot be; what() says what can.
class StudyError : public Error {
 public:
  using Error::Error;
};

}  // namespace unfurl
