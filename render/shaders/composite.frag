// Light to picture: occlusion, tone, gamma. Written top row first.
uniform sampler2D lights;
uniform sampler2D occlusion;
in vec2 at;
out vec4 color;

// Narkowicz's fit of the ACES filmic curve (2015).
vec3 filmic(vec3 x) { return clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0); }

// The sRGB curve, in the shader: drivers' own encodings differ.
vec3 srgb(vec3 c) {
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}

void main() {
  vec2 where = vec2(at.x, 1.0 - at.y);
  vec4 light = textureLod(lights, where, 0.0);
  float open = textureLod(occlusion, where, 0.0).r;
  vec3 lit = light.rgb * mix(1.0, open, 0.25 + 0.75 * light.a);
  float vignette = 1.0 - 0.22 * dot(at - 0.5, at - 0.5);
  color = vec4(srgb(filmic(lit * 0.62 * vignette)), 1.0);
}
