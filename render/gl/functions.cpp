// SPDX-License-Identifier: BSD-3-Clause
#include "render/gl/functions.hpp"

namespace unfurl::gl {

#define UNFURL_GL_DEFINE(type, name) PFNGL##type##PROC name = nullptr;
UNFURL_GL_FUNCTIONS(UNFURL_GL_DEFINE)
#undef UNFURL_GL_DEFINE

int load(AnyFunction (*find)(const char* name)) {
  int missing = 0;
#define UNFURL_GL_LOAD(type, name)                              \
  name = reinterpret_cast<PFNGL##type##PROC>(find("gl" #name)); \
  missing += name == nullptr;
  UNFURL_GL_FUNCTIONS(UNFURL_GL_LOAD)
#undef UNFURL_GL_LOAD
  return missing;
}

}  // namespace unfurl::gl
