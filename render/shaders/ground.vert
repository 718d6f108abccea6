// Vertex of a very large quad of the ground, centred below the eye.
void main() {
  vec2 corner = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID >> 1) * 2 - 1);
  gl_Position = clip_of_eye * vec4(corner.x * 8000.0, ground.w, corner.y * 8000.0, 1.0);
}
