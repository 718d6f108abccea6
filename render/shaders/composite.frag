// Light to picture: occlusion, tone, gamma. Written top row first; alpha is the brightness, for
// finding edges.
uniform sampler2D lights;
uniform sampler2D occlusion;
in vec2 at;
out vec4 color;

const float kExposure = 0.52;

// Narkowicz's fit of the ACES filmic curve (2015).
vec3 filmic(vec3 x) { return clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0); }

// The sRGB curve, in the shader: drivers' own encodings differ. Of roots, which are exact
// everywhere, rather than a power; fitted to 0.011 of a level.
vec3 srgb(vec3 c) {
  vec3 root2 = sqrt(c);
  vec3 root4 = sqrt(root2);
  vec3 root8 = sqrt(root4);
  vec3 curve = 0.6423657 * root2 + 0.7121104 * root4 - 0.3368699 * root8 - 0.0175631 * c;
  return mix(12.92 * c, curve, step(0.0031308, c));
}

void main() {
  vec2 where = vec2(at.x, 1.0 - at.y);
  vec4 light = textureLod(lights, where, 0.0);
  float open = textureLod(occlusion, where, 0.0).r;
  vec3 lit = light.rgb * mix(1.0, open, 0.35 + 0.65 * light.a);
  float vignette = 1.0 - 0.22 * dot(at - 0.5, at - 0.5);
  vec3 shown = srgb(filmic(lit * (kExposure * vignette)));
  color = vec4(shown, dot(shown, vec3(0.299, 0.587, 0.114)));
}
