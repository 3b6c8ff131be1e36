// SPDX-License-Identifier: BSD-3-Clause
// The second offscreen backend: EGL without a surface, for machines whose Mesa has no OSMesa any more (it
// left Mesa with 25.1). The device is Mesa's software renderer, so that pictures do not change with the
// machine; the hardware only where it is asked for. Extensions EGL_EXT_device_enumeration,
// EGL_EXT_platform_device, EGL_MESA_device_software, EGL_KHR_no_config_context, EGL_KHR_surfaceless_context.
#include <dlfcn.h>

#include <array>
#include <cstdlib>
#include <string_view>

#include "render/gl/backends.hpp"
#include "render/gl/functions.hpp"
#include "render/gl/graphics_error.hpp"

namespace unfurl {
namespace {

// The part of <EGL/egl.h> and <EGL/eglext.h> that we use; the library is looked for at run time.
using EglDisplay = void*;
using EglContextHandle = void*;
using EglDevice = void*;
constexpr int egl_none = 0x3038, egl_extensions = 0x3055, egl_opengl_api = 0x30A2;
constexpr int egl_major_version = 0x3098, egl_minor_version = 0x30FB;
constexpr int egl_profile = 0x30FD, egl_core_profile = 1, egl_platform_device = 0x313F;

struct Egl {
  gl::AnyFunction (*find)(const char*) = nullptr;  // eglGetProcAddress
  unsigned (*initialize)(EglDisplay, int*, int*) = nullptr;
  unsigned (*terminate)(EglDisplay) = nullptr;
  unsigned (*bind_api)(unsigned) = nullptr;
  EglContextHandle (*create)(EglDisplay, void* config, EglContextHandle, const int*) = nullptr;
  unsigned (*destroy)(EglDisplay, EglContextHandle) = nullptr;
  unsigned (*make_current)(EglDisplay, void* draw, void* read, EglContextHandle) = nullptr;
  unsigned (*query_devices)(int, EglDevice*, int*) = nullptr;
  const char* (*device_text)(EglDevice, int) = nullptr;
  EglDisplay (*display_of)(unsigned, void*, const int*) = nullptr;
};

// UNFURL_EGL names another library.
std::string egl_library_name() {
  const char* chosen = std::getenv("UNFURL_EGL");
  return chosen != nullptr && *chosen != '\0' ? chosen : "libEGL.so.1";
}

// Opened once and never closed, as its drivers keep threads of their own.
Egl open_egl() {
  void* handle = dlopen(egl_library_name().c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) throw GraphicsError(std::string("the EGL library does not load: ") + dlerror());
  Egl egl;
  const auto take = [&]<class Function>(Function& function, const char* name) {
    function = reinterpret_cast<Function>(dlsym(handle, name));
    if (function == nullptr && egl.find != nullptr) function = reinterpret_cast<Function>(egl.find(name));
    if (function == nullptr) throw GraphicsError(egl_library_name() + " lacks " + name);
  };
  take(egl.find, "eglGetProcAddress");
  take(egl.initialize, "eglInitialize");
  take(egl.terminate, "eglTerminate");
  take(egl.bind_api, "eglBindAPI");
  take(egl.create, "eglCreateContext");
  take(egl.destroy, "eglDestroyContext");
  take(egl.make_current, "eglMakeCurrent");
  take(egl.query_devices, "eglQueryDevicesEXT");
  take(egl.device_text, "eglQueryDeviceStringEXT");
  take(egl.display_of, "eglGetPlatformDisplayEXT");
  return egl;
}

EglDevice device_of(const Egl& egl, bool hardware) {
  std::array<EglDevice, 32> devices{};
  int count = 0;
  if (!egl.query_devices(static_cast<int>(devices.size()), devices.data(), &count)) count = 0;
  for (int i = 0; i < count; ++i) {
    EglDevice device = devices[static_cast<std::size_t>(i)];
    const char* extensions = egl.device_text(device, egl_extensions);
    const bool software =
        extensions && std::string_view(extensions).find("EGL_MESA_device_software") != std::string_view::npos;
    if (software != hardware) return device;
  }
  throw GraphicsError(hardware ? "EGL knows no graphics processor here (--gpu asks for one)"
                               : "EGL knows no software renderer here");
}

class EglContext final : public GlContext {
 public:
  explicit EglContext(bool hardware) : egl_(open_egl()) {
    display_ = egl_.display_of(egl_platform_device, device_of(egl_, hardware), nullptr);
    if (display_ == nullptr || !egl_.initialize(display_, nullptr, nullptr))
      throw GraphicsError("EGL does not open its device");
    egl_.bind_api(egl_opengl_api);
    const std::array<int, 7> attributes{egl_major_version, 3,       egl_minor_version, 3, egl_profile,
                                        egl_core_profile,  egl_none};
    context_ = egl_.create(display_, nullptr, nullptr, attributes.data());
    if (context_ == nullptr) {
      egl_.terminate(display_);
      throw GraphicsError("EGL offers no OpenGL 3.3 core context without a surface");
    }
    try {
      make_current();
    } catch (...) {
      end();
      throw;
    }
  }
  ~EglContext() override { end(); }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  void make_current() override {
    egl_.bind_api(egl_opengl_api);  // is the thread's own
    if (!egl_.make_current(display_, nullptr, nullptr, context_))
      throw GraphicsError("EGL refuses to make its context current without a surface");
    if (const int missing = gl::load(egl_.find); missing > 0)
      throw GraphicsError("EGL's driver lacks " + std::to_string(missing) + " functions of OpenGL 3.3");
  }

  std::string description() const override {
    const auto text = [](GLenum name) {
      return std::string(reinterpret_cast<const char*>(gl::GetString(name)));
    };
    return "EGL, OpenGL " + text(GL_VERSION) + ", " + text(GL_RENDERER);
  }

 private:
  // Another context of the same device shares its display: it is not terminated.
  void end() {
    egl_.make_current(display_, nullptr, nullptr, nullptr);
    egl_.destroy(display_, context_);
  }

  Egl egl_;
  EglDisplay display_ = nullptr;
  EglContextHandle context_ = nullptr;
};

}  // namespace

std::unique_ptr<GlContext> make_egl_context(bool hardware) {
  return std::make_unique<EglContext>(hardware);
}

}  // namespace unfurl
