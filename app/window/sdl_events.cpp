// SPDX-License-Identifier: BSD-3-Clause
#include "app/window/sdl_events.hpp"

#include <utility>

#include "app/window/sdl_library.hpp"

namespace unfurl {

namespace {

Key key_of(SDL_Keycode code) {
  constexpr std::pair<SDL_Keycode, Key> named[] = {{SDLK_TAB, Key::tab},
                                                   {SDLK_LEFT, Key::left},
                                                   {SDLK_RIGHT, Key::right},
                                                   {SDLK_UP, Key::up},
                                                   {SDLK_DOWN, Key::down},
                                                   {SDLK_PAGEUP, Key::page_up},
                                                   {SDLK_PAGEDOWN, Key::page_down},
                                                   {SDLK_HOME, Key::home},
                                                   {SDLK_END, Key::end},
                                                   {SDLK_INSERT, Key::insert},
                                                   {SDLK_DELETE, Key::del},
                                                   {SDLK_BACKSPACE, Key::backspace},
                                                   {SDLK_SPACE, Key::space},
                                                   {SDLK_RETURN, Key::enter},
                                                   {SDLK_KP_ENTER, Key::enter},
                                                   {SDLK_ESCAPE, Key::escape},
                                                   {SDLK_F1, Key::f1},
                                                   {SDLK_F6, Key::f6}};
  for (const auto& [theirs, ours] : named)
    if (theirs == code) return ours;
  if (code >= SDLK_a && code <= SDLK_z) return static_cast<Key>(static_cast<int>(Key::a) + (code - SDLK_a));
  if (code >= SDLK_1 && code <= SDLK_4) return static_cast<Key>(static_cast<int>(Key::one) + (code - SDLK_1));
  return Key::none;
}

InputEvent key_event(const SDL_KeyboardEvent& key) {
  InputEvent event;
  event.kind = InputEvent::Kind::key;
  event.key = key_of(key.keysym.sym);
  event.down = key.type == SDL_KEYDOWN;
  event.control = (key.keysym.mod & KMOD_CTRL) != 0;
  event.shift = (key.keysym.mod & KMOD_SHIFT) != 0;
  event.alt = (key.keysym.mod & KMOD_ALT) != 0;
  return event;
}

InputEvent button_event(const SDL_MouseButtonEvent& button) {
  InputEvent event;
  event.kind = InputEvent::Kind::button;
  event.button = button.button == SDL_BUTTON_LEFT ? 0 : button.button == SDL_BUTTON_RIGHT ? 1 : 2;
  event.down = button.type == SDL_MOUSEBUTTONDOWN;
  event.time = 1e-3 * button.timestamp;
  return event;
}

}  // namespace

std::optional<InputEvent> input_event(const SDL_Event& event, float pixels) {
  InputEvent out;
  switch (event.type) {
    case SDL_MOUSEMOTION:
      out.x = static_cast<float>(event.motion.x) * pixels;
      out.y = static_cast<float>(event.motion.y) * pixels;
      return out;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
      return event.button.button <= SDL_BUTTON_RIGHT ? std::optional(button_event(event.button))
                                                     : std::nullopt;
    case SDL_MOUSEWHEEL:
      out.kind = InputEvent::Kind::wheel;
      out.x = event.wheel.preciseX;
      out.y = event.wheel.preciseY;
      return out;
    case SDL_KEYDOWN:
    case SDL_KEYUP:
      return key_event(event.key);
    case SDL_TEXTINPUT:
      out.kind = InputEvent::Kind::text;
      out.text = event.text.text;
      return out;
    case SDL_DROPFILE:
      out.kind = InputEvent::Kind::drop;
      out.text = event.drop.file;
      sdl().free(event.drop.file);
      return out;
    case SDL_QUIT:
      out.kind = InputEvent::Kind::close;
      return out;
    case SDL_WINDOWEVENT:
      if (event.window.event != SDL_WINDOWEVENT_FOCUS_LOST) return std::nullopt;
      out.kind = InputEvent::Kind::focus_lost;
      return out;
    default:
      return std::nullopt;
  }
}

}  // namespace unfurl
