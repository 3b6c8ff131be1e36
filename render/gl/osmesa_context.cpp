// SPDX-License-Identifier: BSD-3-Clause
// The first offscreen backend: Mesa's software renderer, found at run time so that the program starts without
// it.
#include <dlfcn.h>

#include <array>
#include <cstdlib>
#include <vector>

#include "render/gl/backends.hpp"
#include "render/gl/functions.hpp"
#include "render/gl/graphics_error.hpp"

namespace unfurl {
namespace {

// The part of <GL/osmesa.h> that we use; the header itself would declare OpenGL 1.x prototypes.
using OsmesaHandle = struct osmesa_context*;
using CreateContext = OsmesaHandle (*)(const int* attributes, OsmesaHandle share);
using MakeCurrent = GLboolean (*)(OsmesaHandle, void* buffer, GLenum type, GLsizei width, GLsizei height);
using DestroyContext = void (*)(OsmesaHandle);
using GetProcAddress = gl::AnyFunction (*)(const char*);
constexpr int osmesa_format = 0x22, osmesa_rgba = GL_RGBA;
constexpr int osmesa_depth_bits = 0x30, osmesa_profile = 0x33, osmesa_core_profile = 0x34;
constexpr int osmesa_major_version = 0x36, osmesa_minor_version = 0x37;

// UNFURL_OSMESA names another library, e.g. one that was built by hand.
const char* library_name() {
  const char* chosen = std::getenv("UNFURL_OSMESA");
  return chosen != nullptr && *chosen != '\0' ? chosen : "libOSMesa.so.8";
}

struct Library {
  void* handle = nullptr;
  CreateContext create = nullptr;
  MakeCurrent make_current = nullptr;
  DestroyContext destroy = nullptr;
  GetProcAddress find = nullptr;
};

// Opened once and never closed: Mesa keeps threads and thread-local data of its own.
Library open_library() {
  const char* name = library_name();
  Library lib;
  lib.handle = dlopen(name, RTLD_NOW | RTLD_LOCAL);
  if (lib.handle == nullptr)
    throw GraphicsError(std::string("the OSMesa library does not load: ") + dlerror());
  lib.create = reinterpret_cast<CreateContext>(dlsym(lib.handle, "OSMesaCreateContextAttribs"));
  lib.make_current = reinterpret_cast<MakeCurrent>(dlsym(lib.handle, "OSMesaMakeCurrent"));
  lib.destroy = reinterpret_cast<DestroyContext>(dlsym(lib.handle, "OSMesaDestroyContext"));
  lib.find = reinterpret_cast<GetProcAddress>(dlsym(lib.handle, "OSMesaGetProcAddress"));
  if (!lib.create || !lib.make_current || !lib.destroy || !lib.find) {
    throw GraphicsError(std::string(name) + " is not an OSMesa library with OpenGL 3.3");
  }
  return lib;
}

class OsmesaContext final : public GlContext {
 public:
  OsmesaContext() : lib_(open_library()) {
    const std::array<int, 11> attributes{osmesa_format,
                                         osmesa_rgba,
                                         osmesa_depth_bits,
                                         0,
                                         osmesa_profile,
                                         osmesa_core_profile,
                                         osmesa_major_version,
                                         3,
                                         osmesa_minor_version,
                                         3,
                                         0};
    context_ = lib_.create(attributes.data(), nullptr);
    if (context_ == nullptr)
      throw GraphicsError(std::string(library_name()) + " offers no OpenGL 3.3 core context");
    try {
      make_current();
    } catch (...) {
      lib_.destroy(context_);
      throw;
    }
  }

  ~OsmesaContext() override {
    lib_.make_current(nullptr, nullptr, 0, 0, 0);
    lib_.destroy(context_);
  }
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;

  void make_current() override {
    if (!lib_.make_current(context_, surface_.data(), GL_UNSIGNED_BYTE, side, side)) {
      throw GraphicsError(std::string(library_name()) + " refuses to make its context current");
    }
    if (const int missing = gl::load(lib_.find); missing > 0) {
      throw GraphicsError(std::string(library_name()) + " lacks " + std::to_string(missing) +
                          " functions of OpenGL 3.3");
    }
  }

  std::string description() const override {
    const auto text = [](GLenum name) {
      return std::string(reinterpret_cast<const char*>(gl::GetString(name)));
    };
    return "OSMesa, OpenGL " + text(GL_VERSION) + ", " + text(GL_RENDERER);
  }

 private:
  static constexpr int side = 16;  // the context's own surface [pixels]; pictures go to framebuffers
  Library lib_;
  OsmesaHandle context_ = nullptr;
  std::vector<unsigned char> surface_ = std::vector<unsigned char>(4 * side * side);
};

}  // namespace

std::unique_ptr<GlContext> make_osmesa_context() {
  return std::make_unique<OsmesaContext>();
}

}  // namespace unfurl
