// Converts light to the image by occlusion, dust, tone curve and gamma, top row first. With GATHER,
// writes a weighted sample of light, from whose sum develop.frag makes the image.
uniform sampler2D lights;
uniform sampler2D occlusion;
uniform sampler2D depths;
#ifdef DUSTY
uniform sampler2D dust;
#endif
in vec2 at;
out vec4 color;

// Returns occlusion, and dust in `veil`, which have half the resolution: the four nearest values are
// weighted by the similarity of their distances, so that edges have no seams.
float open_at(ivec2 here, float along, out vec4 veil) {
  ivec2 last = textureSize(occlusion, 0) - 1;
  ivec2 near = here >> 1;
  ivec2 next = near + ((here & 1) * 2 - 1);
  ivec2 aside = clamp(ivec2(next.x, near.y), ivec2(0), last);
  ivec2 above = clamp(ivec2(near.x, next.y), ivec2(0), last);
  next = clamp(next, ivec2(0), last);
  vec2 a = texelFetch(occlusion, near, 0).rg;
  vec2 b = texelFetch(occlusion, aside, 0).rg;
  vec2 c = texelFetch(occlusion, above, 0).rg;
  vec2 d = texelFetch(occlusion, next, 0).rg;
  vec4 off = abs(vec4(a.g, b.g, c.g, d.g) - along) / along;
  vec4 weight = vec4(9.0, 3.0, 3.0, 1.0) / (off * off + 4e-5);
  weight /= dot(weight, vec4(1.0));
#ifdef DUSTY
  veil = weight.x * texelFetch(dust, near, 0) + weight.y * texelFetch(dust, aside, 0) +
         weight.z * texelFetch(dust, above, 0) + weight.w * texelFetch(dust, next, 0);
#else
  veil = vec4(0.0);
#endif
  return dot(weight, vec4(a.r, b.r, c.r, d.r));
}

void main() {
  ivec2 here = ivec2(at.x * pixel.x, (1.0 - at.y) * pixel.y);
  vec4 light = texelFetch(lights, here, 0);
  float along = lens.x / max(1.0 - texelFetch(depths, here, 0).r, 1e-6);
  vec4 veil;
  float open = open_at(here, along, veil);
  vec3 lit = light.rgb * mix(1.0, open, 0.35 + 0.65 * light.a);
  lit = lit * (1.0 - veil.a) + veil.rgb;
#ifdef GATHER
  // Without a solid surface, light.a is the share of the background visible through glass.
  bool covered = texelFetch(depths, here, 0).r < 1.0;
  float through = covered ? 0.0 : light.a * (1.0 - veil.a);
  color = vec4(lit, 1.0 - through) * lens.w;
#else
  color = developed(lit, at);
#endif
}
