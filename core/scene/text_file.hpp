// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <string>

namespace unfurl {

inline constexpr std::size_t max_text_file_bytes = std::size_t{64} << 20U;

struct TextFile {
  std::string path;  // as messages name it
  std::string text;
  std::string error;  // empty: the text is there
};

// A scene may also come through a pipe, which a person names and waits for (/dev/stdin); what a scene or a
// directory of results names may not: it could wait for ever.
enum class TextSource { regular_file, pipe_too };

// The whole file. Refuses what is not readable as a file and more than `most` bytes (also of an endless
// device).
TextFile read_text_file(const std::string& path, TextSource source = TextSource::regular_file,
                        std::size_t most = max_text_file_bytes);
// One of our own, of any size.
TextFile read_result_file(const std::string& path);

// A file whose name is relative to the folder and that lies inside it, links followed.
TextFile read_file_beside(const std::string& folder, const std::string& name);

// Files beside a scene that is read again and again, as they were when each was read first: while one of
// these is in use by a thread, read_file_beside() answers out of it.
class FilesBeside {
 public:
  class InUse {
   public:
    explicit InUse(FilesBeside* files);  // null: files are read
    ~InUse();
    InUse(const InUse&) = delete;
    InUse& operator=(const InUse&) = delete;

   private:
    FilesBeside* before_;
  };

  // By their paths, also those that could not be read.
  void each(const std::function<void(const std::string& path, const TextFile& file)>& told);

 private:
  friend TextFile read_file_beside(const std::string& folder, const std::string& name);
  std::mutex mutex_;
  std::map<std::string, TextFile> read_;  // by path
};

}  // namespace unfurl
