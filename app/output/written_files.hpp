// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/export/atomic_file.hpp"

namespace unfurl {

// The list DIR/.unfurl of what unfurl wrote into DIR: nothing else there is ever removed or replaced.
//
//   Made by unfurl 0.1.0, in order           DIR was empty before; else "Written into by unfurl 0.1.0, ..."
//   cbf29ce484222325 run series.csv          checksum of its bytes, whose result it is, name in DIR
//   ---------------- sweep sweep.csv         of a file that grows: whatever its bytes are
//
// A line is appended before the file gets its name, so that a kill leaves no file without one; a name may
// have several lines: the last one says what its bytes are, and a file is ours where any of them fits it. (In
// lists without "in order" the last one is any of them.) A file grows only while its line for that is the
// last. While the object lives every file that the program writes into DIR is entered under `owner`. A file
// in the way that is not ours, or was changed since, is kept beside ours as NAME.kept-1 (-2, ...).
class WrittenFiles final : public FileWatcher {
 public:
  // Reads the list, or begins one. Throws FileError where it cannot be written.
  WrittenFiles(std::filesystem::path directory, std::string owner, bool was_empty);
  ~WrittenFiles();
  WrittenFiles(const WrittenFiles&) = delete;
  WrittenFiles& operator=(const WrittenFiles&) = delete;

  void before_file(const std::filesystem::path& target, const std::string& checksum) override;
  // The file is there and grows.
  void grows(const std::string& name);
  // It does once it is written the next time, until it is written as a whole or this object ends.
  void will_grow(const std::string& name);

  // Has DIR/name a line of this owner, and is it a file with the checksum of one?
  bool ours(const std::string& name) const;
  // Whose, where DIR/name has no line of this owner that fits it, and one of another; else empty.
  std::string other_owner(const std::string& name) const;
  bool is_empty() const;  // nothing was listed
  // Removes what is ours, but nothing behind a link, and directories that are empty then. The list forgets
  // it. What is asked for by its name and `stays` is left.
  void remove_all(const std::function<bool(const std::string&)>& stays = {});
  // The same for this one.
  void remove(const std::string& name);

  void forget_missing();  // files that are no longer there

  // DIR/name, a file, a folder or a link, gets the name name.kept-1, or the next that is free.
  void keep_aside(const std::string& name);

  const std::filesystem::path& directory() const { return directory_; }
  // What was kept aside, for a word to the person.
  struct Kept {
    std::string name, owner, aside;  // paths; the verb whose result it was: empty: none's
  };
  std::vector<Kept> kept() const;

  // What became of the files that DIR's list names. Throws FileError where there is no list.
  struct Verdict {
    enum Kind { same, changed, missing, growing, earlier };  // earlier: not as its last line says
    std::string name;
    Kind kind;
    std::string owner;  // of the line that fits its bytes, or of one
  };
  static std::vector<Verdict> verify(const std::filesystem::path& directory);
  // Those of the listed files that `asked` takes whose bytes are none that unfurl wrote; none without a list.
  static std::vector<std::string> changed(const std::filesystem::path& directory,
                                          const std::function<bool(const std::string&)>& asked);

  // Is there a list that was begun in an empty directory? False also where it cannot be read.
  static bool begun_here(const std::filesystem::path& directory);
  static constexpr const char* list_name = ".unfurl";

 private:
  struct Line {
    std::string checksum, owner;
    bool operator==(const Line&) const = default;
  };

  using Lines = std::map<std::string, std::vector<Line>>;  // by name, in the order of the list
  static Lines lines_of(const std::string& list, std::string& title);
  void read();
  static std::vector<Verdict> judge(const std::filesystem::path& directory, const std::string& title,
                                    const Lines& lines);
  void append(const std::string& name, const std::vector<std::string>& checksums);
  bool begin(bool was_empty);
  void write_anew();
  bool grows_now(const std::string& name) const;
  bool known(const std::string& name, const std::string& checksum) const;
  std::string owner_of(const std::string& name) const;  // of the bytes of DIR/name; empty: nobody's
  std::string name_of(const std::filesystem::path& target) const;
  void put_aside(const std::filesystem::path& target);

  std::filesystem::path directory_;
  std::string owner_, title_;
  mutable std::mutex mutex_;
  Lines lines_;
  std::set<std::string> will_grow_, grown_;
  std::vector<Kept> kept_;
  FileWatcher* before_ = nullptr;
};

}  // namespace unfurl
