// SPDX-License-Identifier: BSD-3-Clause
#include "app/own_options.hpp"

namespace unfurl {

namespace {

constexpr OwnOption rows[] = {
    {"-o", "PATH", "where results go"},
    {"--set", "KEY=VALUE",
     "change a key of the scene (unfurl list keys); the value is TOML, a bare word is a string (repeatable)"},
    {"--all", "", "every key with its value and unit, also those that the file leaves out"},
    {"--tolerance", "METRES", "pick stages and step for this error of node positions (solver.tolerance)"},
    {"--steps", "LARGEST:SMALLEST", "the ladder of steps [s], each half the one before"},
    {"--repeats", "N", "timed runs per point, at most (5)"},
    {"--methods", "NAME,...", "only these methods (unfurl list methods)"},
    {"--extreme", "NAME", "only this one: mass_ratio, force, fold_angle, units, stiffness (repeatable)"},
    {"--vary", "KEY=FROM:TO:COUNT",
     "a key of the scene and its values (repeatable); also FROM:TO:COUNT:log or A,B,C"},
    {"--measure", "NAME,...", "what to measure of every run (unfurl list measures)"},
    {"--shard", "I/N", "only every N-th point, from the I-th: N jobs share a sweep"},
    {"--merge", "DIR", "take the points of this directory instead of computing (repeatable)"},
    {"--find", "KEY", "the key of the scene that is solved for"},
    {"--target", "NAME=VALUE", "the measure (unfurl list measures) and what it shall be"},
    {"--between", "LOW:HIGH", "look for the key between these (default: around its value in the scene)"},
    {"--picture", "FILE.png", "no window: the panel as it opens, as large as --size says"},
    {"--at", "SECONDS", "of the motion: the pose; modes takes start, end and deployed too (start)"},
    {"--dark", "", "light text on a dark ground"},
    {"--bench", "", "no person: frames per second, where their time goes, and the price of idling"},
    {"--frames", "A:B", "only the frames A to B - 1 of the film, so that several machines can share one"},
    {"--poses", "N", "how many, 1 to 20 (5)"},
    {"--export", "FORMATS", "also write vtk, gltf, csv, npy (a comma list, repeatable)"},
    {"--style", "NAME", "of figures: screen, single-column (89 mm), double-column (183 mm), slide"},
    {"--dpi", "N", "pixels per inch of figures as PNG, 20 to 2400"},
    {"--ui-scale", "X", "size of the window's text and widgets, 0.5 to 4; else the monitor's"},
    {"--models", "", "compare models of the scene instead of methods"},
    {"--validation", "", "published benchmarks with digits instead of the paper: our error in each"},
    {"--size", "WxH", "of pictures in pixels: short for --set render.size=[W, H]"},
    {"--fps", "N", "frames a second: short for --set render.fps=N"},
    {"--look", "NAME", "of pictures (unfurl list looks): short for --set render.look=NAME"},
    {"--supersample", "N", "every pixel is the mean of N x N: short for --set render.supersample=N"},
    {"--transparent", "", "no background: short for --set render.transparent=true"},
    {"--force", "", "write into a directory that holds other files, start another film there over"},
    {"--threads", "N", "at most N threads"},
    {"--json", "", "the result as JSON on standard output"},
    {"--markdown", "", "the list of keys as a page in Markdown"},
    {"--quiet", "", "no progress and no report"},
};

}  // namespace

std::span<const OwnOption> own_options() {
  return rows;
}

bool takes(const Command& command, std::string_view option) {
  // Upper bounds that every verb keeps.
  if (option == "--quiet" || option == "--threads") return true;
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

}  // namespace unfurl
