// SPDX-License-Identifier: BSD-3-Clause
// Completions for shells, the manual page and what desktops list a program by, from the tables of verbs and
// options: they cannot disagree.
#include <iostream>

#include "app/command.hpp"
#include "app/output/command_line.hpp"
#include "app/own_options.hpp"
#include "app/verbs/key_list.hpp"
#include "core/export/formats.hpp"
#include "core/study/extremes.hpp"
#include "core/text/nearest_name.hpp"
#include "core/text/version.hpp"
#include "render/plot/figure_style.hpp"
#include "render/plot/typeface.hpp"

namespace unfurl {

namespace {

// The names of a table, a space between them.
template <class Table>
std::string names_of(const Table& table) {
  std::string text;
  for (const auto& row : table) text.append(text.empty() ? "" : " ").append(row.name);
  return text;
}
std::string listed_names() {
  std::string text;
  for (const std::string_view name : list_names()) text.append(text.empty() ? "" : " ").append(name);
  return text;
}
std::string script_names();

// What a word in this place can be completed with: names of a table, or a list that the program prints.
struct Completed {
  std::string_view place;            // an option, or the name of a verb
  std::string (*words)() = nullptr;  // of the table, or ...
  std::string_view list = {};        // ... `unfurl list` of this
};
constexpr Completed completed[] = {
    {"--methods", nullptr, "methods"},
    {"--measure", nullptr, "measures"},
    {"--look", nullptr, "looks"},
    {"--export", [] { return names_of(export_formats()); }},
    {"--extreme", [] { return names_of(extreme_kinds()); }},
    {"--style", [] { return names_of(figure_styles()); }},
    {"--font", [] { return names_of(plot::typefaces()); }},
    {"completion", script_names},
    {"new", nullptr, "structures"},
    {"list", listed_names},
};

std::string options_of(const Command& command) {
  std::string text;
  for (const OwnOption& own : own_options())
    if (shows(command, own.name)) text.append(text.empty() ? "" : " ").append(own.name);
  return text + (text.empty() ? "" : " ") + "--help";
}

bool takes_scene(const Command& command) {
  return command.usage.find("SCENE") != std::string_view::npos;
}

std::string listed(std::string_view list) {
  return "unfurl list " + std::string(list) +
         " 2>/dev/null | sed -n '/^$/q;s/^\\([a-z][a-z0-9_-]*\\).*/\\1/p'";
}

std::string bash_completion() {
  std::string text =
      "# bash completion for unfurl, printed by `unfurl completion bash`\n"
      "_unfurl() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} verb=${COMP_WORDS[1]} "
      "words=\n"
      "  COMPREPLY=()\n"
      "  if [ \"$COMP_CWORD\" = 1 ]; then\n    words=\"";
  for (const Command& command : commands()) text.append(command.name).append(" ");
  text +=
      "help --help --version\"\n    COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n    return\n  fi\n"
      "  case $before in\n";
  for (const Completed& row : completed) {
    if (!row.place.starts_with("-")) continue;
    text += "    " + std::string(row.place) + ") COMPREPLY=($(compgen -W \"" +
            (row.list.empty() ? row.words() : "$(" + listed(row.list) + ")") +
            "\" -- \"$word\")); return ;;\n";
  }
  text +=
      "    -o | --output | --merge | --picture) COMPREPLY=($(compgen -f -- \"$word\")); return ;;\n"
      "  esac\n  case $verb in\n";
  for (const Command& command : commands()) {
    text += "    " + std::string(command.name) + ") words=\"" + options_of(command) + "\" ;;\n";
  }
  text += "  esac\n  if [[ $word != -* ]]; then\n    case $verb in\n";
  for (const Completed& row : completed) {
    if (row.place.starts_with("-")) continue;
    text += "      " + std::string(row.place) + ") words=\"" +
            (row.list.empty() ? row.words() : "$(" + listed(row.list) + ")") + "\" ;;\n";
  }
  text += "      *) words=\"$(" + listed("scenes") +
          ")\" ;;\n    esac\n  fi\n"
          "  COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
          "  [[ $word == -* ]] || COMPREPLY+=($(compgen -f -X '!*.toml' -- \"$word\"))\n"
          "}\ncomplete -o filenames -F _unfurl unfurl\n";
  return text;
}

std::string zsh_completion() {
  std::string text =
      "#compdef unfurl\n# zsh completion for unfurl, printed by `unfurl completion zsh`\n"
      "_unfurl() {\n  local -a verbs options\n  verbs=(\n";
  const auto colon_free = [](std::string_view words) {
    std::string out;
    for (const char c : words) out += c == ':' ? std::string("\\:") : std::string(1, c);
    return out;
  };
  for (const Command& command : commands())
    text += "    " + in_shell_quotes(std::string(command.name) + ":" + colon_free(command.help)) + "\n";
  text +=
      "  )\n  if (( CURRENT == 2 )); then\n    _describe command verbs\n    return\n  fi\n"
      "  case $words[2] in\n";
  for (const Command& command : commands()) {
    text += "    " + std::string(command.name) + ") options=(";
    for (const OwnOption& own : own_options())
      if (shows(command, own.name))
        text += "\n      " + in_shell_quotes(std::string(own.name) + ":" + colon_free(own.help));
    text += ") ;;\n";
  }
  text +=
      "  esac\n  if [[ $PREFIX == -* ]]; then\n    _describe option options\n    return\n  fi\n"
      "  case $words[2] in\n";
  for (const Completed& row : completed) {
    if (row.place.starts_with("-")) continue;
    text += "    " + std::string(row.place) + ") compadd " +
            (row.list.empty() ? row.words() : "$(" + listed(row.list) + ")") + " ;;\n";
  }
  return text + "    *) compadd $(" + listed("scenes") + "); _files ;;\n  esac\n}\n_unfurl \"$@\"\n";
}

std::string fish_completion() {
  std::string text = "# fish completion for unfurl, printed by `unfurl completion fish`\n";
  for (const Command& command : commands()) {
    const std::string name(command.name), inside = "__fish_seen_subcommand_from " + name;
    text += "complete -c unfurl -f -n __fish_use_subcommand -a " + name + " -d " +
            in_shell_quotes(command.help) + "\n";
    for (const OwnOption& own : own_options()) {
      if (!shows(command, own.name)) continue;
      text += "complete -c unfurl -n '" + inside + "' " +
              (own.name == "-o" ? "-s o" : "-l " + std::string(own.name.substr(2))) +
              (own.value.empty() ? "" : " -r") + " -d " + in_shell_quotes(own.help) + "\n";
    }
    if (takes_scene(command))
      text += "complete -c unfurl -n '" + inside + "' -a \"(" + listed("scenes") + ")\"\n";
  }
  for (const Completed& row : completed) {
    if (row.place.starts_with("-")) continue;
    text += "complete -c unfurl -f -n '__fish_seen_subcommand_from " + std::string(row.place) + "' -a \"" +
            (row.list.empty() ? row.words() : "(" + listed(row.list) + ")") + "\"\n";
  }
  return text;
}

// Text in troff: what it would take as a command or a break is masked.
std::string troff(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) out += "\\&";
    out += c == '\\' ? std::string("\\e") : c == '-' ? std::string("\\-") : std::string(1, c);
  }
  return out;
}

std::string manual_page() {
  std::string text =
      ".TH UNFURL 1 \"\" \"Unfurl " + version() +
      "\" \"User Commands\"\n"
      ".SH NAME\nunfurl \\- simulate, render and measure deployable structures\n.SH SYNOPSIS\n";
  for (const Command& command : commands())
    text += ".B unfurl " + std::string(command.name) + "\n" + troff(command.usage) + " [options]\n.br\n";
  text +=
      ".SH DESCRIPTION\nUnfurl simulates how pin\\-jointed rigid rods unfold, with structure\\-preserving "
      "variational integrators, draws frames, films and figures without a display, and opens a window "
      "where there is one. SCENE is a scene file or a built\\-in one (unfurl list scenes); its keys: unfurl "
      "list keys.\n.SH COMMANDS\n";
  for (const Command& command : commands()) {
    text += ".SS " + std::string(command.name) + "\n" + troff(command.help) + ".\n";
    for (const OwnOption& own : own_options())
      if (shows(command, own.name))
        text += ".TP\n.B " + troff(own.name) +
                (own.value.empty() ? "" : " \\fI" + troff(own.value) + "\\fR") + "\n" + troff(own.help) +
                "\n";
    if (!command.examples.empty()) text += ".PP\nExamples:\n.PP\n.nf\n" + troff(command.examples) + "\n.fi\n";
  }
  return text +
         ".SH EXIT STATUS\n0 ok, 1 internal, 2 usage, 3 scene invalid, 4 solver failed (the good part is "
         "saved), "
         "5 file error, 6 no display or GL, 7 verification failed, 130 interrupted (what is finished is "
         "kept).\n"
         ".SH ENVIRONMENT\n.TP\n.B UNFURL_ASSETS\nthe folder that holds scenes/\n.TP\n.B UNFURL_GL\nosmesa, "
         "egl "
         "or gpu: what draws\n.TP\n.B UNFURL_OSMESA, UNFURL_EGL\nother libraries than the system's\n";
}

constexpr std::string_view summary = "Simulate, render and measure deployable structures";

std::string desktop_entry() {
  return "[Desktop Entry]\nType=Application\nName=Unfurl\nGenericName=Deployable structures\nComment=" +
         std::string(summary) +
         "\nExec=unfurl view %f\nIcon=unfurl\nTerminal=false\nCategories=Science;Engineering;\n"
         "Keywords=linkage;antenna;scissor;mechanism;simulation;\n";
}

std::string in_xml(std::string_view text) {
  std::string out;
  for (const char c : text)
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

std::string appstream_component() {
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<component type=\"desktop-application\">\n"
      "  <id>io.unfurl.Unfurl</id>\n  <name>Unfurl</name>\n  <summary>" +
      std::string(summary) +
      "</summary>\n  <metadata_license>CC0-1.0</metadata_license>\n"
      "  <project_license>BSD-3-Clause</project_license>\n  <developer_name>The Unfurl "
      "authors</developer_name>\n"
      "  <description>\n    <p>Unfurl simulates how pin-jointed rods unfold, with structure-preserving "
      "variational "
      "integrators, draws frames, films and figures without a display, and opens a window to design in.</p>\n"
      "    <p>What it does from a terminal:</p>\n    <ul>\n";
  for (const Command& command : commands())
    text += "      <li>" + std::string(command.name) + ": " + in_xml(command.help) + "</li>\n";
  return text +
         "    </ul>\n  </description>\n  <launchable type=\"desktop-id\">unfurl.desktop</launchable>\n"
         "  <provides>\n    <binary>unfurl</binary>\n  </provides>\n  <content_rating type=\"oars-1.1\"/>\n"
         "</component>\n";
}

struct Script {
  std::string_view name;
  std::string (*text)();
};
constexpr Script scripts[] = {{"bash", bash_completion},  {"zsh", zsh_completion},
                              {"fish", fish_completion},  {"man", manual_page},
                              {"desktop", desktop_entry}, {"appstream", appstream_component}};

std::string script_names() {
  return names_of(scripts);
}

}  // namespace

int cmd_completion(const Arguments& arguments) {
  std::vector<std::string_view> names;
  for (const Script& script : scripts) {
    if (script.name == arguments.names.front()) {
      std::cout << script.text();
      return exit_ok;
    }
    names.push_back(script.name);
  }
  throw UsageError("no completion for " + in_quotes(arguments.names.front()) +
                   did_you_mean(arguments.names.front(), names));
}

}  // namespace unfurl
