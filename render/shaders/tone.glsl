// Tone mapping from light to screen values; after common.glsl.

// Reinhard's curve (2002) with a toe: dark shadows, and shading is visible on white stone in the sun.
vec3 filmic(vec3 x) {
  vec3 part = x / (1.0 + x);
  return min(part * (0.4 + 0.88 * part), vec3(1.0));
}

// The sRGB curve, computed in the shader because drivers' encodings differ, from roots, which are
// exact on every driver, in place of a power; fitted to 0.011 of a level.
vec3 srgb(vec3 c) {
  vec3 root2 = sqrt(c);
  vec3 root4 = sqrt(root2);
  vec3 root8 = sqrt(root4);
  vec3 curve = 0.6423657 * root2 + 0.7121104 * root4 - 0.3368699 * root8 - 0.0175631 * c;
  return mix(12.92 * c, curve, step(0.0031308, c));
}

// Returns the screen values of light at a place in the image; alpha is the brightness.
vec4 developed(vec3 light, vec2 at) {
  float vignette = 1.0 - 0.22 * dot(at - 0.5, at - 0.5);
  vec3 shown = srgb(filmic(light * (lens.z * vignette)));
  return vec4(shown, dot(shown, vec3(0.299, 0.587, 0.114)));
}
