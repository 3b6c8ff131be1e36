#include "app/interrupt.hpp"

#include <csignal>

namespace unfurl {

namespace {

volatile std::sig_atomic_t raised = 0;

void raise_flag(int signal_number) {
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

}  // namespace unfurl
