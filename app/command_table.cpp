// SPDX-License-Identifier: BSD-3-Clause
#include "app/command.hpp"

namespace unfurl {

namespace {

constexpr Command table[] = {
    {"run", "SCENE -o DIR", "simulate; write data", 1, 1, false, cmd_run,
     "-o --set --tolerance --export --checkpoint --resume --size --fps --look --supersample --transparent "
     "--plan "
     "--force --threads --json --quiet",
     "unfurl run hoop6 -o data\n"
     "unfurl run hoop6 -o data --set structure.units=12 --set solver.step=0.005\n"
     "unfurl run my.toml -o data --tolerance 1e-8 --export vtk,npy\n"
     "unfurl run hoop6 -o data --export html\n"
     "unfurl run double_pendulum -o data --set solver.end_time=60 --checkpoint 10"},
    {"render", "SCENE -o DIR", "simulate; write data, frames, animation and figures", 1, 1, true, cmd_render,
     "-o --set --tolerance --export --frames --join --lease --encode-only --mode --at --style --font --dpi "
     "--size "
     "--fps "
     "--look "
     "--supersample --transparent --fit --plan "
     "--force --threads --gpu --json --quiet",
     "unfurl render hoop6 -o film\n"
     "unfurl render hoop6 -o film --size 640x360 --look space --frames 0:20\n"
     "unfurl render hoop6 -o film --size 640x360 --look space --encode-only\n"
     "unfurl render scissor_mast_square -o mast --fit --plan\n"
     "unfurl render hoop6 -o mode --mode 2 --at 4.6 --set structure.youngs_modulus=7e10"},
    {"figure", "SCENE NAME... -o FILE",
     "one figure, PNG, SVG or PDF by extension; NAME all: every figure, into a directory", 2, 100, true,
     cmd_figure, "-o --set --tolerance --style --font --dpi --gpu --quiet",
     "unfurl figure hoop6 energy -o energy.pdf --style single-column --font helvetica\n"
     "unfurl figure hoop6 all -o figures"},
    {"study", "SCENE -o DIR", "speed against accuracy: every method over a ladder of steps", 1, 1, true,
     cmd_study,
     "-o --set --steps --repeats --methods --models --join --lease --style --font --dpi --force --threads "
     "--json --quiet",
     "unfurl study hoop6 -o study\n"
     "unfurl study hoop6 -o two --methods dvm,rk4 --steps 0.04:0.005 --repeats 1"},
    {"stress", "SCENE -o DIR", "stability at the extremes: every method and step", 1, 1, true, cmd_stress,
     "-o --set --extreme --join --lease --style --font --dpi --force --threads --json --quiet",
     "unfurl stress hoop6 --extreme mass_ratio -o stress"},
    {"sweep", "SCENE --vary KEY=FROM:TO:COUNT --measure NAME,... -o DIR",
     "measures of the scene over a grid of parameters", 1, 1, true, cmd_sweep,
     "-o --set --tolerance --vary --measure --shard --join --lease --merge --script --jobs --style --font "
     "--dpi "
     "--force --threads "
     "--json --quiet",
     "unfurl sweep hoop6_sector --vary structure.fold_angle=30:85:12 --measure deploy_time -o sweep"},
    {"solve", "SCENE --find KEY --target NAME=VALUE [-o DIR]",
     "the parameter for which a measure takes a value", 1, 1, false, cmd_solve,
     "-o --set --tolerance --find --target --between --force --threads --json --quiet",
     "unfurl solve hoop6 --find structure.hinge_force --target deploy_time=4"},
    {"reproduce", "-o DIR, or FILE [-o DIR]",
     "the paper's tables and figures, beside ours; or a file again from the receipt in it", 0, 1, false,
     cmd_reproduce, "-o --validation --export --style --font --dpi --force --threads --json --quiet",
     "unfurl reproduce -o paper\n"
     "unfurl reproduce --validation -o validation\n"
     "unfurl reproduce energy.pdf"},
    {"poster", "SCENE -o FILE.png",
     "a strip of poses side by side, from start to end; each a third as wide and half as high as --size", 1,
     1, true, cmd_poster,
     "-o --set --tolerance --poses --size --look --supersample --transparent --threads --gpu --quiet",
     "unfurl poster hoop6 -o poster.png --size 960x540 --poses 4"},
    {"check", "SCENE", "validate; print coordinates, constraints, rank, redundant ones, degrees of freedom",
     1, 1, false, cmd_check, "--set --json", "unfurl check bricard"},
    {"modes", "SCENE [-o DIR]",
     "free motions and natural frequencies at a pose; elastic where rods have a youngs_modulus", 1, 1, false,
     cmd_modes, "-o --set --at --style --font --dpi --force --json --quiet",
     "unfurl modes hoop6 --set structure.youngs_modulus=7e10 --set structure.model=joints\n"
     "unfurl modes hoop6 --at deployed --set solver.at_deployed=latch --set structure.youngs_modulus=7e10 "
     "-o modes"},
    {"margin", "SCENE [-o DIR]",
     "what drives a deployment against what resists it, by source, in every pose and along the motion", 1, 1,
     false, cmd_margin, "-o --set --factor --stuck --style --font --dpi --force --json --quiet",
     "unfurl margin scissor_mast --set gravity.acceleration=[0,0,-1.6] --stuck -o margin"},
    {"view", "[SCENE]", "interactive window: tweak, scrub, compare", 0, 1, false, cmd_view,
     "--set --tolerance --picture --record --replay --at --dark --bench --ui-scale --size --fps --look "
     "--supersample "
     "--transparent --threads --gpu",
     "unfurl view hoop6 --picture window.png --at 4.6\n"
     "unfurl view hoop6 --record session.jsonl\n"
     "unfurl view --replay session.jsonl"},
    {"list", "WHAT [TABLE]",
     "what there is to choose from: structures, methods, figures, scenes, constraints, forces, looks, "
     "surfaces, measures, "
     "columns, and keys [TABLE]: those of scenes with type, unit, range and default; solver, render and "
     "scene "
     "are tables of keys too",
     1, 2, false, cmd_list, "--json --markdown",
     "unfurl list keys solver\n"
     "unfurl list keys hoop\n"
     "unfurl list scenes"},
    {"show", "SCENE", "print a scene, with --set written into it", 1, 1, false, cmd_show,
     "--set --all --size --fps --look --supersample --transparent",
     "unfurl show hoop6\n"
     "unfurl show hoop6 --set structure.units=12 > twelve.toml"},
    {"verify", "PATH", "are results, a directory or a file, still as they were written? exit 7: no", 1, 1,
     false, cmd_verify, "--json",
     "unfurl verify film\n"
     "unfurl verify film/figures/energy.pdf"},
    {"completion", "SHELL", "print a completion script for bash, zsh or fish, or the manual page: man", 1, 1,
     false, cmd_completion, "",
     "unfurl completion bash > ~/.local/share/bash-completion/completions/unfurl\n"
     "unfurl completion man | man -l -"},
    {"new", "KIND", "print a commented scene of a kind (unfurl list structures), to begin your own from", 1,
     1, false, cmd_new, "",
     "unfurl new custom > mine.toml\n"
     "unfurl new hoop > ring.toml"},
    {"import", "FILE [RODS.csv] [-o SCENE.toml]",
     "a scene of origami (FOLD), of lines and faces (OBJ), or of nodes x,y,z and rods a,b between their "
     "names "
     "or numbers (CSV)",
     1, 2, false, cmd_import, "-o --set --force --quiet",
     "unfurl import miura.fold -o miura.toml\n"
     "unfurl import frame.obj -o frame.toml --set variables.section_area=2e-4\n"
     "unfurl import nodes.csv rods.csv > linkage.toml"},
};

}  // namespace

std::span<const Command> commands() {
  return table;
}

}  // namespace unfurl
