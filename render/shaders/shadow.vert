void main() {
  Piece piece = this_piece();
  vec3 place = piece.rotation * position + piece.translation;
  vec3 shadow = (shadow_of_eye * vec4(place, 1.0)).xyz;
  gl_Position = vec4(2.0 * shadow - 1.0, 1.0);
}
