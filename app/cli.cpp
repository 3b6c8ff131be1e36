// SPDX-License-Identifier: BSD-3-Clause
// The one place that knows the command-line library.
#include "app/cli.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>
#include <sstream>
#include <utility>

#include "app/command.hpp"
#include "app/help.hpp"
#include "app/output/failure.hpp"
#include "app/output/interrupt.hpp"
#include "app/output/printable_output.hpp"
#include "app/output/receipt.hpp"
#include "app/output/written_report.hpp"
#include "app/own_options.hpp"
#include "core/export/atomic_file.hpp"
#include "core/study/table.hpp"
#include "core/text/nearest_name.hpp"
#include "core/text/version.hpp"
#include "render/plot/lacking_letters.hpp"

namespace unfurl {

namespace {

const Command& find_command(const std::string& name) {
  std::vector<std::string_view> names;
  for (const auto& command : commands()) {
    if (command.name == name) return command;
    names.push_back(command.name);
  }
  throw UsageError("no command " + in_quotes(name) + did_you_mean(name, names));
}

// A word that no option took: a mistyped option. Words without a dash are counted later.
void refuse_unknown_options(const CLI::App& parser, const Command& command) {
  std::vector<std::string> kept;
  for (const auto* option : parser.get_options())
    for (const auto& name : option->get_lnames())
      if (takes(command, name == "output" ? "-o" : "--" + name)) kept.push_back("--" + name);
  for (const auto& word : parser.remaining()) {
    const std::string name = word.substr(0, word.find('='));
    if (!name.starts_with("-")) continue;
    const std::string near(nearest_name(name, {kept.begin(), kept.end()})), verb(command.name);
    throw UsageError("unfurl " + verb + " has no option " + in_quotes(name) +
                     (near.empty() ? "; unfurl help " + verb + " lists its options"
                                   : "; did you mean " + in_quotes(near) + "?"));
  }
}

// WIDTHxHEIGHT as the list that the key wants. Throws UsageError.
std::string list_of_size(const std::string& text) {
  const std::size_t cross = text.find('x');
  const double width = number_of(text.substr(0, cross));
  const double height = cross == std::string::npos ? 0 : number_of(text.substr(cross + 1));
  if (text.find_first_not_of("0123456789x") != std::string::npos || !(width >= 1) || !(height >= 1))
    throw UsageError("--size is WxH, two whole numbers of pixels, such as 1280x720; got " + in_quotes(text));
  return "[" + text.substr(0, cross) + ", " + text.substr(cross + 1) + "]";
}

// A number that an option takes, in words of our own.
CLI::Validator within(double low, double high, bool whole) {
  return CLI::Validator(
      [low, high, whole](const std::string& text) {
        const double x = number_of(text);
        if (x >= low && x <= high && (!whole || x == std::floor(x))) return std::string();
        std::ostringstream message;
        message << "must be a " << (whole ? "whole " : "") << "number from " << low << " to " << high
                << "; got " << in_quotes(text);
        return message.str();
      },
      "");
}

// How often an option, "-o" or "--fps", stands in what was typed.
std::ptrdiff_t times_given(const std::string& name, const std::vector<std::string>& words) {
  return std::ranges::count_if(words, [&](const std::string& word) {
    if (name == "-o") return word.starts_with("-o") || word.substr(0, word.find('=')) == "--output";
    return word.substr(0, word.find('=')) == name;
  });
}

std::string words_of(const CLI::ParseError& error, const std::vector<std::string>& words) {
  const std::string text = error.what(), given = text.substr(0, text.find(':'));
  if (!dynamic_cast<const CLI::ArgumentMismatch*>(&error)) return text;
  const std::string name = given == "--output" ? "-o" : given;
  // Options that repeat take any number of values: of those only the last one can lack its own.
  if (text.find("received") != std::string::npos && times_given(name, words) > 1)
    return name + " is given more than once; give it once";
  return name + " needs a value behind it";
}

struct Parsed {
  Arguments arguments;
  bool help = false, version = false;
};

// Two ways to say the same key: one of them would be silently over the other.
void refuse_doubled_keys(const CLI::App& parser, const std::vector<std::string>& overrides) {
  for (const OwnOption& own : own_options()) {
    const auto* target = std::get_if<ShortKey>(&own.target);
    if (!target || parser.count(std::string(own.name)) == 0) continue;
    const std::string key(target->key);
    for (const auto& text : overrides)
      if (text.starts_with(key + "=") || text.starts_with(key + "["))
        throw UsageError(std::string(own.name) + " and --set " + key + " say the same key: give one of them");
  }
}

// "; unfurl run and unfurl render have it", where they are few.
std::string verbs_that_take(std::string_view option) {
  constexpr std::size_t few = 3;
  std::vector<std::string> verbs;
  for (const Command& command : commands())
    if (shows(command, option)) verbs.push_back("unfurl " + std::string(command.name));
  if (verbs.empty() || verbs.size() > few) return "";
  std::string text = "; ";
  for (std::size_t i = 0; i < verbs.size(); ++i)
    text += (i == 0 ? "" : i + 1 == verbs.size() ? " and " : ", ") + verbs[i];
  return text + (verbs.size() == 1 ? " has it" : " have it");
}

// An option of another verb.
void refuse_foreign_options(const CLI::App& parser, const Command& command) {
  const auto given = parser.get_options([](const CLI::Option* option) { return option->count() > 0; });
  for (const OwnOption& own : own_options())
    if (!takes(command, own.name) && std::ranges::any_of(given, [&](const CLI::Option* option) {
          return option->check_name(std::string(own.name));
        }))
      throw UsageError("unfurl " + std::string(command.name) + " has no option " + in_quotes(own.name) +
                       verbs_that_take(own.name));
}

// Those that say more of another option, without it.
void refuse_lonely_options(const CLI::App& parser) {
  constexpr std::pair<const char*, const char*> pairs[] = {{"--lease", "--join"}, {"--jobs", "--script"}};
  for (const auto& [option, other] : pairs)
    if (parser.count(option) > 0 && parser.count(other) == 0)
      throw UsageError(std::string(option) + " is for " + other + "; add it, or leave " + option + " out");
}

// Those that are about files, where none are written.
void refuse_idle_options(const CLI::App& parser, const Command& command, const Arguments& arguments) {
  if (command.needs_output || !arguments.output.empty()) return;
  for (const char* option : {"--export", "--checkpoint", "--resume", "--force", "--style", "--font", "--dpi"})
    if (parser.count(option) > 0)
      throw UsageError(std::string(option) + " needs -o DIR: without it no files are written");
}

// `short_keys`: where options that are short for a key of the scene put it.
struct Adder {
  CLI::App& parser;
  const OwnOption& own;
  Arguments& arguments;
  std::vector<std::string>& short_keys;

  std::string name() const { return own.name == "-o" ? "-o,--output" : std::string(own.name); }

  void operator()(const ShortKey& target) const {
    const std::string key(target.key);
    if (own.value.empty()) {
      parser.add_flag_callback(name(), [key, &to = short_keys] { to.push_back(key + "=true"); });
      return;
    }
    parser.add_option_function<std::string>(name(), [key, &to = short_keys](const std::string& value) {
      to.push_back(key + "=" + (key == "render.size" ? list_of_size(value) : value));
    });
  }
  void operator()(bool& (*to)(Arguments&)) const { parser.add_flag(name(), to(arguments)); }
  void operator()(int& (*to)(Arguments&)) const {
    parser.add_option(name(), to(arguments))->check(within(own.low, own.high, true));
  }
  void operator()(double& (*to)(Arguments&)) const {
    parser.add_option(name(), to(arguments))->check(within(own.low, own.high, false));
  }
  void operator()(std::string& (*to)(Arguments&)) const { parser.add_option(name(), to(arguments)); }
  void operator()(std::vector<std::string>& (*to)(Arguments&)) const {
    CLI::Option* list = parser.add_option(name(), to(arguments))->allow_extra_args(false);
    if (own.value.ends_with(",...")) list->delimiter(',');
  }
};

// "-o --quiet", as of a script whose variable is empty: no directory is called so.
void refuse_options_as_values(const std::vector<std::string>& words) {
  const auto named = [](const std::string& word, bool with_value) {
    if (!with_value && (word == "-h" || word == "--help")) return true;
    const std::string_view name = word == "--output" ? "-o" : std::string_view(word);
    return std::ranges::any_of(own_options(), [&](const OwnOption& own) {
      return own.name == name && !(with_value && own.value.empty());
    });
  };
  for (std::size_t i = 0; i + 1 < words.size(); ++i)
    if (named(words[i], true) && named(words[i + 1], false))
      throw UsageError((words[i] == "--output" ? "-o" : words[i]) + " needs a value behind it, not " +
                       words[i + 1]);
}

Parsed parse(const Command& command, const std::vector<std::string>& words) {
  Parsed parsed;
  Arguments& a = parsed.arguments;
  for (const std::string& word : words)
    if (word.starts_with("-o="))
      throw UsageError("a short option takes its value behind a space: -o " + word.substr(3));
  refuse_options_as_values(words);
  CLI::App parser;
  parser.set_help_flag();
  parser.allow_extras();
  parser.add_option("names", a.names);
  std::vector<std::string> short_keys;
  for (const OwnOption& own : own_options()) std::visit(Adder{parser, own, a, short_keys}, own.target);
  parser.add_flag("-h,--help", parsed.help);
  parser.add_flag("--version", parsed.version);
  try {
    parser.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& error) {
    throw UsageError(words_of(error, words));
  }
  refuse_unknown_options(parser, command);
  refuse_foreign_options(parser, command);
  refuse_idle_options(parser, command, a);
  refuse_lonely_options(parser);
  refuse_doubled_keys(parser, a.overrides);
  a.overrides.insert(a.overrides.end(), short_keys.begin(), short_keys.end());
  for (const auto& word : parser.remaining()) a.names.push_back(word);
  return parsed;
}

void check_count(const Command& command, const Arguments& arguments) {
  const std::size_t count = arguments.names.size();
  std::string message;
  if (count < command.min_names) message = "too few arguments";
  if (count > command.max_names)
    message = "unexpected argument " + in_quotes(arguments.names[command.max_names]);
  if (message.empty() && command.needs_output && arguments.output.empty()) message = "-o is missing";
  if (!message.empty()) throw UsageError(message + "; usage: " + usage_line(command));
}

int print_version() {
  std::cout << "unfurl " << version() << "\n";
  return exit_ok;
}

int dispatch(const std::vector<std::string>& words) {
  if (words.empty()) {
    std::cerr << program_help();
    return exit_usage;
  }
  const std::string& first = words.front();
  if (first == "--help" || first == "-h" || first == "help") {
    const bool one = words.size() > 1 && !words[1].starts_with("-");
    std::cout << (one ? command_help(find_command(words[1])) : program_help());
    return exit_ok;
  }
  if (first == "--version") return print_version();
  if (first.starts_with("-")) throw UsageError("a command comes first, then its options; see unfurl --help");
  const Command& command = find_command(first);
  Parsed parsed = parse(command, {words.begin() + 1, words.end()});
  if (parsed.help) {
    std::cout << command_help(command);
    return exit_ok;
  }
  if (parsed.version) return print_version();
  check_count(command, parsed.arguments);
  parsed.arguments.words = words;
  Arguments& a = parsed.arguments;
  for (std::string* file : {&a.output, &a.view.picture, &a.view.record}) *file = behind_links(*file).string();
  std::optional<ReceiptWriter> receipts;
  if (shows(command, "-o")) receipts.emplace(words, place_of_first_name(words), a.output);
  if (!a.view.picture.empty()) {
    std::vector<std::string> shown = words;
    const bool own = a.names.empty() && a.view.replay.empty();
    if (own) shown.emplace(shown.begin() + 1, scene_of_the_window);
    receipts.emplace(shown, place_of_first_name(shown), a.view.picture);
  }
  const WrittenReport report(a.view.picture.empty() ? a.output : a.view.picture);
  const int code = command.run(a);
  if (const std::string letters = plot::take_lacking_letters(); !letters.empty())
    std::cerr << "unfurl: warning: " << letters << "\n";
  if (!a.quiet) std::cerr << report.text();
  return code;
}

}  // namespace

int run_command_line(const std::vector<std::string>& words) {
  int code = exit_internal;
  const PrintableOutput out(std::cout), err(std::cerr);
  end_on_signals();
  end_in_words();
  try {
    code = dispatch(words);
  } catch (...) {
    code = report_failure(std::cerr);
  }
  std::cout.flush();
  if (std::cout.fail() && code == exit_ok) {
    std::cerr << "unfurl: cannot write to standard output\n";
    code = exit_file_error;
  }
  return code;
}

}  // namespace unfurl
