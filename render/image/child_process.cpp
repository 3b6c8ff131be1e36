// SPDX-License-Identifier: BSD-3-Clause
#include "render/image/child_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <thread>

extern char** environ;

namespace unfurl {
namespace {

std::array<std::atomic<pid_t>, 16> children{};  // 0: free; below: to be asked, not killed

void enter_child(pid_t pid) {
  for (auto& child : children)
    if (pid_t none = 0; child.compare_exchange_strong(none, pid)) return;
}

void forget_child(pid_t pid) {
  for (auto& child : children)
    for (pid_t it : {pid, -pid})
      if (child.compare_exchange_strong(it, 0)) return;
}

}  // namespace

ChildProcess::~ChildProcess() {
  send(SIGKILL);
  wait();
}

int ChildProcess::start(const std::vector<std::string>& words, const Streams& streams, Ending ending) {
  std::vector<char*> argv;
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&files);
  const std::array<int, 3> given{streams.input, streams.output, streams.error};
  for (int stream = 0; stream < 3; ++stream) {
    const int from = given[static_cast<std::size_t>(stream)];
    if (from < 0)
      posix_spawn_file_actions_addopen(&files, stream, "/dev/null", stream == 0 ? O_RDONLY : O_WRONLY, 0);
    else
      posix_spawn_file_actions_adddup2(&files, from, stream);
  }
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  pid_t pid = -1;
  const int error = posix_spawnp(&pid, argv[0], &files, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) return error;
  const std::lock_guard lock(mutex_);
  pid_ = pid;
  enter_child(ending == Ending::asked ? -pid : pid);
  return 0;
}

// Has it ended? Its number is free for other processes only after this, and pid_ forgets it at once.
bool ChildProcess::reap() {
  const std::lock_guard lock(mutex_);
  if (pid_ < 0) return true;
  int status = 0;
  if (::waitpid(pid_, &status, WNOHANG) != pid_) return false;  // also where a signal came between
  code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  forget_child(pid_);
  pid_ = -1;
  return true;
}

std::optional<int> ChildProcess::wait(double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  auto pause = std::chrono::milliseconds(1);
  while (!reap()) {
    if (seconds >= 0 && std::chrono::duration<double>(Clock::now() - start).count() >= seconds) return {};
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, std::chrono::milliseconds(20));
  }
  return code_;
}

void ChildProcess::send(int signal) {
  const std::lock_guard lock(mutex_);
  if (pid_ <= 0) return;
  ::kill(pid_, signal);
  if (signal == SIGTERM)  // a second one would end it at once
    for (auto& child : children)
      if (pid_t it = -pid_; child.compare_exchange_strong(it, 0)) return;
}

void end_children() {
  for (auto& child : children)
    if (const pid_t pid = child; pid != 0) ::kill(std::abs(pid), pid > 0 ? SIGKILL : SIGTERM);
}

}  // namespace unfurl
