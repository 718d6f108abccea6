// Ambient occlusion at half the resolution: by near surfaces, from the depths (after McGuire et al.,
// "The Alchemy Screen-Space Ambient Obscurance Algorithm", 2011), and by roofs and walls, from the
// heights seen from above. Red: remaining share of ambient light. Green: distance along the view.
uniform sampler2D depths;
uniform sampler2DShadow zenith_map;
in vec2 at;
out vec4 result;

const float kRadius = 0.7;  // metres
const int kTaps = 10;

float distance_at(vec2 where) {
  return lens.x / max(1.0 - textureLod(depths, where, 0.0).r, 1e-6);
}

vec3 place_at(vec2 where, float along) {
  vec2 ndc = 2.0 * where - 1.0;
  return (ray_forward.xyz + ndc.x * ray_right.xyz + ndc.y * ray_up.xyz) * along;
}

// Returns the visible part of the sky at a place, approximately: the share of taps around it at which
// nothing is higher than a line that rises outwards.
float open_sky(vec3 place, vec3 n, vec2 arm) {
  vec3 from = place + vec3(n.x, 0.0, n.z) * 0.9 + vec3(0.0, 0.12, 0.0);
  float sum = 0.0;
  for (int i = 0; i < 6; ++i) {
    arm = mat2(-0.737369, 0.675490, -0.675490, -0.737369) * arm;
    float out_m = 0.35 + 0.42 * float(i);
    vec3 at_line = from + vec3(arm.x * out_m, 0.45 * out_m, arm.y * out_m);
    sum += texture(zenith_map, (zenith_of_eye * vec4(at_line, 1.0)).xyz);
  }
  return sum / 6.0;
}

void main() {
  float along = distance_at(at);
  vec3 here = place_at(at, along);

  // The normal of the face, from the neighbour on each axis that is nearer in depth, for sharp edges.
  vec2 dx = vec2(pixel.z, 0.0);
  vec2 dy = vec2(0.0, pixel.w);
  float l = distance_at(at - dx), r = distance_at(at + dx);
  float d = distance_at(at - dy), u = distance_at(at + dy);
  vec3 across = abs(l - along) < abs(r - along) ? here - place_at(at - dx, l)
                                                : place_at(at + dx, r) - here;
  vec3 upward = abs(d - along) < abs(u - along) ? here - place_at(at - dy, d)
                                                : place_at(at + dy, u) - here;
  vec3 n = normalize(cross(across, upward));

  float reach = min(kRadius * lens.y / along, 0.12 * pixel.y);  // pixels
  ivec2 cell = ivec2(gl_FragCoord.xy) & 3;
  float turn = float((cell.x * 5 + cell.y * 7 + cell.x * cell.y * 3) & 15) * (6.2831853 / 16.0);
  vec2 arm = vec2(cos(turn), sin(turn));
  float sum = 0.0;
  for (int i = 0; i < kTaps; ++i) {
    float part = (float(i) + 0.6) / float(kTaps);
    arm = mat2(-0.737369, 0.675490, -0.675490, -0.737369) * arm;  // the golden angle
    vec2 where = at + arm * (part * part * reach + 1.0) * pixel.zw;
    vec3 v = place_at(where, distance_at(where)) - here;
    float squared = dot(v, v);
    float fade = max(1.0 - squared / (kRadius * kRadius), 0.0);
    sum += fade * max(dot(v, n) - 0.0025 * along, 0.0) * inversesqrt(squared + 1e-4);
  }
  float left = max(1.0 - 2.6 * sum / float(kTaps), 0.0);
  left *= mix(0.28, 1.0, open_sky(here, n, arm));
  result = vec4(left, along, 0.0, 0.0);
}
