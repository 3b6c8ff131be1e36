#include "app/study_session.hpp"

#include <algorithm>
#include <iostream>
#include <thread>

#include "app/interrupt.hpp"
#include "app/output_directory.hpp"
#include "app/run_figures.hpp"
#include "core/export/atomic_file.hpp"
#include "core/scene/text_file.hpp"
#include "render/plot/figure_data.hpp"

namespace unfurl {

namespace fs = std::filesystem;

std::vector<fs::path> journals_like(const std::string& journal, const fs::path& directory) {
  const std::string begin = journal.substr(0, journal.find_first_of("_."));
  std::vector<fs::path> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(begin) && name.ends_with(".csv")) found.push_back(entry.path());
  }
  if (error) throw FileError(directory, error.value());
  std::sort(found.begin(), found.end());
  return found;
}

void require_identity(const fs::path& directory, const std::string& identity, const std::string& cure) {
  const TextFile scene = read_text_file((directory / "scene.toml").string());
  if (scene.error.empty() && scene.text != identity)
    throw FileError(directory, "holds results of another scene or other settings; " + cure);
}

StudySession::StudySession(const Arguments& arguments, std::string task, const std::string& identity,
                           std::string journal)
    : arguments_(arguments),
      directory_(open_output_directory(arguments.output, arguments.force)),
      journal_(std::move(journal)),
      lock_(directory_, shard() ? DirectoryLock::Use::shareable : DirectoryLock::Use::alone),
      progress_(std::move(task), arguments.quiet),
      writer_(figure_options(arguments)) {
  begin(identity);
}

void StudySession::begin(const std::string& identity) {
  if (lock_.alone()) remove_unfinished(directory_);
  const auto earlier = journals_like(journal_, directory_);
  std::error_code error;
  if (!arguments_.force || !lock_.alone()) {
    if (!earlier.empty())
      require_identity(directory_, identity, "use another directory, or --force to begin anew");
  } else {
    for (const auto& path : earlier) fs::remove(path, error);
  }
  if (!identity.empty()) write_file_atomically(directory_ / "scene.toml", identity);
  fs::create_directories(directory_ / "figures", error);
  if (error) throw FileError(directory_ / "figures", error.value());
  if (shard()) lock_.share();
}

StudyHooks StudySession::hooks() {
  StudyHooks hooks;
  hooks.progress = [this](double fraction) { progress_.show(fraction); };
  hooks.cancelled = interrupted;
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  hooks.threads = arguments_.threads > 0 ? arguments_.threads : std::max(1, cores);
  return hooks;
}

void StudySession::write(const std::string& name, const std::string& text) const {
  write_file_atomically(directory_ / name, text);
}

std::string StudySession::write(const Figure& figure) {
  const std::string stem = "figures/" + figure.name;
  for (const char* extension : {".svg", ".pdf", ".png"})
    writer_.write(figure, directory_ / (stem + extension));
  write_figure_data(figure, directory_ / (stem + ".png"));
  return stem + ".png";
}

int finish(bool complete, const Arguments& arguments, const std::string& sentence) {
  if (!arguments.quiet && !sentence.empty()) std::cerr << sentence << "\n";
  if (complete) return exit_ok;
  std::cerr << "unfurl: interrupted; finished points are kept, the same command does the rest\n";
  return exit_interrupted;
}

}  // namespace unfurl
