// Depth of a piece in a shadow map; LIGHT is the matrix.
void main() {
  Piece piece = this_piece();
  vec3 place = piece.rotation * position + piece.translation;
  vec3 seen = (LIGHT * vec4(place, 1.0)).xyz;
  gl_Position = vec4(2.0 * seen - 1.0, 1.0);
}
