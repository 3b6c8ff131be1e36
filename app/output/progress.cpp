// SPDX-License-Identifier: BSD-3-Clause
#include "app/output/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <string_view>
#include <system_error>
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

namespace {

constexpr double line_every = 10;  // without a terminal [s]

std::string left_text(double seconds) {
  const long s = std::lround(seconds);
  if (s < 100) return std::to_string(s) + " s left";
  if (s < 6000) return std::to_string((s + 30) / 60) + " min left";
  return std::to_string((s + 1800) / 3600) + " h left";
}

}  // namespace

Progress::Progress(std::string task, bool quiet)
    : task_(std::move(task)), quiet_(quiet), terminal_(isatty(STDERR_FILENO)) {}

Progress::~Progress() {
  if (percent_ < 0 || !terminal_) return;
  send_to_terminal(wiped);
  bar_is_shown(false);
}

double Progress::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Progress::show(double fraction) {
  if (!quiet_ && !std::isnan(fraction)) print(std::clamp(fraction, 0.0, 1.0), {});
}

void Progress::show(std::size_t done, std::size_t of, const char* things) {
  if (quiet_ || of == 0) return;
  print(static_cast<double>(done) / static_cast<double>(of),
        std::to_string(done) + " of " + std::to_string(of) + " " + things);
}

void Progress::print(double fraction, const std::string& counts) {
  const int percent = static_cast<int>(100.0 * fraction);
  const double passed = seconds();
  std::string text = std::to_string(percent) + "%";
  if (!counts.empty()) text += ", " + counts;
  if (passed > 2 && fraction > 0.02) text += ", " + left_text(passed * (1 - fraction) / fraction);
  if (!terminal_) {
    const long due = static_cast<long>(passed / line_every);
    if (due == told_) return;
    told_ = due;
    std::cerr << task_ << " " << text << "\n";
    return;
  }
  if (percent == percent_) return;
  percent_ = percent;
  bar_is_shown(true);
  constexpr int width = 30;
  const int done = percent * width / 100;
  send_to_terminal("\r" + task_ + " [" + std::string(static_cast<std::size_t>(done), '=') +
                   std::string(static_cast<std::size_t>(width - done), ' ') + "] " + text + "\x1b[K");
}

Waiting::Waiting(std::string task, bool quiet) {
  if (quiet || !isatty(STDERR_FILENO)) return;
  try {
    thread_ = std::thread([this, words = std::move(task)] {
      std::unique_lock lock(mutex_);
      for (int seconds = 1; !changed_.wait_for(lock, std::chrono::seconds(1), [this] { return over_; });
           ++seconds) {
        bar_is_shown(true);
        send_to_terminal("\r" + words + ", " + std::to_string(seconds) + " s");
        shown_ = true;
      }
    });
  } catch (const std::system_error&) {
    // No thread to be had: it waits without words.
  }
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
