// SPDX-License-Identifier: BSD-3-Clause
// The renderer's shaders (#version 330 core). Light is computed linearly and encoded for the screen at the
// end: an sRGB framebuffer would do the same at a third of the speed in software.
#pragma once

namespace unfurl::shaders {

// Places a body of revolution (solid_mesh.hpp) between two points.
// With HIDDEN, for what is taken to be nearer than it is when depths are compared.
inline constexpr const char* version = "#version 330 core\n";
inline constexpr const char* version_hidden = "#version 330 core\n#define HIDDEN\n";
inline constexpr const char* solid_vertex = R"(
layout(location = 0) in vec3 offset;
layout(location = 1) in vec3 axis_normal;
layout(location = 2) in float end;
layout(location = 3) in vec3 point_a;
layout(location = 4) in vec3 point_b;
layout(location = 5) in vec2 radii;
layout(location = 6) in vec3 color;
layout(location = 7) in vec2 surface;
uniform mat4 view_projection;
uniform vec4 eye;  // the camera, or (w = 0) the direction to it
uniform float nearer;
out vec3 world;
out vec3 normal;
flat out vec3 axis;  // unit; zero for a ball
flat out vec3 albedo;
flat out vec2 metal_roughness;
out float along_axis;  // from a, in radii there
flat out float whole_axis;
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
  axis = span > 0.0 ? z : vec3(0.0);
  along_axis = dot(world - point_a, z) / radii.x;
  whole_axis = span / radii.x;
  gl_Position = view_projection * vec4(world, 1.0);
#ifdef HIDDEN
  vec4 moved = view_projection * vec4(world + nearer * normalize(eye.xyz - eye.w * world), 1.0);
  gl_Position.z = moved.z / moved.w * gl_Position.w;
#endif
})";

inline constexpr const char* depth_fragment = R"(#version 330 core
void main() {})";

// What the fragment stages of all looks begin with: inputs, the key light with its shadow and highlight, and
// the mist that tells near from far.
inline constexpr const char* solid_head = R"(#version 330 core
in vec3 world;
in vec3 normal;
flat in vec3 axis;
flat in vec3 albedo;
flat in vec2 metal_roughness;
in float along_axis;
flat in float whole_axis;
uniform vec4 eye;
uniform vec3 to_light;
uniform vec2 floor_height_reach;  // darkens what is nearer to the floor than `reach`
uniform vec4 background_top, background_bottom;
uniform float picture_height;
uniform vec3 fade_center;
uniform vec2 fade;  // radius, share of the background at the far side
uniform mat4 light_projection;
uniform sampler2DShadow shadow_map;
layout(location = 0) out vec4 color;

vec3 misty(vec3 c) {
  vec3 forward = normalize(fade_center * eye.w - eye.xyz);
  float behind = dot(world - fade_center, forward) / fade.x;
  vec3 mist = mix(background_bottom, background_top, gl_FragCoord.y / picture_height).rgb;
  return mix(c, mist, fade.y * smoothstep(-1.0, 1.0, behind));
}

float lit(vec3 p, vec3 n, float texel) {
  vec3 at = (light_projection * vec4(p + n * 1.5 * texel, 1.0)).xyz * 0.5 + 0.5;
  if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) return 1.0;
  float step = 0.6 / float(textureSize(shadow_map, 0).x);
  return 0.5 * (texture(shadow_map, at + vec3(step, step, 0.0)) + texture(shadow_map, at - vec3(step, step, 0.0)));
}

float key_light(vec3 n) {  // what arrives of it: by the angle and past what is in its way
  float texel = 2.0 / (length(light_projection[0].xyz) * float(textureSize(shadow_map, 0).x));
  float n_l = dot(n, to_light);
  return n_l > 0.0 ? n_l * lit(world, n, texel) : 0.0;
}

float highlight(vec3 n, vec3 v) {  // of the key light, as a rough metal shows it (GGX)
  float a2 = pow(metal_roughness.y, 4.0), n_h = max(dot(n, normalize(v + to_light)), 0.0);
  float d = n_h * n_h * (a2 - 1.0) + 1.0;
  return a2 / (3.14159 * d * d) * 0.25 / mix(max(dot(n, v), 0.02), 1.0, 0.5);
}

)";

// A key light with a soft shadow, the light of a bright room from everywhere and its reflection, less what is
// kept off: by the floor from below, and where rods meet by one another, the more the fewer radii away.
inline constexpr const char* studio_fragment = R"(
uniform int meets;  // other bodies: 0 nowhere, 1 at a, 2 at both ends

float open_to_room() {
  if (meets == 0 || whole_axis <= 0.0) return 1.0;
  float away = meets == 1 ? along_axis : min(along_axis, whole_axis - along_axis);
  return mix(0.15, 1.0, smoothstep(0.0, meets == 1 ? 4.5 : 14.0, away));
}

vec3 room(vec3 d) {  // what a mirror would show: a pale floor, a bright horizon, a lamp overhead
  vec3 c = mix(vec3(0.40, 0.41, 0.43), vec3(0.78, 0.84, 0.92), smoothstep(-0.35, 0.25, d.z));
  return c + vec3(1.3) * smoothstep(0.80, 0.98, dot(d, normalize(to_light + vec3(0.0, 0.0, 0.6))));
}

void main() {
  vec3 n = normalize(normal), v = normalize(eye.xyz - eye.w * world);
  float metal = metal_roughness.x, roughness = metal_roughness.y;
  float n_v = max(dot(n, v), 0.02), key = key_light(n);
  float occlusion = mix(0.55, 1.0, smoothstep(0.0, 1.0, (world.z - floor_height_reach.x) / floor_height_reach.y)) *
                    mix(0.75, 1.0, 0.5 + 0.5 * n.z) * open_to_room();
  key *= mix(0.6, 1.0, occlusion);
  vec3 ambient = mix(vec3(0.30, 0.29, 0.28), vec3(0.55, 0.60, 0.68), 0.5 + 0.5 * n.z) * occlusion;

  vec3 f0 = mix(vec3(0.04), albedo, metal);
  vec3 fresnel = f0 + (max(vec3(1.0 - roughness), f0) - f0) * pow(1.0 - n_v, 5.0);

  vec3 light = albedo * (1.0 - 0.75 * metal) * (ambient + 1.25 * vec3(1.0, 0.97, 0.92) * key);
  light += fresnel * room(reflect(-v, n)) * mix(0.4, 1.0, occlusion);
  light += f0 * min(highlight(n, v), 6.0) * key;
  light = light / (1.0 + 0.18 * light) * 1.12;  // rolls off what is brighter than paper
  color = vec4(misty(pow(clamp(light, 0.0, 1.0), vec3(1.0 / 2.2))), 1.0);
})";

// Sunlight in the dark: a hard key light, hardly anything from elsewhere, and a bright rim against the night.
inline constexpr const char* space_fragment = R"(
void main() {
  vec3 n = normalize(normal), v = normalize(eye.xyz - eye.w * world);
  float metal = metal_roughness.x;
  float n_v = max(dot(n, v), 0.02), key = key_light(n);
  vec3 f0 = mix(vec3(0.04), albedo, metal);
  vec3 planet = mix(vec3(0.05, 0.06, 0.09), vec3(0.10, 0.20, 0.38), 0.5 - 0.5 * n.z);
  vec3 light = albedo * (planet + 1.7 * key * vec3(1.0, 0.97, 0.93));
  light += f0 * min(highlight(n, v), 8.0) * key * 1.5;
  float behind = max(dot(n, normalize(vec3(-to_light.xy, 0.6))), 0.0);  // a second sun's glow at the edge
  light += (0.25 + 0.75 * behind) * pow(1.0 - n_v, 3.0) * mix(vec3(0.45, 0.70, 1.0), albedo, 0.3);
  light = light / (1.0 + 0.15 * light);
  color = vec4(misty(pow(clamp(light, 0.0, 1.0), vec3(1.0 / 2.2))), 1.0);
})";

// Flat colours in two tones, as if printed.
inline constexpr const char* flat_fragment = R"(
void main() {
  vec3 n = normalize(normal);
  float tone = mix(0.62, 1.0, smoothstep(-0.05, 0.20, dot(n, to_light)));
  color = vec4(misty(pow(albedo * tone, vec3(1.0 / 2.2))), 1.0);
})";

// A line along both sides of what is round. Where `hidden`, only that line, pale; else also the paper inside.
inline constexpr const char* outline_fragment = R"(
uniform int hidden;
uniform float line_width;  // [pixels]
void main() {
  vec3 n = normalize(normal), v = normalize(eye.xyz - eye.w * world);
  vec3 across = normalize(v - axis * dot(axis, v) + 1e-6 * n);
  float facing = clamp(dot(n, across), 0.0, 1.0);
  float inside = 1.0 - sqrt(max(1.0 - facing * facing, 0.0));  // 0 at the side, 1 in the middle
  if (abs(dot(n, axis)) > 0.3) inside = 1.0;                   // the flat end of a fitting
  float line = 1.0 - smoothstep(line_width - 0.5, line_width + 0.5, inside / max(fwidth(inside), 1e-6));
  vec3 hue = pow(albedo, vec3(1.0 / 2.2));
  vec3 ink = hue * 0.62;
  if (hidden == 1) {
    if (line < 0.02) discard;
    color = vec4(misty(mix(ink, vec3(1.0), 0.55)), 0.75 * line);
  } else {
    float filled = metal_roughness.x > 0.0 ? 0.10 : 1.0;  // what is painted is so here
    color = vec4(misty(mix(mix(vec3(1.0), hue, filled), ink, line)), 1.0);
  }
})";

// What is seen through: ghosts of other poses.
inline constexpr const char* ghost_fragment = R"(
void main() {
  vec3 n = normalize(normal);
  float opacity = metal_roughness.x;
  color = vec4(misty(pow(albedo, vec3(1.0 / 2.2)) * mix(0.85, 1.0, 0.5 + 0.5 * n.z)), opacity);
})";

// Two passes of a blur. Across: of the depth map, whatever is nearer to the light than the floor. Then along.
inline constexpr const char* shade_fragment = R"(#version 330 core
uniform int across, texels;  // of the depth map for one of the shade
uniform sampler2D depth, shade;
layout(location = 0) out float color;
void main() {
  if (across == 1) {
    ivec2 at = ivec2(gl_FragCoord.xy) * texels + ivec2(texels / 2);
    ivec2 last = textureSize(depth, 0) - 1;
    float sum = 0.0;
    for (int i = 0; i < 8; ++i) {  // on different rows, or a shadow along the rows would be dashed
      ivec2 p = clamp(at + ivec2(3 * i / 2 - 5, (3 * i & 3) - 2) * texels / 4, ivec2(0), last);
      sum += texelFetch(depth, p, 0).r < 1.0 ? 1.0 : 0.0;
    }
    color = sum / 8.0;
  } else {
    vec2 texel = 1.0 / vec2(textureSize(shade, 0)), at = gl_FragCoord.xy * texel;
    float sum = 0.0;
    for (int i = -3; i <= 3; i += 2) sum += texture(shade, at + vec2(0.0, 0.45 * float(i)) * texel).r;
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
uniform float picture_height, stars;
layout(location = 0) out vec4 color;
float scatter(vec2 p) { return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453); }
void main() {
  color = mix(background_bottom, background_top, gl_FragCoord.y / picture_height);
  if (stars > 0.0) {  // at most one in each cell of a grid
    float unit = picture_height / 720.0;
    vec2 at = gl_FragCoord.xy / (36.0 * unit), cell = floor(at);
    float luck = scatter(cell);
    vec2 place = vec2(scatter(cell + 17.0), scatter(cell + 43.0)) * 0.8 + 0.1;
    float away = length(at - cell - place) * 36.0;
    float bright = stars * smoothstep(0.45, 1.0, luck) * smoothstep(1.3, 0.2, away);
    color.rgb += bright * mix(vec3(0.75, 0.85, 1.0), vec3(1.0, 0.92, 0.8), scatter(cell + 5.0));
  }
})";

inline constexpr const char* ground_vertex = R"(#version 330 core
uniform mat4 view_projection;
uniform vec3 corner, side_u, side_v;  // of the part of the floor that is drawn
out vec2 world;
void main() {
  vec3 at = corner + side_u * float(gl_VertexID & 1) + side_v * float(gl_VertexID >> 1);
  world = at.xy;
  gl_Position = view_projection * vec4(at, 1.0);
})";

// The floor has the background's own colour, so that it has no edge: only grid and shadow tell where it is.
inline constexpr const char* grid_fragment = R"(#version 330 core
in vec2 world;
uniform vec2 center;
uniform float picture_height, reach, cell;
layout(location = 0) out vec4 color;

float lines(vec2 p, float pixels) {  // 1 on the lines of the unit grid
  vec2 width = fwidth(p);
  vec2 away = abs(fract(p - 0.5) - 0.5) / width;
  vec2 line = clamp(0.5 * pixels + 0.5 - away, 0.0, 1.0) * clamp(0.8 - width * 1.6, 0.0, 1.0);
  return max(line.x, line.y);
}

void main() {
  float fade = 1.0 - smoothstep(0.35, 1.0, length(world - center) / reach);
  float finer = max(1.0, picture_height / 720.0);  // lines as wide for the eye in pictures of any size
  float grid = max(0.20 * lines(world / cell, 1.1 * finer), 0.34 * lines(world / (5.0 * cell), 1.3 * finer));
  color = vec4(0.36, 0.44, 0.54, grid * fade);
})";

inline constexpr const char* floor_shadow_fragment = R"(#version 330 core
in vec2 world;
uniform float floor_height, reach;
uniform vec2 center;
uniform mat4 light_projection;
uniform sampler2D shade;
layout(location = 0) out vec4 color;
void main() {
  float fade = 1.0 - smoothstep(0.35, 1.0, length(world - center) / reach);
  vec2 at = (light_projection * vec4(world, floor_height, 1.0)).xy * 0.5 + 0.5;
  color = vec4(0.045, 0.11, 0.23, 0.42 * fade * texture(shade, at).r);
})";

}  // namespace unfurl::shaders
