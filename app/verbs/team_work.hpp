// SPDX-License-Identifier: BSD-3-Clause
// What the workers of a --join do with the verbs' work.
#pragma once

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <thread>

#include "app/command.hpp"
#include "app/output/interrupt.hpp"
#include "core/study/journal.hpp"
#include "core/study/reference.hpp"
#include "core/study/team.hpp"

namespace unfurl {

// This worker's place in the team of the directory; none without --join.
inline std::unique_ptr<Team> join_team(const Arguments& arguments, const std::filesystem::path& directory) {
  return arguments.join ? std::make_unique<Team>(directory / "join", arguments.lease) : nullptr;
}

// `done()` works off what no other worker is at and says whether all is there; it is asked until it is, or
// until a person interrupts (false). True for the one worker that is to write the results.
template <class Done>
bool work_together(Team& team, const Arguments& arguments, const Done& done) {
  using namespace std::chrono;
  while (!done()) {
    const auto until = steady_clock::now() + duration<double>(std::min(0.5, arguments.lease / 4));
    while (!interrupted() && steady_clock::now() < until) std::this_thread::sleep_for(milliseconds(20));
    if (interrupted()) return false;
  }
  team.done();
  if (team.takes("results")) return true;
  if (!arguments.quiet) std::cerr << "all is computed; another worker writes the results\n";
  return false;
}

// Fills the journal of a worker with its share and takes in those of the others; `whole` runs the study over
// the journal and says whether nothing is missing.
template <class Whole>
bool study_together(Team& team, const Arguments& arguments, Journal& journal, StudyHooks hooks,
                    const Whole& whole) {
  hooks.team = &team;
  return work_together(team, arguments, [&] {
    for (const auto& path : team.journals_of_others()) journal.take_in(path);
    return whole(journal, hooks);
  });
}

}  // namespace unfurl
