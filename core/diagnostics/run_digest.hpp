// SPDX-License-Identifier: BSD-3-Clause
// What a summary asks of a run whose states are not kept.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/diagnostics/accuracy.hpp"
#include "core/diagnostics/diagnostics.hpp"
#include "core/diagnostics/force_uniqueness.hpp"
#include "core/simulate/parts.hpp"
#include "core/text/archive.hpp"

namespace unfurl {

// Some states of a run with their rows, as if they were all of it: its first state, those at which a column
// or a rod's force is largest or smallest, those around what was found beyond that within a step
// (Diagnostics::found), the last ones.
struct Digest {
  Simulation run;
  Diagnostics diagnostics;
};

// Takes a run window by window.
class RunDigest {
 public:
  RunDigest(std::shared_ptr<const Model> model, const SolverOptions& options);

  // The rows of a window, counted from the start of the run. Its states [first, last) are added to the
  // digest; singular poses become events of the window and are told once by events(). Once `cancelled` says
  // so, for good, states are left open (Diagnostics::left_open), as they are where LooksUntil ends a look
  // within steps.
  Diagnostics add(Simulation& window, std::size_t first, std::size_t last,
                  const std::function<bool()>& cancelled = {});
  // Something was left open: what is settled then is for whole(), and not to go on from.
  bool cut() const { return kept_.diagnostics.left_open + all_.diagnostics.left_open > 0; }
  // Of the states [first, last) of the last window, the beginning that can be trusted (judge()); where that
  // is not all, what comes after it may still make up for it.
  std::size_t trusted() const { return trusted_; }
  bool all_trusted() const { return doubt_.empty(); }

  // All of the run, with the window that was added last, which must live as long: what can be trusted of it,
  // failed where that is not all.
  Digest whole(const Simulation& last_window) const;

  // Behind add(), while the window lives, of every window but the last.
  void settle();
  void archive(Archive& archive);  // of what was settled

 private:
  Digest with_rows(const Digest& before, const Simulation& window, const Diagnostics& d, std::size_t first,
                   std::size_t last) const;
  bool look_at_seam(const Simulation& window, const Diagnostics& d, std::size_t first, std::size_t end);
  Digest thinned(const Digest& all) const;
  bool looked(const std::function<bool()>& look);
  bool worth_a_look(const Digest& all, const Series& column, double sign) const;
  void count_on(Diagnostics& d, std::size_t first);
  void add_events(const Simulation& window, double until);
  void note_rise(const Digest& rows);
  void archive_digest(Archive& archive, Digest& digest) const;
  Digest empty() const;

  std::shared_ptr<const Model> model_;
  SolverOptions options_;
  Digest kept_, good_;  // of all before the last window; of what can be trusted, where that is less
  Digest all_;          // with the last window
  std::string doubt_;   // why not all of it can be trusted
  std::size_t trusted_ = 0;
  std::vector<double> ends_;  // of every column, at the last state
  KnownUniqueness known_;     // of the present model's forces
  std::vector<Event> singular_;
  std::vector<Rise>
      rises_;  // of windows before the last, and of what can be trusted: each the largest so far
};

}  // namespace unfurl
