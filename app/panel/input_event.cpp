// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/input_event.hpp"

#include <iterator>

namespace unfurl {

namespace {

constexpr std::string_view key_names[] = {
    "none",   "tab",    "left",      "right", "up",    "down",   "page_up", "page_down", "home", "end",
    "insert", "delete", "backspace", "space", "enter", "escape", "f1",      "f6",        "a",    "b",
    "c",      "d",      "e",         "f",     "g",     "h",      "i",       "j",         "k",    "l",
    "m",      "n",      "o",         "p",     "q",     "r",      "s",       "t",         "u",    "v",
    "w",      "x",      "y",         "z",     "1",     "2",      "3",       "4"};
static_assert(std::size(key_names) == static_cast<std::size_t>(Key::count));

}  // namespace

std::string_view name_of(Key key) {
  return key_names[static_cast<std::size_t>(key)];
}

Key key_named(std::string_view name) {
  for (std::size_t i = 0; i < std::size(key_names); ++i)
    if (key_names[i] == name) return static_cast<Key>(i);
  return Key::none;
}

}  // namespace unfurl
