// SPDX-License-Identifier: BSD-3-Clause
// What a run of the Python module writes; knows nothing of Python.
#pragma once

#include <functional>
#include <string>

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

// All throw what derives from Error where a person can mend it.
std::string summary_of(const JudgedRun& run);
void write_export(const JudgedRun& run, const std::string& format, const std::string& directory);
void write_plot(const JudgedRun& run, const std::string& name, const std::string& file,
                const std::string& style);
// At a time within the run.
void write_still(const JudgedRun& run, double t, const std::string& file);
// .mp4, .webp or .gif, of the frames that `unfurl render` draws. Throws Cancelled.
void write_film(const JudgedRun& run, const std::string& file, const std::function<bool()>& cancelled);

}  // namespace unfurl
