// Draws a file with three.js. The triangles of many bodies are one draw call: their vertices are moved
// by the processor, those of the bodies alone that move, and the indices are those of visible bodies.
'use strict';

const shaders = (() => {
  // The light of the renderer of this project: sky, haze, and light from the sun, sky and ground.
  const common = `
    precision highp float;
    uniform vec3 toSun, sunLight, skyLight, groundColor;
    const float kHaze = 0.0075;  // per metre
    vec3 horizon() { return skyLight * vec3(1.167, 0.972, 0.75); }
    vec3 sky(vec3 ray) {
      float thin = 1.0 - clamp(ray.y, 0.0, 1.0);
      float air = thin * thin;
      float glow = max(dot(ray, toSun), 0.0);
      float glow4 = glow * glow * glow * glow;
      return mix(skyLight * vec3(0.333, 0.417, 0.511), horizon(), 0.22 + 0.78 * air * air) +
             sunLight * vec3(0.1135, 0.1016, 0.078) * (0.35 * glow4 + 0.8 * glow4 * glow4 * glow4 * glow4);
    }
    vec3 ambient(float up) {
      vec3 ground = groundColor * (0.13 * sunLight * toSun.y + 0.25 * skyLight);
      return mix(ground, skyLight, 0.5 + 0.5 * up);
    }
    vec3 shown(vec3 light) {  // exposure, tone curve, then sRGB
      light *= 1.2;
      vec3 part = light / (1.0 + light);
      vec3 c = min(part * (0.4 + 0.88 * part), vec3(1.0));
      vec3 root2 = sqrt(c), root4 = sqrt(root2), root8 = sqrt(root4);
      return mix(12.92 * c, 0.6423657 * root2 + 0.7121104 * root4 - 0.3368699 * root8 - 0.0175631 * c,
                 step(0.0031308, c));
    }`;

  // Without SHADOWS, everything is in the sun: a renderer on the processor takes long for each varying.
  const shadow = `
    #ifdef SHADOWS
    varying vec3 shadowAt;
    uniform sampler2D shadowMap;
    uniform float shadowTexel;
    float sunlit(vec3 at) {
      if (any(greaterThan(abs(at - 0.5), vec3(0.5)))) return 1.0;
      vec4 depth = vec4(texture2D(shadowMap, at.xy + shadowTexel * vec2(0.4, 0.9)).r,
                        texture2D(shadowMap, at.xy + shadowTexel * vec2(-0.9, 0.4)).r,
                        texture2D(shadowMap, at.xy + shadowTexel * vec2(-0.4, -0.9)).r,
                        texture2D(shadowMap, at.xy + shadowTexel * vec2(0.9, -0.4)).r);
      return dot(step(vec4(at.z), depth), vec4(0.25));
    }
    #endif`;

  // Most bodies are MATT: their colour in the sun and in the shade is computed at vertices, which is
  // exact on flat faces, and the pixel has their mixture. Others get light in the sun and in the shade.
  const bodyVertex = `${common}
    attribute vec4 tint;    // square roots of the colour, opacity
    attribute vec4 finish;  // roughness, metallic
    varying vec3 sunny;
    varying vec2 place;
    #ifdef SHADOWS
    uniform mat4 shadowMatrix;
    uniform float normalOffset;
    varying vec3 shady, shadowAt;
    #endif
    #ifndef MATT
    varying float clear;  // transmittance of the air
    #endif
    #ifdef SHINY
    varying vec3 facing, ray, albedo;
    varying vec3 gloss;  // roughness, metallic, opacity
    #endif
    void main() {
      vec3 n = normal;
      vec3 toEye = cameraPosition - position;
      #ifdef GLASS
      if (dot(n, toEye) < 0.0) n = -n;
      #endif
      place = uv;
      vec3 color = tint.rgb * tint.rgb;
      vec3 direct = (1.0 - 0.85 * finish.y) * color * sunLight * max(dot(n, toSun), 0.0);
      vec3 around = (1.0 - 0.85 * finish.y) * color * ambient(n.y);
      float through = exp2(-kHaze * length(toEye));
      #ifdef MATT
      sunny = shown(mix(horizon(), direct + around, through));
      #else
      sunny = direct + around;
      clear = through;
      #endif
      #ifdef SHADOWS
      shadowAt = (shadowMatrix * vec4(position + normalOffset * n, 1.0)).xyz;
      #ifdef MATT
      shady = shown(mix(horizon(), around, through));
      #else
      shady = around;
      #endif
      #endif
      #ifdef SHINY
      facing = n;
      ray = -toEye;
      albedo = color;
      gloss = vec3(finish.xy, tint.a);
      #endif
      gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
    }`;

  const bodyFragment = `${common}${shadow}
    varying vec3 sunny;
    #ifdef SHADOWS
    varying vec3 shady;
    #endif
    varying vec2 place;
    uniform sampler2D image;  // of the material, otherwise the grain
    #ifndef MATT
    varying float clear;
    #endif
    #ifdef SHINY
    varying vec3 facing, ray, albedo;
    varying vec3 gloss;
    vec4 shiny(vec3 light, float lit) {
      vec3 n = normalize(facing), to = normalize(ray);
      vec3 mirrored = reflect(to, n);
      float grazing = clamp(1.0 + dot(to, n), 0.0, 1.0);
      float fresnel = grazing * grazing * grazing * grazing * grazing;
      vec3 world = mix(groundColor * (0.14 * sunLight * toSun.y + 0.3 * skyLight), sky(mirrored),
                       smoothstep(-0.05 - 0.3 * gloss.x, 0.05 + 0.3 * gloss.x, mirrored.y));
      float shine = pow(max(dot(mirrored, toSun), 0.0), mix(300.0, 12.0, min(1.0, gloss.x / 0.6)));
      vec3 reflected = world + sunLight * lit * shine;
      #ifdef GLASS
      // What is behind remains, less the reflected part; broken faces are less clear.
      return vec4(mix(0.3 * light, reflected, max(fresnel, 0.3)), mix(gloss.z, 1.0, fresnel));
      #else
      vec3 mirror = mix(mix(vec3(0.04), min(1.5 * albedo, vec3(1.0)), gloss.y), vec3(1.0), fresnel);
      return vec4(light + mirror * reflected * (1.0 - 0.4 * gloss.x), 1.0);
      #endif
    }
    #endif
    void main() {
      float lit = 1.0;
      vec3 color = sunny;
      #ifdef SHADOWS
      lit = sunlit(shadowAt);
      color = mix(shady, sunny, lit);
      #endif
      #ifdef MATT
      #if defined(SHADOWS) || !defined(SMALL)
      float noise = texture2D(image, place).r - 0.5;
      #ifdef FINE
      noise += 0.8 * (texture2D(image, place * 0.13).g - 0.5);
      #endif
      color *= 1.0 + 0.2 * noise;
      #endif
      gl_FragColor = vec4(color, 1.0);
      #else
      vec4 light = vec4(color, 1.0);
      #ifdef TEXTURED
      vec3 texel = texture2D(image, place).rgb;
      light.rgb *= texel * (texel * (texel * 0.305306011 + 0.682171111) + 0.012522878);
      #endif
      #ifdef SHINY
      light = shiny(light.rgb, lit);
      #endif
      gl_FragColor = vec4(shown(mix(horizon(), light.rgb, clear)), light.a);
      #endif
    }`;

  const groundVertex = `
    precision highp float;
    varying vec3 world;
    #ifdef SHADOWS
    uniform mat4 shadowMatrix;
    varying vec3 shadowAt;
    #endif
    void main() {
      world = (modelMatrix * vec4(position, 1.0)).xyz;
      #ifdef SHADOWS
      shadowAt = (shadowMatrix * vec4(world, 1.0)).xyz;
      #endif
      gl_Position = projectionMatrix * viewMatrix * vec4(world, 1.0);
    }`;

  const groundFragment = `${common}${shadow}
    varying vec3 world;
    uniform sampler2D image;
    void main() {
      float lit = 1.0;
      #ifdef SHADOWS
      lit = sunlit(shadowAt);
      #endif
      float metres = distance(world, cameraPosition);
      vec2 broad = texture2D(image, world.zx * 0.013).rg;
      #ifdef FINE
      float fine = texture2D(image, world.xz * 0.23).r;
      #else
      float fine = 0.5;
      #endif
      vec3 albedo = groundColor * (0.3 + 0.5 * fine + 0.4 * broad.g + 0.2 * smoothstep(0.3, 0.7, broad.r));
      vec3 light = albedo * (sunLight * toSun.y * lit + ambient(1.0));
      gl_FragColor = vec4(shown(mix(horizon(), light, exp2(-kHaze * metres))), 1.0);
    }`;

  // The sky is computed at the corners of a grid on the screen.
  const skyVertex = `${common}
    uniform mat4 rays;
    varying vec3 color;
    void main() {
      color = shown(sky(normalize((rays * vec4(position.xy, 1.0, 1.0)).xyz)));
      gl_Position = vec4(position.xy, 1.0, 1.0);
    }`;
  const skyFragment = `
    precision mediump float;
    varying vec3 color;
    void main() { gl_FragColor = vec4(color, 1.0); }`;

  const depthVertex = 'void main() { gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0); }';
  const depthFragment = 'void main() { gl_FragColor = vec4(1.0); }';

  const markVertex = `
    varying float up;
    void main() {
      up = normal.y;
      gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
      gl_Position.z -= 1e-4 * gl_Position.w;
    }`;
  const markFragment = `
    varying float up;
    void main() {
      gl_FragColor = vec4(mix(vec3(0.1, 0.5, 0.75), vec3(0.5, 0.9, 1.0), 0.5 + 0.5 * up), 0.75);
    }`;

  // The farthest depth of a square of pixels, in 24 bits; a little less than 1 for the sky.
  const squareVertex = 'void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }';
  const squareFragment = `
    precision highp float;
    uniform highp sampler2D depths;
    uniform vec2 texel;
    void main() {
      vec2 first = (floor(gl_FragCoord.xy) * float(SQUARE) + 0.5) * texel;
      float farthest = 0.0;
      for (int y = 0; y < SQUARE; ++y) {
        for (int x = 0; x < SQUARE; ++x) {
          farthest = max(farthest, texture2D(depths, first + vec2(float(x), float(y)) * texel).r);
        }
      }
      vec3 digits = fract(min(farthest, 0.9999999) * vec3(1.0, 255.0, 65025.0));
      gl_FragColor = vec4(digits.xy - digits.yz / 255.0, digits.z, 1.0);
    }`;

  return {bodyVertex, bodyFragment, groundVertex, groundFragment, skyVertex, skyFragment,
          depthVertex, depthFragment, markVertex, markFragment, squareVertex, squareFragment};
})();

const kGrains = 0.45;         // periods of the grain per metre
const kMaxVertices = 20000;  // of a batch: few enough to upload those that changed, one draw call each

// Triangles that are drawn in one call. An entry is a mesh on a node: `part` of the file, `node` that
// shows it, `mover` that moves it (-1: none), `local`, its matrix to the mover.
class Batch {
  constructor(kind) {
    this.kind = kind;
    this.entries = [];
    this.shown = [];  // entries that are visible
    this.vertexCount = 0;
    this.indexCount = 0;
    this.firstMoved = Infinity;  // vertices that have moved since they were uploaded
    this.endMoved = 0;
  }

  hasRoom(part) {
    return this.vertexCount === 0 || this.vertexCount + part.positions.length / 3 <= kMaxVertices;
  }

  add(entry) {
    entry.firstVertex = this.vertexCount;
    entry.vertexCount = entry.part.positions.length / 3;
    entry.firstIndex = this.indexCount;
    entry.place = new THREE.Vector3();  // centre in the world
    entry.image = 0;  // number of the image of DepthGrid, and the places along the view in it and in the next
    entry.depth = entry.nextDepth = -Infinity;
    entry.version = -1;     // of the mover's matrix
    entry.isStale = false;  // true if the vertices are not yet where the mover is
    this.vertexCount += entry.vertexCount;
    this.indexCount += entry.part.indices.length;
    this.entries.push(entry);
  }

  build(looks) {
    const count = this.vertexCount;
    this.positions = new Float32Array(3 * count);  // in the frame of the mover
    this.normals = new Int8Array(4 * count);
    const tints = new Uint8Array(4 * count), finishes = new Uint8Array(4 * count);
    this.uvs = new Float32Array(2 * count);
    this.all = new Uint32Array(this.indexCount);
    for (const entry of this.entries) this.fill(entry, looks[entry.part.material + 1], tints, finishes);
    const geometry = this.geometry = new THREE.BufferGeometry();
    const attribute = (name, array, size, isFraction) => {
      const made = new THREE.BufferAttribute(array, size, isFraction);
      geometry.setAttribute(name, made);
      return made;
    };
    this.places = attribute('position', new Float32Array(3 * count), 3, false);
    this.facings = attribute('normal', new Int8Array(4 * count), 4, true);
    for (const made of [this.places, this.facings]) made.setUsage(THREE.DynamicDrawUsage);
    attribute('tint', tints, 4, true);
    attribute('finish', finishes, 4, true);
    attribute('uv', this.uvs, 2, false);
    geometry.setIndex(this.makeIndices());
    this.mesh = new THREE.Mesh(geometry);
    this.mesh.frustumCulled = false;
  }

  makeIndices() {
    const Index = this.vertexCount > 65535 ? Uint32Array : Uint16Array;
    return new THREE.BufferAttribute(new Index(this.indexCount), 1).setUsage(THREE.DynamicDrawUsage);
  }

  // Makes the mesh for the shadow map. `isOwn`: it has indices of its own.
  buildCaster(material, isOwn) {
    const geometry = isOwn ? new THREE.BufferGeometry() : this.geometry;
    if (isOwn) {
      geometry.setAttribute('position', this.places);
      geometry.setIndex(this.makeIndices());
    }
    this.caster = new THREE.Mesh(geometry, material);
    this.caster.frustumCulled = false;
  }

  // Copies an entry into the frame of its mover, and finds its bounds there.
  fill(entry, look, tints, finishes) {
    const {part, local, rest} = entry, {positions, normals, uvs} = this;
    const source = part.positions, m = local.elements;
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    const at = [0, 0, 0], n = [0, 0, 0];
    for (let i = 0, vertex = entry.firstVertex; i < source.length; i += 3, ++vertex) {
      const x = source[i], y = source[i + 1], z = source[i + 2];
      const u = part.normals[i], v = part.normals[i + 1], w = part.normals[i + 2];
      for (let axis = 0; axis < 3; ++axis) {
        at[axis] = m[axis] * x + m[axis + 4] * y + m[axis + 8] * z + m[axis + 12];
        n[axis] = m[axis] * u + m[axis + 4] * v + m[axis + 8] * w;
        if (at[axis] < low[axis]) low[axis] = at[axis];
        if (at[axis] > high[axis]) high[axis] = at[axis];
      }
      const scale = 127 / (Math.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) || 1);
      for (let axis = 0; axis < 3; ++axis) {
        positions[3 * vertex + axis] = at[axis];
        normals[4 * vertex + axis] = n[axis] * scale;
      }
      tints.set(look.tint, 4 * vertex);
      finishes.set(look.finish, 4 * vertex);
      if (!part.uvs || this.kind.texture < 0) {
        // The grain is projected along the axis to which the normal is closest.
        const a = Math.abs(n[0]), b = Math.abs(n[1]), c = Math.abs(n[2]);
        const isUp = b > Math.max(a, c);
        uvs[2 * vertex] = kGrains * (isUp || a <= 1.01 * c ? at[0] + rest[0] : at[2] + rest[2]);
        uvs[2 * vertex + 1] = kGrains * (isUp ? at[2] + rest[2] : at[1] + rest[1]);
      }
    }
    if (part.uvs && this.kind.texture >= 0) uvs.set(part.uvs, 2 * entry.firstVertex);
    for (let i = 0; i < part.indices.length; ++i) {
      this.all[entry.firstIndex + i] = part.indices[i] + entry.firstVertex;
    }
    entry.meanArea = this.areaOf(entry) / (part.indices.length / 3);
    entry.center = low.map((value, axis) => 0.5 * (value + high[axis]));
    entry.radius = 0.5 * Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
  }

  // Returns the area of the triangles of an entry.
  areaOf({firstIndex, part}) {
    const {all, positions: p} = this, end = firstIndex + part.indices.length;
    let area = 0;
    for (let i = firstIndex; i < end; i += 3) {
      const a = 3 * all[i], b = 3 * all[i + 1], c = 3 * all[i + 2];
      const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
      const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
      area += 0.5 * Math.sqrt((uy * vz - uz * vy) ** 2 + (uz * vx - ux * vz) ** 2 + (ux * vy - uy * vx) ** 2);
    }
    return area;
  }

  // Lists the entries that are visible. Returns true if others are than before.
  show(isVisible) {
    const {shown} = this;
    let count = 0, isSame = true;
    for (const entry of this.entries) {
      if (!isVisible[entry.node]) continue;
      if (shown[count] !== entry) isSame = false;
      shown[count++] = entry;
    }
    isSame = isSame && count === shown.length;
    shown.length = count;
    return !isSame;
  }

  // Draws all triangles of the visible entries.
  drawAll() {
    const to = this.geometry.index.array;
    let size = 0;
    for (const entry of this.shown) {
      if (entry.isStale) this.moveEntry(entry);
      const {firstIndex, part} = entry;
      const end = firstIndex + part.indices.length;
      for (let i = firstIndex; i < end; ++i) to[size++] = this.all[i];
    }
    this.setSize(this.mesh, size);
    if (this.caster) this.caster.visible = size > 0;
  }

  // Draws the triangles of the visible entries that face a place (w = 1) or a direction (w = 0). A
  // renderer on the processor takes as long for the others. `leastOf` returns for an entry the least
  // 2 area distance cos(angle) of a triangle (w = 0: without the distance); Infinity: none is drawn.
  drawFacing(mesh, {x, y, z}, w, leastOf) {
    const to = mesh.geometry.index.array, {all} = this, p = this.places.array;
    let size = 0;
    for (const entry of this.shown) {
      const least = leastOf(entry);
      if (least === Infinity) continue;
      if (entry.isStale) this.moveEntry(entry);
      const end = entry.firstIndex + entry.part.indices.length;
      for (let i = entry.firstIndex; i < end; i += 3) {
        const a = 3 * all[i], b = 3 * all[i + 1], c = 3 * all[i + 2];
        const px = p[a], py = p[a + 1], pz = p[a + 2];
        const ux = p[b] - px, uy = p[b + 1] - py, uz = p[b + 2] - pz;
        const vx = p[c] - px, vy = p[c + 1] - py, vz = p[c + 2] - pz;
        const facing = (uy * vz - uz * vy) * (x - w * px) + (uz * vx - ux * vz) * (y - w * py) +
                       (ux * vy - uy * vx) * (z - w * pz);
        if (facing <= least) continue;
        to[size++] = all[i];
        to[size++] = all[i + 1];
        to[size++] = all[i + 2];
      }
    }
    this.setSize(mesh, size);
  }

  // Has `size` indices drawn, and what has changed uploaded.
  setSize(mesh, size) {
    this.upload();
    const {index} = mesh.geometry;
    mesh.geometry.setDrawRange(0, size);
    index.updateRange = {offset: 0, count: Math.max(size, 1)};
    index.needsUpdate = true;
    mesh.visible = size > 0;
  }

  // Moves the centres of visible entries to where their movers are; the vertices are moved when they are
  // drawn.
  move(worlds, versions) {
    this.worlds = worlds;
    for (const entry of this.shown) {
      const version = entry.mover < 0 ? 0 : versions[entry.mover];
      if (entry.version === version) continue;
      entry.version = version;
      entry.isStale = true;
      const [x, y, z] = entry.center, w = 12 * entry.mover;
      if (entry.mover < 0) {
        entry.place.set(x, y, z);
      } else {
        entry.place.set(worlds[w] * x + worlds[w + 1] * y + worlds[w + 2] * z + worlds[w + 3],
                        worlds[w + 4] * x + worlds[w + 5] * y + worlds[w + 6] * z + worlds[w + 7],
                        worlds[w + 8] * x + worlds[w + 9] * y + worlds[w + 10] * z + worlds[w + 11]);
      }
    }
  }

  // Moves the vertices of all visible entries.
  moveShown() {
    for (const entry of this.shown) if (entry.isStale) this.moveEntry(entry);
    this.upload();
  }

  // Has the vertices that have moved uploaded.
  upload() {
    const {firstMoved: first, endMoved: end} = this;
    if (end === 0) return;
    for (const attribute of [this.places, this.facings]) {
      // What is still to be uploaded stays in the range; three.js sets the count to -1 afterwards.
      const {itemSize, updateRange: {offset, count}} = attribute;
      const from = Math.min(first * itemSize, count > 0 ? offset : Infinity);
      const to = Math.max(end * itemSize, count > 0 ? offset + count : 0);
      attribute.updateRange = {offset: from, count: to - from};
      attribute.needsUpdate = true;
    }
    this.firstMoved = Infinity;
    this.endMoved = 0;
  }

  // Moves the vertices of an entry to where its mover is.
  moveEntry(entry) {
    const {positions, normals, worlds} = this, places = this.places.array, facings = this.facings.array;
    const begin = entry.firstVertex, end = begin + entry.vertexCount;
    entry.isStale = false;
    this.firstMoved = Math.min(this.firstMoved, begin);
    this.endMoved = Math.max(this.endMoved, end);
    if (entry.mover < 0) {
      places.set(positions.subarray(3 * begin, 3 * end), 3 * begin);
      facings.set(normals.subarray(4 * begin, 4 * end), 4 * begin);
      return;
    }
    const w = 12 * entry.mover;
    const unscaled = 1 / (Math.hypot(worlds[w], worlds[w + 4], worlds[w + 8]) || 1);
    const a = worlds[w], b = worlds[w + 1], c = worlds[w + 2], tx = worlds[w + 3], e = worlds[w + 4],
          f = worlds[w + 5], g = worlds[w + 6], ty = worlds[w + 7], h = worlds[w + 8],
          j = worlds[w + 9], k = worlds[w + 10], tz = worlds[w + 11];
    for (let i = 3 * begin, o = 4 * begin; i < 3 * end; i += 3, o += 4) {
      const x = positions[i], y = positions[i + 1], z = positions[i + 2];
      places[i] = a * x + b * y + c * z + tx;
      places[i + 1] = e * x + f * y + g * z + ty;
      places[i + 2] = h * x + j * y + k * z + tz;
      const u = normals[o] * unscaled, v = normals[o + 1] * unscaled, n = normals[o + 2] * unscaled;
      facings[o] = a * u + b * v + c * n;
      facings[o + 1] = e * u + f * v + g * n;
      facings[o + 2] = h * u + j * v + k * n;
    }
  }
}

const kSquare = 4;      // pixels of a side
const kGridEvery = 2;   // frames for one in which the squares are drawn
const kFarDigits = 2;   // in units of the last digit: more than the error of a stored depth

// What an earlier image hides: the farthest depth in each square of pixels. An entry whose squares are all
// nearer than itself need not be drawn. What comes into view is drawn a few frames late. Needs WebGL 2.
class DepthGrid {
  constructor(renderer) {
    this.renderer = renderer;
    this.gl = renderer.getContext();
    this.buffer = this.gl.createBuffer();
    this.uniforms = {depths: {value: null}, texel: {value: new THREE.Vector2()}};
    const material = new THREE.ShaderMaterial({
      vertexShader: shaders.squareVertex, fragmentShader: shaders.squareFragment, uniforms: this.uniforms,
      defines: {SQUARE: kSquare}, depthTest: false, depthWrite: false});
    this.mesh = new THREE.Mesh(new THREE.PlaneBufferGeometry(2, 2), material);
    this.mesh.frustumCulled = false;
    this.image = this.next = null;  // the image that was read, and the one that is being drawn
    this.number = 0;                // of images that were read
  }

  // True if the next image is not yet finished.
  get isBusy() { return this.next !== null; }

  // Draws the squares of a depth texture, an image of a camera, unless isBusy. read() fetches them once
  // they are drawn, as waiting for them would take as long as drawing.
  draw(depthTexture, texels, camera) {
    const {renderer, gl} = this;
    const width = Math.ceil(texels.width / kSquare), height = Math.ceil(texels.height / kSquare);
    if (!this.target || this.target.width !== width || this.target.height !== height) {
      if (this.target) this.target.dispose();
      this.target = new THREE.WebGLRenderTarget(width, height, {depthBuffer: false, stencilBuffer: false});
      gl.bindBuffer(gl.PIXEL_PACK_BUFFER, this.buffer);
      gl.bufferData(gl.PIXEL_PACK_BUFFER, 4 * width * height, gl.STREAM_COPY);
    }
    this.uniforms.depths.value = depthTexture;
    this.uniforms.texel.value.set(1 / texels.width, 1 / texels.height);
    renderer.setRenderTarget(this.target);
    renderer.render(this.mesh, camera);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, this.buffer);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, 0);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
    renderer.setRenderTarget(null);
    this.next = {
      width, height, isDrawn: gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0),
      view: camera.matrixWorldInverse.elements.slice(), projection: camera.projectionMatrix.elements.slice()};
    gl.flush();
  }

  // Reads the next image, if it is finished.
  read() {
    const {gl, next} = this;
    if (!next || gl.getSyncParameter(next.isDrawn, gl.SYNC_STATUS) !== gl.SIGNALED) return;
    const bytes = new Uint8Array(4 * next.width * next.height);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, this.buffer);
    gl.getBufferSubData(gl.PIXEL_PACK_BUFFER, 0, bytes);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
    next.depths = new Float32Array(next.width * next.height);
    for (let i = 0, at = 0; i < next.depths.length; ++i, at += 4) {
      next.depths[i] = (bytes[at] + (bytes[at + 1] + (bytes[at + 2] + kFarDigits) / 255) / 255) / 255;
    }
    this.forgetNext();
    this.image = next;
    ++this.number;
  }

  forgetNext() {
    if (this.next) this.gl.deleteSync(this.next.isDrawn);
    this.next = null;
  }

  // Forgets all images.
  clear() {
    this.forgetNext();
    this.image = null;
  }

  // Returns true if the image that was read hides an entry, by the sphere around it. `isNext`: draw() will
  // follow.
  hides(entry, isNext) {
    if (!this.image) return false;
    const {view: v, projection: p, width, height, depths} = this.image, {place: {x, y, z}, radius} = entry;
    const depth = v[2] * x + v[6] * y + v[10] * z + v[14];
    if (entry.image !== this.number) {
      entry.image = this.number;
      entry.depth = entry.nextDepth;
    }
    if (isNext) entry.nextDepth = depth;
    // What has moved away since the image is taken for where it was: its own image must not hide it.
    const near = Math.max(depth, entry.depth) + radius, nearW = p[11] * near + p[15];
    if (nearW <= 0.1) return false;
    const w = p[11] * depth + p[15];
    const across = (p[0] * (v[0] * x + v[4] * y + v[8] * z + v[12]) + p[8] * depth + p[12]) / w;
    const up = (p[5] * (v[1] * x + v[5] * y + v[9] * z + v[13]) + p[9] * depth + p[13]) / w;
    const wide = radius * p[0] * (1 + Math.abs(across)) / nearW, high = radius * p[5] * (1 + Math.abs(up)) / nearW;
    const left = Math.floor((0.5 + 0.5 * (across - wide)) * width);
    const right = Math.floor((0.5 + 0.5 * (across + wide)) * width);
    const low = Math.floor((0.5 + 0.5 * (up - high)) * height);
    const top = Math.floor((0.5 + 0.5 * (up + high)) * height);
    if (right < 0 || left >= width || top < 0 || low >= height) return false;
    const nearest = 0.5 + 0.5 * (p[10] * near + p[14]) / nearW;
    for (let row = Math.max(low, 0); row <= top && row < height; ++row) {
      const end = row * width + Math.min(right, width - 1);
      for (let at = row * width + Math.max(left, 0); at <= end; ++at) {
        if (nearest <= depths[at]) return false;
      }
    }
    return true;
  }
}

const kLargest = 200;  // radius in metres from which a mesh is a landscape

// Work per frame, from the least on: the shadow map and every how many frames it is drawn, and the
// pixels of the image per pixel of the page, along each side.
const kQualities = [
  {shadowTexels: 0, shadowEvery: 1, scale: 0.6},
  {shadowTexels: 1024, shadowEvery: 3, scale: 0.75},
  {shadowTexels: 1024, shadowEvery: 2, scale: 1},
  {shadowTexels: 2048, shadowEvery: 1, scale: 1.5},
  {shadowTexels: 2048, shadowEvery: 1, scale: 2},
];
const kBestQuality = kQualities.length - 1;
// Pixels that a triangle covers, to be drawn while the picture moves; or else its share of the mean area of
// the triangles of its mesh.
const kLeastPixels = 0.25, kLeastShare = 0.1;
const kCrowd = 15000;        // visible triangles from which those are found that others hide
const kSmall = 1;            // diagonal in metres of meshes that have no grain where there are no shadows
const kLeastTexels = 2;  // of the shadow map: radius of the smallest meshes that have a shadow

class Stage {
  constructor(canvas, file, motion) {
    this.file = file;
    this.motion = motion;
    this.canvas = canvas;
    const wanted = {alpha: false, antialias: !Stage.isSoftware(), powerPreference: 'high-performance'};
    const context = canvas.getContext('webgl2', wanted) || canvas.getContext('webgl', wanted);
    if (!context) throw new Error('this browser has no WebGL');
    this.renderer = new THREE.WebGLRenderer({canvas, context});
    this.renderer.autoClear = false;
    this.gl = context;
    this.culls = Stage.isSoftware();
    this.quality = Stage.isSoftware() ? 2 : kBestQuality;
    this.scene = new THREE.Scene();
    this.casters = new THREE.Scene();
    this.shadowed = [];
    this.camera = new THREE.PerspectiveCamera(45, 1, 0.05, 2000);
    this.bodies = this.findBodies();
    this.batches = this.makeBatches();
    motion.set(0);
    this.makeUniforms();
    this.build();
    this.mark = null;
    this.drawn = 0;  // number of frames
    this.crowd = kCrowd;
    this.grid = this.culls && context.blitFramebuffer ? new DepthGrid(this.renderer) : null;
    this.setTime(0);
    this.addSurroundings();
  }

  // True if the browser draws on the processor.
  static isSoftware() {
    if (Stage.software !== undefined) return Stage.software;
    const gl = document.createElement('canvas').getContext('webgl');
    const info = gl && gl.getExtension('WEBGL_debug_renderer_info');
    const name = info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : '';
    return Stage.software = /swiftshader|llvmpipe|software|basic render/i.test(name);
  }

  // Returns for each node the one of the body that it is part of; -1 for none.
  findBodies() {
    const {nodes} = this.file, bodies = new Int32Array(nodes.length).fill(-1);
    for (const node of this.motion.order) {
      const parent = this.motion.parents[node];
      const extras = nodes[node].extras;
      bodies[node] = extras && extras.key !== undefined ? node : parent >= 0 ? bodies[parent] : -1;
    }
    return bodies;
  }

  // Returns for each node 1 if tracks move it, and not only show and hide it.
  findMovers() {
    const moves = new Uint8Array(this.motion.count);
    this.hides = new Uint8Array(this.motion.count);
    for (const track of this.motion.tracks) {
      const shows = track.path === 'scale' && track.isStep && track.values.every(v => v === 0 || v === 1);
      if (shows) this.hides[track.node] = 1; else moves[track.node] = 1;
    }
    return moves;
  }

  localMatrix(node) {
    const {translations, rotations, scales} = this.motion;
    const scale = this.hides[node] ? new THREE.Vector3(1, 1, 1) : new THREE.Vector3().fromArray(scales, 3 * node);
    return new THREE.Matrix4().compose(new THREE.Vector3().fromArray(translations, 3 * node),
                                       new THREE.Quaternion().fromArray(rotations, 4 * node), scale);
  }

  // Returns for each body the position of its origin in the frame that its solid had at the start, so
  // that the grain stays in place where a body breaks: from the poses of body and parent when it appears.
  findRestPlaces() {
    const {nodes} = this.file, rests = new Map(), byKey = new Map();
    nodes.forEach((node, index) => { if (node.extras && node.extras.key !== undefined) byKey.set(node.extras.key, index); });
    const bodies = [...byKey.values()].sort((a, b) => (nodes[a].extras.born_s || 0) - (nodes[b].extras.born_s || 0));
    for (const body of bodies) {
      const {parent, born_s: born = 0} = nodes[body].extras, from = byKey.get(parent);
      if (from === undefined || from === body || !rests.has(from)) {
        rests.set(body, [0, 0, 0]);
        continue;
      }
      const [here, there] = [body, from].map(node => this.motion.poseAt(node, born));
      const offset = here.position.sub(there.position).applyQuaternion(there.rotation.inverse()).toArray();
      rests.set(body, rests.get(from).map((value, axis) => value + offset[axis]));
    }
    return rests;
  }

  // Returns how the vertices of each material look, from material -1 (none) on.
  findLooks() {
    return [Stage.plain, ...this.file.materials].map(material => {
      const roots = material.color.slice(0, 3).map(part => 255 * Math.sqrt(Math.min(1, Math.max(0, part))));
      const isInside = material.name.endsWith(' inside');
      const opacity = material.isGlass ? (isInside ? 0.35 : 0.06) : 1;
      return {tint: [...roots, 255 * opacity],
              finish: [255 * material.roughness, 255 * material.metallic, 0, 0]};
    });
  }

  // Sorts the meshes of all nodes into batches, in the order in which they appear.
  makeBatches() {
    const {file, motion} = this, moves = this.findMovers(), rests = this.findRestPlaces();
    const batches = [], open = new Map(), origin = [0, 0, 0];
    this.ground = null;
    const bornAt = node => this.bodies[node] < 0 ? 0 : file.nodes[this.bodies[node]].extras.born_s || 0;
    // Instances (debris) are left out: they are nodes of their own every 1/15 s.
    const isDrawn = ({mesh, extensions = {}}) => mesh !== undefined && !extensions.EXT_mesh_gpu_instancing;
    const order = file.nodes.map((_, node) => node).filter(node => isDrawn(file.nodes[node]))
                      .sort((a, b) => bornAt(a) - bornAt(b) || a - b);
    for (const node of order) {
      if (file.nodes[node].name === 'ground' && this.bodies[node] < 0) {
        this.ground = node;
        continue;
      }
      let mover = node;
      const local = new THREE.Matrix4();
      while (mover >= 0 && !moves[mover]) {
        local.premultiply(this.localMatrix(mover));
        mover = motion.parents[mover];
      }
      const rest = mover >= 0 && rests.get(this.bodies[node]) || origin;
      for (const part of file.meshes[file.nodes[node].mesh]) {
        const material = file.materials[part.material] || Stage.plain;
        const kind = {isGlass: material.isGlass, isShiny: material.isGlass || material.roughness < 0.6,
                      texture: part.uvs ? material.texture : -1, isSmall: Stage.isSmall(part, local)};
        const key = JSON.stringify(kind);
        if (!open.has(key) || !open.get(key).hasRoom(part)) {
          open.set(key, new Batch(kind));
          batches.push(open.get(key));
        }
        open.get(key).add({part, node, mover, local, rest});
      }
    }
    return batches;
  }

  // True if the grain of a mesh is hardly visible.
  static isSmall({positions}, local) {
    const box = new THREE.Box3().setFromArray(positions).applyMatrix4(local);
    return box.getSize(new THREE.Vector3()).length() < kSmall;
  }

  makeUniforms() {
    const {file, motion} = this;
    const toSun = new THREE.Vector3(0.5, 0.7, 0.4), sun = new THREE.Vector3(3.7, 3.05, 2.3);
    if (file.sun) {
      toSun.set(0, 0, 1).transformDirection(motion.matrix(file.sun.node));
      sun.fromArray(file.sun.color).multiplyScalar(file.sun.intensity);
    }
    const ground = this.ground === null ? Stage.plain : file.materials[file.meshes[file.nodes[this.ground].mesh][0].material];
    this.uniforms = {
      toSun: {value: toSun.normalize()}, sunLight: {value: sun},
      skyLight: {value: new THREE.Vector3(0.6, 0.72, 0.92)},
      groundColor: {value: new THREE.Vector3(...ground.color.slice(0, 3))},
      normalOffset: {value: 0}, shadowMatrix: {value: new THREE.Matrix4()},
      shadowMap: {value: null}, shadowTexel: {value: 0},
      image: {value: Stage.makeGrain()}, rays: {value: new THREE.Matrix4()},
    };
  }

  // Returns a texture of smooth noise in two scales, which repeats.
  static makeGrain() {
    const size = 256, data = new Uint8Array(4 * size * size);
    let state = 1;
    const random = () => (state = (state * 1664525 + 1013904223) >>> 0) / 4294967296;
    const sum = channel => {
      const total = new Float32Array(size * size);
      for (let cells = channel ? 4 : 12, weight = channel ? 0.5 : 0.3; cells <= size; cells *= 2, weight *= channel ? 0.6 : 0.9) {
        const grid = Float32Array.from({length: cells * cells}, random);
        for (let i = 0; i < size * size; ++i) {
          const x = (i % size) * cells / size, y = Math.floor(i / size) * cells / size;
          const x0 = Math.floor(x), y0 = Math.floor(y), x1 = (x0 + 1) % cells, y1 = (y0 + 1) % cells;
          const u = x - x0, v = y - y0, s = u * u * (3 - 2 * u), t = v * v * (3 - 2 * v);
          total[i] += weight * ((grid[y0 * cells + x0] * (1 - s) + grid[y0 * cells + x1] * s) * (1 - t) +
                                (grid[y1 * cells + x0] * (1 - s) + grid[y1 * cells + x1] * s) * t);
        }
      }
      return total;
    };
    for (const channel of [0, 1]) {
      const total = sum(channel);
      let low = Infinity, high = -Infinity;
      for (const value of total) low = Math.min(low, value), high = Math.max(high, value);
      for (let i = 0; i < size * size; ++i) data[4 * i + channel] = 255 * (total[i] - low) / (high - low);
    }
    const texture = new THREE.DataTexture(data, size, size, THREE.RGBAFormat);
    texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
    texture.magFilter = THREE.LinearFilter;
    texture.minFilter = Stage.isSoftware() ? THREE.LinearMipmapNearestFilter : THREE.LinearMipmapLinearFilter;
    texture.generateMipmaps = true;
    texture.needsUpdate = true;
    return texture;
  }

  shader(vertexShader, fragmentShader, more = {}) {
    const defines = Stage.isSoftware() ? {} : {FINE: ''};
    return new THREE.ShaderMaterial({vertexShader, fragmentShader, uniforms: this.uniforms, ...more,
                                     defines: {...defines, ...more.defines}});
  }

  // Returns the materials of a mesh without shadows and with them.
  shaderPair(vertexShader, fragmentShader, more = {}) {
    return [{}, {SHADOWS: ''}].map(
        defines => this.shader(vertexShader, fragmentShader, {...more, defines: {...more.defines, ...defines}}));
  }

  bodyShaders({isGlass, isShiny, texture, isSmall}) {
    const more = {defines: {}, transparent: isGlass, depthWrite: !isGlass,
                  side: isGlass ? THREE.DoubleSide : THREE.FrontSide};
    if (isGlass) more.defines.GLASS = '';
    if (isShiny) more.defines.SHINY = '';
    if (isSmall) more.defines.SMALL = '';
    if (!isShiny && texture < 0) more.defines.MATT = '';
    if (texture >= 0) {
      more.defines.TEXTURED = '';
      more.uniforms = {...this.uniforms, image: {value: this.loadTexture(texture)}};
    }
    return this.shaderPair(shaders.bodyVertex, shaders.bodyFragment, more);
  }

  build() {
    const depthMaterial = this.shader(shaders.depthVertex, shaders.depthFragment,
                                      {side: THREE.DoubleSide, colorWrite: false});
    const looks = this.findLooks(), materials = new Map();
    for (const batch of this.batches) {
      const key = JSON.stringify(batch.kind);
      if (!materials.has(key)) materials.set(key, this.bodyShaders(batch.kind));
      batch.build(looks);
      this.addShadowed(batch.mesh, materials.get(key));
      if (batch.kind.isGlass) continue;
      batch.buildCaster(depthMaterial, this.culls);
      this.casters.add(batch.caster);
    }
  }

  // Adds a mesh whose material is one of a pair, by the shadows that there are.
  addShadowed(mesh, materials) {
    this.shadowed.push({mesh, materials});
    this.scene.add(mesh);
  }

  loadTexture(index) {
    const address = this.file.images[this.file.textures[index]];
    const texture = new THREE.Texture();
    texture.flipY = false;
    texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
    texture.anisotropy = 4;
    if (!address) return texture;
    const image = new Image();
    image.onload = () => {
      texture.image = image;
      texture.needsUpdate = true;
      this.isDirty = true;
    };
    image.src = address;
    return texture;
  }

  // Adds ground and sky, and finds the region of shadows: around what is visible at the start.
  addSurroundings() {
    const box = new THREE.Box3();
    for (const batch of this.batches) {
      for (const {place, radius} of batch.shown) {
        if (radius > kLargest) continue;
        box.expandByPoint(place.clone().addScalar(radius));
        box.expandByPoint(place.clone().addScalar(-radius));
      }
    }
    if (box.isEmpty()) box.expandByPoint(new THREE.Vector3(-1, 0, -1)).expandByPoint(new THREE.Vector3(1, 1, 1));
    this.box = box;
    const place = this.ground === null ? null : this.motion.matrix(this.ground);
    const height = place ? place.elements[13] : box.min.y;
    if (this.ground !== null || this.batches.every(batch => batch.entries.every(entry => entry.radius < kLargest))) {
      const disc = new THREE.Mesh(new THREE.CircleBufferGeometry(1500, 48).rotateX(-Math.PI / 2));
      disc.position.set(0, height, 0);
      disc.renderOrder = 1;
      this.addShadowed(disc, this.shaderPair(shaders.groundVertex, shaders.groundFragment));
    }
    const sky = new THREE.Mesh(new THREE.PlaneBufferGeometry(2, 2, 24, 24),
                               this.shader(shaders.skyVertex, shaders.skyFragment,
                                           {depthWrite: false, depthFunc: THREE.LessEqualDepth}));
    sky.frustumCulled = false;
    sky.renderOrder = 2;
    this.scene.add(sky);
    this.aimShadows(box, height);
  }

  aimShadows(box, height) {
    const sphere = box.getBoundingSphere(new THREE.Sphere());
    const radius = 1.35 * sphere.radius + 0.5;
    const camera = this.sunCamera = new THREE.OrthographicCamera(-radius, radius, radius, -radius, 0.1, 6 * radius);
    const center = new THREE.Vector3(sphere.center.x, Math.max(height, sphere.center.y - 0.3 * radius), sphere.center.z);
    camera.position.copy(center).addScaledVector(this.uniforms.toSun.value, 3 * radius);
    camera.lookAt(center);
    camera.updateMatrixWorld();
    camera.updateProjectionMatrix();
    const half = new THREE.Matrix4().set(0.5, 0, 0, 0.5, 0, 0.5, 0, 0.5, 0, 0, 0.5, 0.4985, 0, 0, 0, 1);
    this.uniforms.shadowMatrix.value.multiplyMatrices(half, camera.projectionMatrix).multiply(camera.matrixWorldInverse);
    this.shadowRadius = radius;
  }

  setQuality(quality) {
    if (quality === this.quality) return;
    this.quality = quality;
    this.updateTargets();
  }

  // Makes the shadow map that the quality asks for.
  updateTargets() {
    const {shadowTexels, scale} = kQualities[this.quality];
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, scale));
    this.renderer.setSize(this.canvas.clientWidth, this.canvas.clientHeight, false);
    const current = this.shadowTarget ? this.shadowTarget.width : 0;
    if (current !== shadowTexels) {
      if (this.shadowTarget) this.shadowTarget.dispose();
      this.shadowTarget = null;
      if (shadowTexels) this.shadowTarget = Stage.depthTarget(shadowTexels, shadowTexels);
      this.uniforms.shadowMap.value = this.shadowTarget && this.shadowTarget.depthTexture;
      this.uniforms.shadowTexel.value = shadowTexels ? 1 / shadowTexels : 0;
      this.uniforms.normalOffset.value = shadowTexels ? 3 * this.shadowRadius / shadowTexels : 0;
    }
    for (const {mesh, materials} of this.shadowed) mesh.material = materials[shadowTexels ? 1 : 0];
    this.isDirty = this.shadowsDirty = true;
  }

  resize() {
    const {clientWidth: width, clientHeight: height} = this.canvas;
    if (!width || !height) return;
    const {camera, panelHeight = 0} = this, free = Math.max(height - panelHeight, 0.5 * height);
    // The free part of the page has the view of the scene's camera. On upright screens, as much of the
    // width is visible as on a square one.
    const tall = Math.tan((this.fov || 0.8) / 2) * Math.max(1, 1.25 * free / width);
    camera.aspect = width / height;
    camera.fov = 2 * Math.atan(tall * height / free) * 180 / Math.PI;
    camera.setViewOffset(width, height, 0, 0.5 * (height - free), width, height);
    camera.updateProjectionMatrix();
    this.updateTargets();
  }

  // Moves everything to a time.
  setTime(time) {
    const {moved, shown} = this.motion.set(time);
    const isFirst = !this.visibleBodies;
    if (!moved && !shown && !isFirst) return;
    if (shown || isFirst) this.showBodies();
    for (const batch of this.batches) {
      batch.move(this.motion.worlds, this.motion.versions);
      if (!this.culls) batch.moveShown();
    }
    this.isDirty = this.shadowsDirty = true;
    this.updateMark();
  }

  showBodies() {
    this.visibleBodies = new Set();
    this.visibleTriangles = 0;
    for (const batch of this.batches) {
      if (batch.show(this.motion.isVisible) && !this.culls) batch.drawAll();
      for (const {node, part} of batch.shown) {
        if (this.bodies[node] >= 0) this.visibleBodies.add(this.bodies[node]);
        this.visibleTriangles += part.indices.length / 3;
      }
    }
  }

  // Draws if anything changed. Returns true if so. `isPlaying`: shadows may be of an earlier frame.
  draw(isPlaying = false) {
    if (!this.isDirty) return false;
    const {renderer, camera} = this;
    camera.updateMatrixWorld();
    if (this.shadowTarget && this.shadowsDirty && (!isPlaying || this.drawn % kQualities[this.quality].shadowEvery === 0)) {
      this.cullCasters();
      renderer.setRenderTarget(this.shadowTarget);
      renderer.clear();
      renderer.render(this.casters, this.sunCamera);
      renderer.setRenderTarget(null);
      this.shadowsDirty = false;
    }
    const hides = this.grid && isPlaying && this.visibleTriangles > this.crowd;
    this.cullMeshes(isPlaying, hides);
    this.uniforms.rays.value.getInverse(camera.projectionMatrix);
    const turn = new THREE.Matrix4().extractRotation(camera.matrixWorld);
    this.uniforms.rays.value.premultiply(turn);
    if (hides && this.isGridFrame()) {
      this.drawByTarget();
    } else {
      renderer.clear();
      renderer.render(this.scene, camera);
    }
    ++this.drawn;
    this.isDirty = false;
    return true;
  }

  isGridFrame() { return this.drawn % kGridEvery === 0 && !this.grid.isBusy; }

  // Draws by way of a target, whose depths can be read.
  drawByTarget() {
    const {renderer, gl, canvas: {width, height}} = this;
    if (!this.target || this.target.width !== width || this.target.height !== height) {
      if (this.target) this.target.dispose();
      this.target = Stage.depthTarget(width, height);
    }
    renderer.setRenderTarget(this.target);
    renderer.clear();
    renderer.render(this.scene, this.camera);
    renderer.setRenderTarget(null);
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, renderer.properties.get(this.target).__webglFramebuffer);
    gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, null);
    this.grid.draw(this.target.depthTexture, this.target, this.camera);
  }

  // Returns a target with a depth texture.
  static depthTarget(width, height) {
    return new THREE.WebGLRenderTarget(width, height, {
      depthTexture: new THREE.DepthTexture(width, height, THREE.UnsignedIntType),
      minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter});
  }

  cullCasters() {
    if (!this.culls) return;
    const least = kLeastTexels * this.shadowRadius / this.shadowTarget.width;
    const leastOf = entry => entry.radius > least ? 0 : Infinity;
    for (const batch of this.batches) {
      if (batch.caster) batch.drawFacing(batch.caster, this.uniforms.toSun.value, 0, leastOf);
    }
  }

  cullMeshes(isPlaying, hides) {
    if (!this.culls) return;
    const {camera, grid} = this;
    if (hides) grid.read();
    else if (grid) grid.clear();
    const isNext = hides && this.isGridFrame();
    const sphere = new THREE.Sphere();
    const frustum = new THREE.Frustum().setFromMatrix(
        new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse));
    // A triangle of area A covers A cos(angle) / (distance pixel)² pixels.
    const pixel = 2 * Math.tan(camera.fov * Math.PI / 360) / this.canvas.height;
    const leastOf = entry => {
      sphere.center = entry.place;
      sphere.radius = entry.radius;
      if (!frustum.intersectsSphere(sphere) || hides && grid.hides(entry, isNext)) return Infinity;
      if (!isPlaying) return 0;
      const nearest = Math.max(0, entry.place.distanceTo(camera.position) - entry.radius);
      return 2 * nearest * Math.min(kLeastPixels * pixel * pixel * nearest * nearest, kLeastShare * entry.meanArea);
    };
    for (const batch of this.batches) {
      if (batch.kind.isGlass) batch.drawAll();
      else batch.drawFacing(batch.mesh, camera.position, 1, leastOf);
    }
  }

  // Waits until the frame is drawn: a pixel that is read back cannot be read earlier.
  finish() { this.gl.readPixels(0, 0, 1, 1, this.gl.RGBA, this.gl.UNSIGNED_BYTE, new Uint8Array(4)); }

  // Returns the body and the point that a place on the screen (-1 to 1) shows; null for none.
  pick(x, y) {
    const caster = new THREE.Raycaster();
    caster.setFromCamera({x, y}, this.camera);
    let nearest = Infinity, found = null;
    for (const batch of this.batches) {
      for (const entry of batch.shown) {
        if (this.bodies[entry.node] < 0) continue;
        if (!caster.ray.intersectsSphere(new THREE.Sphere(entry.place, 1.01 * entry.radius))) continue;
        if (entry.isStale) batch.moveEntry(entry);
        const point = Stage.hit(batch, entry, caster.ray);
        if (!point || point.distanceTo(caster.ray.origin) >= nearest) continue;
        nearest = point.distanceTo(caster.ray.origin);
        found = {body: this.bodies[entry.node], point};
      }
    }
    return found;
  }

  // Returns the point at which a ray meets an entry first; null for none.
  static hit(batch, entry, ray) {
    const corners = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()];
    let nearest = Infinity, found = null;
    for (let i = 0; i + 2 < entry.part.indices.length; i += 3) {
      for (let j = 0; j < 3; ++j) corners[j].fromArray(batch.places.array, 3 * batch.all[entry.firstIndex + i + j]);
      const point = ray.intersectTriangle(...corners, false, new THREE.Vector3());
      if (point && point.distanceTo(ray.origin) < nearest) {
        nearest = point.distanceTo(ray.origin);
        found = point;
      }
    }
    return found;
  }

  // Marks a body in colour; -1: none.
  setMark(body) {
    if (this.mark) {
      this.scene.remove(this.mark);
      this.mark.children.forEach(child => child.geometry.dispose());
      this.mark = null;
    }
    this.markedBody = body;
    this.isDirty = true;
    if (body < 0) return;
    this.mark = new THREE.Group();
    const material = new THREE.ShaderMaterial({vertexShader: shaders.markVertex, fragmentShader: shaders.markFragment,
                                               transparent: true, depthWrite: false});
    for (const batch of this.batches) {
      for (const entry of batch.entries) {
        if (this.bodies[entry.node] !== body) continue;
        const geometry = new THREE.BufferGeometry();
        for (const name of ['position', 'normal']) geometry.setAttribute(name, batch.geometry.attributes[name]);
        const indices = batch.all.slice(entry.firstIndex, entry.firstIndex + entry.part.indices.length);
        geometry.setIndex(new THREE.BufferAttribute(indices, 1));
        const mesh = new THREE.Mesh(geometry, material);
        mesh.frustumCulled = false;
        mesh.renderOrder = 3;
        mesh.userData = {batch, entry};
        this.mark.add(mesh);
      }
    }
    this.scene.add(this.mark);
    this.updateMark();
  }

  updateMark() {
    if (!this.mark) return;
    for (const mesh of this.mark.children) {
      const {batch, entry} = mesh.userData;
      mesh.visible = !!this.motion.isVisible[entry.node];
      if (!mesh.visible || !entry.isStale) continue;
      batch.moveEntry(entry);
      batch.upload();
    }
  }
}
Stage.plain = {name: '', color: [0.5, 0.48, 0.45, 1], roughness: 0.9, metallic: 0, isGlass: false, opacity: 1, texture: -1, extras: {}};
