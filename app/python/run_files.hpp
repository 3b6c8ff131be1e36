// SPDX-License-Identifier: BSD-3-Clause
// What a run of the Python module writes; knows nothing of Python.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/output/receipt.hpp"
#include "core/diagnostics/diagnostics.hpp"
#include "core/scene/scene.hpp"
#include "core/simulate/simulation.hpp"

namespace unfurl {

struct JudgedRun {
  Scene scene;
  Simulation simulation;
  Diagnostics diagnostics;
  std::string made_by = "run()";  // the call of the scene that gave it
};

// While it lives, what is written gets the receipt of this run; `call`: of it, that writes. One at a time.
class RunReceipt {
 public:
  RunReceipt(const JudgedRun& run, const std::string& call, const std::string& output);

 private:
  ReceiptWriter writer_;
};

// Called between pieces of work, which ends with what it throws.
using Between = std::function<void()>;

// All throw what derives from Error where a person can mend it.
std::string summary_of(const JudgedRun& run);
// Returns what the format could not show.
std::vector<std::string> write_export(const JudgedRun& run, const std::string& format,
                                      const std::string& directory, const Between& between);
void write_plot(const JudgedRun& run, const std::string& name, const std::string& file,
                const std::string& style, const Between& between);
// At a time within the run.
void write_still(const JudgedRun& run, double t, const std::string& file, const Between& between);
// .mp4, .webp or .gif, of the frames that `unfurl render` draws.
void write_film(const JudgedRun& run, const std::string& file, const Between& between);

}  // namespace unfurl
