// Converts a sum of samples to the image. With TRANSPARENT, alpha is the covered part of a pixel.
uniform sampler2D sums;
in vec2 at;
out vec4 color;

void main() {
  vec4 sum = texelFetch(sums, ivec2(gl_FragCoord.xy), 0);
#ifdef TRANSPARENT
  color = vec4(developed(sum.rgb / max(sum.a, 1e-4), at).rgb, sum.a);
#else
  color = developed(sum.rgb, at);
#endif
}
