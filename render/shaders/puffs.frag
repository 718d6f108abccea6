// A puff of dust: fades towards its rim, towards surfaces in it and towards the eye; denser in clots.
uniform sampler2DArray tiles;
uniform sampler2D openness;  // green: distance of the surface along the view
in vec2 on;
in vec2 cloud;
in float lit;
flat in vec4 puff;
flat in vec3 color;
out vec4 result;

void main() {
  float squared = dot(on, on);
  if (squared >= 1.0) discard;
  float body = 1.0 - squared;
  float clot = texture(tiles, vec3(cloud, 6.0)).r;
  float wisp = 0.6 * clot + 0.4 * texture(tiles, vec3(cloud.yx * 2.7, 6.0)).r;
  float gap = texelFetch(openness, ivec2(gl_FragCoord.xy), 0).g - puff.x;
  float clear_of = clamp(0.5 + gap / puff.y, 0.0, 1.0) * clamp(2.0 * puff.x - 0.6, 0.0, 1.0);
  // The rim is ragged: the farther out, the denser the noise must be to be visible.
  float density = body * smoothstep(0.0, 0.34, wisp - 0.66 + 0.42 * body);
  float alpha = puff.z * density * clear_of;
  if (alpha < 0.003) discard;

  // Shaded like a ball of powder: brighter where its surface faces the sun.
  vec3 bulge = normalize(ray_right.xyz) * on.x + normalize(ray_up.xyz) * on.y -
               ray_forward.xyz * sqrt(body);
  float facing = 0.5 + 0.5 * dot(bulge, to_sun.xyz);
  vec3 light = color * (sun_light.rgb * (0.12 + 0.38 * facing * (0.6 + 0.8 * clot)) * lit +
                        ambient_light(0.3 + 0.5 * bulge.y));
  result = vec4(mix(horizon.rgb, light, puff.w) * alpha, alpha);
}
