#include "app/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <utility>

#include "app/interrupt.hpp"

namespace unfurl {

Progress::Progress(std::string task, bool quiet)
    : task_(std::move(task)), shown_(!quiet && isatty(STDERR_FILENO)) {}

Progress::~Progress() {
  if (percent_ < 0) return;
  std::cerr << "\r\x1b[K" << std::flush;
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
  std::cerr << "\r" << task_ << " [" << std::string(static_cast<std::size_t>(done), '=')
            << std::string(static_cast<std::size_t>(width - done), ' ') << "] " << percent << "%"
            << std::flush;
}

}  // namespace unfurl
