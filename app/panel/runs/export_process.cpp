#include "app/panel/runs/export_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
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

std::vector<std::string> export_words(const SceneDocument& document, const std::string& verb,
                                      const std::string& output) {
  std::string scene = document.path;
  if (scene.empty()) {
    scene = output + ".toml";
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
  if (running_ && pid_ > 0) ::kill(pid_, SIGTERM);
  if (thread_.joinable()) thread_.join();
}

void ExportProcess::start(const std::string& program, const std::vector<std::string>& words) {
  if (running_) return;
  if (thread_.joinable()) thread_.join();
  std::string log = (fs::temp_directory_path() / "unfurl_export_XXXXXX").string();
  const int file = ::mkstemp(log.data());
  if (file < 0) throw FileError(log, errno);
  std::vector<std::string> all{program};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> argv;
  for (std::string& word : all) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t streams;
  posix_spawn_file_actions_init(&streams);
  posix_spawn_file_actions_addopen(&streams, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&streams, file, STDERR_FILENO);
  pid_t pid = 0;
  const int error = ::posix_spawn(&pid, program.c_str(), &streams, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&streams);
  ::close(file);
  if (error != 0) {
    ::unlink(log.c_str());
    throw FileError(program, error);
  }
  const auto output = std::find(words.begin(), words.end(), "-o");
  running_ = true;
  pid_ = pid;
  thread_ = std::thread(
      [this, pid, log, where = output == words.end() ? "" : *(output + 1)] { wait(pid, log, where); });
}

void ExportProcess::wait(int pid, const std::string& log, const std::string& output) {
  int status = 0;
  ::waitpid(pid, &status, 0);
  std::string text = read_text_file(log).text;
  ::unlink(log.c_str());
  while (!text.empty() && text.back() == '\n') text.pop_back();
  const bool good = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  {
    const std::lock_guard lock(mutex_);
    report_ = good ? "exported to " + output : text.substr(text.rfind('\n') + 1);
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
