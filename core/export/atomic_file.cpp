// SPDX-License-Identifier: BSD-3-Clause
#include "core/export/atomic_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <functional>
#include <mutex>
#include <random>
#include <system_error>
#include <utility>
#include <vector>

#include "core/export/checksum.hpp"
#include "core/export/pending_files.hpp"
#include "core/export/run_tables.hpp"

namespace unfurl {
namespace {

constexpr std::string_view unfinished_prefix = ".unfurl-", unfinished_suffix = ".part";
constexpr std::size_t unfinished_digits = 16;

std::atomic<FileWatcher*> file_watcher{nullptr};
std::atomic<FileFinisher*> finisher_of_files{nullptr};

// "no space left on device": as the end of a sentence, so in lower case.
std::string cause_text(int error_number) {
  std::string text = std::generic_category().message(error_number);
  if (!text.empty()) text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

std::filesystem::path random_name(const std::filesystem::path& folder) {
  std::random_device random;
  std::array<char, unfinished_digits + 1> digits{};
  std::snprintf(digits.data(), digits.size(), "%08x%08x", random(), random());
  return folder / (std::string(unfinished_prefix) + digits.data() + std::string(unfinished_suffix));
}

int write_all(int file, const std::byte* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(file, data, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    data += written;
    size -= static_cast<std::size_t>(written);
  }
  return 0;
}

// In memory that is always there, and read without the lock: by handlers, which may ask for neither.
struct PendingName {
  std::atomic<bool> known{false};
  std::array<char, 1024> text{};
};
std::array<PendingName, 32> pending_names;
std::mutex pending_lock;
static_assert(std::atomic<bool>::is_always_lock_free);

void remember(const std::string& name) {
  if (name.size() >= pending_names[0].text.size()) return;
  const std::lock_guard lock(pending_lock);
  for (PendingName& slot : pending_names) {
    if (slot.known) continue;
    std::memcpy(slot.text.data(), name.c_str(), name.size() + 1);
    slot.known = true;
    return;
  }
}

void forget(const std::string& name) {
  const std::lock_guard lock(pending_lock);
  for (PendingName& slot : pending_names)
    if (slot.known && name == slot.text.data()) slot.known = false;
}

// A file's new name is in its directory, which is a file too. What cannot be flushed is not an error: there
// are file systems that know no such thing.
void flush_directory_of(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return;
  ::fsync(file);
  ::close(file);
}

}  // namespace

FileError::FileError(const std::filesystem::path& path, const std::string& cause)
    : Error(path.string() + ": " + cause), path_(path) {}

FileError::FileError(const std::filesystem::path& path, int error_number)
    : FileError(path, cause_text(error_number)) {}

std::string checksum_of(int file) {
  struct stat status {};
  if (::fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) return "";
  Checksum sum;
  std::vector<std::byte> block(std::size_t{1} << 16U);
  while (true) {
    const ssize_t got = ::read(file, block.data(), block.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return "";
    if (got == 0) return sum.text();
    sum.add(std::span(block.data(), static_cast<std::size_t>(got)));
  }
}

std::string checksum_of_file(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return "";
  std::string text = checksum_of(file);
  ::close(file);
  return text;
}

void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes, Flush flush) {
  PendingFile pending(path);
  pending.write(bytes);
  pending.commit(flush);
}

void write_file_atomically(const std::filesystem::path& path, std::string_view text, Flush flush) {
  write_file_atomically(path, std::as_bytes(std::span(text.data(), text.size())), flush);
}

void flush_files(const std::filesystem::path& directory) {
  const int file = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return;
  ::syncfs(file);
  ::close(file);
}

bool is_unfinished_name(std::string_view name) {
  if (name.size() != unfinished_prefix.size() + unfinished_digits + unfinished_suffix.size()) return false;
  if (!name.starts_with(unfinished_prefix) || !name.ends_with(unfinished_suffix)) return false;
  const std::string_view digits = name.substr(unfinished_prefix.size(), unfinished_digits);
  return digits.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

void remove_pending_files() noexcept {
  for (PendingName& slot : pending_names) {
    if (!slot.known) continue;
    const std::string_view path = slot.text.data();
    if (is_unfinished_name(path.substr(path.rfind('/') + 1))) ::unlink(slot.text.data());
  }
}

void remove_abandoned(const std::filesystem::path& unfinished) {
  const int file = ::open(unfinished.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return;
  struct stat status {};
  const bool regular = ::fstat(file, &status) == 0 && S_ISREG(status.st_mode);
  const bool locked = ::flock(file, LOCK_EX | LOCK_NB) == 0;
  const bool held = !locked && errno == EWOULDBLOCK;
  std::error_code error;
  const auto old = std::filesystem::file_time_type::clock::now() - std::chrono::minutes(1);
  if (regular && !held && (locked || std::filesystem::last_write_time(unfinished, error) < old))
    ::unlink(unfinished.c_str());
  ::close(file);
}

namespace {

// What the system shows as files: what stands there is for it to make.
bool is_systems_own(const std::filesystem::path& path) {
  const std::string text = path.string();
  return text.starts_with("/dev/") || text.starts_with("/proc/");
}

}  // namespace

std::filesystem::path behind_links(const std::filesystem::path& path) {
  namespace fs = std::filesystem;
  constexpr int most = 40;  // as the system follows
  std::error_code error;
  fs::path at = path;
  for (int i = 0; i < most && fs::is_symlink(fs::symlink_status(at, error)); ++i) {
    const fs::path to = fs::read_symlink(at, error);
    if (error || is_systems_own(to)) return path;
    at = to.is_absolute() ? to : at.parent_path() / to;
  }
  const bool file = !fs::is_symlink(fs::symlink_status(at, error)) && !fs::is_directory(at, error);
  return file && at.extension() == path.extension() ? at : path;
}

namespace {

// Devices, pipes and sockets, and links to them: a file in their place would take them from everybody.
bool is_no_file(const std::filesystem::path& path) {
  struct stat there {};
  std::error_code error;
  return is_systems_own(std::filesystem::read_symlink(path, error)) ||
         (::stat(path.c_str(), &there) == 0 && (S_ISCHR(there.st_mode) || S_ISBLK(there.st_mode) ||
                                                S_ISFIFO(there.st_mode) || S_ISSOCK(there.st_mode)));
}

}  // namespace

PendingFile::PendingFile(std::filesystem::path target) : target_(std::move(target)) {
  std::error_code unknown;
  if (!target_.has_filename() || std::filesystem::is_directory(target_, unknown))
    throw FileError(target_, EISDIR);
  if (is_no_file(target_))
    throw FileError(target_, "is a device, a pipe or a socket, which no file replaces; name another one");
  while (file_ < 0) {
    temporary_ = random_name(target_.parent_path());
    file_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file_ < 0 && errno == EEXIST) continue;
    if (file_ < 0) throw FileError(target_, errno);
    ::flock(file_, LOCK_EX | LOCK_NB);
    struct stat status {};
    // Taken for abandoned in the moment before it was locked: again.
    if (::fstat(file_, &status) == 0 && status.st_nlink == 0) ::close(std::exchange(file_, -1));
  }
  remember(temporary_.native());
}

PendingFile::~PendingFile() {
  forget(temporary_.native());
  if (file_ >= 0) ::close(file_);
  if (!placed_) ::unlink(temporary_.c_str());
}

void PendingFile::write(std::span<const std::byte> bytes) {
  if (const int error = write_all(file_, bytes.data(), bytes.size()); error != 0)
    throw FileError(target_, error);
}

void PendingFile::write(std::string_view text) {
  write(std::as_bytes(std::span(text.data(), text.size())));
}

void PendingFile::send(const Checksum* sum) {
  if (sum) checksum_ = sum->text();
  ::sync_file_range(file_, 0, 0, SYNC_FILE_RANGE_WRITE);  // a hint: where it fails, fsync does it all
}

void PendingFile::complete(Flush flush) {
  if (std::exchange(complete_, true)) return;
  if (FileFinisher* finisher = file_finisher(); finisher && finisher->finish(temporary_, target_))
    checksum_.clear();
  if (flush == Flush::at_once && ::fsync(file_) != 0 && errno != EINVAL && errno != EROFS)
    throw FileError(target_, errno);
  if (file_watcher.load() && checksum_.empty()) checksum_ = checksum_of_file(temporary_);
}

void PendingFile::announce() {
  struct stat before {};
  if (::lstat(target_.c_str(), &before) == 0 && S_ISREG(before.st_mode))
    ::fchmod(file_, before.st_mode & 0777);  // where that may not be, it has those of a new file
  if (FileWatcher* watcher = file_watcher; watcher)
    watcher->before_file(target_, checksum_.empty() ? checksum_of_file(temporary_) : checksum_);
  // Some file systems report a full disk only at close.
  if (::close(std::exchange(file_, -1)) != 0) throw FileError(target_, errno);
}

void PendingFile::take_place() {
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) throw FileError(target_, errno);
  placed_ = true;
}

void PendingFile::commit(Flush flush) {
  complete(flush);
  announce();
  take_place();
  if (flush == Flush::at_once) flush_directory_of(target_);
}

void commit_together(std::span<PendingFile* const> files) {
  for (PendingFile* file : files) file->complete();
  for (PendingFile* file : files) file->announce();
  for (PendingFile* file : files) file->take_place();
  if (!files.empty()) flush_directory_of(files.front()->target());
}

void move_into_place(const std::filesystem::path& from, std::span<const std::string> names,
                     const std::filesystem::path& to, const std::function<void()>& before) {
  for (const std::string& name : names) {
    if (FileFinisher* finisher = file_finisher(); finisher) finisher->finish(from / name, to / name);
    if (FileWatcher* watcher = file_watcher; watcher)
      watcher->before_file(to / name, checksum_of_file(from / name));
  }
  before();
  for (const std::string& name : names)
    if (std::rename((from / name).c_str(), (to / name).c_str()) != 0) throw FileError(to / name, errno);
  if (!names.empty()) flush_directory_of(to / names.front());
}

FileFinisher* finish_files(FileFinisher* finisher) {
  return finisher_of_files.exchange(finisher);
}

FileFinisher* file_finisher() {
  return finisher_of_files;
}

void replace_bytes(const std::filesystem::path& path, std::string_view bytes) {
  const int file = ::open(path.c_str(), O_WRONLY | O_TRUNC | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0) throw FileError(path, errno);
  const auto raw = std::as_bytes(std::span(bytes.data(), bytes.size()));
  const int error = write_all(file, raw.data(), raw.size());
  if (::close(file) != 0 || error != 0) throw FileError(path, error != 0 ? error : errno);
}

FileWatcher* watch_files(FileWatcher* watcher) {
  return file_watcher.exchange(watcher);
}

}  // namespace unfurl
