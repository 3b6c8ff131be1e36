// SPDX-License-Identifier: BSD-3-Clause
#include "app/window/sdl_library.hpp"

#include <dlfcn.h>

#include "app/window/window.hpp"
#include "render/gl/graphics_error.hpp"

namespace unfurl {

namespace {

SdlLibrary open_library() {
  void* handle = dlopen("libSDL2-2.0.so.0", RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr)
    throw GraphicsError(no_window_message("the library SDL2 does not load (apt-get install libsdl2-2.0-0)"));
  SdlLibrary lib;
  const char* missing = nullptr;
#define UNFURL_SDL_FIND(name)                                                        \
  lib.name = reinterpret_cast<decltype(&::SDL_##name)>(dlsym(handle, "SDL_" #name)); \
  if (lib.name == nullptr) missing = "SDL_" #name;
  UNFURL_SDL_FUNCTIONS(UNFURL_SDL_FIND)
#undef UNFURL_SDL_FIND
  if (missing != nullptr)
    throw GraphicsError(no_window_message(std::string("the library SDL2 lacks ") + missing));
  return lib;
}

}  // namespace

const SdlLibrary& sdl() {
  static const SdlLibrary library = open_library();
  return library;
}

}  // namespace unfurl
