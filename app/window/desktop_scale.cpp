// SPDX-License-Identifier: BSD-3-Clause
#include "app/window/desktop_scale.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

namespace unfurl {

namespace {

// Only what is asked of it; nothing else of the program needs the library or its headers.
struct XLibrary {
  void* handle = dlopen("libX11.so.6", RTLD_NOW | RTLD_LOCAL);
  ~XLibrary() {
    if (handle != nullptr) dlclose(handle);
  }
  template <class Function>
  Function* find(const char* name) const {
    return reinterpret_cast<Function*>(handle != nullptr ? dlsym(handle, name) : nullptr);
  }
};

}  // namespace

double xft_dpi(std::string_view resources) {
  constexpr std::string_view key = "Xft.dpi:";
  while (!resources.empty()) {
    const std::size_t end = std::min(resources.find('\n'), resources.size());
    std::string_view line = resources.substr(0, end);
    resources.remove_prefix(std::min(end + 1, resources.size()));
    if (!line.starts_with(key)) continue;
    line.remove_prefix(key.size());
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    double dpi = 0;
    const auto read = std::from_chars(line.data(), line.data() + line.size(), dpi);
    return read.ec == std::errc() && std::isfinite(dpi) ? dpi : 0;
  }
  return 0;
}

X11Dpi x11_dpi() {
  using Display = void;
  const XLibrary x;
  const auto open = x.find<Display*(const char*)>("XOpenDisplay");
  const auto close = x.find<int(Display*)>("XCloseDisplay");
  const auto resources = x.find<char*(Display*)>("XResourceManagerString");
  const auto screen = x.find<int(Display*)>("XDefaultScreen");
  const auto pixels = x.find<int(Display*, int)>("XDisplayHeight");
  const auto millimetres = x.find<int(Display*, int)>("XDisplayHeightMM");
  if (!open || !close || !resources || !screen || !pixels || !millimetres) return {};
  Display* display = open(nullptr);
  if (display == nullptr) return {};
  X11Dpi dpi;
  if (const char* text = resources(display)) dpi.chosen = xft_dpi(text);
  if (const int height = millimetres(display, screen(display)); height > 0)
    dpi.screen = 25.4 * pixels(display, screen(display)) / height;
  close(display);
  return dpi;
}

float scale_for(double dpi, float pixels_per_unit) {
  if (!(dpi >= 48 && dpi <= 800)) return pixels_per_unit;
  const auto asked = static_cast<float>(dpi / 96);
  return std::max(1.0f, std::round(4 * std::max(pixels_per_unit, asked)) / 4);
}

}  // namespace unfurl
