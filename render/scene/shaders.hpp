// The renderer's shaders (#version 330 core). Light is computed linearly and encoded for the screen at the
// end: an sRGB framebuffer would do the same at a third of the speed in software.
#pragma once

namespace unfurl::shaders {

// Places a body of revolution (solid_mesh.hpp) between two points.
inline constexpr const char* solid_vertex = R"(#version 330 core
layout(location = 0) in vec3 offset;
layout(location = 1) in vec3 axis_normal;
layout(location = 2) in float end;
layout(location = 3) in vec3 point_a;
layout(location = 4) in vec3 point_b;
layout(location = 5) in vec2 radii;
layout(location = 6) in vec3 color;
layout(location = 7) in vec2 surface;
uniform mat4 view_projection;
out vec3 world;
out vec3 normal;
flat out vec3 albedo;
flat out vec2 metal_roughness;
void main() {
  vec3 along = point_b - point_a;
  float span = length(along);
  vec3 z = span > 0.0 ? along / span : vec3(0.0, 0.0, 1.0);
  vec3 x = normalize(cross(abs(z.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0), z));
  vec3 y = cross(z, x);
  world = mix(point_a, point_b, end) + mix(radii.x, radii.y, end) * (x * offset.x + y * offset.y + z * offset.z);
  float tilt = span > 0.0 ? (radii.x - radii.y) / span : 0.0;  // of a cone's side
  normal = x * axis_normal.x + y * axis_normal.y + z * (axis_normal.z + tilt * length(axis_normal.xy));
  albedo = pow(color, vec3(2.2));
  metal_roughness = surface;
  gl_Position = view_projection * vec4(world, 1.0);
})";

inline constexpr const char* depth_fragment = R"(#version 330 core
void main() {})";

// A key light with a soft shadow, the light of a bright room from everywhere, its reflection, and the floor's
// darkening from below.
inline constexpr const char* solid_fragment = R"(#version 330 core
in vec3 world;
in vec3 normal;
flat in vec3 albedo;
flat in vec2 metal_roughness;
uniform vec3 eye, to_light;
uniform vec2 floor_height_reach;  // darkens what is nearer to the floor than `reach`
uniform mat4 light_projection;
uniform sampler2DShadow shadow_map;
layout(location = 0) out vec4 color;

float lit(vec3 p, vec3 n, float texel) {
  vec3 at = (light_projection * vec4(p + n * 1.5 * texel, 1.0)).xyz * 0.5 + 0.5;
  if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) return 1.0;
  vec2 step = 0.75 / vec2(textureSize(shadow_map, 0));
  return 0.25 * (texture(shadow_map, at + vec3(step, 0.0)) + texture(shadow_map, at - vec3(step, 0.0)) +
                 texture(shadow_map, at + vec3(step.x, -step.y, 0.0)) +
                 texture(shadow_map, at + vec3(-step.x, step.y, 0.0)));
}

vec3 room(vec3 d) {  // what a mirror would show: a pale floor, a bright horizon, a lamp overhead
  vec3 c = mix(vec3(0.40, 0.41, 0.43), vec3(0.78, 0.84, 0.92), smoothstep(-0.35, 0.25, d.z));
  return c + vec3(1.3) * smoothstep(0.80, 0.98, dot(d, normalize(to_light + vec3(0.0, 0.0, 0.6))));
}

void main() {
  vec3 n = normalize(normal), v = normalize(eye - world);
  float metal = metal_roughness.x, roughness = metal_roughness.y;
  float texel = 2.0 / (length(light_projection[0].xyz) * float(textureSize(shadow_map, 0).x));
  float n_l = dot(n, to_light), n_v = max(dot(n, v), 0.02);
  float key = n_l > 0.0 ? n_l * lit(world, n, texel) : 0.0;
  float occlusion = mix(0.55, 1.0, smoothstep(0.0, 1.0, (world.z - floor_height_reach.x) / floor_height_reach.y)) *
                    mix(0.75, 1.0, 0.5 + 0.5 * n.z);
  vec3 ambient = mix(vec3(0.30, 0.29, 0.28), vec3(0.55, 0.60, 0.68), 0.5 + 0.5 * n.z) * occlusion;

  vec3 f0 = mix(vec3(0.04), albedo, metal);
  vec3 h = normalize(v + to_light);
  float a2 = pow(roughness, 4.0), n_h = max(dot(n, h), 0.0);
  float d = n_h * n_h * (a2 - 1.0) + 1.0;
  float highlight = a2 / (3.14159 * d * d) * 0.25 / mix(n_v, 1.0, 0.5);
  vec3 fresnel = f0 + (max(vec3(1.0 - roughness), f0) - f0) * pow(1.0 - n_v, 5.0);

  vec3 light = albedo * (1.0 - 0.75 * metal) * (ambient + 1.25 * vec3(1.0, 0.97, 0.92) * key);
  light += fresnel * room(reflect(-v, n)) * mix(0.6, 1.0, occlusion);
  light += f0 * min(highlight, 6.0) * key;
  light = light / (1.0 + 0.18 * light) * 1.12;  // rolls off what is brighter than paper
  color = vec4(pow(clamp(light, 0.0, 1.0), vec3(1.0 / 2.2)), 1.0);
})";

// Two passes of a blur. Across: of the depth map, whatever is nearer to the light than the floor. Then along.
inline constexpr const char* shade_fragment = R"(#version 330 core
uniform int across;
uniform sampler2DShadow depth;
uniform sampler2D shade;
layout(location = 0) out float color;
void main() {
  float side = float(textureSize(depth, 0).x);
  vec2 at = gl_FragCoord.xy * 4.0 / side;  // four texels of depth for one of shade
  float sum = 0.0;
  if (across == 1) {
    for (int i = 0; i < 6; ++i) sum += texture(depth, vec3(at + vec2(2.0 * float(i) - 5.0, 0.0) / side, 0.99999));
    color = 1.0 - sum / 6.0;
  } else {
    for (int i = 0; i < 4; ++i) sum += texture(shade, at + vec2(0.0, 3.0 * float(i) - 4.5) / side).r;
    color = 0.25 * sum;
  }
})";

inline constexpr const char* background_vertex = R"(#version 330 core
void main() {  // one triangle over the whole picture, behind everything
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(corner, 1.0, 1.0);
})";

inline constexpr const char* background_fragment = R"(#version 330 core
uniform vec4 background_top, background_bottom;
uniform float picture_height;
layout(location = 0) out vec4 color;
void main() { color = mix(background_bottom, background_top, gl_FragCoord.y / picture_height); })";

inline constexpr const char* ground_vertex = R"(#version 330 core
uniform mat4 view_projection;
uniform vec3 center;
uniform float reach;
out vec2 world;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  world = center.xy + corner * reach;
  gl_Position = view_projection * vec4(world, center.z, 1.0);
})";

// The floor has the background's own colour, so that it has no edge: only shadow and grid tell where it is.
inline constexpr const char* ground_fragment = R"(#version 330 core
in vec2 world;
uniform vec4 background_top, background_bottom;
uniform float picture_height;
uniform vec3 center;
uniform float reach, cell;
uniform mat4 light_projection;
uniform sampler2D shade;
layout(location = 0) out vec4 color;

float lit(vec3 p) {  // the map's edge is lit, and continues
  return 1.0 - texture(shade, (light_projection * vec4(p, 1.0)).xy * 0.5 + 0.5).r;
}

float lines(vec2 p, float pixels) {  // 1 on the lines of the unit grid
  vec2 width = fwidth(p);
  vec2 away = abs(fract(p - 0.5) - 0.5) / width;
  vec2 line = clamp(0.5 * pixels + 0.5 - away, 0.0, 1.0) * clamp(0.8 - width * 1.6, 0.0, 1.0);
  return max(line.x, line.y);
}

void main() {
  float fade = 1.0 - smoothstep(0.35, 1.0, length(world - center.xy) / reach);
  vec3 paper = mix(background_bottom, background_top, gl_FragCoord.y / picture_height).rgb;
  float grid = max(0.20 * lines(world / cell, 1.1), 0.34 * lines(world / (5.0 * cell), 1.3));
  paper = mix(paper, vec3(0.36, 0.44, 0.54), grid * fade);
  if (fade > 0.0) paper *= mix(vec3(1.0), mix(vec3(0.60, 0.63, 0.68), vec3(1.0), lit(vec3(world, center.z))), fade);
  color = vec4(paper, 1.0);
})";

}  // namespace unfurl::shaders
