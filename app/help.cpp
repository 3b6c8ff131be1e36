#include "app/help.hpp"

#include "app/own_options.hpp"

namespace unfurl {

namespace {

// Two columns; what is too long for the first has a line of its own.
std::string row(const std::string& name, std::string_view help, std::size_t width) {
  const std::string gap =
      name.size() < width ? std::string(width - name.size(), ' ') : "\n" + std::string(width + 2, ' ');
  return "  " + name + gap + std::string(help) + "\n";
}

constexpr std::string_view common_options =
    "options:\n"
    "  -o DIR             where results go\n"
    "  --set KEY=VALUE    change a key of the scene (repeatable); the value is TOML, a bare word is a "
    "string:\n"
    "                     --set solver.step=0.005 --set structure.model=sector --set "
    "structure.nodes.B0.mass=2\n"
    "  --size WxH, --fps N, --look NAME, --supersample N, --transparent\n"
    "                     short for --set render.size=[W, H], render.fps=N, ...\n"
    "  --force            write into a directory that holds other files, start another film there over\n"
    "  --quiet            no progress and no report\n"
    "  --json             the summary or the list as JSON on standard output\n"
    "  --threads N        at most N threads\n"
    "  --help, --version\n";

}  // namespace

std::string usage_line(const Command& command) {
  return "unfurl " + std::string(command.name) + " " + std::string(command.usage);
}

std::string command_help(const Command& command) {
  std::string text = "usage: " + usage_line(command) + " [options]\n" + std::string(command.help) + "\n\n";
  if (!command.options.empty()) text += "options of its own:\n";
  for (const OwnOption& own : own_options())
    if (takes(command, own.name))
      text += row(std::string(own.name) + " " + std::string(own.value), own.help, 30);
  return text + (command.options.empty() ? "" : "\n") + std::string(common_options);
}

std::string program_help() {
  std::string text = "Unfurl simulates deployable structures, renders and plots them.\n\nusage:\n";
  for (const auto& command : commands()) text += row(usage_line(command), command.help, 40);
  text +=
      "\nSCENE is a scene file or a built-in one (unfurl list scenes).\n"
      "unfurl help COMMAND, or COMMAND --help, tells the options of each.\n\n" +
      std::string(common_options);
  return text +
         "\nexit codes: 0 ok, 1 internal, 2 usage, 3 scene invalid, 4 solver failed (the good part is "
         "saved),\n"
         "  5 file error, 6 no display or GL, 7 verification failed, 130 interrupted (what is finished is "
         "kept)\n";
}

}  // namespace unfurl
