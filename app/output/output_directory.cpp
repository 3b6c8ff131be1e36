// SPDX-License-Identifier: BSD-3-Clause
#include "app/output/output_directory.hpp"

#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>

#include "app/output/exit_code.hpp"
#include "core/export/atomic_file.hpp"
#include "core/export/formats.hpp"
#include "core/scene/text_file.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

namespace fs = std::filesystem;

// Without a slash at its end: the parent of "a/b/" is "a/b".
fs::path plain(const fs::path& directory) {
  return directory.has_filename() ? directory : directory.parent_path();
}

bool holds_our_results(const fs::path& directory) {
  if (WrittenFiles::begun_here(directory)) return true;
  const TextFile summary = read_text_file((directory / "summary.json").string());
  const auto json = nlohmann::json::parse(summary.text, nullptr, false);
  return json.is_object() && json.contains("unfurl");
}

// The system's words of an error about another file.
std::string cause_of(const FileError& error) {
  const std::string text = error.what();
  return text.substr(text.rfind(": ") + 2);
}

// Nothing is in it but what another unfurl that just begins has not finished.
bool holds_nothing(const fs::path& directory) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory, error))
    if (!is_unfinished_name(entry.path().filename().string())) return false;
  if (error) throw FileError(directory, error.value());
  return true;
}

// Remove what programs that were killed left half written. Only for who is alone there.
void remove_unfinished(const fs::path& directory) {
  std::vector<std::string> folders{"", "frames", "figures"};
  for (const ExportFormat& format : export_formats()) folders.emplace_back(format.result);
  std::error_code error;
  for (const std::string& folder : folders) {
    if (fs::is_symlink(directory / folder, error) && !folder.empty()) continue;
    for (const auto& entry : fs::directory_iterator(directory / folder, error))
      if (is_unfinished_name(entry.path().filename().string())) remove_abandoned(entry.path());
  }
}

}  // namespace

OwnDirectory::OwnDirectory(const std::string& path, bool force, const std::string& owner,
                           DirectoryLock::Use use)
    : path_(path) {
  if (path.empty()) return;
  std::error_code error;
  if (fs::exists(path_, error) && !fs::is_directory(path_, error))
    throw FileError(path_, "is a file; -o names a directory");
  for (fs::path part = plain(path_); !part.empty() && !fs::exists(part, error); part = part.parent_path())
    made_ = part;
  fs::create_directories(path_, error);
  if (error) throw FileError(path_, error.value());
  const bool empty = holds_nothing(path_);
  // Another worker may have begun a moment ago.
  for (int wait = 0; use == DirectoryLock::Use::joined && !empty && !holds_our_results(path_) && wait < 100;
       ++wait)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  if (!empty && !force && !holds_our_results(path_))
    throw FileError(path_, "is not empty and holds no earlier results; use --force to write into it");
  lock_.emplace(path_, use);
  try {
    require_writable(path_ / WrittenFiles::list_name);
    written_.emplace(path_, owner, empty);
  } catch (const FileError& problem) {
    if (fs::is_symlink(path_ / WrittenFiles::list_name, error)) throw;
    throw FileError(path_, cause_of(problem));
  }
  if (lock_->alone()) remove_unfinished(path_);
}

namespace {

// Lines that are not empty, with or without the comments that say what was asked of a scene.
std::string lines_in(const std::string& text, bool comments) {
  std::istringstream lines(text);
  std::string out;
  for (std::string line; std::getline(lines, line);)
    if (!line.empty() && line != "# mp4 = true" && (comments || !line.starts_with('#'))) out += line + "\n";
  return out;
}

}  // namespace

void OwnDirectory::require_scene(const std::string& text, bool force) {
  if (!written_) return;
  const char* name = "scene.toml";
  const TextFile there = read_text_file((path_ / name).string());
  // A study's comment may come to the same scene of a run, but not go.
  if (!there.error.empty() || there.text == text || lines_in(there.text, true) == lines_in(text, false))
    return;
  const std::string owner = written_->other_owner(name);
  if (owner.empty()) return;
  if (!force)
    throw FileError(path_, "holds results of unfurl " + owner +
                               ", whose scene.toml this would replace; use another directory, or --force");
  written_->keep_aside(name);
}

void OwnDirectory::require_files(std::initializer_list<const char*> names) const {
  std::error_code unknown;
  for (const char* name : names)
    if (written_ && fs::is_directory(path_ / name, unknown)) throw FileError(path_ / name, EISDIR);
}

OwnDirectory::~OwnDirectory() {
  if (!written_) return;
  const auto kept = written_->kept();
  // What was refused before anything was written leaves nothing.
  if (!made_.empty() && lock_->alone() && written_->is_empty()) {
    std::error_code error;
    written_.reset();
    fs::remove(path_ / WrittenFiles::list_name, error);
    for (fs::path part = plain(path_); fs::remove(part, error) && part != made_;) part = part.parent_path();
  }
  if (kept.empty()) return;
  const WrittenFiles::Kept& first = kept.front();
  std::cerr << "unfurl: warning: " << first.name
            << (first.owner.empty() ? " was not, or not any more, what unfurl wrote"
                                    : " held what unfurl " + first.owner + " wrote")
            << "; it is kept as " << first.aside;
  if (kept.size() > 1) std::cerr << ", and " << kept.size() - 1 << " more likewise";
  std::cerr << "\n";
}

namespace {

void refuse_long_name(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const long most = ::pathconf(folder.c_str(), _PC_NAME_MAX);  // below 0: no limit, or not known
  const std::size_t length = file.filename().native().size();
  if (most < 0 || length <= static_cast<std::size_t>(most)) return;
  throw FileError(file, "the name has " + std::to_string(length) + " bytes; names there have at most " +
                            std::to_string(most));
}

}  // namespace

void require_writable(const fs::path& file) {
  refuse_long_name(file);
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) throw FileError(file, "is a directory");
  try {
    const PendingFile pending(file);
    write_file_atomically(pending.name(), std::string_view("can this directory be written to?\n"),
                          Flush::later);
  } catch (const FileError& error) {
    throw FileError(file, cause_of(error));
  }
}

void require_writable_png(const fs::path& file, const std::string& what) {
  if (file.extension() != ".png")
    throw UsageError(what + " is written as .png, not " + in_quotes(file.extension().string()));
  require_writable(file);
}

}  // namespace unfurl
