// SPDX-License-Identifier: BSD-3-Clause
#include "app/verbs/cluster.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "app/output/command_line.hpp"
#include "core/text/nearest_name.hpp"

namespace unfurl {

namespace {

std::optional<long> number_in(const char* variable) {
  const char* text = variable == nullptr ? nullptr : std::getenv(variable);
  if (text == nullptr || *text == '\0') return std::nullopt;
  char* end = nullptr;
  const long x = std::strtol(text, &end, 10);
  return *end == '\0' ? std::optional(x) : std::nullopt;  // Grid Engine says "undefined" outside of an array
}

// Tasks are numbered from `first` by `step`, `count` of them or up to `last`.
struct Engine {
  const char* task;
  const char* first;  // nullptr: from 0
  const char* step;   // nullptr: by 1
  const char* count;
  const char* last;
};
constexpr Engine engines[] = {
    {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_STEP", "SLURM_ARRAY_TASK_COUNT",
     nullptr},
    {"SGE_TASK_ID", "SGE_TASK_FIRST", "SGE_TASK_STEPSIZE", nullptr, "SGE_TASK_LAST"},
    {"OMPI_COMM_WORLD_RANK", nullptr, nullptr, "OMPI_COMM_WORLD_SIZE", nullptr},
    {"PMI_RANK", nullptr, nullptr, "PMI_SIZE", nullptr},
    {"SLURM_PROCID", nullptr, nullptr, "SLURM_NTASKS", nullptr},
};

// Without --script, --jobs and what names a share.
std::vector<std::string> whole_sweep(const Arguments& arguments) {
  std::vector<std::string> words = arguments.words;
  for (const char* option : {"--script", "--jobs", "--shard", "--merge", "--threads"})
    words = without_option(words, option);
  // Tasks that begin again keep what is finished, and what --merge puts together stays.
  std::erase_if(words, [](const std::string& word) { return word == "--quiet" || word == "--force"; });
  return words;
}

std::string with(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return as_typed(words);
}

// In lines that begin as a comment does, wherever its lines end.
std::string commented(const std::string& text) {
  std::string out = "# ";
  for (const char c : text) out += c == '\n' ? std::string("\n# ") : std::string(1, c);
  return out;
}

std::string slurm(const Arguments& a) {
  const std::string jobs = std::to_string(a.study.jobs);
  return "#!/bin/sh\n"
         "# sbatch this file; after a kill, sbatch it again: points that are finished stay.\n" +
         commented("When all tasks are done: " + with(whole_sweep(a), {"--merge", a.output})) +
         "\n#SBATCH --job-name=unfurl\n#SBATCH --array=1-" + jobs +
         "\n#SBATCH --cpus-per-task=1\n#SBATCH --requeue\n"
         "exec " +
         with(whole_sweep(a), {"--shard", "auto/" + jobs, "--threads", "1", "--quiet"}) + "\n";
}

std::string parallel(const Arguments& a) {
  const std::string jobs = std::to_string(a.study.jobs);
  return "#!/bin/sh\n# GNU parallel: one task a core; run it again after a kill, finished points stay.\nset "
         "-e\n"
         "seq " +
         jobs + " | parallel -q --halt soon,fail=1 " + with(whole_sweep(a), {"--threads", "1", "--quiet"}) +
         " --shard {}/" + jobs + "\n" + with(whole_sweep(a), {"--merge", a.output}) + "\n";
}

std::string snakemake(const Arguments& a) {
  const std::string jobs = std::to_string(a.study.jobs);
  const auto python = [](const std::string& text) {
    std::string out = "\"";
    for (const char c : text)
      out += c == '"' || c == '\\' ? std::string("\\") + c
             : c == '{'            ? "{{"
             : c == '}'            ? "}}"
             : c == '\n'           ? "\\n"
                                   : std::string(1, c);
    return out;
  };
  return "# snakemake -c CORES -s THIS_FILE; tasks leave marks beside the directory, points stay in it.\n"
         "rule merged:\n    input: expand(" +
         python(a.output + ".shard_") + "{i}_done\", i=range(1, " + std::to_string(a.study.jobs + 1) +
         "))\n    shell: " + python(with(whole_sweep(a), {"--merge", a.output})) +
         "\"\n\n"
         "rule shard:\n    output: touch(" +
         python(a.output + ".shard_") + "{i}_done\")\n    shell: " +
         python(with(whole_sweep(a), {"--threads", "1", "--quiet"}) + " --shard ") + "{wildcards.i}/" + jobs +
         "\"\n";
}

struct ScriptKind {
  std::string_view name;
  std::string (*text)(const Arguments&);
};
constexpr ScriptKind script_kinds[] = {{"slurm", slurm}, {"parallel", parallel}, {"snakemake", snakemake}};

}  // namespace

std::string shard_of(const std::string& text) {
  if (!text.starts_with("auto")) return text;
  const std::string told = text.size() > 5 && text[4] == '/' ? text.substr(5) : "";
  if (text.size() > 4 && told.empty())
    throw UsageError("a shard is I/N, auto, or auto/N; got " + in_quotes(text));
  for (const Engine& engine : engines) {
    const auto task = number_in(engine.task);
    if (!task) continue;
    const long first = number_in(engine.first).value_or(engine.first ? 1 : 0),
               step = number_in(engine.step).value_or(1);
    const auto count = number_in(engine.count), last = number_in(engine.last);
    const long index = (*task - first) / std::max(step, 1L) + 1;
    const long tasks = count ? *count : last ? (*last - first) / std::max(step, 1L) + 1 : index;
    // Of an array of other tasks than the shares, some were submitted again: each has the share of its
    // number.
    const bool some = engine.first && !told.empty() && std::to_string(tasks) != told;
    if (!told.empty()) return std::to_string(some ? *task : index) + "/" + told;
    if (count) return std::to_string(index) + "/" + std::to_string(*count);
    if (last) return std::to_string(index) + "/" + std::to_string((*last - first) / std::max(step, 1L) + 1);
  }
  for (const char* variable : {"PBS_ARRAY_INDEX", "PBS_ARRAYID"})
    if (const auto task = number_in(variable)) {
      if (told.empty())
        throw UsageError("--shard auto: PBS does not say how many tasks there are; --shard auto/N does");
      return std::to_string(*task) + "/" + told;
    }
  throw UsageError(
      "--shard auto: no job array is around (Slurm, Grid Engine, PBS, Open MPI, PMI); say --shard I/N");
}

std::string job_script(const Arguments& arguments) {
  std::vector<std::string_view> names;
  for (const ScriptKind& kind : script_kinds) {
    if (kind.name == arguments.study.script) return kind.text(arguments);
    names.push_back(kind.name);
  }
  throw UsageError("no script for " + in_quotes(arguments.study.script) +
                   did_you_mean(arguments.study.script, names));
}

std::string missing_shards(const Arguments& arguments, const std::vector<int>& shards, int count) {
  std::string text;
  for (const int shard : shards)
    text += "\n  " +
            with(whole_sweep(arguments), {"--shard", std::to_string(shard) + "/" + std::to_string(count)});
  return text;
}

}  // namespace unfurl
