#include "app/study_session.hpp"

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

StudySession::StudySession(const Arguments& arguments, std::string task, const std::string& identity,
                           std::string journal)
    : arguments_(arguments),
      directory_(open_output_directory(arguments.output, arguments.force)),
      journal_(std::move(journal)),
      progress_(std::move(task), arguments.quiet),
      writer_(figure_options(arguments)) {
  const fs::path scene = directory_ / "scene.toml", results = directory_ / journal_;
  std::error_code error;
  const bool begun = fs::exists(results, error);
  if (arguments.force) fs::remove(results, error);
  if (begun && !arguments.force && read_text_file(scene.string()).text != identity)
    throw FileError(directory_,
                    "holds results of another scene or other settings; use another directory, or --force to "
                    "begin anew");
  if (!identity.empty()) write_file_atomically(scene, identity);
  fs::create_directories(directory_ / "figures", error);
  if (error) throw FileError(directory_ / "figures", error.value());
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
