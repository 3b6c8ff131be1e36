// The [render] table of a scene, checked: what the pictures show and how.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/model/param_spec.hpp"

namespace unfurl {

// A moment of the camera's path, [[render.camera_keys]]; between them it moves smoothly.
struct CameraKey {
  double time = 0.0;        // of the motion [s]
  double azimuth = -62.0;   // from the x axis towards y [deg]
  double elevation = 24.0;  // above the floor [deg]
  double zoom = 1.0;        // 1 shows the whole motion, 2 half of its width

  bool operator==(const CameraKey&) const = default;
};

struct RenderOptions {
  int width = 1280, height = 720;  // [pixels]
  double fps = 30.0;               // frames per second of the film
  double speed = 1.0;              // seconds of motion per second of film
  int supersample = 1;             // every pixel is the mean of as many in each direction
  bool transparent = false;        // no background
  std::string look = "studio";
  // Which films are made of the frames; changes no frame.
  bool webp = true, gif = true, mp4 = true;
  int gif_width = 640;  // frames that are wider are scaled down to it for the GIF [pixels]

  bool operator==(const RenderOptions&) const = default;
};

const std::vector<ParamSpec>& render_params();          // one row per key of [render]
RenderOptions render_options(const ParamSet& values);   // values: checked against render_params()
ParamSet render_values(const RenderOptions& options);   // the other way round
RenderOptions without_encoding(RenderOptions options);  // keys that change no frame at their defaults

}  // namespace unfurl
