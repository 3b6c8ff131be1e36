// Files appear whole or not at all: written under a temporary name in the same directory, then renamed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace unfurl {

// A file that could not be written or read. what(): "out/frames/x.png: no space left on device".
class FileError : public std::runtime_error {
 public:
  FileError(const std::filesystem::path& path, const std::string& cause);
  // The cause in the system's words for `error_number` (an errno value).
  FileError(const std::filesystem::path& path, int error_number);
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// Replace `path` by a file with these bytes. Throws FileError and leaves what was there before.
void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_file_atomically(const std::filesystem::path& path, std::string_view text);

// What the temporary names end in; they begin with a dot.
inline constexpr const char* unfinished_suffix = ".part";

// A file that another program writes: hand it name(), then commit(). What is not committed is removed again.
class PendingFile {
 public:
  explicit PendingFile(std::filesystem::path target);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  const std::filesystem::path& name() const { return temporary_; }  // beside the target, hidden
  void commit();  // rename onto the target; throws FileError

 private:
  std::filesystem::path target_, temporary_;
  bool pending_ = true;
};

}  // namespace unfurl
