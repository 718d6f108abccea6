// Vertex of a chip of debris, an instance of one of a few meshes. Each chip has its own rest frame, at
// an arbitrary place in the texture of its material's interior.
layout(location = 0) in vec3 position;  // for a chip of radius 1
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 place;  // centre in eye space, radius
layout(location = 3) in vec4 rotation;
layout(location = 4) in float material;

vec3 turned(vec3 v, vec4 q) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }

#if defined(LAYER)
out vec3 place_;
out vec3 normal_;
flat out float body;

void main() {
  place_ = place.xyz + turned(position * place.w, rotation);
  normal_ = turned(normal, rotation);
  body = 0.0;
  gl_Position = clip_of_eye * vec4(place_, 1.0);
}
#elif defined(SHADOW)
void main() {
  vec3 here = place.xyz + turned(position * place.w, rotation);
  vec3 seen = (shadow_of_eye * vec4(here, 1.0)).xyz;
  gl_Position = vec4(2.0 * seen - 1.0, 1.0);
}
#else
uniform samplerBuffer materials;  // as in pieces.vert

out vec3 rest;
out vec3 normal_rest;
out vec3 shadow;
flat out vec3 sun_rest;
flat out vec3 up_rest;
flat out vec3 eye_rest;
flat out vec4 first_color;
flat out vec4 second_color;
flat out vec3 finish;

void main() {
  vec4 back = vec4(-rotation.xyz, rotation.w);
  vec3 here = place.xyz + turned(position * place.w, rotation);
  gl_Position = clip_of_eye * vec4(here, 1.0);

  vec3 origin = place.w * vec3(977.0, 1531.0, 613.0);
  rest = origin + position * place.w;
  normal_rest = normal;
  sun_rest = turned(to_sun.xyz, back);
  up_rest = turned(vec3(0.0, 1.0, 0.0), back);
  eye_rest = origin - turned(place.xyz, back);
  float facing = clamp(dot(normal, sun_rest), 0.0, 1.0);
  vec3 off = turned(normal, rotation) * (to_sun.w * (0.6 + 2.2 * (1.0 - facing)));
  shadow = (shadow_of_eye * vec4(here + off, 1.0)).xyz;

  int row = 6 * int(material) + 3;
  first_color = texelFetch(materials, row);
  second_color = texelFetch(materials, row + 1);
  vec4 rest_of_row = texelFetch(materials, row + 2);
  finish = rest_of_row.xyz;
  first_color.rgb *= rest_of_row.w;  // below 1 for glass, because a heap of it is transparent
}
#endif
