#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/directory_lock.hpp"

namespace unfurl {

// The directory that results go to, made where it is missing. Throws FileError before any work is done: the
// path is a file, cannot be made or written to, or holds files of somebody else and `force` was not given.
std::filesystem::path open_output_directory(const std::string& path, bool force);

// The same, for this process alone while the object lives; nothing where the path is empty.
class OwnDirectory {
 public:
  OwnDirectory(const std::string& path, bool force);
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::optional<DirectoryLock> lock_;
};

// Remove what programs that were killed left half written, a minute ago or longer. Only for who is alone
// there.
void remove_unfinished(const std::filesystem::path& directory);

// Throws FileError, naming the file, where it could not be written now: no such directory, no permission,
// disk full.
void require_writable(const std::filesystem::path& file);
// The same for a picture, `what` ("a poster"), that is a PNG file; UsageError where it has another extension.
void require_writable_png(const std::filesystem::path& file, const std::string& what);

// Remove what an earlier run left under the names that this program uses, so that no frame of it stays among
// ours.
void clear_old_results(const std::filesystem::path& directory);

}  // namespace unfurl
