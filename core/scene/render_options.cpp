// SPDX-License-Identifier: BSD-3-Clause
#include "core/scene/render_options.hpp"

#include <utility>
#include <variant>

namespace unfurl {

namespace {

struct SizeMembers {};  // width and height
template <class T>
using Of = T RenderOptions::*;
using Range = std::array<double, 2>;
using Member = std::variant<SizeMembers, Of<bool>, Of<int>, Of<double>, Of<std::string>, Of<Range>>;

struct Key {
  ParamSpec spec;  // the default is filled in from RenderOptions
  Member member;
  bool changes_frames = true;
};

ParamValue value_of(const RenderOptions& options, const Member& member) {
  struct Reader {
    const RenderOptions& o;
    ParamValue operator()(SizeMembers) const {
      return std::vector<double>{static_cast<double>(o.width), static_cast<double>(o.height)};
    }
    ParamValue operator()(Of<int> m) const { return static_cast<long>(o.*m); }
    ParamValue operator()(Of<bool> m) const { return o.*m; }
    ParamValue operator()(Of<double> m) const { return o.*m; }
    ParamValue operator()(Of<std::string> m) const { return o.*m; }
    ParamValue operator()(Of<Range> m) const { return std::vector<double>{(o.*m)[0], (o.*m)[1]}; }
  };
  return std::visit(Reader{options}, member);
}

void assign(RenderOptions& options, const Key& key, const ParamSet& values) {
  struct Writer {
    RenderOptions& o;
    std::string_view name;
    const ParamSet& values;
    void operator()(SizeMembers) const {
      o.width = static_cast<int>(values.vector(name)[0]);
      o.height = static_cast<int>(values.vector(name)[1]);
    }
    void operator()(Of<int> m) const { o.*m = static_cast<int>(values.integer(name)); }
    void operator()(Of<bool> m) const { o.*m = values.boolean(name); }
    void operator()(Of<double> m) const { o.*m = values.real(name); }
    void operator()(Of<std::string> m) const { o.*m = values.text(name); }
    void operator()(Of<Range> m) const { o.*m = {values.vector(name)[0], values.vector(name)[1]}; }
  };
  std::visit(Writer{options, key.spec.name, values}, key.member);
}

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
      {size_param(), SizeMembers{}},
      {real_param("fps", "frames/s", 0, 0.1, 1000, "frames per second of the film"), &R::fps},
      {real_param("speed", "", 0, 1e-6, 1e6, "seconds of motion per second of film"), &R::speed},
      {integer_param("supersample", 0, 1, 4, "every pixel is the mean of N x N"), &R::supersample},
      {boolean_param("transparent", false, "no background"), &R::transparent},
      {choice_param("look", "", {"studio", "dark", "space", "blueprint", "print"},
                    "how everything looks; `unfurl list looks`"),
       &R::look},
      {choice_param("colour_by", "",
                    {"group", "axial_force", "stress", "buckling", "speed", "constraint_error"},
                    "what the colours of the rods stand for"),
       &R::colour_by},
      {vector_param("colour_range", "", {0, 0},
                    "from which value to which the colours run; [0, 0]: the run's"),
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
      {boolean_param("loads", false, "forces as arrows"), &R::loads},
      {boolean_param("method", false, "the method and its step"), &R::method},
      {boolean_param("errors", false, "largest constraint error and energy imbalance so far"), &R::errors},
      {boolean_param("scale_bar", false, "a length to compare with"), &R::scale_bar},
      {boolean_param("axes", false, "the directions of x, y and z"), &R::axes},
      {boolean_param("dimensions", false, "width, depth and height (always on in the look blueprint)"),
       &R::dimensions},
      {boolean_param("node_labels", false, "names of nodes, where there is room"), &R::node_labels},
      {boolean_param("rod_labels", false, "names of rods, where there is room"), &R::rod_labels},
      {text_param("inset", "", "a column of series.csv, drawn as a small figure that grows with the film"),
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
      {real_param("depth_of_field", "", 0, 0, 1,
                  "blurs what is off the middle: the lens's opening over its distance; 0.02 is much"),
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
      {boolean_param("webp", false, "make animation.webp"), &R::webp, false},
      {boolean_param("gif", false, "make animation.gif"), &R::gif, false},
      {boolean_param("mp4", false, "make animation.mp4 where ffmpeg is"), &R::mp4, false},
      {integer_param("gif_width", 0, 16, 8192, "the GIF is at most so many pixels wide"), &R::gif_width,
       false},
  };
}

const std::vector<Key>& keys() {
  static const std::vector<Key> rows = [] {
    std::vector<Key> all = picture_keys();
    for (const auto& more : {overlay_keys(), camera_keys(), pace_keys(), film_keys()})
      all.insert(all.end(), more.begin(), more.end());
    for (Key& key : all) key.spec.fallback = value_of(RenderOptions{}, key.member);
    return all;
  }();
  return rows;
}

}  // namespace

const std::vector<ParamSpec>& render_params() {
  static const std::vector<ParamSpec> params = [] {
    std::vector<ParamSpec> specs;
    for (const Key& key : keys()) specs.push_back(key.spec);
    return specs;
  }();
  return params;
}

const std::vector<ParamSpec>& camera_key_params() {
  static const CameraKey fallback;
  static const std::vector<ParamSpec> params = [] {
    ParamSpec time = real_param("time", "s", 0, 0, 1e9, "of the motion");
    time.required = true;
    return std::vector<ParamSpec>{
        time, real_param("azimuth", "deg", fallback.azimuth, -36000, 36000, "from the x axis towards y"),
        real_param("elevation", "deg", fallback.elevation, -90, 90, "above the floor"),
        real_param("zoom", "", fallback.zoom, 0.05, 50, "1 shows the whole motion")};
  }();
  return params;
}

const std::vector<ParamSpec>& material_params() {
  static const std::vector<ParamSpec> params = [] {
    ParamSpec group = text_param("group", "", "of rods: a name or a glob");
    group.required = true;
    ParamSpec material = choice_param("material", "anodised", material_names(), "what they are made of");
    material.required = true;
    return std::vector<ParamSpec>{group, material};
  }();
  return params;
}

RenderOptions render_options(const ParamSet& values) {
  RenderOptions options;
  for (const Key& key : keys()) assign(options, key, values);
  return options;
}

ParamSet render_values(const RenderOptions& options) {
  ParamSet values;
  for (const Key& key : keys()) values.set(key.spec.name, value_of(options, key.member));
  return values;
}

RenderOptions without_encoding(RenderOptions options) {
  const ParamSet defaults(render_params());
  for (const Key& key : keys())
    if (!key.changes_frames) assign(options, key, defaults);
  return options;
}

}  // namespace unfurl
