// SPDX-License-Identifier: BSD-3-Clause
#include "app/verbs/study_session.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "app/output/interrupt.hpp"
#include "app/output/receipt.hpp"
#include "app/verbs/run_figures.hpp"
#include "core/export/atomic_file.hpp"
#include "core/scene/text_file.hpp"
#include "core/scene/write.hpp"
#include "core/study/sweep.hpp"
#include "core/text/version.hpp"
#include "render/plot/figure_data.hpp"

namespace unfurl {

namespace fs = std::filesystem;

namespace {

// "_3_of_16.csv", or ".csv" alone.
bool ends_as_journal(std::string_view end) {
  const auto digits = [&end] {
    const std::size_t count = std::min(end.find_first_not_of("0123456789"), end.size());
    end.remove_prefix(count);
    return count > 0;
  };
  const auto word = [&end](std::string_view text) {
    if (!end.starts_with(text)) return false;
    end.remove_prefix(text.size());
    return true;
  };
  return end == ".csv" || (word("_") && digits() && word("_of_") && digits() && end == ".csv");
}

}  // namespace

void warn_of_own_steps(const Scene& scene) {
  const auto idle = [](const char* key, const char* why) {
    std::cerr << "unfurl: warning: " << key << " does nothing here: " << why << "\n";
  };
  const char* ladder = "steps are equal, as the ladder has them";
  if (scene.solver.adaptive) idle("solver.adaptive", ladder);
  if (scene.solver.tolerance > 0) idle("solver.tolerance", ladder);
  // "auto" is the full model wherever methods are asked about.
  if (scene.solver.model == "path" || scene.solver.model == "sector")
    idle("solver.model", "every method steps the whole model");
}

void warn_of_idle_sets(const Arguments& arguments, const std::vector<std::string>& keys,
                       const std::string& why) {
  for (const std::string& setting : arguments.overrides)
    if (std::ranges::any_of(keys, [&](const std::string& key) { return setting.starts_with(key); }))
      std::cerr << "unfurl: warning: --set " << setting << " does nothing: " << why << "\n";
}

std::string idle_key_text(const Scene& scene, const std::string& key) {
  for (const SceneProblem& warning : scene.warnings)
    if (warning.key == key && warning.message.starts_with("does nothing")) return key + " " + warning.message;
  return "";
}

std::vector<fs::path> journals_like(const std::string& journal, const fs::path& directory) {
  const std::string begin = journal.substr(0, journal.find_first_of("_."));
  std::vector<fs::path> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(begin) && ends_as_journal(std::string_view(name).substr(begin.size())))
      found.push_back(entry.path());
  }
  if (error) throw FileError(directory, error.value());
  std::sort(found.begin(), found.end());
  return found;
}

std::string study_identity(const std::string& what, const Scene& scene) {
  return "# " + what + ", by unfurl " + version() + " (build " + checksum_of_this_program() + ")\n" +
         scene_text(scene);
}

std::string require_identity(const fs::path& directory, const std::string& identity, const std::string& cure,
                             bool may_have_come) {
  const TextFile scene = read_text_file((directory / "scene.toml").string());
  if (!scene.error.empty()) return identity;
  if (const auto both = identity_of_both(scene.text, identity, may_have_come)) return *both;
  const std::size_t there = std::min(scene.text.find('\n'), scene.text.size());
  const std::size_t asked = std::min(identity.find('\n'), identity.size());
  std::string what = "holds results of another scene or other settings; ";
  if (scene.text.substr(there) == identity.substr(asked) && there > 2 &&
      asked > 2)  // behind the "# " of headings
    what = "holds \"" + scene.text.substr(2, there - 2) + "\"; asked for: \"" +
           identity.substr(2, asked - 2) + "\"; ";
  throw FileError(directory, what + cure);
}

void require_as_written(const fs::path& directory, const std::vector<fs::path>& tables,
                        const std::string& cure) {
  const auto changed = WrittenFiles::changed(directory, [&](const std::string& name) {
    return std::ranges::find(tables, directory / name) != tables.end();
  });
  if (changed.empty()) return;
  throw FileError(directory / changed.front(),
                  "was changed since unfurl wrote it, and its results are not taken; put back what was "
                  "written, or " +
                      cure);
}

StudySession::StudySession(const Arguments& arguments, std::string task, const std::string& identity,
                           std::string journal)
    : arguments_(arguments),
      output_(arguments.output, arguments.force, journal.substr(0, journal.find_first_of("_.")),
              arguments.join                           ? DirectoryLock::Use::joined
              : journal.find('_') != std::string::npos ? DirectoryLock::Use::shareable
                                                       : DirectoryLock::Use::alone),
      journal_(std::move(journal)),
      identity_(identity),
      progress_(std::move(task), arguments.quiet),
      writer_(figure_options(arguments)) {
  begin();
}

void StudySession::begin() {
  std::error_code error;
  if (shard()) Journal::require_free(journal());
  if (arguments_.force && arguments_.join)
    throw UsageError("--force could remove what other workers of the --join write; use another directory");
  if (arguments_.force && output_.lock().unknown())
    throw FileError(directory(),
                    "is on a file system without locks, so --force could remove what another "
                    "unfurl is writing; use another directory");
  output_.require_files({"scene.toml", journal_.c_str()});
  in_the_way_ = arguments_.force && output_.lock().alone();
  found_ = read_result_file(journal().string()).text;
  if (shard()) make_room();
  if (in_the_way_) return;
  if (!identity_.empty()) output_.require_scene(identity_, arguments_.force);
  const bool begun = arguments_.join ? fs::exists(directory() / "scene.toml", error)
                                     : !journals_like(journal_, directory()).empty();
  if (begun)
    identity_ = require_identity(directory(), identity_, "use another directory, or --force to begin anew",
                                 !arguments_.join);  // whose workers keep what others have found
  if (!identity_.empty()) write_file_atomically(directory() / "scene.toml", identity_);
  if (shard()) output_.lock().share();
}

// A first result is on the disk, or others are at work.
void StudySession::make_room() {
  if (!std::exchange(in_the_way_, false)) return;
  if (shard()) return begin_anew();
  std::optional<PendingFile> scene;
  if (!identity_.empty()) {
    scene.emplace(directory() / "scene.toml").write(identity_);
    scene->complete();
  }
  begin_anew();
  if (scene) {
    output_.require_scene(identity_, true);
    scene->commit();
  }
  if (!grows_.empty()) grows(grows_);
}

std::function<void()> StudySession::room_for_first() {
  if (!in_the_way_) return nullptr;
  return [this] { make_room(); };
}

void StudySession::grows(const fs::path& file) {
  grows_ = file;
  if (in_the_way_) return;
  const bool force_helps = arguments_.study.merge.empty() && !arguments_.force;
  require_as_written(
      directory(), {file},
      force_helps ? "use --force to begin anew, which keeps it as " + journal_ + ".kept-1" : out_of_the_way);
  output_.written().will_grow(file.lexically_relative(directory()).generic_string());
}

// Another study's results go, those of this one too; but a shard leaves alone what other shards of the same
// sweep have finished. What is called as a journal and is not ours is put aside.
void StudySession::begin_anew() {
  const TextFile scene = read_text_file((directory() / "scene.toml").string());
  if (const auto both = identity_of_both(scene.text, identity_); both && shard() && scene.error.empty()) {
    identity_ = *both;
    output_.written().remove(journal_);
    std::error_code error;
    if (fs::exists(journal(), error)) output_.written().keep_aside(journal_);
    return;
  }
  output_.written().remove_all();
  for (const auto& path : journals_like(journal_, directory()))
    output_.written().keep_aside(path.filename().string());
}

StudyHooks StudySession::hooks() {
  StudyHooks hooks;
  hooks.progress = [this](double fraction) { progress_.show(fraction); };
  hooks.cancelled = interrupted;
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  hooks.threads = arguments_.threads > 0 ? arguments_.threads : std::max(1, cores);
  return hooks;
}

void StudySession::require_asked(Journal& nowhere,
                                 const std::function<bool(const Journal::Row&)>& asked) const {
  if (in_the_way_) return;
  nowhere.take_in(journal());
  nowhere.require_asked(asked, directory(), "ask for them, too, or use another -o, or --force to begin anew");
}

void StudySession::write(const std::string& name, const std::string& text) {
  if (in_the_way_) throw_if_interrupted();  // a study that was ended before its first result has none
  PendingFile file(directory() / name);
  file.write(text);
  file.complete();
  make_room();
  if (name == journal_ && text == found_) keeps_pictures_ = true;
  drop_pictures();
  file.commit();
}

// Those of an earlier command, and its reports, are of other results than are there now. Beside shares of a
// sweep they are of what was merged.
void StudySession::drop_pictures() {
  if (std::exchange(keeps_pictures_, true) || shard()) return;
  output_.written().remove_all([](const std::string& name) {
    return !name.starts_with("figures/") && !name.ends_with(".md") && !name.ends_with(".html");
  });
}

std::string StudySession::write(const Figure& figure) {
  if (in_the_way_) throw_if_interrupted();
  make_room();
  drop_pictures();
  const std::string stem = "figures/" + figure.name;
  std::error_code error;
  fs::create_directories(directory() / "figures", error);
  if (error) throw FileError(directory() / "figures", error.value());
  for (const char* extension : {".svg", ".pdf", ".png"}) {
    throw_if_interrupted();  // the points are kept, and figures are made of them again
    writer_.write(figure, directory() / (stem + extension));
  }
  write_figure_data(figure, directory() / (stem + ".png"));
  return stem + ".png";
}

namespace {

using Json = nlohmann::ordered_json;

// Numbers as numbers, what is none of those that JSON knows as null.
Json cell_json(const std::string& cell) {
  if (cell.empty()) return nullptr;
  if (!is_number(cell)) return cell;
  const double number = number_of(cell);
  if (cell.find_first_of(".ein") == std::string::npos && std::abs(number) < 1e15)
    return static_cast<std::int64_t>(number);
  return number;
}

}  // namespace

void print_rows(const Arguments& arguments, bool complete, const Table& table) {
  if (!arguments.json) return;
  Json rows = Json::array();
  for (const auto& row : table.rows) {
    Json entry = Json::object();
    for (std::size_t i = 0; i < row.size(); ++i) entry[table.columns[i]] = cell_json(row[i]);
    rows.push_back(std::move(entry));
  }
  std::cout << Json{{"complete", complete}, {"rows", std::move(rows)}}.dump(2) << "\n";
}

int finish(bool complete, const Arguments& arguments, const std::string& sentence) {
  if (!arguments.quiet && !sentence.empty()) std::cerr << sentence << "\n";
  if (complete) return exit_ok;
  std::cerr << "unfurl: interrupted; finished points are kept, the same command "
            << (arguments.force ? "without --force " : "") << "does the rest\n";
  return exit_interrupted;
}

}  // namespace unfurl
