// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The viewer's shaders, GLSL ES 3.00.

const CAPSULE_VERTEX = `#version 300 es
  in vec4 shape;               // cos and sin around, sin along, 0 at a or 1 at b
  in vec3 a, b, side, colour;
  in vec4 girth;               // radius at a, radius at b, flatness, cap
  uniform mat4 clip_from_world;
  out vec3 world, normal, paint;
  void main() {
    vec3 along = b - a;
    float length_m = length(along);
    along /= length_m;
    vec3 across = cross(along, side);
    float radius = mix(girth.x, girth.y, shape.w);
    float level = sqrt(max(0.0, 1.0 - shape.z * shape.z));
    vec3 ring = side * shape.x;
    float slope = (girth.x - girth.y) / length_m;
    world = mix(a, b, shape.w) +
      radius * (level * (ring + across * shape.y * girth.z) + along * shape.z * girth.w);
    normal = level * (ring + across * shape.y / girth.z + along * slope) +
      along * shape.z / girth.w;
    paint = colour;
    gl_Position = clip_from_world * vec4(world, 1.0);
  }`;

const CAPSULE_FRAGMENT = `#version 300 es
  precision highp float;
  in vec3 world, normal, paint;
  uniform vec3 eye, light, sky, ground;
  out vec4 pixel;
  void main() {
    vec3 n = normalize(normal);
    vec3 v = normalize(eye - world);
    vec3 base = paint * paint;             // near enough to linear light
    float key = max(0.0, dot(n, -light) * 0.75 + 0.25);
    vec3 ambient = mix(ground, sky, 0.5 + 0.5 * n.y);
    float rim = pow(1.0 - max(dot(n, v), 0.0), 3.0);
    float gloss = pow(max(dot(n, normalize(v - light)), 0.0), 28.0);
    float near_floor = 0.72 + 0.28 * smoothstep(0.0, 0.35, world.y);
    vec3 shade = base * (ambient + 0.85 * key) * near_floor + 0.10 * gloss + 0.14 * rim * sky;
    pixel = vec4(sqrt(shade), 1.0);
  }`;

const SHADOW_FRAGMENT = `#version 300 es
  precision highp float;
  in vec3 world, normal, paint;
  out vec4 pixel;
  void main() {
    float height = max(world.y, 0.0);
    pixel = vec4(exp(-9.0 * height), exp(-1.1 * height), 0.0, 1.0);
  }`;

const QUAD_VERTEX = `#version 300 es
  in vec2 corner;
  out vec2 place;
  void main() {
    place = 0.5 + 0.5 * corner;
    gl_Position = vec4(corner, 0.0, 1.0);
  }`;

const BLUR_FRAGMENT = `#version 300 es
  precision highp float;
  in vec2 place;
  uniform sampler2D shadow;
  uniform vec2 step_tight, step_wide;
  out vec4 pixel;
  void main() {
    vec2 sum = vec2(0.0);
    float total = 0.0;
    for (int i = -6; i <= 6; ++i) {
      float k = float(i);
      float weight = exp(-0.09 * k * k);
      sum += weight * vec2(texture(shadow, place + k * step_tight).r,
                           texture(shadow, place + k * step_wide).g);
      total += weight;
    }
    pixel = vec4(sum / total, 0.0, 1.0);
  }`;

const FLOOR_VERTEX = `#version 300 es
  in vec2 corner;
  uniform mat4 clip_from_world;
  uniform vec3 target;
  uniform float reach;
  out vec2 place;
  void main() {
    place = target.xz + reach * corner;
    gl_Position = clip_from_world * vec4(place.x, 0.0, place.y, 1.0);
  }`;

const FLOOR_FRAGMENT = `#version 300 es
  precision highp float;
  in vec2 place;
  uniform vec3 target, backdrop, ground_colour, line_colour, shadow_area;
  uniform float reach, shadow_depth;
  uniform sampler2D shadow;
  out vec4 pixel;
  float lines(float spacing) {
    vec2 at = place / spacing;
    vec2 width = fwidth(at);
    vec2 off = abs(fract(at - 0.5) - 0.5) / max(width, 1e-6);
    float thin = 1.0 - min(min(off.x, off.y), 1.0);
    return thin * (1.0 - smoothstep(0.15, 0.5, max(width.x, width.y)));
  }
  void main() {
    float away = length(place - target.xz) / reach;
    float fade = 1.0 - smoothstep(0.25, 0.95, away);
    float grid = max(0.9 * lines(1.0), 0.4 * lines(0.25));
    vec3 colour = mix(ground_colour, line_colour, grid);
    vec2 at = 0.5 + 0.5 * (place - shadow_area.xy) / shadow_area.z;
    vec2 dark = texture(shadow, at).rg;
    vec2 edge = smoothstep(0.0, 0.04, at) * smoothstep(0.0, 0.04, 1.0 - at);
    float cover = 1.0 - (1.0 - 0.65 * dark.r) * (1.0 - 0.55 * dark.g);
    colour *= 1.0 - shadow_depth * cover * edge.x * edge.y;
    pixel = vec4(mix(backdrop, colour, fade), 1.0);
  }`;

const LINE_VERTEX = `#version 300 es
  in vec3 at, colour;
  uniform mat4 clip_from_world;
  out vec3 paint;
  void main() {
    paint = colour;
    gl_Position = clip_from_world * vec4(at, 1.0);
  }`;

const LINE_FRAGMENT = `#version 300 es
  precision mediump float;
  in vec3 paint;
  out vec4 pixel;
  void main() { pixel = vec4(paint, 1.0); }`;
