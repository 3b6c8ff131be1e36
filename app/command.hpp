// The verbs of the program. To add one: cmd_NAME.cpp and a row in command_table.cpp.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/exit_code.hpp"

namespace unfurl {

// What the command line says, the same for every verb.
struct Arguments {
  std::vector<std::string> names;      // the words behind the verb: SCENE NAME...
  std::vector<std::string> overrides;  // --set
  std::string output;                  // -o; empty: not given
  std::vector<std::string> exports;    // --export, split at commas
  bool force = false;
  bool quiet = false;
  bool json = false;
  int threads = 0;  // 0: as many as the machine has
};

struct Command {
  std::string_view name;
  std::string_view usage;  // what follows the name: "SCENE -o DIR"
  std::string_view help;   // one line
  std::size_t min_names, max_names;
  bool needs_output;
  int (*run)(const Arguments&);  // returns an ExitCode
};

std::span<const Command> commands();

int cmd_run(const Arguments& arguments);
int cmd_render(const Arguments& arguments);
int cmd_figure(const Arguments& arguments);
int cmd_check(const Arguments& arguments);
int cmd_list(const Arguments& arguments);

}  // namespace unfurl
