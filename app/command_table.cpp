#include "app/command.hpp"

namespace unfurl {

namespace {

constexpr Command table[] = {
    {"run", "SCENE -o DIR", "simulate; write data", 1, 1, false, cmd_run, "--tolerance --export"},
    {"render", "SCENE -o DIR", "simulate; write data, frames, animation and figures", 1, 1, true, cmd_render,
     "--tolerance --export --frames --style --dpi"},
    {"figure", "SCENE NAME... -o FILE",
     "one figure, PNG, SVG or PDF by extension; NAME all: every figure, into a directory", 2, 100, true,
     cmd_figure, "--tolerance --style --dpi"},
    {"study", "SCENE -o DIR", "speed against accuracy: every method over a ladder of steps", 1, 1, true,
     cmd_study, "--steps --repeats --methods --models --style --dpi"},
    {"stress", "SCENE -o DIR", "stability at the extremes: every method and step", 1, 1, true, cmd_stress,
     "--extreme --style --dpi"},
    {"sweep", "SCENE --vary KEY=FROM:TO:COUNT --measure NAME,... -o DIR",
     "measures of the scene over a grid of parameters", 1, 1, true, cmd_sweep,
     "--tolerance --vary --measure --shard --merge --style --dpi"},
    {"solve", "SCENE --find KEY --target NAME=VALUE [-o DIR]",
     "the parameter for which a measure takes a value", 1, 1, false, cmd_solve, "--tolerance --find --target --between"},
    {"reproduce", "-o DIR", "the paper's tables and figures, beside ours", 0, 0, true, cmd_reproduce,
     "--style --dpi"},
    {"poster", "SCENE -o FILE.png", "a strip of poses side by side, from start to end", 1, 1, true,
     cmd_poster, "--tolerance --poses"},
    {"check", "SCENE", "validate; print coordinates, constraints, rank, redundant ones, degrees of freedom",
     1, 1, false, cmd_check},
    {"view", "[SCENE]", "interactive window: tweak, scrub, compare", 0, 1, false, cmd_view,
     "--tolerance --picture --at --dark --bench --ui-scale"},
    {"list", "structures|methods|figures|scenes|constraints|forces|looks|measures",
     "what there is to choose from", 1, 1, false, cmd_list},
};

}  // namespace

std::span<const Command> commands() {
  return table;
}

}  // namespace unfurl
