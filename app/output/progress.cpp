// SPDX-License-Identifier: BSD-3-Clause
#include "app/output/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string_view>
#include <utility>

#include "app/output/interrupt.hpp"

namespace unfurl {

namespace {

// To the terminal as it is: std::cerr passes on what is printable (printable_output.hpp).
void send_to_terminal(std::string_view text) {
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
}

constexpr std::string_view wiped = "\r\x1b[K";

}  // namespace

Progress::Progress(std::string task, bool quiet)
    : task_(std::move(task)), shown_(!quiet && isatty(STDERR_FILENO)) {}

Progress::~Progress() {
  if (percent_ < 0) return;
  send_to_terminal(wiped);
  bar_is_shown(false);
}

void Progress::show(double fraction) {
  if (!shown_ || std::isnan(fraction)) return;
  const int percent = static_cast<int>(100.0 * std::clamp(fraction, 0.0, 1.0));
  if (percent == percent_) return;
  percent_ = percent;
  bar_is_shown(true);
  constexpr int width = 40;
  const int done = percent * width / 100;
  send_to_terminal("\r" + task_ + " [" + std::string(static_cast<std::size_t>(done), '=') +
                   std::string(static_cast<std::size_t>(width - done), ' ') + "] " + std::to_string(percent) +
                   "%");
}

Waiting::Waiting(std::string task, bool quiet) {
  if (quiet || !isatty(STDERR_FILENO)) return;
  thread_ = std::thread([this, words = std::move(task)] {
    std::unique_lock lock(mutex_);
    for (int seconds = 1; !changed_.wait_for(lock, std::chrono::seconds(1), [this] { return over_; });
         ++seconds) {
      bar_is_shown(true);
      send_to_terminal("\r" + words + ", " + std::to_string(seconds) + " s");
      shown_ = true;
    }
  });
}

Waiting::~Waiting() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  changed_.notify_all();
  thread_.join();
  if (!shown_) return;
  send_to_terminal(wiped);
  bar_is_shown(false);
}

}  // namespace unfurl
