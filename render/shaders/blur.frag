// Averages occlusion over 4x4 pixels, the period of its noise, but not across edges.
uniform sampler2D openness;
out vec4 result;

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(openness, 0) - 1;
  float along = texelFetch(openness, here, 0).g;
  float sum = 0.0;
  float weights = 1e-4;
  for (int y = -2; y < 2; ++y) {
    for (int x = -2; x < 2; ++x) {
      vec2 tap = texelFetch(openness, clamp(here + ivec2(x, y), ivec2(0), last), 0).rg;
      float weight = max(1.0 - abs(tap.g - along) / (0.04 * along), 0.0);
      sum += weight * tap.r;
      weights += weight;
    }
  }
  result = vec4(sum / weights, along, 0.0, 0.0);
}
