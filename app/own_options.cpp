// SPDX-License-Identifier: BSD-3-Clause
#include "app/own_options.hpp"

#include <algorithm>

namespace unfurl {

namespace {

// A field of Arguments, or of one of its parts.
template <auto... members>
auto& at(Arguments& arguments) {
  return (arguments.*....*members);
}

constexpr OwnOption rows[] = {
    {"-o", "PATH", "where results go", at<&Arguments::output>},
    {"--set", "KEY=VALUE",
     "change a key of the scene (unfurl list keys); the value is TOML, a bare word is a string (repeatable)",
     at<&Arguments::overrides>},
    {"--all", "", "every key with its value and unit, also those that the file leaves out",
     at<&Arguments::all>},
    {"--tolerance", "METRES", "pick stages and step for this error of node positions (solver.tolerance)",
     ShortKey{"solver.tolerance"}},
    {"--steps", "LARGEST:SMALLEST",
     "the ladder of steps [s], rounded to fit the motion: halved again and again, between the larger ones "
     "two "
     "thirds, too",
     at<&Arguments::study, &StudyArguments::ladder>},
    {"--repeats", "N", "timed runs per point, at most (5)", at<&Arguments::study, &StudyArguments::repeats>,
     1, 1000},
    {"--methods", "NAME,...", "only these methods (unfurl list methods)",
     at<&Arguments::study, &StudyArguments::methods>},
    {"--extreme", "NAME", "only this one: mass_ratio, force, fold_angle, units, stiffness (repeatable)",
     at<&Arguments::study, &StudyArguments::extremes>},
    {"--vary", "KEY=FROM:TO:COUNT",
     "a key of the scene and its values (repeatable); also FROM:TO:COUNT:log or A,B,C",
     at<&Arguments::study, &StudyArguments::vary>},
    {"--measure", "NAME,...", "what to measure of every run (unfurl list measures)",
     at<&Arguments::study, &StudyArguments::measure>},
    {"--shard", "I/N",
     "the I-th of N equal shares of the points; auto: of this task of a job array (Slurm, Grid Engine, MPI), "
     "auto/N where the engine does not say how many",
     at<&Arguments::study, &StudyArguments::shard>},
    {"--join", "", "work with all others that are given the same command and directory, on any machine",
     at<&Arguments::join>},
    {"--lease", "SECONDS", "with --join: who is silent for so long is taken for dead (60)",
     at<&Arguments::lease>, 0.1, 86400},
    {"--script", "NAME",
     "print a job for slurm, parallel or snakemake whose tasks share the sweep, instead of computing",
     at<&Arguments::study, &StudyArguments::script>},
    {"--jobs", "N", "tasks of --script (16)", at<&Arguments::study, &StudyArguments::jobs>, 1, 100000},
    {"--merge", "DIR", "take the points of this directory instead of computing (repeatable)",
     at<&Arguments::study, &StudyArguments::merge>},
    {"--find", "KEY", "the key of the scene that is solved for",
     at<&Arguments::study, &StudyArguments::find>},
    {"--target", "NAME=VALUE", "the measure (unfurl list measures) and what it shall be",
     at<&Arguments::study, &StudyArguments::target>},
    {"--between", "LOW:HIGH", "look for the key between these (default: around its value in the scene)",
     at<&Arguments::study, &StudyArguments::between>},
    {"--factor", "NAME=VALUE", "multiply a source of force, an uncertainty factor (repeatable)",
     at<&Arguments::study, &StudyArguments::factors>},
    {"--stuck", "", "jam every hinge in turn: the friction torque that stalls the motion, and where",
     at<&Arguments::study, &StudyArguments::stuck>},
    {"--picture", "FILE.png", "no window: the panel as it opens, as large as --size says",
     at<&Arguments::view, &ViewArguments::picture>},
    {"--record", "FILE", "write what is done in the window, frame by frame, and what came of it",
     at<&Arguments::view, &ViewArguments::record>},
    {"--replay", "FILE",
     "no window: play what --record wrote, and compare states and pictures; exit 7: not the same",
     at<&Arguments::view, &ViewArguments::replay>},
    {"--at", "SECONDS",
     "of the motion: the pose; modes and render --mode take start, end and deployed too (start)",
     at<&Arguments::at>},
    {"--dark", "", "light text on a dark ground", at<&Arguments::view, &ViewArguments::dark>},
    {"--bench", "", "no person: frames per second, where their time goes, and the price of idling",
     at<&Arguments::view, &ViewArguments::bench>},
    {"--frames", "A:B",
     "only the frames A to B - 1 of the film (A alone: that one), so that several machines can share one",
     at<&Arguments::frames>},
    {"--encode-only", "", "draw nothing: films of the frames that are there, whoever drew them",
     at<&Arguments::encode_only>},
    {"--plan", "", "write nothing: what would be written, how many frames, and about how long it would take",
     at<&Arguments::plan>},
    {"--mode", "K", "a film of mode K of `unfurl modes`, at the pose of --at, instead of the motion",
     at<&Arguments::mode>, 1, 100000},
    {"--poses", "N", "how many, 1 to 20 (5)", at<&Arguments::poses>, 1, 20},
    {"--export", "FORMAT,...", "also write vtk, gltf, csv, npy, mat, html (a comma list, repeatable)",
     at<&Arguments::exports>},
    {"--resume", "", "go on with the unfinished run in -o; an error where there is none",
     at<&Arguments::resume>},
    {"--checkpoint", "SECONDS",
     "a long run can go on after a kill from where it was so long before, at most (60)",
     at<&Arguments::checkpoint>, 0, 86400},
    {"--style", "NAME", "of figures: screen, single-column (89 mm), double-column (183 mm), slide",
     at<&Arguments::style>},
    {"--font", "NAME", "of figures: dejavu, or helvetica (Liberation Sans, as wide as Helvetica and Arial)",
     at<&Arguments::font>},
    {"--dpi", "N", "pixels per inch of figures as PNG, 20 to 2400", at<&Arguments::dpi>, 20, 2400},
    {"--ui-scale", "X", "size of the window's text and widgets, 0.5 to 4; else the monitor's",
     at<&Arguments::ui_scale>, 0.5, 4},
    {"--models", "", "compare models of the scene instead of methods",
     at<&Arguments::study, &StudyArguments::models>},
    {"--validation", "", "published benchmarks with digits instead of the paper: our error in each",
     at<&Arguments::study, &StudyArguments::validation>},
    {"--size", "WxH", "of pictures in pixels: short for --set render.size=[W, H]", ShortKey{"render.size"}},
    {"--fps", "N", "frames a second: short for --set render.fps=N", ShortKey{"render.fps"}},
    {"--look", "NAME", "of pictures (unfurl list looks): short for --set render.look=NAME",
     ShortKey{"render.look"}},
    {"--supersample", "N", "every pixel is the mean of N x N: short for --set render.supersample=N",
     ShortKey{"render.supersample"}},
    {"--transparent", "", "no background: short for --set render.transparent=true",
     ShortKey{"render.transparent"}},
    {"--fit", "", "pictures of the motion's shape, with as many pixels: short for --set render.fit=true",
     ShortKey{"render.fit"}},
    {"--force", "", "write into a directory that holds other files, start another film there over",
     at<&Arguments::force>},
    {"--gpu", "", "draw on the graphics processor (EGL): faster, pixels may differ between machines",
     at<&Arguments::gpu>},
    {"--threads", "N", "at most N threads", at<&Arguments::threads>, 1, 1024},
    {"--json", "", "the result as JSON on standard output", at<&Arguments::json>},
    {"--markdown", "", "the list of keys as a page in Markdown", at<&Arguments::markdown>},
    {"--quiet", "", "no progress and no report", at<&Arguments::quiet>},
};

}  // namespace

std::span<const OwnOption> own_options() {
  return rows;
}

bool takes(const Command& command, std::string_view option) {
  // Upper bounds that every verb keeps.
  if (option == "--quiet" || option == "--threads") return true;
  // A file that is named is written over without it.
  if (option == "--force" && shows(command, "-o")) return true;
  return shows(command, option);
}

bool shows(const Command& command, std::string_view option) {
  std::string_view rest = command.options;
  while (!rest.empty()) {
    const std::size_t end = rest.find(' ');
    if (rest.substr(0, end) == option) return true;
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
  }
  return false;
}

std::size_t place_of_first_name(const std::vector<std::string>& words) {
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word.size() < 2 || word.front() != '-') return i;
    const std::string_view name = word == "--output" ? "-o" : std::string_view(word);
    // "-oDIR" and "--size=8x8" have their values in them.
    if (std::ranges::any_of(rows,
                            [&](const OwnOption& row) { return row.name == name && !row.value.empty(); }))
      ++i;
  }
  return 0;
}

}  // namespace unfurl
