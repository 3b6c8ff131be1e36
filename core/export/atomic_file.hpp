// SPDX-License-Identifier: BSD-3-Clause
// Files appear whole or not at all: written under a temporary name in the same directory, then renamed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "core/text/error.hpp"

namespace unfurl {

class Checksum;

// A file that could not be written or read. what(): "out/frames/x.png: no space left on device".
class FileError : public Error {
 public:
  FileError(const std::filesystem::path& path, const std::string& cause);
  // The cause in the system's words for `error_number` (an errno value).
  FileError(const std::filesystem::path& path, int error_number);
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// When a new file is on the disk and not only in memory. `at_once`: before it has its name, so that a power
// cut leaves the old file or the new one; 5 ms a file were measured. `later`: for the many files of a film,
// which are checked when they are used again; one flush_files() at the end of them costs as much as one.
enum class Flush { at_once, later };

// Replace `path` by a file with these bytes and the permissions of the file that was there. A link is
// replaced too, not what it leads to. Throws FileError and leaves what was there before.
void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes,
                           Flush flush = Flush::at_once);
void write_file_atomically(const std::filesystem::path& path, std::string_view text,
                           Flush flush = Flush::at_once);

// Of a file that a person names, who means what links lead to: where it lies. Links to directories, and those
// to a file of another kind (by its suffix), stay as they are.
std::filesystem::path behind_links(const std::filesystem::path& path);

// Wait until what was written to the file system of this directory is on its disk.
void flush_files(const std::filesystem::path& directory);

// Temporary names are ".unfurl-", 16 random digits and ".part": never longer than a name may be, and
// different among processes, containers and machines.
bool is_unfinished_name(std::string_view name);
// Remove a file of such a name that nobody is writing any more: its writer would hold a lock on it. Where the
// file system knows no locks a minute must have gone by.
void remove_abandoned(const std::filesystem::path& unfinished);

// A file that another program or a stream writes: hand it name(), then commit(). It is made empty, under a
// name that nothing had (also no link); what is not committed is removed again.
class PendingFile {
 public:
  explicit PendingFile(std::filesystem::path target);  // throws FileError
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  const std::filesystem::path& target() const { return target_; }
  const std::filesystem::path& name() const { return temporary_; }  // beside the target, hidden
  int file() const { return file_; }                                // open for writing
  void write(std::span<const std::byte> bytes);                     // throws FileError, as the others
  void write(std::string_view text);
  // All bytes are there: on their way to the disk from now on, which complete() waits for. `sum`: theirs,
  // where who wrote them knows it, so that nobody reads them again.
  void send(const Checksum* sum = nullptr);
  // All bytes are there, and on the disk when it returns. A thread may do this for a file.
  void complete(Flush flush = Flush::at_once);
  void commit(Flush flush = Flush::at_once);  // complete and rename onto the target; throws FileError

 private:
  friend void commit_together(std::span<PendingFile* const> files);
  void announce();    // to who watches files; its bytes are closed
  void take_place();  // what was announced
  std::filesystem::path target_, temporary_;
  std::string checksum_;
  bool complete_ = false, placed_ = false;
  int file_ = -1;
};

// Files of one directory get their names in this order, at one moment, when all are on the disk and those who
// watch files know of all: a kill finds the old ones or the new ones. One wait for the directory.
void commit_together(std::span<PendingFile* const> files);

// Is told of every file just before it takes its place, with the checksum (core/export/checksum.hpp) of its
// bytes; may be called by several threads at once, may throw FileError: then the file does not appear.
class FileWatcher {
 public:
  virtual void before_file(const std::filesystem::path& target, const std::string& checksum) = 0;

 protected:
  FileWatcher() = default;
  FileWatcher(const FileWatcher&) = default;
  FileWatcher& operator=(const FileWatcher&) = default;
  ~FileWatcher() = default;
};
// One for the whole program; nullptr: none. Returns the one before.
FileWatcher* watch_files(FileWatcher* watcher);

// Completes files before they are checked and get their names; may be called by several threads at once.
class FileFinisher {
 public:
  // What a program that writes a whole file by itself shall put into it as a comment.
  virtual std::string note(const std::filesystem::path& target) = 0;
  // Whether the file has other bytes now.
  virtual bool finish(const std::filesystem::path& temporary, const std::filesystem::path& target) = 0;

 protected:
  FileFinisher() = default;
  FileFinisher(const FileFinisher&) = default;
  FileFinisher& operator=(const FileFinisher&) = default;
  ~FileFinisher() = default;
};
// One for the whole program; nullptr: none. Returns the one before.
FileFinisher* finish_files(FileFinisher* finisher);
FileFinisher* file_finisher();
// Other bytes for a file that is there. Throws FileError.
void replace_bytes(const std::filesystem::path& file, std::string_view bytes);

}  // namespace unfurl
