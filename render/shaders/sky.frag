// The sky with thin clouds.
uniform sampler2DArray tiles;
in vec2 at;
out vec4 color;

void main() {
  vec2 ndc = 2.0 * at - 1.0;
  vec3 ray = normalize(ray_forward.xyz + ndc.x * ray_right.xyz + ndc.y * ray_up.xyz);
  vec3 air = sky(ray);
  // Thin high clouds, which fade towards the horizon.
  vec2 uv = ray.xz / max(ray.y + 0.12, 0.02);
  float cloud = texture(tiles, vec3(uv * vec2(0.16, 0.34), 6.0)).r;
  float veil = smoothstep(0.42, 0.8, cloud) * smoothstep(0.02, 0.3, ray.y);
  color = vec4(mix(air, cloud_light.rgb, 0.32 * veil), 0.0);
}
