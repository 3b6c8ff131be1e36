#include "app/command.hpp"

namespace unfurl {

namespace {

constexpr Command table[] = {
    {"run", "SCENE -o DIR", "simulate; write data", 1, 1, false, cmd_run},
    {"render", "SCENE -o DIR", "simulate; write data, frames, animation and figures", 1, 1, true, cmd_render},
    {"figure", "SCENE NAME... -o FILE",
     "one figure, PNG or SVG by extension; NAME all: every figure, into a directory", 2, 100, true,
     cmd_figure},
    {"check", "SCENE", "validate; print coordinates, constraints, rank, redundant ones, degrees of freedom",
     1, 1, false, cmd_check},
    {"view", "[SCENE]", "interactive window: tweak, scrub, compare", 0, 1, false, cmd_view},
    {"list", "structures|methods|figures|scenes|constraints|forces", "what there is to choose from", 1, 1,
     false, cmd_list},
};

}  // namespace

std::span<const Command> commands() {
  return table;
}

}  // namespace unfurl
