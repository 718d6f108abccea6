// Vertex of a mark of a view mode.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;  // 0 for an edge
layout(location = 2) in vec3 center;  // in eye space
layout(location = 3) in vec3 axis_x;
layout(location = 4) in vec3 axis_y;
layout(location = 5) in vec3 axis_z;
layout(location = 6) in vec4 look;  // colour; opacity where hidden

flat out vec4 color;

void main() {
  mat3 axes = mat3(axis_x, axis_y, axis_z);
  vec3 place = center + axes * position;
  gl_Position = clip_of_eye * vec4(place, 1.0);
  // Lit from the eye, so that the shape is visible.
  vec3 out_of = axes * (normal / max(vec3(dot(axis_x, axis_x), dot(axis_y, axis_y), dot(axis_z, axis_z)), 1e-12));
  float facing = dot(normal, normal) > 0.0 ? max(-dot(normalize(out_of), normalize(place)), 0.0) : 1.0;
  color = vec4(look.rgb * (0.4 + 0.6 * facing), look.w);
}
