// SPDX-License-Identifier: BSD-3-Clause
// The verbs of the program. To add one: verbs/cmd_NAME.cpp and a row in command_table.cpp.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/output/exit_code.hpp"

namespace unfurl {

// What only the verbs that measure take; empty or 0: not given.
struct StudyArguments {
  std::string ladder;                 // --steps LARGEST:SMALLEST
  int repeats = 0;                    // --repeats
  std::vector<std::string> methods;   // --methods NAME,...
  bool models = false;                // --models
  bool validation = false;            // --validation
  std::vector<std::string> extremes;  // --extreme NAME
  std::vector<std::string> vary;      // --vary KEY=FROM:TO:COUNT
  std::string measure;                // --measure NAME,NAME
  std::string shard;                  // --shard I/N
  std::vector<std::string> merge;     // --merge DIR
  std::string script;                 // --script NAME
  int jobs = 16;                      // --jobs N, of the script
  std::vector<std::string> factors;   // --factor NAME=VALUE
  bool stuck = false;                 // --stuck
  std::string find, target, between;  // --find KEY --target NAME=VALUE --between LOW:HIGH
};

inline constexpr const char* scene_of_the_window = "hoop6";  // where none is named

// What only the window takes.
struct ViewArguments {
  std::string picture;               // --picture FILE: draw the panel into it, without a window
  std::string record, replay;        // --record FILE, --replay FILE: a session (panel/session_log.hpp)
  bool dark = false, bench = false;  // --dark, --bench
};

// What the command line says, the same for every verb.
struct Arguments {
  std::vector<std::string> words;      // all of it, from the verb on
  std::vector<std::string> names;      // the words behind the verb: SCENE NAME...
  std::vector<std::string> overrides;  // --set
  std::string output;                  // -o; empty: not given
  bool join = false;                   // --join: one worker of many
  double lease = 60;                   // --lease SECONDS
  std::string frames;                  // --frames FIRST:END; empty: all
  int poses = 5;                       // --poses
  int mode = 0;                        // --mode K, of render; 0: not given
  std::vector<std::string> exports;    // --export, split at commas
  bool force = false;
  bool resume = false;       // --resume
  double checkpoint = 60;    // --checkpoint SECONDS
  bool encode_only = false;  // --encode-only
  bool plan = false;         // --plan
  bool quiet = false;
  bool json = false;
  bool all = false;       // --all, of show
  bool markdown = false;  // --markdown, of list keys
  double ui_scale = 0;    // --ui-scale of the window; 0: the monitor's
  int threads = 0;        // 0: as many as the machine has
  bool gpu = false;       // --gpu: draw on the graphics processor
  std::string at;         // --at SECONDS of the motion, of modes also a word; empty: where it begins
  std::string style;      // --style, of figures; empty: screen
  std::string font;       // --font, of figures; empty: DejaVu Sans
  double dpi = 0;         // --dpi, of figures; 0: the style's
  StudyArguments study;
  ViewArguments view;
};

struct Command {
  std::string_view name;
  std::string_view usage;  // what follows the name: "SCENE -o DIR"
  std::string_view help;   // one line
  std::size_t min_names, max_names;
  bool needs_output;
  int (*run)(const Arguments&);    // returns an ExitCode
  std::string_view options = {};   // all that it takes: "-o --set --steps" (own_options.hpp)
  std::string_view examples = {};  // command lines, one a line
};

std::span<const Command> commands();

int cmd_run(const Arguments& arguments);
int cmd_render(const Arguments& arguments);
int cmd_poster(const Arguments& arguments);
int cmd_figure(const Arguments& arguments);
int cmd_check(const Arguments& arguments);
int cmd_study(const Arguments& arguments);
int cmd_stress(const Arguments& arguments);
int cmd_sweep(const Arguments& arguments);
int cmd_solve(const Arguments& arguments);
int cmd_reproduce(const Arguments& arguments);
int cmd_view(const Arguments& arguments);
int cmd_list(const Arguments& arguments);
int cmd_show(const Arguments& arguments);
int cmd_margin(const Arguments& arguments);
int cmd_modes(const Arguments& arguments);
int cmd_new(const Arguments& arguments);
int cmd_import(const Arguments& arguments);
int cmd_verify(const Arguments& arguments);
int cmd_completion(const Arguments& arguments);

}  // namespace unfurl
