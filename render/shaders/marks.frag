// A mark of a view mode; with HIDDEN, its hidden part, blended by alpha.
flat in vec4 color;
out vec4 light;

void main() {
#ifdef HIDDEN
  light = color;
#else
  light = vec4(color.rgb, 1.0);
#endif
}
