// Vertex of a puff of dust: a sprite that faces the eye, rotated with its particle.
layout(location = 0) in vec4 place;  // centre in eye space, radius
layout(location = 1) in vec4 look;   // cosine and sine of the rotation, opacity, material

uniform samplerBuffer materials;  // as in pieces.vert

const float kDrawnLarger = 2.15;  // sprite radius / puff radius: soft edges look smaller
const float kSpread = 0.16;      // growth per metre above the ground: higher dust has risen longer
const float kMostSpread = 1.8;
const vec3 kPowder = vec3(0.60, 0.54, 0.46);

out vec2 on;     // position on the sprite, -1 to 1
out vec2 cloud;  // position in the noise that shapes the puff
out float lit;   // share of sunlight
flat out vec4 puff;    // distance along the view, radius, opacity, transmittance of the air
flat out vec3 color;

void main() {
  vec2 corner = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID >> 1) * 2 - 1);
  float spread = clamp(1.0 + kSpread * (place.y - ground.w), 1.0, kMostSpread);
  float radius = place.w * kDrawnLarger * spread;
  vec3 right = normalize(ray_right.xyz);
  vec3 up = normalize(ray_up.xyz);
  vec3 here = place.xyz + radius * (right * corner.x + up * corner.y);
  gl_Position = clip_of_eye * vec4(here, 1.0);
  on = corner;
  vec2 turned = mat2(look.x, look.y, -look.y, look.x) * corner;
  cloud = turned * 0.11 * spread + vec2(look.x * 0.03 + look.w * 0.37, look.y * 0.03) + place.w * 5.1;
  // Sampled nearer to the centre than the corner, so that light is softly blurred over the puff.
  vec3 inner = place.xyz + 0.5 * (here - place.xyz);
  lit = sunlit((shadow_of_eye * vec4(inner, 1.0)).xyz);
  float metres = length(place.xyz);
  // Puffs that fill much of the image fade, because they would look like sprites.
  float small = clamp(1.7 - 4.0 * radius / metres, 0.0, 1.0);
  puff = vec4(dot(place.xyz, ray_forward.xyz), radius, look.z * small / (spread * sqrt(spread)), exp2(-metres * kHaze));
  color = mix(kPowder, texelFetch(materials, 6 * int(look.w) + 3).rgb, 0.25);
}
