// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "core/export/atomic_file.hpp"
#include "core/scene/csv_table.hpp"
#include "core/scene/text_file.hpp"

namespace unfurl {

namespace {

// Throws FileError where somebody else has the lock. Where the file system knows no locks nobody can tell.
void take_lock(int file, const std::filesystem::path& path) {
  if (::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw FileError(path,
                    "another unfurl is adding results to it; wait until it has finished, or use another -o");
}

// Holds the lock of a file that may be there; its name may lead to another one afterwards.
class LockOfFile {
 public:
  explicit LockOfFile(const std::filesystem::path& path) : file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    try {
      if (file_ >= 0) take_lock(file_, path);
    } catch (...) {
      ::close(file_);
      throw;
    }
  }
  ~LockOfFile() {
    if (file_ >= 0) ::close(file_);
  }
  LockOfFile(const LockOfFile&) = delete;
  LockOfFile& operator=(const LockOfFile&) = delete;

 private:
  int file_;
};

}  // namespace

Journal::Journal(std::filesystem::path path, std::vector<std::string> columns, std::size_t keys,
                 std::vector<std::size_t> numbers, std::function<bool(const Row&)> finished,
                 std::function<void()> make_room)
    : path_(std::move(path)),
      columns_(std::move(columns)),
      keys_(keys),
      numbers_(std::move(numbers)),
      finished_(std::move(finished)),
      make_room_(std::move(make_room)) {
  if (path_.empty()) return;
  const LockOfFile earlier(path_);
  if (make_room_) return;
  take_in(path_);
  begin_file();  // without what was torn
}

// The file, with the results that are known.
void Journal::begin_file() {
  PendingFile file(path_);
  file.write(csv_line(columns_));
  for (const auto& [key, row] : rows_) file.write(csv_line(row));
  file.complete();
  if (make_room_) std::exchange(make_room_, nullptr)();
  file.commit();
  file_ = std::fopen(path_.c_str(), "abe");
  if (!file_) throw FileError(path_, errno);
  try {
    take_lock(::fileno(file_), path_);
  } catch (...) {
    std::fclose(std::exchange(file_, nullptr));
    throw;
  }
}

void Journal::require_free(const std::filesystem::path& path) {
  const LockOfFile now(path);
}

Journal::~Journal() {
  if (file_) std::fclose(file_);
}

void Journal::take_in(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return;
  const TextFile file = read_result_file(path.string());
  if (!file.error.empty()) throw FileError(path, file.error);
  const std::size_t whole = file.text.rfind('\n');
  if (whole == std::string::npos) return;
  auto records = csv_records(std::string_view(file.text).substr(0, whole + 1));
  if (records.empty()) return;
  if (records.front() != columns_)
    throw JournalMismatch(
        path.string() +
        ": holds results with other columns, of another version or another question; use another directory");
  Damage damage;
  decltype(rows_) found;  // of a key that is there twice the later row, as append() would have it
  for (std::size_t i = 1; i < records.size(); ++i) {
    auto& row = records[i];
    if (!is_result(row)) {
      if (damage.lines++ == 0) damage.first = i + 1;
      continue;
    }
    found.insert_or_assign({row.begin(), row.begin() + static_cast<std::ptrdiff_t>(keys_)}, row);
  }
  rows_.merge(found);
  if (damage.lines > 0) damage_[path] = damage;
}

bool Journal::is_result(const Row& row) const {
  return row.size() == columns_.size() &&
         std::ranges::all_of(numbers_, [&](std::size_t c) { return is_number(row[c]); }) &&
         (!finished_ || finished_(row));
}

std::vector<std::string> Journal::damage() const {
  std::vector<std::string> texts;
  for (const auto& [path, found] : damage_) {
    const std::string first = std::to_string(found.first);
    texts.push_back(path.string() + ": " +
                    (found.lines == 1 ? "line " + first + " is no finished result"
                                      : std::to_string(found.lines) + " lines, the first of them line " +
                                            first + ", are no finished results"));
  }
  return texts;
}

void Journal::require_asked(const std::function<bool(const Row&)>& asked,
                            const std::filesystem::path& directory, const std::string& cure) const {
  const auto lost = std::ranges::count_if(rows_, [&](const auto& known) { return !asked(known.second); });
  if (lost > 0)
    throw FileError(directory, "holds " + std::to_string(lost) +
                                   (lost == 1 ? " result that is" : " results that are") +
                                   " not asked for now and would be lost; " + cure);
}

const std::vector<std::string>* Journal::find(const std::vector<std::string>& key) const {
  const auto it = rows_.find(key);
  return it == rows_.end() ? nullptr : &it->second;
}

void Journal::append(std::vector<std::string> row) {
  const bool first = make_room_ != nullptr;
  if (file_) {
    const std::string line = csv_line(row);
    if (std::fwrite(line.data(), 1, line.size(), file_) != line.size() || std::fflush(file_) != 0)
      throw FileError(path_, errno);
  }
  std::vector<std::string> key(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(keys_));
  rows_[std::move(key)] = std::move(row);
  if (first) begin_file();
}

}  // namespace unfurl
