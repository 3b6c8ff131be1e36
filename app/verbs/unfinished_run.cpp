// SPDX-License-Identifier: BSD-3-Clause
#include "app/verbs/unfinished_run.hpp"

#include <array>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include "app/output/checkpoint_head.hpp"
#include "core/diagnostics/peaks.hpp"
#include "core/export/atomic_file.hpp"
#include "core/export/checksum.hpp"

namespace unfurl {

namespace {

namespace fs = std::filesystem;

const std::string tables[] = {"series.csv", "trajectory.csv", "rod_forces.csv"};

std::string sum_of(const std::string& bytes) {
  Checksum sum;
  sum.add(bytes);
  return sum.text();
}

}  // namespace

UnfinishedRun::UnfinishedRun(WrittenFiles& written, const Scene& scene, std::shared_ptr<const Model> model,
                             double seconds, Beside beside)
    : written_(written),
      scene_(scene),
      digest_(std::move(model), scene.solver),
      seconds_(seconds),
      beside_(beside) {}

void UnfinishedRun::refuse_in(const fs::path& directory, const std::string& who) {
  if (holds_checkpoint(directory))
    throw FileError(directory / "unfinished", "holds an unfinished run, which " + who +
                                                  " cannot go on with; use --force to begin anew, or "
                                                  "another -o");
}

bool UnfinishedRun::find() {
  if (holds_checkpoint(written_.directory())) keep_foreign_aside();
  if (!holds_checkpoint(written_.directory())) return false;
  const fs::path path = folder() / "checkpoint";
  std::ifstream in(path, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  if (!in) throw FileError(path, "cannot be read");
  const std::string first = checkpoint_head(scene_);
  if (!text.starts_with(checkpoint_magic) || text.size() < first.size() + 17)
    throw FileError(path, "is no checkpoint of a run; --force begins anew");
  if (!text.starts_with(first))
    throw FileError(folder(),
                    "holds an unfinished run of another scene, of other settings or by another version of "
                    "unfurl; use --force to begin anew, or another -o");
  const std::string sum = text.substr(first.size(), 16), bytes = text.substr(first.size() + 17);
  if (sum_of(bytes) != sum) throw FileError(path, "is damaged; --force begins anew");
  Archive archive(bytes);
  RunTables::Sizes sizes;
  std::string stepper;
  archive(t_);
  archive(cpu_s_);
  archive(sizes);
  archive(good_);
  digest_.archive(archive);
  archive(stepper);
  take_back(sizes);
  begin();
  tables_->cut(sizes);
  archived_.emplace(std::move(stepper));
  return true;
}

// What a person has under these names, or leads elsewhere, is neither cut nor written through.
void UnfinishedRun::keep_foreign_aside() {
  std::error_code error;
  const auto there = [&](const fs::path& path) { return fs::exists(fs::symlink_status(path, error)); };
  bool foreign = there(folder()) && !fs::is_directory(fs::symlink_status(folder(), error));
  for (const std::string& name : {tables[0], tables[1], tables[2], std::string("checkpoint")})
    foreign = foreign || (there(folder() / name) && !written_.ours("unfinished/" + name));
  if (foreign) written_.keep_aside("unfinished");
}

// A run that was killed while its tables took their places left some of them there; where an earlier run's
// summary still stands beside them they are that run's.
void UnfinishedRun::take_back(const RunTables::Sizes& sizes) const {
  const std::uint64_t size[] = {sizes.series, sizes.trajectory, sizes.rod_forces};
  std::error_code error;
  const bool taken = beside_ == Beside::nothing && fs::exists(written_.directory() / "summary.json", error);
  for (std::size_t k = 0; k < std::size(tables); ++k) {
    const fs::path path = folder() / tables[k], place = written_.directory() / tables[k];
    if (!taken && !fs::exists(path, error) && fs::exists(place, error)) fs::rename(place, path, error);
    const auto bytes = fs::file_size(path, error);
    if (error || bytes < size[k])
      throw FileError(path, "is shorter than the checkpoint beside it says; --force begins anew");
  }
}

void UnfinishedRun::begin() {
  keep_foreign_aside();
  std::error_code error;
  fs::create_directory(folder(), error);
  if (error) throw FileError(folder(), error.value());
  for (const std::string& name : tables) written_.grows("unfinished/" + name);
  written_.grows("unfinished/checkpoint");
  tables_ = std::make_unique<RunTables>(folder());
}

void UnfinishedRun::forget() {
  for (const std::string& name : tables) written_.remove("unfinished/" + name);
  written_.remove("unfinished/checkpoint");
  std::error_code error;
  if (!fs::is_symlink(fs::symlink_status(folder(), error))) {
    for (const auto& entry : fs::directory_iterator(folder(), error))  // a run was killed in a checkpoint
      if (is_unfinished_name(entry.path().filename().string())) remove_abandoned(entry.path());
    fs::remove(folder(), error);
  }
  written_.forget_missing();
}

void UnfinishedRun::add(Simulation& window, std::size_t first, std::size_t last) {
  const Diagnostics d = digest_.add(window, first, last, waited_enough);
  const std::size_t good = first + digest_.trusted();
  tables_->add(window.trajectory, d, first, good);
  if (digest_.all_trusted() || digest_.trusted() > 0) good_ = tables_->sizes();
  tables_->add(window.trajectory, d, good, last);
}

void UnfinishedRun::take(Stepper::Window window, Stepper& stepper, TaskQueue& beside) {
  beside.finish();
  if (!any()) {
    begin();
    tables_->cut({});
  }
  Archive rest;
  stepper.archive(rest);
  const auto part = std::make_shared<Part>(Part{std::move(window), stepper.time(), rest.bytes()});
  beside.add([this, part] { take(*part); });
}

void UnfinishedRun::take(Part& part) {
  Simulation& run = part.window.run;
  const LooksUntil end(waited_enough);
  add(run, part.window.first, part.window.last);
  digest_.settle();
  if (digest_.cut()) return;
  t_ = part.t;
  RunTables::Sizes sizes = tables_->sizes();
  Archive archive;
  double cpu = cpu_s_ + run.cpu_s;
  archive(t_);
  archive(cpu);
  archive(sizes);
  archive(good_);
  digest_.archive(archive);
  archive(part.stepper);
  last_ = archive.bytes();
  const auto now = std::chrono::steady_clock::now();
  if (now - written_at_ < std::chrono::duration<double>(seconds_)) return;
  written_at_ = now;
  keep();
}

void UnfinishedRun::keep() {
  if (last_.empty()) return;
  tables_->flush_to_disk();
  if (head_.empty()) head_ = checkpoint_head(scene_);
  FileWatcher* const watcher = watch_files(nullptr);  // listed by its name, not by its bytes
  write_file_atomically(folder() / "checkpoint", head_ + sum_of(last_) + "\n" + last_);
  watch_files(watcher);
}

Digest UnfinishedRun::whole(Simulation& rest) const {
  Digest all = digest_.whole(rest);
  all.run.cpu_s = rest.cpu_s + cpu_s_;
  return all;
}

Digest UnfinishedRun::finish(Simulation& rest, std::size_t first) {
  const bool stopped = rest.status == RunStatus::stopped;
  if (stopped) keep();
  {
    const LooksUntil end(waited_enough);
    add(rest, first, rest.trajectory.size());
  }
  if (stopped || digest_.cut()) {
    if (!stopped) keep();
    copy_tables();
    return whole(rest);
  }
  if (!digest_.all_trusted()) tables_->cut(good_);
  tables_->flush_to_disk();
  tables_.reset();
  return whole(rest);
}

// The tables themselves grow beyond what the checkpoint knows of them: they are cut when it is found.
void UnfinishedRun::copy_tables() {
  const RunTables::Sizes sizes = digest_.all_trusted() ? tables_->sizes() : good_;
  tables_->flush_to_disk();
  const std::uint64_t size[] = {sizes.series, sizes.trajectory, sizes.rod_forces};
  for (std::size_t k = 0; k < std::size(tables); ++k) {
    PendingFile& copy =
        *copies_.emplace_back(std::make_unique<PendingFile>(written_.directory() / tables[k]));
    std::error_code error;
    fs::copy_file(folder() / tables[k], copy.name(), fs::copy_options::overwrite_existing, error);
    if (!error) fs::resize_file(copy.name(), size[k], error);
    if (error) throw FileError(copy.target(), error.value());
    copy.complete();
  }
}

void UnfinishedRun::take_places() {
  make_room(written_, beside_, Unfinished::stays);
  if (goes_on()) return commit_together(std::array{copies_[0].get(), copies_[1].get(), copies_[2].get()});
  // Tables without a summary are those of a run that goes on (take_back()).
  move_into_place(folder(), tables, written_.directory(), [&] { written_.remove("summary.json"); });
  written_.remove("unfinished/checkpoint");
}

}  // namespace unfurl
