// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "core/study/reference.hpp"

namespace unfurl {

// True once Ctrl-C was pressed; asks the interpreter twenty times a second at most. For a thread without the
// lock.
class Asker {
 public:
  bool operator()() {
    const auto now = std::chrono::steady_clock::now();
    if (raised_ || now - last_ < std::chrono::milliseconds(50)) return raised_;
    last_ = now;
    const pybind11::gil_scoped_acquire lock;
    raised_ = PyErr_CheckSignals() != 0;
    if (raised_) kept_ = std::make_unique<pybind11::error_already_set>();
    return raised_;
  }
  // With the lock.
  void raise() {
    if (raised_) throw *kept_;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  std::unique_ptr<pybind11::error_already_set> kept_;
  bool raised_ = false;
};

// Throws where warnings are errors.
inline void warn(const std::vector<std::string>& texts) {
  constexpr int of_caller = 2;  // of the method in __init__.py
  for (const std::string& text : texts)
    if (PyErr_WarnEx(PyExc_RuntimeWarning, text.c_str(), of_caller) != 0) throw pybind11::error_already_set();
}

// Work of which Ctrl-C ends the rest: it is given what it calls between its pieces, without the lock, and
// lets go what that throws.
template <class Work>
void heard(const Work& work) {
  Asker asker;
  try {
    work([&asker] {
      if (asker()) throw Cancelled();
    });
  } catch (const Cancelled&) {
    asker.raise();
    throw;
  }
}

}  // namespace unfurl
