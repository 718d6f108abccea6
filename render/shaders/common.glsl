// Prefix of every shader: the uniforms of the frame, the sky and ambient light.
// "Eye space" has the axes of the world and its origin at the eye.
#version 330 core

layout(std140) uniform Frame {
  mat4 clip_of_eye;
  mat4 shadow_of_eye;    // from eye space to the sun's shadow map, [0,1] cubed
  mat4 zenith_of_eye;    // from eye space to the map of heights seen from above, [0,1] cubed
  vec4 ray_right;        // the ray of a pixel is forward + x * right + y * up, x and y in [-1,1]
  vec4 ray_up;
  vec4 ray_forward;
  vec4 to_sun;           // w: metres per texel of the shadow map
  vec4 ground;           // linear colour; w: height above the eye
  vec4 ground_offset;    // x, y: offset of the eye in the ground's texture, in metres; z: first texel of appearances in materials
  vec4 pixel;            // width, height, and their inverses
  vec4 lens;             // x: near plane, y: pixels per radian, z: exposure, w: weight of a sample
  vec4 sun_light;        // sunlight on a face towards the sun
  vec4 sky_light;        // sky light on a face that points up
  vec4 zenith;           // visible colour of the sky at the zenith
  vec4 horizon;
  vec4 cloud_light;
  vec4 sun_glow;         // glow around the sun
};

const float kHaze = 0.0075;  // per metre

// Returns the sky in a direction of this height (y) and cosine to the sun.
vec3 sky_at(float height, float sunward) {
  float thin = 1.0 - clamp(height, 0.0, 1.0);
  float air = thin * thin;
  air *= air;
  vec3 color = mix(zenith.rgb, horizon.rgb, 0.22 + 0.78 * air);
  float glow = max(sunward, 0.0);
  float glow4 = glow * glow * glow * glow;
  return color + sun_glow.rgb * (0.35 * glow4 + 0.8 * glow4 * glow4 * glow4 * glow4);
}

// Returns the sky in a direction; also the colour that distant surfaces fade into.
vec3 sky(vec3 direction) { return sky_at(direction.y, dot(direction, to_sun.xyz)); }

// Returns the reflection in a mirror: sky and sunlit ground, with a horizon of width `soft`.
vec3 mirrored_at(float height, float sunward, float soft) {
  vec3 below = ground.rgb * (0.14 * sun_light.rgb * max(to_sun.y, 0.0) + 0.3 * sky_light.rgb);
  return mix(below, sky_at(height, sunward), smoothstep(-soft, soft, height));
}

// Applies the haze between the eye and a surface `metres` away.
vec3 through_air(vec3 color, vec3 direction, float metres) {
  float clear = exp2(-metres * kHaze);
  return mix(sky(vec3(direction.x, abs(direction.y) * 0.3, direction.z)), color, clear);
}

// Returns the light reflected by the ground.
vec3 ground_light() { return ground.rgb * (0.13 * sun_light.rgb * to_sun.y + 0.25 * sky_light.rgb); }

// Returns the ambient light on a face whose normal has this y.
vec3 ambient_light(float normal_y) {
  return mix(ground_light(), sky_light.rgb, 0.5 + 0.5 * normal_y);
}
