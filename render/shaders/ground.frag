// Bare dry ground. Positions follow from the pixel's ray: interpolation over the quad is
// inaccurate.
uniform sampler2DArray tiles;
out vec4 color;

void main() {
  vec2 ndc = gl_FragCoord.xy * pixel.zw * 2.0 - 1.0;
  vec3 ray = ray_forward.xyz + ndc.x * ray_right.xyz + ndc.y * ray_up.xyz;
  float along = ground.w / min(ray.y, -1e-5);
  vec3 place = ray * along;
  vec2 uv = place.xz + ground_offset.xy;

  vec4 stones = texture(tiles, vec3(uv * (52.0 / 64.0), 5.0));
  vec4 grain = texture(tiles, vec3(uv * (15.0 / 64.0), 6.0));
  vec4 broad = texture(tiles, vec3(uv.yx * (2.0 / 64.0), 6.0));
  float patches = smoothstep(0.25, 0.75, broad.g);
  vec3 albedo = ground.rgb * (0.22 + 0.48 * grain.r + 0.32 * broad.r + 0.18 * patches);
  albedo *= 1.0 + 0.7 * (stones.r - 0.5) - 0.16 * stones.g * (1.0 - patches);
  albedo = mix(albedo, albedo * vec3(1.1, 1.0, 0.86), patches);
  vec2 slope = (stones.ba - 0.5) * mix(1.5, 0.7, patches) + (grain.ba - 0.5) * 1.0;
  vec3 n = normalize(vec3(-slope.x, 1.0, -slope.y));

  vec3 shadow = (shadow_of_eye * vec4(place + vec3(0.0, to_sun.w, 0.0), 1.0)).xyz;
  vec3 direct = albedo * sun_light.rgb * (max(dot(n, to_sun.xyz), 0.0) * sunlit(shadow));
  vec3 around = albedo * ambient_light(n.y);
  vec3 light = direct + around;
  float ambient_share = dot(around, vec3(0.33)) / max(dot(light, vec3(0.33)), 1e-4);
  float metres = length(place);
  color = vec4(through_air(light, ray / length(ray), metres), ambient_share);
}
