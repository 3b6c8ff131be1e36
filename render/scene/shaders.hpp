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
layout(location = 8) in vec3 side;  // of a plate; else zero
uniform mat4 view_projection;
uniform vec4 eye;  // the camera, or (w = 0) the direction to it
uniform float nearer;
uniform float pixel;  // its height, where w = 1 [m]
centroid out vec3 world;  // not beyond the edge, where there is nothing to be lit
centroid out vec3 normal;
flat out vec3 axis;  // unit; zero for a ball
flat out vec3 albedo;
flat out vec3 material;  // metal, roughness, and the radius [m]
out float along_axis;  // from a, in radii there
flat out float whole_axis;
void main() {
  vec3 along = point_b - point_a;
  float span = length(along);
  vec3 z = span > 0.0 ? along / span : vec3(0.0, 0.0, 1.0);
  bool plate = dot(side, side) > 0.0, ribbon = end > 1.5;
  float e = ribbon ? end - 2.0 : end;
  vec3 middle = mix(point_a, point_b, e), x, y;
  if (ribbon) {  // between its two sides as they are seen
    y = eye.xyz - eye.w * middle;
    y = normalize(y - z * dot(y, z));
    x = cross(y, z);
  } else {
    x = normalize(plate ? side : cross(abs(z.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0), z));
    y = cross(z, x);
  }
  vec3 scale = plate ? radii.yxx : vec3(mix(radii.x, radii.y, e));
  // Samples would take turns in missing what is thinner than a pixel.
  if (ribbon && !plate) scale.x = max(scale.x, 0.5 * pixel * (view_projection * vec4(middle, 1.0)).w);
  vec3 n = axis_normal;
  if (plate && ribbon) {  // its face or its edge, whichever more is seen of
    vec3 wide = cross(side, z);
    float face = radii.x * abs(dot(wide, x)), edge = radii.y * abs(dot(side, x));
    scale.x = face + edge;
    n = face > edge ? side * sign(dot(side, y)) : wide * sign(dot(wide, y));
  }
  world = middle + x * offset.x * scale.x + y * offset.y * scale.y + z * offset.z * scale.z;
  float tilt = span > 0.0 && !plate ? (radii.x - radii.y) / span : 0.0;  // of a cone's side
  normal = plate && ribbon ? n : x * n.x + y * n.y + z * (n.z + tilt * length(n.xy));
  albedo = pow(color, vec3(2.2));
  material = vec3(surface, plate ? 0.0 : scale.x);
  axis = span > 0.0 ? z : vec3(0.0);
  along_axis = dot(world - point_a, z) / radii.x;
  whole_axis = span / radii.x;
  gl_Position = view_projection * vec4(world, 1.0);
  float lift = ribbon ? 0.6 * scale.x : 0.0;  // as near as the middle of what it stands for
#ifdef HIDDEN
  lift += nearer;
#endif
  if (lift > 0.0) {
    vec4 moved = view_projection * vec4(world + lift * normalize(eye.xyz - eye.w * world), 1.0);
    gl_Position.z = moved.z / moved.w * gl_Position.w;
  }
})";

inline constexpr const char* depth_fragment = R"(#version 330 core
void main() {})";

// What the fragment stages of all looks begin with: inputs, the key light with its shadow and highlight, and
// the mist that tells near from far.
inline constexpr const char* solid_head = R"(#version 330 core
centroid in vec3 world;
centroid in vec3 normal;
flat in vec3 axis;
flat in vec3 albedo;
flat in vec3 material;
in float along_axis;
flat in float whole_axis;
uniform vec4 eye;
uniform vec3 to_light;
uniform vec2 floor_height_reach;  // darkens what is nearer to the floor than `reach`
uniform vec4 background_top, background_bottom;
uniform float picture_height;
uniform vec3 fade_center;
uniform vec3 mist_way;  // away from the camera, over the radius of what it shows
uniform float mist;     // share of the background at the far side
uniform float texel;    // of the shadow map [m]
uniform mat4 light_projection;
uniform sampler2DShadow shadow_map;
layout(location = 0) out vec4 color;

// Facets stand for a round body: across the line of sight a point is where it seems to be, along it on the
// circle.
vec3 place;
vec3 round_normal(vec3 v) {
  vec3 toward = v - axis * dot(v, axis);
  toward *= inversesqrt(max(dot(toward, toward), 1e-12));
  float had = dot(normal, toward);
  vec3 rest = normal - had * toward;
  vec3 pixel = fwidth(normal);  // at its sides nothing is seen as slanted as the edge itself
  float has = sqrt(max(1.0 - dot(rest, rest), min(0.8 * max(max(pixel.x, pixel.y), pixel.z), 0.4)));
  if (had < -0.05) has = -has;
  place = world + toward * (material.z * (has - had));
  return normalize(rest + has * toward);
}

vec3 misty(vec3 c) {
  float behind = dot(place - fade_center, mist_way);
  vec3 ground = mix(background_bottom, background_top, gl_FragCoord.y / picture_height).rgb;
  return mix(c, ground, mist * smoothstep(-1.0, 1.0, behind));
}

// As pow(c, 1 / 2.2) to a quarter of a step of eight bits, at a third of its price in software.
vec3 encoded(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  vec3 root = sqrt(c);
  return 1.08403 * root + 0.050876 * sqrt(root) + c * (0.0902063 * root - 0.2241657);
}

float lit(vec3 p, vec3 n) {
  vec3 at = (light_projection * vec4(p + n * 1.5 * texel, 1.0)).xyz * 0.5 + 0.5;
  if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) return 1.0;
  float step = 0.6 / float(textureSize(shadow_map, 0).x);
  return 0.5 * (texture(shadow_map, at + vec3(step, step, 0.0)) + texture(shadow_map, at - vec3(step, step, 0.0)));
}

float key_light(vec3 n) {  // what arrives of it: by the angle and past what is in its way
  float n_l = dot(n, to_light);
  return n_l > 0.0 ? n_l * lit(place, n) : 0.0;
}

// Rougher where the normal turns within a pixel: else what is thin glitters (Kaplanyan et al., Filtering
// distributions of normals for shading antialiasing, 2016).
float rough_alpha(vec3 n) {
  vec3 dx = dFdx(n), dy = dFdy(n);
  float alpha = material.y * material.y;
  return sqrt(min(alpha * alpha + min(0.5 * (dot(dx, dx) + dot(dy, dy)), 0.35), 1.0));
}

float highlight(vec3 n, vec3 v, float alpha) {  // of the key light, as a rough metal shows it (GGX)
  float a2 = alpha * alpha, n_h = max(dot(n, normalize(v + to_light)), 0.0);
  float d = n_h * n_h * (a2 - 1.0) + 1.0;
  return a2 / (3.14159 * d * d) * 0.25 / mix(max(dot(n, v), 0.02), 1.0, 0.5);
}

)";

// A key light with a soft shadow, the light of a bright room from everywhere and its reflection, less what is
// kept off: by the floor from below, and where rods meet by one another, the more the fewer radii away.
inline constexpr const char* studio_fragment = R"(
uniform vec3 lamp, strip;  // directions
uniform int meets;  // other bodies: 0 nowhere, 1 at a, 2 at both ends

float open_to_room() {
  if (meets == 0 || whole_axis <= 0.0) return 1.0;
  float away = meets == 1 ? along_axis : min(along_axis, whole_axis - along_axis);
  return mix(0.15, 1.0, smoothstep(0.0, meets == 1 ? 4.5 : 14.0, away));
}

// The studio as a small sky: a floor that throws light back, walls that grow brighter upwards, a wide lamp
// overhead on the key light's side and a strip of light low on the other. `blur`: 0 a mirror's, 1 a matt one's.
vec3 room(vec3 d, float blur) {
  float edge = 0.05 + 0.5 * blur;
  vec3 c = mix(vec3(0.36, 0.36, 0.37), vec3(0.74, 0.80, 0.88), smoothstep(-0.2 - edge, 0.1 + edge, d.z));
  c *= mix(1.0, 0.55, smoothstep(0.02, 0.10 + edge, d.z) * (1.0 - smoothstep(0.12, 0.45 + edge, d.z)));
  c += vec3(2.1, 2.05, 1.95) * smoothstep(0.88 - edge, 0.92 + 0.5 * edge, dot(d, lamp)) / (1.0 + 3.0 * blur);
  c += vec3(0.75, 0.85, 1.0) * smoothstep(0.90 - edge, 0.94 + 0.5 * edge, dot(d, strip)) / (1.0 + 4.0 * blur);
  return c;
}

void main() {
  vec3 v = normalize(eye.xyz - eye.w * world), n = round_normal(v);
  float metal = material.x, alpha = rough_alpha(n), roughness = sqrt(alpha);
  float n_v = max(dot(n, v), 0.02), key = key_light(n);
  float occlusion = mix(0.45, 1.0, smoothstep(0.0, 1.0, (world.z - floor_height_reach.x) / floor_height_reach.y)) *
                    mix(0.72, 1.0, 0.5 + 0.5 * n.z) * open_to_room();
  key *= mix(0.6, 1.0, occlusion);
  vec3 ambient = mix(vec3(0.27, 0.26, 0.25), vec3(0.52, 0.57, 0.65), 0.5 + 0.5 * n.z) * occlusion;

  vec3 f0 = mix(vec3(0.04), albedo, metal);
  float grazing = 1.0 - n_v, g2 = grazing*grazing;
  vec3 fresnel = f0 + (max(vec3(1.0 - roughness), f0) - f0) * (g2 * g2 * grazing);

  vec3 light = albedo * (1.0 - 0.75 * metal) * (ambient + 1.45 * vec3(1.0, 0.96, 0.90) * key);
  light += fresnel * room(reflect(-v, n), roughness) * mix(0.35, 1.0, occlusion);
  light += f0 * min(highlight(n, v, alpha), 6.0) * key;
  light = light / (1.0 + 0.20 * light) * 1.13;  // rolls off what is brighter than paper
  color = vec4(misty(encoded(light)), 1.0);
})";

// Sunlight in the dark: a hard key light, hardly anything from elsewhere, and a bright rim against the night.
inline constexpr const char* space_fragment = R"(
uniform vec4 planet;  // direction to its middle, cosine of half its width
uniform vec3 to_eye;  // from the middle of the picture
void main() {
  vec3 v = normalize(eye.xyz - eye.w * world), n = round_normal(v);
  float metal = material.x, alpha = rough_alpha(n);
  float n_v = max(dot(n, v), 0.02), key = key_light(n);
  vec3 f0 = mix(vec3(0.04), albedo, metal);
  float below = 0.5 + 0.5 * dot(n, planet.xyz);
  vec3 shine = vec3(0.16, 0.25, 0.40) * below * below;                         // of the Earth
  float fill = 0.16 * (0.25 + 0.75 * max(dot(n, normalize(to_eye + vec3(0.0, 0.0, 0.35))), 0.0));
  vec3 light = albedo * (shine + fill + 1.35 * key * vec3(1.0, 0.97, 0.92));
  vec3 r = reflect(-v, n);
  light += f0 * smoothstep(planet.w - 0.25, planet.w + 0.1, dot(r, planet.xyz)) * vec3(0.22, 0.36, 0.55);
  light += f0 * min(highlight(n, v, alpha), 10.0) * key * 0.9;
  float behind = max(dot(n, normalize(vec3(-to_light.xy, 0.4))), 0.0);  // sunlight that grazes the edge
  light += (0.12 + 0.6 * behind) * pow(1.0 - n_v, 3.0) * mix(vec3(0.55, 0.72, 1.0), albedo, 0.4);
  light = light / (1.0 + 0.18 * light) * 1.08;
  color = vec4(misty(encoded(light)), 1.0);
})";

// Surfaces: a pattern of lines with something thinner between them, lit from both sides.
inline constexpr const char* skin_vertex = R"(#version 330 core
layout(location = 0) in vec3 at;
layout(location = 1) in vec3 up;
layout(location = 2) in vec2 place;
uniform mat4 view_projection;
uniform float pushed;  // back, for shadows: the rods along its edge have none of it
centroid out vec3 world;  // not beyond the edge, where there is nothing to be lit
centroid out vec3 normal;
flat out vec3 axis;
flat out vec3 albedo;
flat out vec3 material;
out float along_axis;
flat out float whole_axis;
out vec2 cell;
void main() {
  world = at, normal = up, cell = place;
  axis = vec3(0.0), albedo = vec3(0.0), material = vec3(0.9, 0.45, 0.0), along_axis = 0.0, whole_axis = 0.0;
  gl_Position = view_projection * vec4(at, 1.0);
  gl_Position.z += pushed * gl_Position.w;
})";

inline constexpr const char* skin_fragment = R"(
in vec2 cell;
uniform vec3 front, back;
uniform float opacity, cord;  // cord: half its thickness in cells
uniform int weave;            // 0 mesh, 1 net, 2 film, 3 cells
uniform int square, night, plain;

float line(float x, float width) {  // share of a pixel that lines at whole x cover
  float pixel = max(fwidth(x), 1e-5), away = abs(fract(x - 0.5) - 0.5);
  float crisp = clamp((width - away) / pixel + 0.5, 0.0, 1.0) * min(1.0, 2.0 * width / pixel + 0.25);
  return mix(crisp, 2.0 * width, smoothstep(0.35, 0.7, pixel));
}

float pattern(float width) {
  float x = line(cell.x, width);
  if (square == 1) return max(x, line(cell.y, width));
  return max(x, max(line(0.5 * cell.x + 0.8660254 * cell.y, width), line(0.5 * cell.x - 0.8660254 * cell.y, width)));
}

void main() {
  vec3 v = normalize(eye.xyz - eye.w * world), n = normalize(normal);
  place = world;
  bool is_front = dot(n, v) > 0.0;
  if (!is_front) n = -n;
  float n_v = max(dot(n, v), 0.05), cords = weave == 2 ? 0.0 : pattern(cord);
  vec3 hue = pow(is_front || weave < 2 ? front : back, vec3(2.2));
  float a = weave >= 2 ? opacity : 1.0 - pow(1.0 - opacity, 1.0 / max(n_v, 0.18));  // denser at a slant
  if (weave == 1) a = opacity;
  if (weave == 3 && is_front) hue = mix(hue, vec3(0.55, 0.58, 0.62), cords);
  if (weave < 2) a = max(a, cords * 0.95), hue = mix(hue, hue * vec3(0.80, 0.70, 0.55), cords);
  if (plain == 1) {
    color = vec4(misty(encoded(hue)), 0.25 * a + 0.6 * cords * a);
    return;
  }
  float metal = weave == 3 ? 0.35 : 0.7;
  float lit_front = key_light(n), lit_back = key_light(-n);  // what comes through
  float through = weave < 2 ? 0.55 : weave == 2 ? 0.10 : 0.0;
  vec3 sky = night == 1 ? vec3(0.12, 0.15, 0.20) : mix(vec3(0.26, 0.25, 0.25), vec3(0.42, 0.44, 0.47), 0.5 + 0.5 * n.z);
  vec3 light = hue * (sky + (night == 1 ? 1.2 : 0.75) * vec3(1.0, 0.97, 0.93) * (lit_front + through * lit_back));
  vec3 r = reflect(-v, n);
  float lamp = smoothstep(weave == 3 ? 0.92 : 0.55, 1.0, dot(r, normalize(to_light + vec3(0.0, 0.0, 0.4))));
  light += mix(vec3(0.05), hue, metal) * lamp * (night == 1 ? lit_front * 1.2 : 0.45);
  light += (night == 1 ? 0.10 : 0.22) * pow(1.0 - n_v, 4.0);
  light = light / (1.0 + 0.22 * light) * 1.12;
  color = vec4(misty(encoded(light)), a);
})";

// In the shadow map a surface is as many of sixteen texels as it keeps of the light.
inline constexpr const char* skin_depth_fragment = R"(#version 330 core
uniform float coverage;
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy) & 3;
  int order = (((p.x ^ p.y) & 1) << 3) | ((p.y & 1) << 2) | ((((p.x ^ p.y) >> 1) & 1) << 1) | (p.y >> 1);
  if (float(order) + 0.5 > 16.0 * coverage) discard;
})";

// Flat colours in two tones, as if printed.
inline constexpr const char* flat_fragment = R"(
void main() {
  vec3 n = round_normal(normalize(eye.xyz - eye.w * world));
  float tone = mix(0.62, 1.0, smoothstep(-0.05, 0.20, dot(n, to_light)));
  color = vec4(misty(encoded(albedo * tone)), 1.0);
})";

// A line along both sides of what is round. Where `hidden`, only that line, pale; else also the paper inside.
inline constexpr const char* outline_fragment = R"(
uniform int hidden;
uniform float line_width, pixel;  // [pixels]; the height of one, where w = 1 [m]
void main() {
  vec3 v = normalize(eye.xyz - eye.w * world), n = round_normal(v);
  vec3 across = normalize(v - axis * dot(axis, v) + 1e-6 * n);
  float inside = 1.0 - min(length(normal - across * dot(normal, across)), 1.0);  // 0 at the side, 1 in the middle
  if (abs(dot(n, axis)) > 0.3) inside = 1.0;  // the flat end of a fitting
  // Of what is round the radius tells how many pixels that is: differences would be dots along its middle.
  float radius = material.z * gl_FragCoord.w / pixel, from_edge = inside * (radius > 0.0 ? radius : 1.0 / max(fwidth(inside), 1e-6));
  float line = 1.0 - smoothstep(line_width - 0.5, line_width + 0.5, from_edge);
  vec3 hue = encoded(albedo), ink = hue * 0.62;
  if (hidden == 1) {
    if (line < 0.02) discard;
    color = vec4(misty(mix(ink, vec3(1.0), 0.55)), 0.75 * line);
  } else {
    float filled = material.x > 0.0 ? 0.10 : 1.0;  // what is painted is so here
    color = vec4(misty(mix(mix(vec3(1.0), hue, filled), ink, line)), 1.0);
  }
})";

// What is seen through: ghosts of other poses.
inline constexpr const char* ghost_fragment = R"(
void main() {
  vec3 n = round_normal(normalize(eye.xyz - eye.w * world));
  color = vec4(misty(encoded(albedo) * mix(0.85, 1.0, 0.5 + 0.5 * n.z)), material.x);  // its opacity
})";

// Passes of a blur. 0: of the depth map, along rows, whatever is nearer to the light than the floor, and how
// much nearer; 1: of that, along columns; 2 and 3: the same again, four times as wide.
// Each is a program of its own: software takes all branches of one.
inline constexpr const char* shade_fragment = R"(
uniform int texels;        // of the depth map for one of the shade
uniform vec3 floor_depth;  // of the floor in the map: x, y and 1
uniform vec2 way;          // a texel of what is blurred, along the blur
uniform float coarser;     // texels of what is read for one that is drawn
uniform sampler2D depth, shade;
layout(location = 0) out vec2 color;  // share of the light that is missing; times how far its cause is away
void main() {
#ifdef FROM_DEPTH
  ivec2 at = ivec2(gl_FragCoord.xy) * texels + ivec2(texels / 2);
  ivec2 last = textureSize(depth, 0) - 1;
  vec2 sum = vec2(0.0);
  for (int i = 0; i < 8; ++i) {  // on different rows, or a shadow along the rows would be dashed
    ivec2 p = clamp(at + ivec2(3 * i / 2 - 5, (3 * i & 3) - 2) * texels / 4, ivec2(0), last);
    float d = texelFetch(depth, p, 0).r;
    if (d < 1.0) sum += vec2(1.0, clamp(dot(floor_depth, vec3(vec2(p) / vec2(last), 1.0)) - d, 0.0, 0.5) * 2.0);
  }
  color = sum / 8.0;
#else
  vec2 at = gl_FragCoord.xy * coarser / vec2(textureSize(shade, 0));
#ifdef NARROW  // four reads of two texels each, in three
  vec2 sides = texture(shade, at + 1.241 * way).rg + texture(shade, at - 1.241 * way).rg;
  color = 0.275 * texture(shade, at).rg + 0.3625 * sides;
#else  // a Gauss curve of 2.4 texels, two of them with each read
  vec2 sum = 0.171 * texture(shade, at).rg;
  sum += 0.272 * (texture(shade, at + 1.46 * way).rg + texture(shade, at - 1.46 * way).rg);
  sum += 0.1145 * (texture(shade, at + 3.4 * way).rg + texture(shade, at - 3.4 * way).rg);
  color = sum + 0.028 * (texture(shade, at + 5.3 * way).rg + texture(shade, at - 5.3 * way).rg);
#endif
#endif
})";

inline constexpr const char* background_vertex = R"(#version 330 core
void main() {  // one triangle over the whole picture, behind everything
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(corner, 1.0, 1.0);
})";

// A gradient; with STARS and PLANET, programs of their own as above, stars and the Earth seen from a low
// orbit: day and night, clouds, and air that glows at its limb.
inline constexpr const char* background_fragment = R"(
uniform vec4 background_top, background_bottom;
uniform float picture_height, stars;
uniform vec4 planet;                       // direction to its middle, cosine of half its width; 2: none
uniform vec3 view_right, view_up, view_forward, to_light;  // right and up: of half a picture's height
uniform vec2 picture_middle;
layout(location = 0) out vec4 color;
float scatter(vec2 p) { return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453); }
float scatter3(vec3 p) { return fract(sin(dot(p, vec3(12.9898, 78.233, 37.719))) * 43758.5453); }
float noise(vec3 p) {
  vec3 i = floor(p), f = fract(p);
  f = f * f * (3.0 - 2.0 * f);
  vec4 a = vec4(scatter3(i), scatter3(i + vec3(1, 0, 0)), scatter3(i + vec3(0, 1, 0)), scatter3(i + vec3(1, 1, 0)));
  vec4 b = vec4(scatter3(i + vec3(0, 0, 1)), scatter3(i + vec3(1, 0, 1)), scatter3(i + vec3(0, 1, 1)), scatter3(i + vec3(1)));
  vec4 c = mix(a, b, f.z);
  return mix(mix(c.x, c.y, f.x), mix(c.z, c.w, f.x), f.y);
}
float clouds(vec3 p) {
  float sum = 0.0, size = 0.5;
  for (int i = 0; i < 5; ++i) sum += size * noise(p), p = 2.03 * p + 3.1, size *= 0.5;
  return sum;
}
void main() {
  color = mix(background_bottom, background_top, gl_FragCoord.y / picture_height);
#if defined(STARS) || defined(PLANET)
  vec2 screen = (gl_FragCoord.xy - picture_middle) / (0.5 * picture_height);
  vec3 d = normalize(view_forward + screen.x * view_right + screen.y * view_up);
  float toward = dot(d, planet.xyz), edge = planet.w;
#endif
#ifdef STARS
  if (toward < edge) {  // at most one in each cell of a grid
    float unit = picture_height / 720.0;
    for (int layer = 0; layer < 2; ++layer) {
      float size = layer == 0 ? 26.0 : 61.0;
      vec2 at = gl_FragCoord.xy / (size * unit), cell = floor(at) + 91.0 * float(layer);
      at += 91.0 * float(layer);
      float luck = scatter(cell);
      vec2 place = vec2(scatter(cell + 17.0), scatter(cell + 43.0)) * 0.8 + 0.1;
      float away = length(at - cell - place) * size, wide = layer == 0 ? 1.0 : 1.7;
      float bright = stars * (layer == 0 ? 0.75 : 1.3) * smoothstep(0.35, 1.0, luck) * smoothstep(wide, 0.1, away);
      color.rgb += bright * mix(vec3(0.70, 0.82, 1.0), vec3(1.0, 0.90, 0.78), scatter(cell + 5.0));
    }
  }
#endif
#ifdef PLANET
  float half_width = acos(edge), from = acos(clamp(toward, -1.0, 1.0));
  float above = (from - half_width) / half_width;  // of the limb
  // Where the ray meets a sphere of radius 1 whose middle is 1 / sin(half_width) away.
  float distance = 1.0 / sin(half_width), along = distance * toward;
  float inside = along * along - (distance * distance - 1.0);
  vec3 hit = d * (along - sqrt(max(inside, 0.0))) - planet.xyz * distance;
  vec3 n = above < 0.0 ? normalize(hit) : normalize(d * along - planet.xyz * distance);
  float day = smoothstep(-0.10, 0.30, dot(n, to_light));
  vec3 air = mix(vec3(0.10, 0.13, 0.30), vec3(0.30, 0.58, 1.0), day) * (0.10 + 0.90 * day);
  if (above < 0.0) {
    float land = smoothstep(0.50, 0.60, clouds(n * 3.1 + 7.0)), cloud = smoothstep(0.46, 0.72, clouds(n * vec3(11.0, 11.0, 17.0)));
    vec3 ground = mix(vec3(0.035, 0.13, 0.30), mix(vec3(0.12, 0.20, 0.10), vec3(0.36, 0.30, 0.19), clouds(n * 11.0)), land);
    ground = mix(ground, vec3(0.88, 0.91, 0.95), 0.85 * cloud);
    float slant = 1.0 - max(dot(n, -d), 0.0);
    vec3 c = ground * (0.015 + 0.85 * day);
    c = mix(c, air, clamp(0.10 + 0.80 * pow(slant, 5.0), 0.0, 1.0) * (0.15 + 0.85 * day));
    color.rgb = mix(color.rgb, c, smoothstep(0.0, -0.004, above));
  }
  color.rgb += air * exp(-max(above, 0.0) * 70.0) * smoothstep(-0.004, 0.0, above) * 0.9;
#endif
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
uniform vec4 lines_color;
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
  float grid = max(0.59 * lines(world / cell, 1.1 * finer), lines(world / (5.0 * cell), 1.3 * finer));
  color = vec4(lines_color.rgb, lines_color.a * grid * fade);
})";

// Sharp where what throws it is near, softer the farther away it is.
inline constexpr const char* floor_shadow_fragment = R"(#version 330 core
in vec2 world;
uniform float floor_height, reach;
uniform vec2 center;
uniform vec4 shadow_color;
uniform mat4 light_projection;
uniform sampler2D shade, soft_shade;
layout(location = 0) out vec4 color;
void main() {
  float fade = 1.0 - smoothstep(0.35, 1.0, length(world - center) / reach);
  vec2 at = (light_projection * vec4(world, floor_height, 1.0)).xy * 0.5 + 0.5;
  vec2 sharp = texture(shade, at).rg, soft = texture(soft_shade, at).rg;
  float away = soft.g / max(soft.r, 1e-3);
  float dark = mix(sharp.r, soft.r, smoothstep(0.08, 1.1, away));
  dark = max(dark, 0.35 * soft.r);  // light from the sky that is kept off as well
  color = vec4(shadow_color.rgb, shadow_color.a * fade * dark);
})";

}  // namespace unfurl::shaders
