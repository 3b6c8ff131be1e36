// SPDX-License-Identifier: BSD-3-Clause
#include "app/output/written_files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <sstream>
#include <utility>

#include "core/export/checksum.hpp"
#include "core/scene/text_file.hpp"
#include "core/text/version.hpp"

namespace unfurl {

namespace {

namespace fs = std::filesystem;

constexpr const char* any_content = "----------------";
constexpr const char* made = "Made by unfurl ";
constexpr const char* written_into = "Written into by unfurl ";
constexpr const char* in_order = ", in order";  // behind the version: as older lists are not
constexpr const char* of_figures = "figure";    // owner of numbers that no other verb makes anew
constexpr const char* of_workers = "join/";     // what the workers of a --join keep of their own

class Descriptor {
 public:
  explicit Descriptor(int file) : file_(file) {}
  Descriptor(Descriptor&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(file_, other.file_);
    return *this;
  }
  ~Descriptor() {
    if (file_ >= 0) ::close(file_);
  }
  int get() const { return file_; }
  explicit operator bool() const { return file_ >= 0; }

 private:
  int file_;
};

// Names may hold anything but NUL; a line holds one name.
std::string escaped(const std::string& name) {
  std::string text;
  for (const char c : name) text += c == '\\' ? "\\\\" : c == '\n' ? "\\n" : std::string(1, c);
  return text;
}

std::string unescaped(std::string_view text) {
  std::string name;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\' || i + 1 == text.size()) {
      name += text[i];
      continue;
    }
    name += text[++i] == 'n' ? '\n' : text[i];
  }
  return name;
}

// The checksum of a regular file, no link, in an open directory; empty where there is none.
std::string checksum_in(int directory, const std::string& name) {
  const Descriptor file(::openat(directory, name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  return file ? checksum_of(file.get()) : "";
}

// The directory that holds DIR/name, reached through directories only; none where a link is on the way or the
// name leads out of DIR.
Descriptor parent_in(const fs::path& directory, const fs::path& name) {
  Descriptor at(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  for (const fs::path& part : name.parent_path()) {
    if (part.empty() || part == "." || part == ".." || part.is_absolute()) return Descriptor(-1);
    at = Descriptor(::openat(at.get(), part.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
    if (!at) break;
  }
  return at;
}

}  // namespace

bool WrittenFiles::begun_here(const fs::path& directory) {
  return read_text_file((directory / list_name).string()).text.starts_with(made);
}

WrittenFiles::WrittenFiles(fs::path directory, std::string owner, bool was_empty)
    : directory_(std::move(directory)), owner_(std::move(owner)) {
  std::error_code error;
  if (fs::is_symlink(directory_ / list_name, error))
    throw FileError(directory_ / list_name, "is a link, not the list of what unfurl wrote");
  if (!begin(was_empty)) read();
  before_ = watch_files(this);
}

WrittenFiles::~WrittenFiles() {
  watch_files(before_);
  for (const std::string& name : grown_) {
    const std::string sum = checksum_in(AT_FDCWD, (directory_ / name).string());
    try {
      if (!sum.empty() && grows_now(name)) append(name, {sum});
    } catch (const FileError&) {  // it is listed as one that grows
    }
  }
}

WrittenFiles::Lines WrittenFiles::lines_of(const std::string& list, std::string& title) {
  Lines lines;
  std::istringstream text(list);
  std::getline(text, title);
  for (std::string line; std::getline(text, line);) {
    const std::size_t one = line.find(' '), two = line.find(' ', one + 1);
    if (one == std::string::npos || two == std::string::npos) continue;
    lines[unescaped(std::string_view(line).substr(two + 1))].push_back(
        {line.substr(0, one), line.substr(one + 1, two - one - 1)});
  }
  return lines;
}

void WrittenFiles::read() {
  const TextFile file = read_text_file((directory_ / list_name).string());
  if (!file.error.empty()) throw FileError(directory_ / list_name, file.error);
  lines_ = lines_of(file.text, title_);
}

// The last line of a name says what its bytes are.
std::vector<WrittenFiles::Verdict> WrittenFiles::judge(const fs::path& directory, const std::string& title,
                                                       const Lines& lines) {
  const bool ordered = title.ends_with(in_order);
  std::vector<Verdict> verdicts;
  for (const auto& [name, known] : lines) {
    const Descriptor parent = parent_in(directory, name);
    const std::string now = parent ? checksum_in(parent.get(), fs::path(name).filename().string()) : "";
    if (now.empty() && name.starts_with(of_workers)) continue;  // which may be removed
    const Line& last = known.back();
    const auto fits =
        std::find_if(known.rbegin(), known.rend(), [&now](const Line& line) { return line.checksum == now; });
    Verdict verdict{name, Verdict::changed, last.owner};
    if (now.empty()) {
      verdict.kind = Verdict::missing;
    } else if (fits != known.rend()) {
      const bool as_last = last.checksum == now || last.checksum == any_content || !ordered;
      verdict.kind = as_last ? Verdict::same : Verdict::earlier;
      verdict.owner = fits->owner;
    } else if (last.checksum == any_content) {
      verdict.kind = Verdict::growing;
    }
    verdicts.push_back(std::move(verdict));
  }
  return verdicts;
}

std::vector<WrittenFiles::Verdict> WrittenFiles::verify(const fs::path& directory) {
  const TextFile file = read_text_file((directory / list_name).string());
  std::string title;
  const Lines lines = lines_of(file.text, title);
  if (!file.error.empty() || (!title.starts_with(made) && !title.starts_with(written_into)))
    throw FileError(directory, "has no list of what unfurl wrote into it (.unfurl)");
  return judge(directory, title, lines);
}

std::vector<std::string> WrittenFiles::changed(const fs::path& directory,
                                               const std::function<bool(const std::string&)>& asked) {
  std::string title;
  Lines lines = lines_of(read_text_file((directory / list_name).string()).text, title);
  std::erase_if(lines, [&](const auto& entry) { return !asked(entry.first); });
  std::vector<std::string> names;
  for (const Verdict& verdict : judge(directory, title, lines))
    if (verdict.kind == Verdict::changed) names.push_back(verdict.name);
  return names;
}

// False where there is a list already; others may begin one at the same moment.
bool WrittenFiles::begin(bool was_empty) {
  const fs::path list = directory_ / list_name;
  const Descriptor file(::open(list.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
  if (!file && errno == EEXIST) return false;
  if (!file) throw FileError(list, errno);
  title_ = (was_empty ? made : written_into) + version() + in_order;
  const std::string line = title_ + "\n";
  if (::write(file.get(), line.data(), line.size()) == static_cast<ssize_t>(line.size())) return true;
  const int trouble = errno;
  ::unlink(list.c_str());
  throw FileError(list, trouble);
}

void WrittenFiles::write_anew() {
  std::string text = title_ + "\n";
  for (const auto& [name, lines] : lines_)
    for (const Line& line : lines) text += line.checksum + " " + line.owner + " " + escaped(name) + "\n";
  FileWatcher* watcher = watch_files(nullptr);  // the list is not in the list
  try {
    write_file_atomically(directory_ / list_name, text);
  } catch (...) {
    watch_files(watcher);
    throw;
  }
  watch_files(watcher);
}

// One write at the file's end: whole beside those of other programs.
void WrittenFiles::append(const std::string& name, const std::vector<std::string>& checksums) {
  std::string text;
  std::vector<Line>& lines = lines_[name];
  for (const std::string& checksum : checksums) {
    const Line line{checksum, owner_};
    if (!lines.empty() && lines.back() == line) continue;
    std::erase(lines, line);
    lines.push_back(line);
    text += checksum + " " + owner_ + " " + escaped(name) + "\n";
  }
  if (text.empty()) return;
  const Descriptor file(
      ::open((directory_ / list_name).c_str(), O_WRONLY | O_APPEND | O_NOFOLLOW | O_CLOEXEC));
  if (!file || ::write(file.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size()))
    throw FileError(directory_ / list_name, errno);
  // After a power cut what grew would be one that was changed.
  if (checksums.back() == any_content) ::fsync(file.get());
}

bool WrittenFiles::grows_now(const std::string& name) const {
  const auto found = lines_.find(name);
  return found != lines_.end() && found->second.back().checksum == any_content;
}

bool WrittenFiles::known(const std::string& name, const std::string& checksum) const {
  const auto found = lines_.find(name);
  if (found == lines_.end()) return false;
  return grows_now(name) || std::any_of(found->second.begin(), found->second.end(), [&](const Line& line) {
           return line.checksum == checksum && (line.owner == owner_ || line.owner != of_figures);
         });
}

// Empty for what lies elsewhere.
std::string WrittenFiles::name_of(const fs::path& target) const {
  const fs::path name = target.lexically_relative(directory_);
  return name.empty() || *name.begin() == ".." ? "" : name.string();
}

void WrittenFiles::before_file(const fs::path& target, const std::string& checksum) {
  if (before_) before_->before_file(target, checksum);
  const std::string name = name_of(target);
  if (name.empty()) return;
  const std::lock_guard lock(mutex_);
  struct stat status {};
  std::vector<std::string> sums;
  if (::lstat(target.c_str(), &status) == 0 && !S_ISDIR(status.st_mode)) {
    const std::string old = checksum_in(AT_FDCWD, target.string());
    const bool same = !old.empty() && old == checksum;
    if (!same && (old.empty() || !known(name, old))) {
      read();  // another program may have written it since
      if (old.empty() || !known(name, old)) put_aside(target);
    }
    if (grows_now(name) && !old.empty()) sums.push_back(old);  // it is that until the new one has its place
  }
  sums.push_back(checksum);
  if (will_grow_.erase(name) > 0) {
    sums.push_back(any_content);
    grown_.insert(name);
  }
  append(name, sums);
}

void WrittenFiles::keep_aside(const std::string& name) {
  const std::lock_guard lock(mutex_);
  const fs::path target = directory_ / name;
  put_aside(target);
  ::unlink(target.c_str());  // the other of two names; a folder has moved
}

void WrittenFiles::put_aside(const fs::path& target) {
  const std::string owner = owner_of(name_of(target));
  for (int n = 1;; ++n) {
    const fs::path aside = target.string() + ".kept-" + std::to_string(n);
    struct stat status {};
    if (::lstat(aside.c_str(), &status) == 0) continue;
    // Both names at once where the file system can, so that there is no moment without the file.
    if (::linkat(AT_FDCWD, target.c_str(), AT_FDCWD, aside.c_str(), 0) != 0) {
      if (errno == EEXIST) continue;
      if (std::rename(target.c_str(), aside.c_str()) != 0) throw FileError(aside, errno);
    }
    kept_.push_back({target.string(), owner, aside.string()});
    return;
  }
}

void WrittenFiles::grows(const std::string& name) {
  const std::lock_guard lock(mutex_);
  append(name, {any_content});
  if (before_) before_->before_file(directory_ / name, any_content);
}

void WrittenFiles::will_grow(const std::string& name) {
  const std::lock_guard lock(mutex_);
  will_grow_.insert(name);
}

bool WrittenFiles::ours(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  const auto found = lines_.find(name);
  if (found == lines_.end()) return false;
  const Descriptor folder = parent_in(directory_, name);
  const std::string sum = folder ? checksum_in(folder.get(), fs::path(name).filename().string()) : "";
  if (sum.empty()) return false;
  const std::vector<Line>& lines = found->second;
  return lines.back() == Line{any_content, owner_} ||
         std::find(lines.begin(), lines.end(), Line{sum, owner_}) != lines.end();
}

std::string WrittenFiles::other_owner(const std::string& name) const {
  if (ours(name)) return "";
  const std::lock_guard lock(mutex_);
  return owner_of(name);
}

std::string WrittenFiles::owner_of(const std::string& name) const {
  const auto found = lines_.find(name);
  const std::string sum = checksum_in(AT_FDCWD, (directory_ / name).string());
  if (found == lines_.end() || sum.empty()) return "";
  for (const Line& line : found->second)
    if (line.checksum == sum) return line.owner;
  return "";
}

bool WrittenFiles::is_empty() const {
  const std::lock_guard lock(mutex_);
  return lines_.empty();
}

void WrittenFiles::remove(const std::string& name) {
  if (!ours(name)) return;
  fs::path path = name;
  Descriptor folder = parent_in(directory_, path);
  ::unlinkat(folder.get(), path.filename().c_str(), 0);
  for (path = path.parent_path(); !path.empty(); path = path.parent_path()) {
    folder = parent_in(directory_, path);
    if (!folder || ::unlinkat(folder.get(), path.filename().c_str(), AT_REMOVEDIR) != 0) break;
  }
}

void WrittenFiles::remove_all(const std::function<bool(const std::string&)>& stays) {
  std::vector<std::string> names;
  for (const auto& [name, lines] : lines_)
    if (!stays || !stays(name)) names.push_back(name);
  for (const std::string& name : names) remove(name);
  forget_missing();
}

void WrittenFiles::forget_missing() {
  const std::lock_guard lock(mutex_);
  std::error_code error;
  const auto missing = [&](const auto& entry) { return !fs::exists(directory_ / entry.first, error); };
  if (std::erase_if(lines_, missing) > 0) write_anew();
}

std::vector<WrittenFiles::Kept> WrittenFiles::kept() const {
  const std::lock_guard lock(mutex_);
  return kept_;
}

}  // namespace unfurl
