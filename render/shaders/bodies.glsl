// Transform and material of a piece; after common.glsl, in vertex shaders.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in uint piece;  // slot * 2 + interior

// Six texels per slot: three rows of the 3x4 matrix to eye space; origin in the rest frame, and
// material; low sides of the original box in the rest frame, and brightness; high sides, and redness.
uniform samplerBuffer slots;

struct Piece {
  mat3 rotation;
  vec3 translation;
  vec3 origin;
  int material;
};

Piece this_piece() {
  int first = int(piece >> 1) * 6;
  vec4 x = texelFetch(slots, first);
  vec4 y = texelFetch(slots, first + 1);
  vec4 z = texelFetch(slots, first + 2);
  vec4 rest = texelFetch(slots, first + 3);
  mat3 rotation = transpose(mat3(x.xyz, y.xyz, z.xyz));
  return Piece(rotation, vec3(x.w, y.w, z.w), rest.xyz, int(rest.w));
}
