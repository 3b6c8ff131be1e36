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
#include "render/image/child_process.hpp"

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

namespace {

// A file of its own for what the program prints.
struct Log {
  std::string name = (fs::temp_directory_path() / "unfurl_export_XXXXXX").string();
  int file = ::mkostemp(name.data(), O_CLOEXEC);
  Log() {
    if (file < 0) throw FileError(name, errno);
  }
  ~Log() {
    ::close(file);
    ::unlink(name.c_str());
  }
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;
};

std::string exported(const ExportRequest& request, const ExportProcess::Task& task) {
  const Log log;
  std::vector<std::string> words{request.program};
  words.insert(words.end(), request.words.begin(), request.words.end());
  ChildProcess child;
  if (const int error = child.start(words, {.error = log.file}); error != 0)
    throw FileError(request.program, error);
  std::optional<int> code;
  while (!(code = child.wait(0.1)))
    if (task.stopped()) child.send(SIGTERM);
  std::string text = read_text_file(log.name).text;
  while (!text.empty() && text.back() == '\n') text.pop_back();
  const auto output = std::find(words.begin(), words.end(), "-o");
  if (*code == 0) return "exported to " + (output == words.end() ? "" : *(output + 1));
  return text.empty() ? "the export was ended" : text.substr(text.rfind('\n') + 1);
}

}  // namespace

ExportProcess::ExportProcess(std::function<void()> wake)
    : Worker(
          [](const ExportRequest& request, const Task& task) -> std::string {
            try {
              return exported(request, task);
            } catch (const std::exception& error) {
              return error.what();
            }
          },
          std::move(wake)) {}

}  // namespace unfurl
