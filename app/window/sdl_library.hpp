// SPDX-License-Identifier: BSD-3-Clause
// SDL2, found when a window is asked for: everything else of the program starts without it.
#pragma once

#include <SDL2/SDL.h>

#define UNFURL_SDL_FUNCTIONS(X) \
  X(Init)                       \
  X(Quit)                       \
  X(GetError)                   \
  X(GetCurrentVideoDriver)      \
  X(SetHint)                    \
  X(CreateWindow)               \
  X(DestroyWindow)              \
  X(SetWindowMinimumSize)       \
  X(GetWindowSize)              \
  X(GetWindowFlags)             \
  X(GetWindowDisplayIndex)      \
  X(GetDisplayDPI)              \
  X(GetDisplayUsableBounds)     \
  X(SetWindowSize)              \
  X(SetWindowPosition)          \
  X(GL_SetAttribute)            \
  X(GL_CreateContext)           \
  X(GL_DeleteContext)           \
  X(GL_MakeCurrent)             \
  X(GL_GetProcAddress)          \
  X(GL_GetDrawableSize)         \
  X(GL_SetSwapInterval)         \
  X(GL_SwapWindow)              \
  X(WaitEventTimeout)           \
  X(PollEvent)                  \
  X(PushEvent)                  \
  X(RegisterEvents)             \
  X(GetModState)                \
  X(GetClipboardText)           \
  X(SetClipboardText)           \
  X(free)                       \
  X(StartTextInput)             \
  X(CaptureMouse)

namespace unfurl {

struct SdlLibrary {
#define UNFURL_SDL_DECLARE(name) decltype(&::SDL_##name) name = nullptr;
  UNFURL_SDL_FUNCTIONS(UNFURL_SDL_DECLARE)
#undef UNFURL_SDL_DECLARE
};

// Opened once. Throws GraphicsError, naming the package to install, where it is missing.
const SdlLibrary& sdl();

}  // namespace unfurl
