// SPDX-License-Identifier: BSD-3-Clause
// A sweep on many machines: which share a job computes, and the job's script.
#pragma once

#include <string>
#include <vector>

#include "app/command.hpp"

namespace unfurl {

// "2/8" as it is. "auto": the share of this task of a job array or of a parallel job, from the variables that
// Slurm (array or srun), Open MPI, PMI and Grid Engine set; "auto/8" where the engine does not say how many
// there are (PBS). Throws UsageError where there are none.
std::string shard_of(const std::string& text);

// What --script NAME prints: a job whose tasks share the sweep of this command line, how it is gone on with
// after a kill, how its points are merged. Throws UsageError on a name that there is none of.
std::string job_script(const Arguments& arguments);

// A line per shard of `count` that lacks points, as the command that computes it.
std::string missing_shards(const Arguments& arguments, const std::vector<int>& shards, int count);

}  // namespace unfurl
