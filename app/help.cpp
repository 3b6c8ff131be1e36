#include "app/help.hpp"

#include "app/own_options.hpp"

namespace unfurl {

namespace {

std::string padded(std::string_view text, std::size_t width) {
  return std::string(text) + std::string(text.size() < width ? width - text.size() : 1, ' ');
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
    "  --frames A:B       of a film only the frames A to B - 1, so that several machines can share one\n"
    "  --force            write into a directory that holds other files, start another film there over\n"
    "  --quiet            no progress and no report\n"
    "  --json             the summary or the list as JSON on standard output\n"
    "  --threads N        at most N threads\n"
    "  --style NAME       of figures: screen, single-column (89 mm), double-column (183 mm), slide\n"
    "  --dpi N            pixels per inch of figures as PNG\n"
    "  --ui-scale X       size of the window's text and widgets, 0.5 to 4; else the monitor's\n"
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
      text += "  " + padded(std::string(own.name) + " " + std::string(own.value), 30) +
              std::string(own.help) + "\n";
  return text + (command.options.empty() ? "" : "\n") + std::string(common_options);
}

std::string program_help() {
  std::string text = "Unfurl simulates deployable structures, renders and plots them.\n\nusage:\n";
  for (const auto& command : commands())
    text += "  " + padded(usage_line(command), 40) + std::string(command.help) + "\n";
  text += "\nSCENE is a scene file or a built-in one (unfurl list scenes).\n\n" + std::string(common_options);
  return text +
         "\nexit codes: 0 ok, 1 internal, 2 usage, 3 scene invalid, 4 solver failed (the good part is "
         "saved),\n"
         "  5 file error, 6 no display or GL, 7 verification failed, 130 interrupted (what is finished is "
         "kept)\n";
}

}  // namespace unfurl
