// Value of a data layer at a pixel.
in vec3 place_;
in vec3 normal_;
flat in float body;
out vec4 value;

void main() {
#ifdef DEPTH
  // In metres, from the depth: positions interpolated over the ground's quad are inaccurate.
  value = vec4(lens.x / max(1.0 - gl_FragCoord.z, 1e-6));
#endif
#ifdef NORMALS
  value = vec4(0.5 + 0.5 * normalize(normal_), 1.0);
#endif
#ifdef IDS
  value = vec4(mod(body, 65536.0) / 65535.0, floor(body / 65536.0) / 65535.0, 0.0, 1.0);
#endif
}
