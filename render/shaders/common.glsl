// Before every shader: the frame's uniforms, the sky, the sun and its shadow.
// "Eye space" here has the world's axes and its origin at the eye.
#version 330 core

layout(std140) uniform Frame {
  mat4 clip_of_eye;
  mat4 shadow_of_eye;    // to [0,1] cubed, seen from the sun
  mat4 zenith_of_eye;    // the same, seen from straight above
  vec4 ray_right;        // a pixel's ray is forward + x * right + y * up, x and y in [-1,1]
  vec4 ray_up;
  vec4 ray_forward;
  vec4 to_sun;           // w: metres a texel of the shadow map
  vec4 ground;           // linear colour; w: height above the eye
  vec4 ground_offset;    // of the eye in the ground's texture: x, z, in metres; z: where paints begin in materials
  vec4 pixel;            // width, height, and their inverses
  vec4 lens;             // x: near plane, y: pixels a radian, z: exposure, w: weight of a sample
  vec4 sun_light;        // on a face turned to it
  vec4 sky_light;        // on a face turned up
  vec4 zenith;           // what is seen of the sky
  vec4 horizon;
  vec4 cloud_light;
  vec4 sun_glow;         // around the sun
};

const float kHaze = 0.0075;  // per metre

// The sky in a direction of which its height and the cosine to the sun are known.
vec3 sky_at(float height, float sunward) {
  float thin = 1.0 - clamp(height, 0.0, 1.0);
  float air = thin * thin;
  air *= air;
  vec3 color = mix(zenith.rgb, horizon.rgb, 0.22 + 0.78 * air);
  float glow = max(sunward, 0.0);
  float glow4 = glow * glow * glow * glow;
  return color + sun_glow.rgb * (0.35 * glow4 + 0.8 * glow4 * glow4 * glow4 * glow4);
}

// What is seen of the sky in a direction; also what far things fade into.
vec3 sky(vec3 direction) { return sky_at(direction.y, dot(direction, to_sun.xyz)); }

// What a mirror shows: the sky above, sunlit ground below, the horizon between them as soft as
// the mirror is rough.
vec3 mirrored_at(float height, float sunward, float soft) {
  vec3 below = ground.rgb * (0.14 * sun_light.rgb * max(to_sun.y, 0.0) + 0.3 * sky_light.rgb);
  return mix(below, sky_at(height, sunward), smoothstep(-soft, soft, height));
}

// Air between the eye and something `metres` away.
vec3 through_air(vec3 color, vec3 direction, float metres) {
  float clear = exp2(-metres * kHaze);
  return mix(sky(vec3(direction.x, abs(direction.y) * 0.3, direction.z)), color, clear);
}

// Light that the ground throws back up.
vec3 ground_light() { return ground.rgb * (0.13 * sun_light.rgb * to_sun.y + 0.25 * sky_light.rgb); }

// Light from all around on a face whose normal has the given height.
vec3 ambient_light(float normal_y) {
  return mix(ground_light(), sky_light.rgb, 0.5 + 0.5 * normal_y);
}
