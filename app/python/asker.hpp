// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <memory>

namespace unfurl {

// True once Ctrl-C was pressed; asks the interpreter ten times a second at most. For a thread without the
// lock.
class Asker {
 public:
  bool operator()() {
    const auto now = std::chrono::steady_clock::now();
    if (raised_ || now - last_ < std::chrono::milliseconds(100)) return raised_;
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

}  // namespace unfurl
