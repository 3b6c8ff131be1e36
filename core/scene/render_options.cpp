// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/render_options.hpp"

#include "core/text/param_binding.hpp"

namespace unfurl {

namespace {

using Key = BoundParam<RenderOptions>;

ParamSpec size_param() {
  ParamSpec size = vector_param("size", "pixels", {0, 0}, "width and height of the pictures");
  size.min = 16;
  size.max = 8192;
  return size;
}

using R = RenderOptions;

std::vector<std::string_view> material_names() {
  return {"anodised", "paint", "cfrp", "aluminium", "steel", "gold"};
}

std::vector<Key> picture_keys() {
  return {
      {size_param(), Key::IntPair{&R::width, &R::height}},
      {real_param("fps", "frames/s", 0, 0.1, 1000, "frames per second of the film"), &R::fps},
      {real_param("speed", "", 0, 1e-6, 1e6, "seconds of motion per second of film"), &R::speed},
      {integer_param("supersample", 0, 1, 4, "every pixel is the mean of N x N"), &R::supersample},
      {only_with("look", {"studio", "dark", "space", "blueprint"},
                 boolean_param("transparent", false, "no background")),
       &R::transparent},
      {choice_param("look", "", {"studio", "dark", "space", "blueprint", "print"},
                    "how everything looks; `unfurl list looks`"),
       &R::look},
      {choice_param("colour_by", "",
                    {"group", "axial_force", "stress", "buckling", "speed", "constraint_error"},
                    "what the colours of the rods stand for; axial_force: of cables and springs, too"),
       &R::colour_by},
      {only_with("colour_by", {"axial_force", "stress", "buckling", "speed", "constraint_error"},
                 vector_param("colour_range", "", {0, 0},
                              "from which value to which the colours run; [0, 0]: the run's")),
       &R::colour_range},
      {real_param(
           "rod_scale", "", 0, 0, 1000,
           "rods are drawn so many times as thick as they are, 1 = true; 0: no thinner than can be seen"),
       &R::rod_scale},
      {choice_param("material", "", material_names(), "what rods are made of in the pictures"), &R::material},
  };
}

std::vector<Key> overlay_keys() {
  return {
      {boolean_param("title", false, "the scene's title"), &R::title},
      {boolean_param("time", false, "time and deployed fraction"), &R::time},
      {boolean_param("legend", false, "what the colours mean"), &R::legend},
      {boolean_param("loads", false, "constant forces ([[loads]]) as arrows"), &R::loads},
      {boolean_param("method", false, "the method and its step"), &R::method},
      {boolean_param("errors", false, "largest constraint error and energy imbalance so far"), &R::errors},
      {boolean_param("scale_bar", false, "a length to compare with"), &R::scale_bar},
      {boolean_param("axes", false, "the directions of x, y and z"), &R::axes},
      {only_with(
           "look", {"studio", "dark", "space", "print"},
           boolean_param("dimensions", false, "width, depth and height (always on in the look blueprint)")),
       &R::dimensions},
      {boolean_param("node_labels", false, "names of nodes, where there is room"), &R::node_labels},
      {boolean_param("rod_labels", false, "names of rods, where there is room"), &R::rod_labels},
      {text_param("inset", "",
                  "a column of series.csv, drawn as a small figure that grows with the film, where the "
                  "picture has room beside or above the structure"),
       &R::inset},
      {text_param("trails", "", "nodes that leave a trail: a name or a glob"), &R::trails},
      {integer_param("ghosts", 0, 0, 50, "earlier poses that stay visible"), &R::ghosts},
  };
}

std::vector<Key> camera_keys() {
  return {
      {choice_param("camera", "", {"auto", "iso", "front", "top", "side"}, "from where the motion is seen"),
       &R::camera},
      {choice_param("projection", "", {"perspective", "orthographic"}, "how depth is drawn"), &R::projection},
      {real_param("zoom", "", 0, 0.05, 50, "1 shows the whole motion, 2 half of its width"), &R::zoom},
      {real_param("orbit", "deg", 0, -36000, 36000, "the camera's turn around the motion during the film"),
       &R::orbit},
      {boolean_param("follow", false, "frame what is there, instead of the whole motion"), &R::follow},
      {real_param("turntable", "s", 0, 0, 3600,
                  "after the motion one turn around its end in so much film time"),
       &R::turntable},
      {boolean_param("fit", false, "the picture's shape is the motion's, with as many pixels"), &R::fit},
      {only_with(
           "projection", {"perspective"},
           real_param("depth_of_field", "", 0, 0, 1,
                      "blurs what is off the middle: the lens's opening over its distance; 0.02 is much")),
       &R::depth_of_field},
  };
}

std::vector<Key> pace_keys() {
  return {
      {choice_param("pace", "", {"time", "even"},
                    "film time runs with time, or evenly with the way that the nodes go"),
       &R::pace},
      {real_param("easing", "s", 0, 0, 60,
                  "the motion's pace begins and ends at rest over so much film time"),
       &R::easing},
      {real_param("hold", "s", 0, 0, 3600, "film time for which the last picture stays"), &R::hold},
      {real_param("hold_start", "s", 0, 0, 3600, "film time for which the first picture stays"),
       &R::hold_start},
      {real_param("title_card", "s", 0, 0, 60, "film time of a card with the title before all else"),
       &R::title_card},
      {real_param("motion_blur", "", 0, 0, 1, "share of a frame's time for which its shutter is open"),
       &R::motion_blur},
  };
}

std::vector<Key> film_keys() {
  return {
      {boolean_param("webp", false, "make animation.webp"), &R::webp},
      {boolean_param("gif", false, "make animation.gif"), &R::gif},
      {boolean_param("mp4", false, "make animation.mp4 where ffmpeg is"), &R::mp4},
      {only_with("gif", {"true"},
                 integer_param("gif_width", 0, 16, 8192, "the GIF is at most so many pixels wide")),
       &R::gif_width},
  };
}

const ParamBinding<RenderOptions>& keys() {
  static const ParamBinding<RenderOptions> rows([] {
    std::vector<Key> all = picture_keys();
    for (const auto& more : {overlay_keys(), camera_keys(), pace_keys(), film_keys()})
      all.insert(all.end(), more.begin(), more.end());
    return all;
  }());
  return rows;
}

const ParamBinding<CameraKey>& keys_of_camera_key() {
  using C = CameraKey;
  static const ParamBinding<C> rows({
      {required(real_param("time", "s", 0, 0, 1e9, "of the motion")), &C::time},
      {real_param("azimuth", "deg", 0, -36000, 36000, "from the x axis towards y"), &C::azimuth},
      {real_param("elevation", "deg", 0, -90, 90, "above the floor"), &C::elevation},
      {real_param("zoom", "", 0, 0.05, 50, "1 shows the whole motion"), &C::zoom},
  });
  return rows;
}

}  // namespace

const std::vector<ParamSpec>& render_params() {
  return keys().specs();
}
const std::vector<ParamSpec>& camera_key_params() {
  return keys_of_camera_key().specs();
}

const std::vector<ParamSpec>& material_params() {
  static const std::vector<ParamSpec> params = [] {
    return std::vector<ParamSpec>{
        required(text_param("group", "", "of rods: a name or a glob")),
        required(choice_param("material", "anodised", material_names(), "what they are made of"))};
  }();
  return params;
}

RenderOptions render_options(const ParamSet& values) {
  return keys().read(values);
}
ParamSet render_values(const RenderOptions& options) {
  return keys().values(options);
}
CameraKey camera_key(const ParamSet& values) {
  return keys_of_camera_key().read(values);
}
ParamSet camera_key_values(const CameraKey& key) {
  return keys_of_camera_key().values(key);
}

RenderOptions without_encoding(RenderOptions options) {
  const ParamSet defaults(render_params());
  for (const Key& key : film_keys()) key.assign(options, defaults);
  return options;
}

}  // namespace unfurl
