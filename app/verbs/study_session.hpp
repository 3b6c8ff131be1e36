// SPDX-License-Identifier: BSD-3-Clause
// What the measuring verbs share: their directory with what an earlier run left in it, hooks, files.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "app/command.hpp"
#include "app/output/output_directory.hpp"
#include "app/output/progress.hpp"
#include "core/scene/scene.hpp"
#include "core/study/journal.hpp"
#include "core/study/reference.hpp"
#include "core/study/report.hpp"
#include "render/plot/figure.hpp"
#include "render/ui/write_figure.hpp"

namespace unfurl {

// The journals in the directory: `journal` ("sweep.csv", or that of a shard, "sweep_1_of_4.csv") and those of
// all shards. Throws FileError where the directory cannot be read.
std::vector<std::filesystem::path> journals_like(const std::string& journal,
                                                 const std::filesystem::path& directory);
// The scene under a line that says what was asked and by which build: points of another are not mixed with
// these.
std::string study_identity(const std::string& what, const Scene& scene);

// On stderr: what the scene, or --set, says of steps and the model that a study picks itself.
void warn_of_own_steps(const Scene& scene);
// On stderr: every --set of these keys of the solver, which do nothing here.
void warn_of_idle_sets(const Arguments& arguments, const std::vector<std::string>& keys,
                       const std::string& why);

// "solver.rho_inf: does nothing with method = 'dvm'", where the scene says that of the key; else empty.
std::string idle_key_text(const Scene& scene, const std::string& key);

// What DIR/scene.toml is to say with results of `identity` there. Throws FileError, with what can be done,
// where it tells of others. As for identity_of_both().
std::string require_identity(const std::filesystem::path& directory, const std::string& identity,
                             const std::string& cure, bool may_have_come = true);

// Throws FileError, with what can be done, where one of these tables in the directory was finished and
// changed since.
void require_as_written(const std::filesystem::path& directory,
                        const std::vector<std::filesystem::path>& tables, const std::string& cure);
// What can be done where --force is no cure.
constexpr const char* out_of_the_way = "move it away: what it stood for is made anew";

class StudySession {
 public:
  // `identity` is written to DIR/scene.toml: what the results belong to. Results of another identity are
  // refused; with --force they stay until a first new result is whole and are removed then, at once only
  // beside other shards. `journal` is the file that holds finished results; a journal of one shard has others
  // beside it, which may be at work in other processes.
  StudySession(const Arguments& arguments, std::string task, const std::string& identity,
               std::string journal);

  // A file in the directory has results added to it as they come. Throws FileError where it was finished and
  // changed since.
  void grows(const std::filesystem::path& file);

  StudyHooks hooks();
  const std::filesystem::path& directory() const { return output_.path(); }
  std::filesystem::path journal() const { return directory() / journal_; }
  // For the journal: what takes earlier results away, where that is to be done.
  std::function<void()> room_for_first();

  // Throws FileError where the journal has results that `asked` does not take; `nowhere` is an empty one of
  // its kind.
  void require_asked(Journal& nowhere, const std::function<bool(const Journal::Row&)>& asked) const;

  // DIR/name. With the first table that is another one than was there, figures and reports of that go.
  void write(const std::string& name, const std::string& text);
  // DIR/figures/NAME.svg, .pdf and .png, its numbers and caption, as --style and --dpi say; returns
  // "figures/NAME.png".
  std::string write(const Figure& figure);

 private:
  const Arguments& arguments_;
  void begin();
  void begin_anew();
  void make_room();
  void drop_pictures();
  bool shard() const { return journal_.find('_') != std::string::npos; }

  OwnDirectory output_;
  std::string journal_, identity_;
  std::filesystem::path grows_;  // is told of when there is room
  bool in_the_way_ = false;      // earlier results are still there
  std::string found_;            // in the journal
  bool keeps_pictures_ = false;  // those that are there are of the present results
  Progress progress_;
  FigureWriter writer_;
};

// With --json: the rows of a result's main table on standard output, {"complete": ..., "rows": [{column:
// cell}]}.
void print_rows(const Arguments& arguments, bool complete, const Table& table);

// The words of a report with its end: 0 or interrupted, with a line on stderr.
int finish(bool complete, const Arguments& arguments, const std::string& sentence);

}  // namespace unfurl
