// SPDX-License-Identifier: BSD-3-Clause
// What the workers of a --join do with the verbs' work.
#pragma once

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "app/command.hpp"
#include "app/output/interrupt.hpp"
#include "app/verbs/study_session.hpp"
#include "core/study/journal.hpp"
#include "core/study/reference.hpp"
#include "core/study/team.hpp"

namespace unfurl {

// This worker's place in the team of the directory; none without --join.
inline std::unique_ptr<Team> join_team(const Arguments& arguments, const std::filesystem::path& directory) {
  return arguments.join ? std::make_unique<Team>(directory / "join", arguments.lease) : nullptr;
}

// The same over the directory of a study, in which the worker's journal grows, or that of the only one.
inline std::unique_ptr<Team> join_team(const Arguments& arguments, StudySession& session) {
  auto team = join_team(arguments, session.directory());
  if (team) require_as_written(session.directory(), team->journals_of_others(), out_of_the_way);
  session.grows(team ? team->journal() : session.journal());
  return team;
}

// Asks `done()` until it says so (true), or until a person interrupts (false).
template <class Done>
bool wait_until(const Arguments& arguments, const Done& done) {
  using namespace std::chrono;
  while (!done()) {
    const auto until = steady_clock::now() + duration<double>(std::min(0.5, arguments.lease / 4));
    while (!interrupted() && steady_clock::now() < until) std::this_thread::sleep_for(milliseconds(20));
    if (interrupted()) return false;
  }
  return true;
}

// `done()` works off what no other worker is at and says whether all is there; it is asked until it is. True
// for the one worker that is to write the results, and say so by results_written(); the others wait until it
// has, or are that one when it has died. False, too, where a person interrupts.
template <class Done>
bool work_together(Team& team, const Arguments& arguments, const Done& done) {
  if (!wait_until(arguments, done)) return false;
  team.done();
  if (team.takes("results")) return true;
  if (!arguments.quiet) std::cerr << "all is computed; another worker writes the results\n";
  bool writes = false;
  wait_until(arguments, [&] { return team.finished("results") || (writes = team.takes("results")); });
  return writes;
}

inline void results_written(Team* team) {
  if (team) team->finish("results");
}

inline void warn_of_damage(const Journal& journal) {
  for (const std::string& text : journal.damage())
    std::cerr << "unfurl: warning: " << text << " and was not taken: what it stood for is computed anew\n";
}

// What is there when all is computed, and whether this worker is to write it.
template <class Result>
struct Worked {
  Result result;
  bool writes = true;
};

// What `run(journal, hooks)` finds over this process's journal, or with a team over its own and those of the
// others, until `whole(result)`; another worker than the one that writes has it when it is written. None: a
// person interrupted the wait.
template <class Run, class Whole>
auto alone_or_joined(Team* team, const Arguments& arguments, Journal& journal, StudyHooks hooks,
                     const Run& run, const Whole& whole)
    -> std::optional<Worked<decltype(run(journal, hooks))>> {
  using Result = decltype(run(journal, hooks));
  if (team) {
    StudyHooks shared = hooks;
    shared.team = team;
    std::optional<Result> all;
    const bool writes = work_together(*team, arguments, [&] {
      journal.take_in(team->journals_of_others());
      return whole(all.emplace(run(journal, shared)));
    });
    warn_of_damage(journal);
    if (!writes && interrupted()) return std::nullopt;
    if (!writes) return Worked<Result>{*std::move(all), false};
  } else {
    warn_of_damage(journal);
  }
  return Worked<Result>{run(journal, hooks)};
}

// The exit code where a person interrupted the wait for others.
inline int nothing_to_write(const Arguments& arguments) {
  return finish(false, arguments, "");
}

}  // namespace unfurl
