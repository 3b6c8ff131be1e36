// What the measuring verbs share: their directory with what an earlier run left in it, hooks, files.
#pragma once

#include <filesystem>
#include <string>

#include "app/command.hpp"
#include "app/progress.hpp"
#include "core/study/reference.hpp"
#include "core/study/report.hpp"
#include "render/plot/figure.hpp"
#include "render/plot/write_figure.hpp"

namespace unfurl {

class StudySession {
 public:
  // `identity` is written to DIR/scene.toml: what the results belong to. Results of another identity are
  // refused; with --force they are removed first. `journal` is the file that holds finished results.
  StudySession(const Arguments& arguments, std::string task, const std::string& identity,
               std::string journal);

  StudyHooks hooks();
  const std::filesystem::path& directory() const { return directory_; }
  std::filesystem::path journal() const { return directory_ / journal_; }

  void write(const std::string& name, const std::string& text) const;  // DIR/name
  // DIR/figures/NAME.svg, .pdf and .png, its numbers and caption, as --style and --dpi say; returns
  // "figures/NAME.png".
  std::string write(const Figure& figure);

 private:
  const Arguments& arguments_;
  std::filesystem::path directory_;
  std::string journal_;
  Progress progress_;
  FigureWriter writer_;
};

// The words of a report with its end: 0 or interrupted, with a line on stderr.
// What a person asked for cannot be: std::invalid_argument of the studies as UsageError.
template <class Work>
auto as_usage(const Work& work) {
  try {
    return work();
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

int finish(bool complete, const Arguments& arguments, const std::string& sentence);

}  // namespace unfurl
