// Glass: a face reflects more at grazing angles and tints the background; an edge face, with a long
// path through the glass, absorbs most of the background and scatters some ambient light. So cracks
// look dark before a bright background, bright before a dark one, and glint where they reflect the sun.
in vec3 rest;
in vec3 normal_rest;
in vec3 shadow;
flat in vec3 sun_rest;
flat in vec3 up_rest;
flat in vec3 eye_rest;
flat in vec4 first_color;
flat in vec3 finish;

#ifdef THIN_EDGES
flat in float thickness;
const float kLineWeight = 0.25;  // about four lines lie on each other along a broken face
#endif

layout(location = 0, index = 0) out vec4 color;
layout(location = 0, index = 1) out vec4 through;  // transmitted share of the background

void main() {
  vec3 n = normalize(normal_rest);
  vec3 view = normalize(rest - eye_rest);
  if (dot(view, n) > 0.0) n = -n;
  float edge = finish.y;  // 1 on a broken face
  float facing = max(-dot(view, n), 0.0);
#ifdef THIN_EDGES
  // A broken face narrower than a pixel would be drawn as dots: its borders are drawn as lines.
  float pixels = facing * thickness * lens.y / length(rest - eye_rest);
  float filled = smoothstep(0.6, 1.1, pixels);
#ifdef LINES
  if (edge < 0.5) discard;
  float weight = kLineWeight * clamp(pixels, 0.2, 1.0) * (1.0 - filled);
#else
  float weight = mix(1.0, filled, edge);
#endif
#endif
  float grazing = 1.0 - facing;
  float fresnel = grazing * grazing;
  // A pane has two faces, each of which reflects 4 % of what is straight before it (index 1.5).
  fresnel = mix(0.04, 1.0, fresnel * fresnel * grazing);

  vec3 mirrored = reflect(view, n);
  float sunward = dot(mirrored, sun_rest);
  float sun = sunlit(shadow);
  float glint = max(sunward, 0.0);
  glint *= glint;
  glint *= glint;
  glint *= glint;
  glint *= glint;
  glint *= glint;
  glint *= glint * glint;
  vec3 world = mirrored_at(dot(mirrored, up_rest), sunward, 0.04);
  vec3 light = fresnel * world;
  light += sun_light.rgb * (sun * glint * (0.4 + fresnel));

  // The path through the glass is longer at grazing angles, up to three times.
  float way = min(1.0 / max(facing, 0.33), 3.0);
  vec3 clear = exp2(-way * 0.25 * (1.0 - first_color.rgb));
  vec3 deep = 0.5 * first_color.rgb * first_color.rgb;
  light += edge * deep * (0.35 * world + 0.1 * sun_light.rgb * sun);
  through = vec4((1.0 - fresnel) * mix(clear, deep, edge), 1.0 - fresnel);
#ifdef THIN_EDGES
  light *= weight;
  through = mix(vec4(1.0), through, weight);
#endif
  color = vec4(light, 1.0);
}
