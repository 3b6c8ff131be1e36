// SPDX-License-Identifier: BSD-3-Clause
#include "app/help.hpp"

#include <algorithm>

#include "app/own_options.hpp"
#include "core/text/wrapped.hpp"

namespace unfurl {

namespace {

constexpr std::size_t help_width = 80;

// Two columns; what is too long for the first has a line of its own.
std::string row(const std::string& name, std::string_view help, std::size_t column) {
  const std::string indent(column, ' ');
  std::string first = "  " + name + " ";
  if (first.size() > column)
    first += "\n" + indent;
  else
    first.resize(column, ' ');
  const std::size_t behind_break = first.find('\n') == std::string::npos ? 0 : first.find('\n') + 1;
  return first.substr(0, behind_break) + wrapped(help, help_width, first.substr(behind_break), indent);
}

std::string examples_of(const Command& command) {
  if (command.examples.empty()) return "";
  std::string text = "\nexamples:\n";
  for (std::string_view rest = command.examples; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    text += wrapped(rest.substr(0, end), help_width - 2, "  ", "      ");
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return text;
}

}  // namespace

std::string usage_line(const Command& command) {
  return "unfurl " + std::string(command.name) + " " + std::string(command.usage);
}

std::string command_help(const Command& command) {
  std::string text = wrapped("usage: " + usage_line(command) + " [options]", help_width, "", "    ") +
                     wrapped(command.help, help_width) + "\noptions:\n";
  for (const OwnOption& own : own_options())
    if (shows(command, own.name))
      text += row(std::string(own.name) + " " + std::string(own.value), own.help, 30);
  return text + row("--help", "this text", 30) + examples_of(command);
}

std::string program_help() {
  std::string text = "Unfurl simulates deployable structures, renders and plots them.\n\nusage:\n";
  for (const auto& command : commands())
    text += wrapped(usage_line(command), help_width, "  ", "      ") +
            wrapped(command.help, help_width, "      ", "      ");
  return text +
         "\nSCENE is a scene file or a built-in one (unfurl list scenes); its keys: unfurl\n"
         "list keys. unfurl help COMMAND, or COMMAND --help, tells the options of each,\n"
         "with examples; unfurl --version the version.\n"
         "\nexit codes: 0 ok, 1 internal, 2 usage, 3 scene invalid, 4 solver failed (the\n"
         "  good part is saved), 5 file error, 6 no display or GL, 7 verification failed,\n"
         "  130 interrupted (what is finished is kept)\n";
}

}  // namespace unfurl
