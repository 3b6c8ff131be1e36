// SPDX-License-Identifier: BSD-3-Clause
#include "app/output/directory_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <thread>

#include "core/export/atomic_file.hpp"

namespace unfurl {

DirectoryLock::DirectoryLock(const std::filesystem::path& directory, Use use)
    : file_(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  using namespace std::chrono_literals;
  if (use == Use::joined) {
    held_ = Held::shared;
    return;
  }
  // Who begins to share holds it alone until its first files are on the disk: a moment, but not on a busy
  // machine.
  const int attempts = use == Use::shareable ? 80 : 20;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    if (attempt > 0) std::this_thread::sleep_for(50ms);
    if (take(LOCK_EX, Held::alone)) return;
    if (use == Use::shareable && take(LOCK_SH, Held::shared)) return;
  }
  ::close(file_);
  throw FileError(directory,
                  "another unfurl is writing into it; wait until it has finished, or use another -o");
}

DirectoryLock::~DirectoryLock() {
  if (file_ >= 0) ::close(file_);
}

// False where another holds it.
bool DirectoryLock::take(int mode, Held held) {
  if (file_ >= 0 && ::flock(file_, mode | LOCK_NB) == 0) {
    held_ = held;
    return true;
  }
  if (file_ >= 0 && errno == EWOULDBLOCK) return false;
  held_ = Held::unknown;
  return true;
}

void DirectoryLock::share() {
  if (held_ == Held::alone) take(LOCK_SH, Held::shared);
}

}  // namespace unfurl
