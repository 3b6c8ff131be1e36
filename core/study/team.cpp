// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/team.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <random>

#include "core/export/atomic_file.hpp"

namespace unfurl {

namespace fs = std::filesystem;

namespace {

std::string worker_name() {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0 || host[0] == '\0') host = {'h', 'o', 's', 't'};
  std::string name = host.data();
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  std::random_device random;
  return name.substr(0, 60) + "-" + std::to_string(::getpid()) + "-" + std::to_string(random());
}

// Names of pieces are file names: what is no letter, digit, dot or dash is written as its number.
std::string file_name(const std::string& piece) {
  std::string name;
  for (const char c : piece) {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalnum(u) || c == '.' || c == '-')
      name += c;
    else
      name += "_" + std::to_string(u) + "_";
  }
  return name.substr(0, 200);
}

double seconds(const timespec& t) {
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// Time of change as the file system has it now: a file that is opened is asked for anew also where attributes
// are kept for a while (NFS). Negative: there is none.
double time_of(const fs::path& file) {
  const int open = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  if (open < 0) return -1;
  struct stat status {};
  const bool ok = ::fstat(open, &status) == 0;
  ::close(open);
  return ok ? seconds(status.st_mtim) : -1;
}

void set_time(const fs::path& file, long nanoseconds) {
  const timespec time{0, nanoseconds};
  const std::array<timespec, 2> both{time, time};
  ::utimensat(AT_FDCWD, file.c_str(), both.data(), AT_SYMLINK_NOFOLLOW);
}

}  // namespace

Team::Team(fs::path folder, double lease) : folder_(std::move(folder)), lease_(lease), name_(worker_name()) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) throw FileError(folder_, error.value());
  if (!create(folder_ / (name_ + ".clock"))) throw FileError(folder_ / (name_ + ".clock"), EEXIST);
  keeper_ = std::jthread([this](const std::stop_token& stop) { renew(stop); });
}

Team::~Team() {
  keeper_.request_stop();
  keeper_.join();
  for (const auto& [piece, generation] : held_)
    if (age(lease_file(piece, generation + 1)) < 0) set_time(lease_file(piece, generation), 0);
  std::error_code ignored;
  fs::remove(folder_ / (name_ + ".clock"), ignored);
}

fs::path Team::lease_file(const std::string& piece, int generation) const {
  return folder_ / (file_name(piece) + "." + std::to_string(generation) + ".lease");
}

fs::path Team::mark(const std::string& piece, int generation) const {
  return lease_file(piece, generation).replace_extension(".done");
}

bool Team::create(const fs::path& file) const {
  const int made = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (made < 0 && errno == EEXIST) return false;
  if (made < 0) throw FileError(file, errno);
  const std::string text = name_ + "\n";
  const bool written = ::write(made, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  const int trouble = errno;
  if (::close(made) != 0 || !written) throw FileError(file, trouble);
  return true;
}

double Team::age(const fs::path& file) const {
  const double changed = time_of(file);
  if (changed < 0) return -1;
  const fs::path clock = folder_ / (name_ + ".clock");
  set_time(clock, UTIME_NOW);
  return std::max(time_of(clock) - changed, 0.0);
}

bool Team::takes(const std::string& piece, const std::function<void()>& taken_over) {
  std::unique_lock lock(mutex_);
  if (held_.contains(piece)) return age(lease_file(piece, held_[piece] + 1)) < 0;
  int last = -1;
  double idle = -1;
  for (double a; (a = age(lease_file(piece, last + 1))) >= 0; ++last) idle = a;
  if (last >= 0 && idle <= lease_) return false;
  if (!create(lease_file(piece, last + 1))) return false;
  held_[piece] = last + 1;
  lock.unlock();
  if (last >= 0 && taken_over) taken_over();
  return true;
}

bool Team::holds(const std::string& piece) {
  const std::lock_guard lock(mutex_);
  const auto held = held_.find(piece);
  return held != held_.end() && age(lease_file(piece, held->second + 1)) < 0;
}

void Team::finish(const std::string& piece) {
  const std::lock_guard lock(mutex_);
  const auto held = held_.find(piece);
  if (held != held_.end()) create(mark(piece, held->second));
}

bool Team::finished(const std::string& piece) const {
  int next = 0;
  while (time_of(lease_file(piece, next)) >= 0) ++next;
  return next > 0 && time_of(mark(piece, next - 1)) >= 0;
}

void Team::done() {
  const std::lock_guard lock(mutex_);
  held_.clear();
}

std::vector<fs::path> Team::journals_of_others() const {
  std::vector<fs::path> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder_, error))
    if (entry.path().extension() == ".csv" && entry.path() != journal()) found.push_back(entry.path());
  if (error) throw FileError(folder_, error.value());
  std::sort(found.begin(), found.end());
  return found;
}

void Team::renew(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    wake_.wait_for(lock, stop, std::chrono::duration<double>(lease_ / 5), [] { return false; });
    if (stop.stop_requested()) return;
    for (const auto& [piece, generation] : held_) set_time(lease_file(piece, generation), UTIME_NOW);
  }
}

}  // namespace unfurl
