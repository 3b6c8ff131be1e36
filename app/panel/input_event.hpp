// SPDX-License-Identifier: BSD-3-Clause
// What a person does, independent of who reports it: a window or a test.
#pragma once

#include <string>
#include <string_view>

namespace unfurl {

enum class Key {
  none,
  tab,
  left,
  right,
  up,
  down,
  page_up,
  page_down,
  home,
  end,
  insert,
  del,
  backspace,
  space,
  enter,
  escape,
  f1,
  f6,
  a,
  b,
  c,
  d,
  e,
  f,
  g,
  h,
  i,
  j,
  k,
  l,
  m,
  n,
  o,
  p,
  q,
  r,
  s,
  t,
  u,
  v,
  w,
  x,
  y,
  z,
  one,
  two,
  three,
  four,
  count
};

struct InputEvent {
  enum class Kind { move, button, wheel, key, text, focus_lost, drop, close };
  Kind kind = Kind::move;
  float x = 0, y = 0;  // move: pixels from the top left; wheel: steps to the right and up
  int button = 0;      // 0 left, 1 right, 2 middle
  bool down = false;   // button, key
  double time = -1;    // button: when it was pressed, by the desktop's clock [s]; < 0: not known
  Key key = Key::none;
  bool control = false, shift = false, alt = false;  // key
  std::string text = {};                             // text: UTF-8; drop: the file's path
};

std::string_view name_of(Key key);     // "page_up", "a", "1"
Key key_named(std::string_view name);  // Key::none where none has that name

}  // namespace unfurl
