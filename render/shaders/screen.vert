// Vertex of a triangle that covers the image, at the far end of the depth range.
out vec2 at;
void main() {
  vec2 corner = vec2((gl_VertexID & 1) * 4 - 1, (gl_VertexID & 2) * 2 - 1);
  at = 0.5 * corner + 0.5;
  gl_Position = vec4(corner, 1.0, 1.0);
}
