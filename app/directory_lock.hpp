#pragma once

#include <filesystem>

namespace unfurl {

// Held while a verb writes into a directory, so that two of them do not mix their files there. It ends with
// the object or the process, whichever comes first. Where the file system knows no locks there is none.
class DirectoryLock {
 public:
  enum class Use { alone, shareable };

  // Alone where nobody else is at work in the directory; else, where the use is shareable, beside those who
  // share it. Throws FileError where that cannot be had within a second.
  DirectoryLock(const std::filesystem::path& directory, Use use);
  ~DirectoryLock();
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

  bool alone() const { return alone_; }
  void share();  // lets in others whose use is shareable

 private:
  bool take(int mode);

  int file_ = -1;
  bool alone_ = true;
};

}  // namespace unfurl
