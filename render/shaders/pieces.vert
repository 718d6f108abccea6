// Vertex of a piece. The directions to sun and sky and the eye are transformed to the rest frame of
// the piece, in which its textures are defined.
uniform samplerBuffer materials;  // material_rows(), then Pictures::rows()
#ifdef TEXTURED
layout(location = 3) in vec2 uv;
layout(location = 4) in uint appearance_number;  // from 1; 0 for none

out vec2 picture_uv;
flat out vec4 appearance;  // linear colour; w: layer of the picture from 1, 0: none, -1: no appearance
flat out vec4 detail;  // layers of relief and gloss from 1, 0: none; roughness, -1: no gloss; metalness
#endif

#ifdef BLOCKS
flat out vec3 low;   // sides of the block; 1e4 m away where it is broken
flat out vec3 high;
#endif

#ifdef THIN_EDGES
flat out float thickness;  // between sides of the original surface, in metres; 1e4 and more without
#endif

out vec3 rest;
out vec3 normal_rest;
out vec3 shadow;
flat out vec3 sun_rest;
flat out vec3 up_rest;
flat out vec3 eye_rest;
flat out vec4 first_color;   // w: tiles per metre
flat out vec4 second_color;  // w: value of the weathering noise above which there is plaster
flat out vec3 finish;        // tile layer, bump, contrast

void main() {
  Piece piece_ = this_piece();
  vec3 place = piece_.rotation * position + piece_.translation;
  gl_Position = clip_of_eye * vec4(place, 1.0);

  mat3 back = transpose(piece_.rotation);
  rest = piece_.origin + position;
  normal_rest = normal;
  sun_rest = back * to_sun.xyz;
  up_rest = back[1];
  eye_rest = piece_.origin - back * piece_.translation;

  // The shadow map is sampled at an offset along the normal, larger at grazing light.
  float facing = clamp(dot(normal, sun_rest), 0.0, 1.0);
  vec3 off = piece_.rotation * normal * (to_sun.w * (0.6 + 2.2 * (1.0 - facing)));
  shadow = (shadow_of_eye * vec4(place + off, 1.0)).xyz;

  int row = 6 * piece_.material + 3 * int(piece & 1u);
  first_color = texelFetch(materials, row);
  second_color = texelFetch(materials, row + 1);
  finish = texelFetch(materials, row + 2).xyz;
#ifdef BLOCKS
  int sides = int(piece >> 1) * 6 + 4;
  vec4 low_side = texelFetch(slots, sides), high_side = texelFetch(slots, sides + 1);
  float broken = float(piece & 1u) * 1e4;
  low = low_side.xyz - broken;
  high = high_side.xyz + broken;
  first_color.rgb *= low_side.w * vec3(1.0 + high_side.w, 1.0, 1.0 - 0.6 * high_side.w);
#endif
#ifdef THIN_EDGES
  int box = int(piece >> 1) * 6 + 4;
  vec3 extent = texelFetch(slots, box + 1).xyz - texelFetch(slots, box).xyz;
  thickness = min(extent.x, min(extent.y, extent.z));
#endif
#ifdef TEXTURED
  picture_uv = uv;
  appearance = vec4(0.0, 0.0, 0.0, -1.0);
  detail = vec4(0.0, 0.0, -1.0, 0.0);
  if (appearance_number > 0u) {
    int appearance_row = int(ground_offset.z) + 2 * (int(appearance_number) - 1);
    appearance = texelFetch(materials, appearance_row);
    detail = texelFetch(materials, appearance_row + 1);
  }
#endif
}
