// SPDX-License-Identifier: BSD-3-Clause
#include "app/output/interrupt.hpp"

#include <signal.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <string_view>

#include "app/output/exit_code.hpp"
#include "core/export/pending_files.hpp"
#include "render/image/child_process.hpp"

namespace unfurl {

namespace {

// Handlers run on any thread, and workers ask for the flag.
std::atomic<bool> raised{false}, bar_shown{false};
std::atomic<double> raised_at{0};  // [s], of the monotonic clock
std::atomic<int> guards{0}, keeping{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<double>::is_always_lock_free &&
              std::atomic<int>::is_always_lock_free);

constexpr long patience_us = 800'000, again_us = 50'000;

double monotonic_seconds() {  // may be asked in a signal handler
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void say(std::string_view text) {
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
}

// Without destructors: nothing of ours needs them but files that are being written.
[[noreturn]] void end_now() {
  end_children();
  remove_pending_files();
  if (bar_shown) say("\r\x1b[K");
  say("unfurl: interrupted; what is finished is kept\n");
  ::_exit(exit_interrupted);
}

void ring_in(long microseconds) {
  const itimerval once{{0, 0}, {0, microseconds}};
  ::setitimer(ITIMER_REAL, &once, nullptr);
}

void on_alarm(int) {
  if (keeping == 0) end_now();
  ring_in(again_us);
}

void on_signal(int) {
  if (raised || guards == 0) end_now();
  raised_at = monotonic_seconds();  // before the flag, which says that it is there
  raised = true;
  ring_in(patience_us);
}

void handle(int signal_number, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  ::sigaction(signal_number, &action, nullptr);
}

}  // namespace

void end_on_signals() {
  handle(SIGALRM, on_alarm);
  handle(SIGINT, on_signal);
  handle(SIGTERM, on_signal);
  struct sigaction of_hangup {};
  ::sigaction(SIGHUP, nullptr, &of_hangup);
  if (of_hangup.sa_handler != SIG_IGN) handle(SIGHUP, on_signal);  // else it was started by nohup
  handle(SIGXFSZ, SIG_IGN);  // a limit on files: write() tells, as of a full disk
}

InterruptGuard::InterruptGuard() {
  if (guards++ == 0) end_on_signals();
}
InterruptGuard::~InterruptGuard() {
  --guards;
}

FinishedWork::FinishedWork() {
  ++keeping;
}
FinishedWork::~FinishedWork() {
  --keeping;
}

bool interrupted() {
  return raised;
}

bool interrupted_for(double seconds) {
  return raised && monotonic_seconds() - raised_at >= seconds;
}

void throw_if_interrupted() {
  if (raised) throw Interrupted();
}

void bar_is_shown(bool shown) {
  bar_shown = shown;
}

}  // namespace unfurl
