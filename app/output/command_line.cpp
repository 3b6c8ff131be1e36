// SPDX-License-Identifier: BSD-3-Clause
#include "app/output/command_line.hpp"

namespace unfurl {

std::string in_shell_quotes(std::string_view text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string as_typed(const std::vector<std::string>& words) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,@%";
  std::string text = "unfurl";
  for (const std::string& word : words) {
    text += " ";
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) {
      text += word;
      continue;
    }
    text += in_shell_quotes(word);
  }
  return text;
}

std::vector<std::string> without_option(const std::vector<std::string>& words, const std::string& option) {
  const std::string joined = option.size() == 2 ? option : option + "=";  // -oFILE, --dpi=200
  std::vector<std::string> kept;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == option)
      ++i;
    else if (!words[i].starts_with(joined))
      kept.push_back(words[i]);
  }
  return kept;
}

}  // namespace unfurl
