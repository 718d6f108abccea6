flat in vec4 color;
out vec4 light;

void main() {
#ifdef HIDDEN
  light = color;
#else
  light = vec4(color.rgb, 1.0);
#endif
}
