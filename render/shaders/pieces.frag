// A lit, textured face. Alpha is the share of ambient light, which ambient occlusion reduces.
uniform sampler2DArray tiles;
#ifdef TEXTURED
uniform sampler2DArray pictures;
in vec2 picture_uv;
flat in vec4 appearance;
flat in vec4 detail;
#endif

#ifdef BLOCKS
flat in vec3 low;
flat in vec3 high;
#endif

in vec3 rest;
in vec3 normal_rest;
in vec3 shadow;
flat in vec3 sun_rest;
flat in vec3 up_rest;
flat in vec3 eye_rest;
flat in vec4 first_color;
flat in vec4 second_color;
flat in vec3 finish;

out vec4 color;

const float kCloudLayer = 6.0;
const float kCloudsPerMetre = 1.0 / 7.3;
const float kMaxSlope = 2.0;
const float kDielectric = 0.04;  // reflectance of non-metals at normal incidence
const vec3 kPlaster = vec3(0.56, 0.52, 0.45);
const float kJoint = 0.007;  // half the width of a joint between blocks, in metres

#ifdef TEXTURED
// Returns the normal of a normal map on a face with normal n. The directions of the texture
// coordinates follow from the changes of place and coordinates from pixel to pixel: for changes
// `across` and `down` of the place, the gradient g of a coordinate that changes by a and d satisfies
// dot(g, across) = a, dot(g, down) = d and dot(g, n) = 0.
vec3 in_relief(vec3 n, vec3 place) {
  vec3 across = dFdx(place), down = dFdy(place);
  vec2 a = dFdx(picture_uv), d = dFdy(picture_uv);
  vec3 by_across = cross(down, n), by_down = cross(n, across);
  float side = sign(dot(across, by_across));
  vec3 right = side * (a.x * by_across + d.x * by_down);
  vec3 along = side * (a.y * by_across + d.y * by_down);
  vec3 told = texture(pictures, vec3(picture_uv, detail.x - 1.0)).xyz;
  told = (told * 255.0 - 128.0) / 127.0;
  // If the coordinates are constant, the gradients are 0 and the face stays flat.
  right *= inversesqrt(max(dot(right, right), 1e-37));
  along *= inversesqrt(max(dot(along, along), 1e-37));
  return normalize(told.x * right + told.y * along + told.z * n);
}

// Returns the specular reflection of the sun in a face with normal n, times the cosine `slant` to the
// sun: GGX distribution (Trowbridge and Reitz), Smith masking in Hammon's approximation (2017), and
// Schlick's approximation (1994) of Fresnel's equations.
vec3 sun_in(vec3 n, vec3 view, float slant, float roughness, vec3 mirror) {
  vec3 half_way = normalize(sun_rest - view);
  float spread = max(roughness * roughness, 0.015);  // at least the width of the sun and of a pixel
  float square = spread * spread;
  float off = dot(n, half_way);
  float peak = off * off * (square - 1.0) + 1.0;
  float facing = max(-dot(n, view), 1e-3);
  float seen = 0.5 / max(mix(2.0 * slant * facing, slant + facing, spread), 1e-4);
  float grazing = 1.0 - max(-dot(view, half_way), 0.0);
  float grazing2 = grazing * grazing;
  vec3 fresnel = mix(mirror, vec3(1.0), grazing2 * grazing2 * grazing);
  return fresnel * (slant * seen * square / (peak * peak));
}

// Returns the reflection of the surroundings in a face of this roughness; blurred if rough.
vec3 world_in(vec3 n, vec3 view, float roughness, vec3 mirror) {
  vec3 mirrored = reflect(view, n);
  vec3 world = mirrored_at(dot(mirrored, up_rest), dot(mirrored, sun_rest) * (1.0 - roughness),
                           0.04 + 0.5 * roughness);
  world = mix(world, ambient_light(dot(n, up_rest)), roughness * roughness);
  float grazing = 1.0 - max(-dot(n, view), 0.0);
  float grazing2 = grazing * grazing;
  vec3 most = max(vec3(1.0 - roughness), mirror);
  return mix(mirror, most, grazing2 * grazing2 * grazing) * world;
}
#endif

void main() {
  vec3 n = normalize(normal_rest);

  // The texture is projected along the axis to which the normal is closest.
  vec3 a = abs(n);
  vec2 uv = a.y > max(a.x, a.z) ? rest.xz : (a.x > 1.01 * a.z ? rest.zy : rest.xy);
  vec4 tile = texture(tiles, vec3(uv * first_color.w, finish.x));
  vec4 cloud = texture(tiles, vec3(uv * kCloudsPerMetre, kCloudLayer));

  vec3 albedo = mix(first_color.rgb, second_color.rgb, tile.g);
  albedo *= 1.0 + finish.z * (tile.r - 0.5) + 0.5 * (cloud.r - 0.5);

  // Plaster where the weathering noise is high, with a dark rim.
  float bare = second_color.w;
  float plaster = smoothstep(bare - 0.035, bare, cloud.g + 0.08 * (tile.r - 0.5));
  float rim = plaster * (1.0 - smoothstep(bare, bare + 0.05, cloud.g));
  vec3 coat = kPlaster * (0.65 + 0.7 * cloud.r) * (1.0 - 0.25 * rim);
  albedo = mix(albedo, coat, plaster);
  vec2 slope = (mix(tile.ba, cloud.ba, plaster) - 0.5) * (2.0 * kMaxSlope * finish.y);

#ifdef BLOCKS
  // Original edges are worn, and joints between blocks are dark. A joint narrower than a pixel is
  // weighted by the part of the pixel that it covers.
  vec3 to_sides = min(rest - low, high - rest) + 1e4 * step(0.7, a);
  float edge = min(to_sides.x, min(to_sides.y, to_sides.z)) + 0.012 * (cloud.r - 0.5);
  float half_pixel = 0.5 * length(rest - eye_rest) / lens.y + 1e-4;
  float joint = (min(edge + half_pixel, kJoint) - max(edge - half_pixel, -kJoint)) / (2.0 * half_pixel);
  float worn = 1.0 - smoothstep(kJoint, 5.0 * kJoint, edge);
  albedo *= (1.0 + 0.18 * worn) * (1.0 - 0.8 * clamp(joint, 0.0, 1.0));
#endif

#ifdef TEXTURED
  // The colours of a mesh file replace those of the material; some of the grain is kept.
  vec3 shown = texture(pictures, vec3(picture_uv, max(appearance.w - 1.0, 0.0))).rgb;
  shown = shown * (shown * (shown * 0.305306011 + 0.682171111) + 0.012522878);  // from sRGB
  if (appearance.w >= 0.0) {
    albedo = appearance.rgb * (appearance.w > 0.0 ? shown : vec3(1.0));
    slope *= 0.3 * (detail.z < 0.0 ? 1.0 : detail.z);
  }
#endif

  vec3 tilt = a.y > max(a.x, a.z) ? vec3(slope.x, 0.0, slope.y)
                                  : (a.x > 1.01 * a.z ? vec3(0.0, slope.y, slope.x)
                                                      : vec3(slope, 0.0));
  vec3 bumped = normalize(n - tilt + n * dot(n, tilt));
#ifdef TEXTURED
  if (detail.x > 0.0) bumped = in_relief(n, rest - eye_rest);
#endif

  float facing = dot(bumped, sun_rest) * smoothstep(0.0, 0.12, dot(n, sun_rest));
  float sunlit_here = sunlit(shadow);
  vec3 direct = sun_light.rgb * (max(facing, 0.0) * sunlit_here);
  vec3 around = ambient_light(dot(bumped, up_rest));

  vec3 from_eye = rest - eye_rest;
  float metres = length(from_eye);
#ifdef SHINY
  // Metal reflects little diffusely and tints its specular reflections.
  vec3 view = from_eye / metres;
  vec3 mirrored = reflect(view, bumped);
  float grazing = 1.0 - max(-dot(view, bumped), 0.0);
  float fresnel = grazing * grazing;
  fresnel *= fresnel * grazing;
  float sunward = dot(mirrored, sun_rest);
  float shine = max(sunward, 0.0);
  shine *= shine;
  shine *= shine;
  shine *= shine;
  shine *= shine;
  float sharp = shine * shine * shine;
  // Weathered metal is rougher: its reflections are weaker and blurred.
  float rough = smoothstep(0.35, 0.8, cloud.g + 0.3 * (tile.r - 0.5));
  float drawn = texture(tiles, vec3(uv * vec2(1.9, 0.07), kCloudLayer)).r - 0.5;  // drawing marks of steel
  vec3 tint = min(1.5 * first_color.rgb * (0.96 + 0.08 * tile.r + 0.2 * drawn), vec3(1.0));
  vec3 mirror = mix(tint, vec3(1.0), fresnel);
  vec3 world = mirrored_at(dot(mirrored, up_rest) + 0.2 * drawn * (1.0 - grazing), sunward,
                           mix(0.05, 0.25, rough));
  around = tint * (0.1 + 0.1 * rough) * around + mirror * world * (0.85 - 0.3 * rough);
  direct = sun_light.rgb * sunlit_here * (0.12 * tint * max(facing, 0.0) +
                                      mirror * mix(1.6 * sharp, 0.6 * shine, rough));
#else
#ifdef TEXTURED
  vec3 mirror_of_sun = vec3(0.0), mirror_of_world = vec3(0.0);
  if (detail.z >= 0.0) {
    vec2 gloss = detail.zw;
    if (detail.y > 0.0) gloss *= texture(pictures, vec3(picture_uv, detail.y - 1.0)).gb;
    vec3 view = from_eye / metres;
    vec3 mirror = mix(vec3(kDielectric), albedo, gloss.y);
    mirror_of_sun = sun_light.rgb * sunlit_here * sun_in(bumped, view, max(facing, 0.0), gloss.x, mirror);
    mirror_of_world = world_in(bumped, view, gloss.x, mirror);
    albedo *= 1.0 - gloss.y;
  }
  around = around * albedo + mirror_of_world;
  direct = direct * albedo + mirror_of_sun;
#else
  around *= albedo;
  direct *= albedo;
#endif
#endif
  vec3 light = direct + around;
  float ambient_share = dot(around, vec3(0.33)) / max(dot(light, vec3(0.33)), 1e-4);
  color = vec4(mix(horizon.rgb, light, exp2(-metres * kHaze)), ambient_share);
}
