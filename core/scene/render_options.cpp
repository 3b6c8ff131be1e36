#include "core/scene/render_options.hpp"

#include <utility>
#include <variant>

namespace unfurl {

namespace {

struct SizeMembers {};  // width and height
template <class T>
using Of = T RenderOptions::*;
using Member = std::variant<SizeMembers, Of<bool>, Of<int>, Of<double>, Of<std::string>>;

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
  };
  std::visit(Writer{options, key.spec.name, values}, key.member);
}

ParamSpec size_param() {
  ParamSpec size = vector_param("size", "pixels", {0, 0}, "width and height of the pictures");
  size.min = 16;
  size.max = 8192;
  return size;
}

std::vector<Key> make_keys() {
  using R = RenderOptions;
  return {
      {size_param(), SizeMembers{}},
      {real_param("fps", "frames/s", 0, 0.1, 1000, "frames per second of the film"), &R::fps},
      {real_param("speed", "", 0, 1e-6, 1e6, "seconds of motion per second of film"), &R::speed},
      {integer_param("supersample", 0, 1, 4, "every pixel is the mean of N x N"), &R::supersample},
      {boolean_param("transparent", false, "no background"), &R::transparent},
      {choice_param("look", "", {"studio", "space", "blueprint", "print"},
                    "how everything looks; `unfurl list looks`"),
       &R::look},
      {boolean_param("webp", false, "make animation.webp"), &R::webp, false},
      {boolean_param("gif", false, "make animation.gif"), &R::gif, false},
      {boolean_param("mp4", false, "make animation.mp4 where ffmpeg is"), &R::mp4, false},
      {integer_param("gif_width", 0, 16, 8192, "the GIF is at most so many pixels wide"), &R::gif_width,
       false},
  };
}

const std::vector<Key>& keys() {
  static const std::vector<Key> rows = [] {
    std::vector<Key> all = make_keys();
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
