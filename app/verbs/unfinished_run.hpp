// SPDX-License-Identifier: BSD-3-Clause
// A long run on disk while it goes on: its tables and a checkpoint from which it can go on after a kill.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/output/written_files.hpp"
#include "app/verbs/scene_run.hpp"
#include "core/diagnostics/run_digest.hpp"
#include "core/export/atomic_file.hpp"
#include "core/export/run_tables.hpp"
#include "core/scene/scene.hpp"
#include "render/image/task_queue.hpp"

namespace unfurl {

// DIR/unfinished/ holds the tables so far and the file `checkpoint`: what the rest of the run depends on, to
// the bit, with a fingerprint of scene, settings and program. It is made behind the first part of a run; a
// run of one part leaves no trace of it.
class UnfinishedRun {
 public:
  // seconds: between two checkpoints; beside: what stays when the tables get their places.
  UnfinishedRun(WrittenFiles& written, const Scene& scene, std::shared_ptr<const Model> model, double seconds,
                Beside beside);

  // Throws FileError where one does that `who` ("a film") cannot go on with.
  static void refuse_in(const std::filesystem::path& directory, const std::string& who);
  // Reads the checkpoint, if there is one. Throws FileError where it is of another run or damaged.
  bool find();
  Archive& stepper() { return *archived_; }  // that was found
  double begins_at() const { return t_; }    // [s] of motion

  bool any() const { return tables_ != nullptr; }  // a part was taken or found
  // The part's diagnosis, rows and checkpoint are made `beside` what comes next; one part at a time.
  void take(Stepper::Window window, Stepper& stepper, TaskQueue& beside);
  // All of the run; `rest`: what no part had. Where an interrupt stopped it, or left states that were not
  // judged, it can still go on from the last part that was.
  Digest finish(Simulation& rest, std::size_t first);
  bool goes_on() const { return !copies_.empty(); }
  // After that: the tables get their places and, of a run that is done, the checkpoint goes. What is killed
  // between the two goes on all the same.
  void take_places();
  void forget();  // what was found

 private:
  std::filesystem::path folder() const { return written_.directory() / "unfinished"; }
  void keep_foreign_aside();
  void take_back(const RunTables::Sizes& sizes) const;
  void begin();
  void add(Simulation& window, std::size_t first, std::size_t last);
  struct Part {
    Stepper::Window window;
    double t;             // of the stepper behind it
    std::string stepper;  // archived
  };
  void take(Part& part);
  void keep();  // as the last part that was judged left it
  void copy_tables();
  Digest whole(Simulation& rest) const;

  WrittenFiles& written_;
  const Scene& scene_;
  RunDigest digest_;
  double seconds_, t_ = 0;
  double cpu_s_ = 0;  // of earlier processes
  Beside beside_;
  std::unique_ptr<RunTables> tables_;
  RunTables::Sizes good_;  // of what can be trusted
  std::optional<Archive> archived_;
  std::string head_;
  std::string last_;                                  // checkpoint behind the last part
  std::vector<std::unique_ptr<PendingFile>> copies_;  // of the tables of a run that was interrupted
  std::chrono::steady_clock::time_point written_at_ = std::chrono::steady_clock::now();
};

}  // namespace unfurl
