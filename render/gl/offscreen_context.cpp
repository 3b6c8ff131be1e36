// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>
#include <string_view>

#include "render/gl/backends.hpp"
#include "render/gl/graphics_error.hpp"

namespace unfurl {

std::unique_ptr<GlContext> make_offscreen_context(const Offscreen& wanted) {
  // Mesa's own setting, read once; 0 draws on the calling thread. What the user set stays.
  const int threads = wanted.threads;
  if (threads > 0) setenv("LP_NUM_THREADS", std::to_string(threads == 1 ? 0 : threads).c_str(), 0);
  const char* variable = std::getenv("UNFURL_GL");
  const std::string_view chosen = variable == nullptr ? "" : variable;
  if (wanted.gpu || chosen == "gpu") return make_egl_context(true);
  if (chosen == "egl") return make_egl_context(false);
  std::string osmesa;
  try {
    return make_osmesa_context();
  } catch (const GraphicsError& error) {
    if (chosen == "osmesa") throw;
    osmesa = error.what();
  }
  try {
    return make_egl_context(false);
  } catch (const GraphicsError& error) {
    throw GraphicsError("cannot draw: " + osmesa + "; " + error.what() +
                        ". Install the Debian package libosmesa6, or libegl1 and libegl-mesa0 "
                        "(apt-get install libegl1 libegl-mesa0), or say in UNFURL_OSMESA or UNFURL_EGL where "
                        "such a library is");
  }
}

}  // namespace unfurl
