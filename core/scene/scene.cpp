#include "core/scene/scene.hpp"

#include <utility>

namespace unfurl {

const std::vector<ParamSpec>& render_params() {
  static const std::vector<ParamSpec> params = [] {
    const RenderOptions fallback;
    ParamSpec size = vector_param("size", "pixels", {double(fallback.width), double(fallback.height)},
                                  "width and height of the pictures");
    size.min = 16;
    size.max = 8192;
    return std::vector<ParamSpec>{
        std::move(size),
        real_param("fps", "frames/s", fallback.fps, 0.1, 1000, "frames per second of the film"),
        real_param("speed", "", fallback.speed, 1e-6, 1e6, "seconds of motion per second of film"),
    };
  }();
  return params;
}

}  // namespace unfurl
