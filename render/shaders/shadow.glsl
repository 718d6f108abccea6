// Sampling of the sun's shadow map; after common.glsl.
uniform sampler2DShadow shadow_map;

float sunlit(vec3 shadow) {
  vec2 texel = vec2(1.1) / vec2(textureSize(shadow_map, 0));
  float sum = texture(shadow_map, shadow + vec3(texel * vec2(0.38, 0.92), 0.0));
  sum += texture(shadow_map, shadow + vec3(texel * vec2(-0.92, 0.38), 0.0));
  sum += texture(shadow_map, shadow + vec3(texel * vec2(-0.38, -0.92), 0.0));
  sum += texture(shadow_map, shadow + vec3(texel * vec2(0.92, -0.38), 0.0));
  return 0.25 * sum;
}
