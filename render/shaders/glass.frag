// A pane: what is behind it, tinted, under a reflected sky; broken edges scatter light.
in vec3 rest;
in vec3 normal_rest;
in vec3 shadow;
flat in vec3 sun_rest;
flat in vec3 up_rest;
flat in vec3 eye_rest;
flat in vec4 first_color;
flat in vec3 finish;
out vec4 color;

void main() {
  vec3 n = normalize(normal_rest);
  vec3 from_eye = rest - eye_rest;
  float metres = length(from_eye);
  vec3 view = from_eye / metres;
  if (dot(view, n) > 0.0) n = -n;
  float edge = finish.y;  // 1 on a broken face
  float grazing = 1.0 - max(-dot(view, n), 0.0);
  float fresnel = 0.05 + 0.95 * grazing * grazing * grazing * grazing * grazing;
  vec3 mirrored = reflect(view, n);
  float up = dot(mirrored, up_rest);
  vec3 mirrored_sky = mix(ground_light(), mix(kHorizon, kZenith, max(up, 0.0)), smoothstep(-0.1, 0.1, up));
  float shine = pow(max(dot(mirrored, sun_rest), 0.0), 200.0) * 6.0 * sunlit(shadow);

  vec3 scattered = first_color.rgb * (ambient_light(dot(n, up_rest)) + 0.5 * kSunLight * sunlit(shadow));
  float body = mix(0.025, 0.5, edge);
  vec3 light = mirrored_sky * fresnel + scattered * body + kSunLight * 0.25 * shine;
  color = vec4(light, clamp(fresnel + body, 0.0, 1.0));
}
