#include "core/export/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <system_error>

namespace unfurl {
namespace {

// "no space left on device": as the end of a sentence, so in lower case.
std::string cause_text(int error_number) {
  std::string text = std::generic_category().message(error_number);
  if (!text.empty()) text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

// Unique among the threads and the running processes of one machine.
std::filesystem::path temporary_name(const std::filesystem::path& target) {
  static std::atomic<unsigned> count{0};
  const std::string name = "." + target.filename().string() + "." + std::to_string(::getpid()) + "-" +
                           std::to_string(count++) + unfinished_suffix;
  return target.parent_path() / name;
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

// 0, or the errno of what failed; some file systems report a full disk only at close.
int write_new_file(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) return errno;
  const int error = write_all(file, bytes.data(), bytes.size());
  const int close_error = ::close(file) == 0 ? 0 : errno;
  return error != 0 ? error : close_error;
}

}  // namespace

FileError::FileError(const std::filesystem::path& path, const std::string& cause)
    : std::runtime_error(path.string() + ": " + cause), path_(path) {}

FileError::FileError(const std::filesystem::path& path, int error_number)
    : FileError(path, cause_text(error_number)) {}

void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  PendingFile pending(path);
  if (const int error = write_new_file(pending.name(), bytes); error != 0) throw FileError(path, error);
  pending.commit();
}

void write_file_atomically(const std::filesystem::path& path, std::string_view text) {
  write_file_atomically(path, std::as_bytes(std::span(text.data(), text.size())));
}

PendingFile::PendingFile(std::filesystem::path target)
    : target_(std::move(target)), temporary_(temporary_name(target_)) {
  if (!target_.has_filename()) throw FileError(target_, EISDIR);
}

PendingFile::~PendingFile() {
  if (pending_) ::unlink(temporary_.c_str());
}

void PendingFile::commit() {
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) throw FileError(target_, errno);
  pending_ = false;
}

}  // namespace unfurl
