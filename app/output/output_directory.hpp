// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>

#include "app/output/directory_lock.hpp"
#include "app/output/written_files.hpp"

namespace unfurl {

// The directory that results go to, made where it is missing, with the list of what unfurl wrote there. Only
// what is on that list is ever removed or replaced.
class OwnDirectory {
 public:
  // Throws FileError before any work is done: the path is a file, cannot be made or written to, another
  // unfurl is at work in it, or it holds files of somebody else and `force` was not given. What is written
  // while the object lives is listed as the results of `owner` ("run", "study"). An empty path: nothing.
  OwnDirectory(const std::string& path, bool force, const std::string& owner,
               DirectoryLock::Use use = DirectoryLock::Use::alone);
  ~OwnDirectory();  // says on stderr what was in the way and kept
  OwnDirectory(const OwnDirectory&) = delete;
  OwnDirectory& operator=(const OwnDirectory&) = delete;

  // DIR/scene.toml will hold this text. Throws FileError where results of another verb need another one
  // that stands there; with `force` it is kept aside. Nothing fits the text "", of a scene that is not known
  // yet.
  void require_scene(const std::string& text, bool force);
  // Throws FileError where one of these is a directory: hours of work would end there.
  void require_files(std::initializer_list<const char*> names) const;

  const std::filesystem::path& path() const { return path_; }
  DirectoryLock& lock() { return *lock_; }
  WrittenFiles& written() { return *written_; }

 private:
  std::filesystem::path path_;
  std::optional<DirectoryLock> lock_;
  std::optional<WrittenFiles> written_;
  std::filesystem::path
      made_;  // by this one: the first directory of the path that was not there; empty: none
};

// Throws FileError, naming the file, where it could not be written now: no such directory, no permission,
// disk full.
void require_writable(const std::filesystem::path& file);
// The same for a picture, `what` ("a poster"), that is a PNG file; UsageError where it has another extension.
void require_writable_png(const std::filesystem::path& file, const std::string& what);

}  // namespace unfurl
