// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/runs/export_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "core/export/atomic_file.hpp"
#include "core/scene/text_file.hpp"
#include "core/scene/write_back.hpp"

namespace unfurl {

namespace fs = std::filesystem;

namespace {

// OUTPUT.toml, or OUTPUT-2.toml, ...: the first that is not there or holds this very text.
std::string free_name(const std::string& output, const std::string& text) {
  std::error_code unknown;
  for (int number = 1;; ++number) {
    std::string name = output + (number == 1 ? "" : "-" + std::to_string(number)) + ".toml";
    if (!fs::exists(fs::symlink_status(name, unknown)) || read_text_file(name).text == text) return name;
  }
}

}  // namespace

std::vector<std::string> export_words(const SceneDocument& document, const std::string& verb,
                                      const std::string& output) {
  std::string scene = document.path;
  if (scene.empty()) {
    scene = free_name(output, *document.text);
    write_file_atomically(scene, *document.text);
  }
  std::vector<std::string> words{verb, scene};
  if (verb == "figure") words.push_back("all");
  words.insert(words.end(), {"-o", output});
  for (std::string& text : overrides_of(document)) {
    words.push_back("--set");
    words.push_back(std::move(text));
  }
  return words;
}

SceneDocument save_document(const SceneDocument& document, const std::string& path, bool& anew) {
  const WrittenBack written =
      write_back(*document.text, document.name, overrides_of(document), document.folder);
  anew = written.anew;
  write_file_atomically(path, written.text);
  return open_document(path, {});
}

std::string own_program() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).string();
}

ExportProcess::~ExportProcess() {
  child_.send(SIGTERM);
  if (thread_.joinable()) thread_.join();
}

void ExportProcess::start(const std::string& program, const std::vector<std::string>& words) {
  if (running_) return;
  if (thread_.joinable()) thread_.join();
  std::string log = (fs::temp_directory_path() / "unfurl_export_XXXXXX").string();
  const int file = ::mkostemp(log.data(), O_CLOEXEC);
  if (file < 0) throw FileError(log, errno);
  std::vector<std::string> all{program};
  all.insert(all.end(), words.begin(), words.end());
  const int error = child_.start(all, {.error = file});
  ::close(file);
  if (error != 0) {
    ::unlink(log.c_str());
    throw FileError(program, error);
  }
  const auto output = std::find(words.begin(), words.end(), "-o");
  running_ = true;
  thread_ =
      std::thread([this, log, where = output == words.end() ? "" : *(output + 1)] { wait(log, where); });
}

void ExportProcess::wait(const std::string& log, const std::string& output) {
  const int code = child_.wait().value_or(-1);
  std::string text = read_text_file(log).text;
  ::unlink(log.c_str());
  while (!text.empty() && text.back() == '\n') text.pop_back();
  {
    const std::lock_guard lock(mutex_);
    report_ = code == 0 ? "exported to " + output : text.substr(text.rfind('\n') + 1);
    if (report_.empty()) report_ = "the export was ended";
  }
  running_ = false;
  if (wake_) wake_();
}

std::string ExportProcess::take_report() {
  const std::lock_guard lock(mutex_);
  return std::exchange(report_, "");
}

}  // namespace unfurl
