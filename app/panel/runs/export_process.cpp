// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/runs/export_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "app/output/checkpoint_head.hpp"
#include "app/output/film_folder.hpp"
#include "app/panel/document/own_file.hpp"
#include "core/export/atomic_file.hpp"
#include "core/scene/text_file.hpp"
#include "render/image/child_process.hpp"

namespace unfurl {

namespace fs = std::filesystem;

namespace {

// Beside a folder that need not be there, as a command line takes it; "exported" in those without a name.
std::string name_beside(const std::string& folder) {
  fs::path name = fs::path(folder).lexically_normal();
  if (!name.has_filename()) name = name.parent_path();  // "out/"
  if (!name.has_filename() || name.filename() == "." || name.filename() == "..") name /= "exported";
  return (name.string().starts_with('-') ? "./" : "") + name.string();
}

// OUTPUT.toml, or OUTPUT-2.toml, ...: the first that is not there or holds this very text.
std::string free_name(const std::string& output, const std::string& text) {
  std::error_code unknown;
  for (int number = 1;; ++number) {
    std::string name = output + (number == 1 ? "" : "-" + std::to_string(number)) + ".toml";
    if (!fs::exists(fs::symlink_status(name, unknown)) || read_text_file(name).text == text) return name;
  }
}

// "12 files, 3.4 MB"
std::string size_of_folder(const std::string& folder) {
  std::error_code unknown;
  long files = 0;
  double bytes = 0;
  for (auto it = fs::recursive_directory_iterator(folder, unknown); it != fs::recursive_directory_iterator();
       it.increment(unknown)) {
    if (unknown) break;
    if (!it->is_regular_file(unknown)) continue;
    if (it->path().filename().string().starts_with('.')) continue;  // the list of its files
    ++files;
    bytes += static_cast<double>(it->file_size(unknown));
  }
  char text[64];
  std::snprintf(text, sizeof text, "%ld %s, %.3g MB", files, files == 1 ? "file" : "files", bytes / 1e6);
  return text;
}

}  // namespace

std::span<const ExportKind> export_kinds() {
  static constexpr ExportKind rows[] = {
      {"Film, figures, data", "everything that the program makes of a scene", "render", ""},
      {"Figures", "every figure as PNG, SVG, PDF and its numbers as CSV", "figure", ""},
      {"Data", "summary, series and trajectory", "run", ""},
      {"glTF", "the moving structure for Blender and the web", "run", "gltf"},
      {"VTK", "the moving structure for ParaView", "run", "vtk"},
      {"Web page", "an HTML page in which the structure turns and plays", "run", "html"},
      {"Tables", "tidy CSV tables", "run", "csv"}};
  return rows;
}

namespace {

// Behind the scene's name.
std::vector<std::string> words_behind(const ExportKind& kind, const std::string& output, bool replace) {
  std::vector<std::string> words;
  if (kind.verb == "figure") words.emplace_back("all");
  words.insert(words.end(), {"-o", output});
  if (!kind.formats.empty()) words.insert(words.end(), {"--export", std::string(kind.formats)});
  if (replace && kind.verb != "figure") words.emplace_back("--force");
  return words;
}

bool file_holds(const SceneDocument& document) {
  return !document.path.empty() && own_file(document, nullptr) == OwnFile::same;
}

}  // namespace

std::string exported_scene(const SceneDocument& document, const std::string& output, bool in_file) {
  if (in_file) return document.path;
  return free_name(
      document.path.empty() ? name_beside(output) : fs::path(document.path).replace_extension().string(),
      *document.text);
}

std::vector<std::string> export_words(const SceneDocument& document, const ExportKind& kind,
                                      const std::string& output, bool replace) {
  const bool in_file = file_holds(document);
  const std::string scene = exported_scene(document, output, in_file);
  if (!in_file) {
    if (const fs::path folder = fs::path(scene).parent_path(); !folder.empty())
      fs::create_directories(folder);
    write_file_atomically(scene, *document.text);
  }
  std::vector<std::string> words{std::string(kind.verb), scene};
  for (std::string& word : words_behind(kind, output, replace)) words.push_back(std::move(word));
  for (std::string& text : overrides_of(document)) {
    words.push_back("--set");
    words.push_back(std::move(text));
  }
  return words;
}

std::string export_command(const SceneDocument& document, const ExportKind& kind, const std::string& output,
                           bool in_file) {
  SceneDocument named = document;
  named.path = exported_scene(document, output, in_file);
  std::string verb(kind.verb), line = command_line(named, verb, output);
  const std::string plain = " -o " + shell_word(output);
  std::string behind;
  for (const std::string& word : words_behind(kind, output, false)) behind += " " + shell_word(word);
  return line.replace(line.find(plain), plain.size(), behind);
}

std::string export_goes_on_with(const SceneDocument& document, const ExportKind& kind,
                                const std::string& output) {
  const bool run = holds_checkpoint(output);
  if (kind.verb == "figure" || (kind.verb == "run" ? !run || !kind.formats.empty() : run)) return "";
  SceneDocument exported = document;
  exported.name = exported_scene(document, output, file_holds(document));  // may be its title
  const Scene scene = read_document(exported);
  if (run) return holds_checkpoint_of(scene, output) ? "an unfinished run" : "";
  return FilmFolder(output, scene).holds_this() ? "a film" : "";
}

bool export_loses_run(const ExportKind& kind, const std::string& output) {
  return kind.verb != "figure" && holds_checkpoint(output);
}

SceneDocument saved_document(const SceneDocument& document, const std::string& path, WrittenBack& written) {
  written = write_back(*document.text, document.name, overrides_of(document), document.folder);
  SceneDocument saved;
  saved.path = saved.name = path;
  saved.text = std::make_shared<const std::string>(written.text);
  saved.folder = fs::path(path).parent_path().string();
  if (saved.folder.empty()) saved.folder = ".";
  return saved;
}

SceneDocument save_document(const SceneDocument& document, const std::string& path, WrittenBack& written) {
  SceneDocument saved = saved_document(document, path, written);
  write_file_atomically(path, *saved.text);
  return saved;
}

std::string own_program() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).string();
}

namespace {

// A file of its own for what the program prints; it has no name that could be left behind.
struct Log {
  std::string name = (fs::temp_directory_path() / "unfurl_export_XXXXXX").string();
  int file = ::mkostemp(name.data(), O_CLOEXEC);
  Log() {
    if (file < 0) throw FileError(name, errno);
    ::unlink(name.c_str());
    name = "/proc/self/fd/" + std::to_string(file);
  }
  ~Log() { ::close(file); }
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;
};

std::string exported(const ExportRequest& request, const ExportProcess::Task& task) {
  const Log log;
  std::vector<std::string> words{request.program};
  words.insert(words.end(), request.words.begin(), request.words.end());
  words.emplace_back("--quiet");  // what is left is what failed
  ChildProcess child;
  if (const int error = child.start(words, {.error = log.file}, ChildProcess::Ending::asked); error != 0)
    throw FileError(request.program, error);
  std::optional<int> code;
  // A second signal ends it at once, and what it has simulated is lost: only where nothing came of the first.
  constexpr int patience = 6000;  // of so many waits: a part of a large run takes minutes to be judged
  for (int asked = 0; !(code = child.wait(0.1));)
    if (task.stopped() && asked++ % patience == 0) child.send(SIGTERM);
  std::string text = read_text_file(log.name).text;
  while (!text.empty() && text.back() == '\n') text.pop_back();
  const auto output = std::find(words.begin(), words.end(), "-o");
  if (*code == 0) {
    const std::string folder = output == words.end() ? "." : *(output + 1);
    return "exported to " + fs::absolute(folder).lexically_normal().string() + ": " + size_of_folder(folder);
  }
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
