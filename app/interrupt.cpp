#include "app/interrupt.hpp"

#include <time.h>

#include <atomic>
#include <csignal>

namespace unfurl {

namespace {

volatile std::sig_atomic_t raised = 0;
std::atomic<double> raised_at = 0;  // [s], of the monotonic clock

double monotonic_seconds() {  // may be asked in a signal handler
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void raise_flag(int signal_number) {
  raised_at = monotonic_seconds();
  raised = 1;
  std::signal(signal_number, SIG_DFL);
}

}  // namespace

InterruptGuard::InterruptGuard() {
  std::signal(SIGINT, raise_flag);
  std::signal(SIGTERM, raise_flag);
}

InterruptGuard::~InterruptGuard() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

bool interrupted() {
  return raised != 0;
}

bool interrupted_for(double seconds) {
  return raised != 0 && monotonic_seconds() - raised_at >= seconds;
}

}  // namespace unfurl
