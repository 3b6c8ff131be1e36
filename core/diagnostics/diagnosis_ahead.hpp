// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>

#include "core/diagnostics/diagnostics.hpp"

namespace unfurl {

// The diagnosis of a run while it goes on: what diagnose() has of its first states, which it then takes over.
class DiagnosisAhead {
 public:
  // All of it is kept and grows; `known` has forces and flow of every state that the run has by the time.
  // `run` is what the whole run has become by the time of diagnose().
  DiagnosisAhead(const Simulation& run, const KnownAhead& known);
  DiagnosisAhead(const DiagnosisAhead&) = delete;
  DiagnosisAhead& operator=(const DiagnosisAhead&) = delete;

  // States of which those that follow do not change what is said, until it is `enough`, which is asked before
  // each; nothing where what is unique comes first.
  void judge(const std::function<bool()>& enough = {});

 private:
  friend Diagnostics diagnose(const Simulation&, const std::function<bool()>&, const KnownAhead&);
  std::shared_ptr<void> table_;  // of states, as diagnose() knows it
};

}  // namespace unfurl
