// Vertex of a data layer: position, normal and body of a piece or of the ground.
out vec3 place_;
out vec3 normal_;
flat out float body;

#ifdef PIECES
void main() {
  Piece piece_ = this_piece();
  place_ = piece_.rotation * position + piece_.translation;
  normal_ = piece_.rotation * normal;
  body = float(piece_.material);  // key of the body + 1, see Pieces::write_body_ids()
  gl_Position = clip_of_eye * vec4(place_, 1.0);
}
#endif

#ifdef GROUND
void main() {
  vec2 corner = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID >> 1) * 2 - 1);
  place_ = vec3(corner.x * 8000.0, ground.w, corner.y * 8000.0);
  normal_ = vec3(0.0, 1.0, 0.0);
  body = 0.0;
  gl_Position = clip_of_eye * vec4(place_, 1.0);
}
#endif
