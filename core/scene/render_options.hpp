// SPDX-License-Identifier: BSD-3-Clause
// The [render] table of a scene, checked: what the pictures show and how.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/text/param_spec.hpp"

namespace unfurl {

// A moment of the camera's path, [[render.camera_keys]]; between them it moves smoothly.
struct CameraKey {
  double time = 0.0;        // of the motion [s]
  double azimuth = -62.0;   // from the x axis towards y [deg]
  double elevation = 24.0;  // above the floor [deg]
  double zoom = 1.0;        // 1 shows the whole motion, 2 half of its width

  bool operator==(const CameraKey&) const = default;
};

// What rods of some groups are made of in the picture, [[render.materials]].
struct GroupMaterial {
  std::string group;  // a name or a glob
  std::string material = "anodised";

  bool operator==(const GroupMaterial&) const = default;
};

struct RenderOptions {
  int width = 1280, height = 720;  // [pixels]
  double fps = 30.0;               // frames per second of the film
  double speed = 1.0;              // seconds of motion per second of film
  int supersample = 1;             // every pixel is the mean of as many in each direction
  bool transparent = false;        // no background
  std::string look = "studio";
  // What colours the rods: their group or a quantity, over a range that stays fixed through the film.
  std::string colour_by = "group";
  std::array<double, 2> colour_range{0.0, 0.0};  // in the quantity's unit; equal ends: from the run
  double rod_scale =
      0.0;  // rods are drawn so many times as thick as they are; 0: as far as they must be seen
  std::string material = "anodised";  // of all rods but those that an entry of `materials` names
  std::vector<GroupMaterial> materials;
  // What is written or drawn over the picture.
  bool title = true, time = true, legend = true, loads = true;
  bool method = false, errors = false, scale_bar = false, axes = false, dimensions = false;
  bool node_labels = false, rod_labels = false;
  std::string inset = "";   // a column of series.csv, as a small figure that grows with the film
  std::string trails = "";  // nodes that leave a trail: a name or a glob
  int ghosts = 0;           // earlier poses that stay visible
  // The camera.
  std::string camera = "auto";
  std::string projection = "perspective";
  double zoom = 1.0;
  double orbit = 0.0;           // turns around the motion by so much during the film [deg]
  bool follow = false;          // keeps what is there in the picture, instead of the whole motion
  bool fit = false;             // the picture's shape is the motion's, with as many pixels
  double turntable = 0.0;       // after the motion one turn around its end that takes so long [s of film]
  double depth_of_field = 0.0;  // what is off the middle is blurred: the lens's opening over its distance
  // The film's pace.
  std::string pace = "time";  // "even": by the way that the nodes go, so that slow and quick parts last alike
  double easing = 0.0;        // the pace begins and ends at rest over so long [s of film]
  double hold = 1.0;          // the last picture stays for so long [s of film]
  double hold_start = 0.0;    // and the first one
  double title_card = 0.0;    // before it, the title alone for so long [s of film]
  double motion_blur = 0.0;   // how much of a frame's time its shutter is open
  std::vector<CameraKey> camera_keys;
  // Which films are made of the frames; changes no frame.
  bool webp = true, gif = true, mp4 = true;
  int gif_width = 640;  // frames that are wider are scaled down to it for the GIF [pixels]

  bool operator==(const RenderOptions&) const = default;
};

const std::vector<ParamSpec>& render_params();          // one row per key of [render]
const std::vector<ParamSpec>& camera_key_params();      // of an entry of [[render.camera_keys]]
CameraKey camera_key(const ParamSet& values);           // values: checked against them
ParamSet camera_key_values(const CameraKey& key);       // and back
const std::vector<ParamSpec>& material_params();        // of an entry of [[render.materials]]
RenderOptions render_options(const ParamSet& values);   // values: checked against render_params()
ParamSet render_values(const RenderOptions& options);   // the other way round
RenderOptions without_encoding(RenderOptions options);  // keys that change no frame at their defaults

}  // namespace unfurl
