// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace unfurl {

// Held while a verb writes into a directory, so that two of them do not mix their files there. It ends with
// the object or the process, whichever comes first. Where the file system knows no locks nobody can tell who
// else is at work.
class DirectoryLock {
 public:
  enum class Use { alone, shareable, joined };

  // Alone where nobody else is at work in the directory; else, where the use is shareable, beside those who
  // share it. Throws FileError where that cannot be had within seconds. Those who join need no lock: whatever
  // they write says by itself whose it is.
  DirectoryLock(const std::filesystem::path& directory, Use use);
  ~DirectoryLock();
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

  bool alone() const { return held_ == Held::alone; }    // for certain
  bool shared() const { return held_ == Held::shared; }  // others may be at work
  bool unknown() const { return held_ == Held::unknown; }
  void share();  // lets in others whose use is shareable

 private:
  enum class Held { alone, shared, unknown };
  bool take(int mode, Held held);

  int file_ = -1;
  Held held_ = Held::unknown;
};

}  // namespace unfurl
