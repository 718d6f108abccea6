// Reads a GLB: nodes, triangles, materials, images, animation tracks, camera and sun.
'use strict';

const glb = (() => {
  const kElements = {SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16};
  const kArrays = {5120: Int8Array, 5121: Uint8Array, 5122: Int16Array, 5123: Uint16Array,
                   5125: Uint32Array, 5126: Float32Array};
  const kFractions = {5120: 127, 5121: 255, 5122: 32767, 5123: 65535};

  // Returns the JSON document and the binary chunk of a file.
  function parseChunks(bytes) {
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    if (view.getUint32(0, true) !== 0x46546c67) throw new Error('not a GLB file');
    let json = null, binary = null;
    for (let at = 12; at + 8 <= bytes.byteLength;) {
      const size = view.getUint32(at, true), type = view.getUint32(at + 4, true);
      const chunk = bytes.subarray(at + 8, at + 8 + size);
      if (type === 0x4e4f534a) json = JSON.parse(new TextDecoder().decode(chunk));
      if (type === 0x004e4942) binary = chunk;
      at += 8 + size;
    }
    if (!json) throw new Error('the GLB file has no JSON');
    return {json, binary};
  }

  // Returns the numbers of an accessor without gaps; normalized integers become fractions.
  function readAccessor(file, index) {
    const accessor = file.json.accessors[index];
    const width = kElements[accessor.type], Type = kArrays[accessor.componentType];
    const length = accessor.count * width;
    const divisor = accessor.normalized ? kFractions[accessor.componentType] : 0;
    if (accessor.bufferView === undefined) return new Float32Array(length);
    const view = file.json.bufferViews[accessor.bufferView];
    const start = file.binary.byteOffset + (view.byteOffset || 0) + (accessor.byteOffset || 0);
    const size = Type.BYTES_PER_ELEMENT, buffer = file.binary.buffer;
    const stride = (view.byteStride || width * size) / size;
    const isAligned = start % size === 0 && Number.isInteger(stride);
    if (isAligned && stride === width && !divisor) return new Type(buffer, start, length);
    const out = divisor ? new Float32Array(length) : new Type(length);
    if (isAligned) {
      const source = new Type(buffer, start, (accessor.count - 1) * stride + width);
      const factor = divisor ? 1 / divisor : 1;
      for (let i = 0, from = 0, to = 0; i < accessor.count; ++i, from += stride) {
        for (let j = 0; j < width; ++j) out[to++] = source[from + j] * factor;
      }
    } else {
      const copy = new Type(1), raw = new Uint8Array(copy.buffer);
      const all = new Uint8Array(buffer), step = view.byteStride || width * size;
      for (let i = 0; i < length; ++i) {
        const from = start + Math.floor(i / width) * step + (i % width) * size;
        raw.set(all.subarray(from, from + size));
        out[i] = divisor ? copy[0] / divisor : copy[0];
      }
    }
    return out;
  }

  // Returns normals of triangles that have none: those of the faces, added up at shared vertices.
  function makeNormals(positions, indices) {
    const normals = new Float32Array(positions.length);
    for (let i = 0; i + 2 < indices.length; i += 3) {
      const [a, b, c] = [indices[i] * 3, indices[i + 1] * 3, indices[i + 2] * 3];
      const u = [0, 1, 2].map(j => positions[b + j] - positions[a + j]);
      const v = [0, 1, 2].map(j => positions[c + j] - positions[a + j]);
      const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      for (const corner of [a, b, c]) for (let j = 0; j < 3; ++j) normals[corner + j] += n[j];
    }
    return normals;
  }

  // Returns the triangles of a mesh, a part for each material. Parts share vertices where the file
  // does. Other primitives (points, lines) are left out.
  function readMesh(file, mesh) {
    const parts = [];
    for (const primitive of mesh.primitives) {
      if ((primitive.mode === undefined ? 4 : primitive.mode) !== 4) continue;
      const {POSITION, NORMAL, TEXCOORD_0} = primitive.attributes;
      const positions = readAccessor(file, POSITION);
      const indices = primitive.indices === undefined
          ? Uint32Array.from({length: positions.length / 3}, (_, i) => i)
          : readAccessor(file, primitive.indices);
      parts.push({
        positions, indices,
        key: POSITION,
        normals: NORMAL === undefined ? makeNormals(positions, indices) : readAccessor(file, NORMAL),
        uvs: TEXCOORD_0 === undefined ? null : readAccessor(file, TEXCOORD_0),
        material: primitive.material === undefined ? -1 : primitive.material,
      });
    }
    return parts;
  }

  function readMaterial(material) {
    const pbr = material.pbrMetallicRoughness || {};
    const color = pbr.baseColorFactor || [1, 1, 1, 1];
    const or = (value, otherwise) => value === undefined ? otherwise : value;
    const transmission = (material.extensions || {}).KHR_materials_transmission;
    return {
      name: material.name || '',
      color,
      roughness: or(pbr.roughnessFactor, 1),
      metallic: or(pbr.metallicFactor, 1),
      isGlass: material.alphaMode === 'BLEND' || !!transmission,
      opacity: transmission ? 0.3 : color[3],
      texture: pbr.baseColorTexture ? pbr.baseColorTexture.index : -1,
      extras: material.extras || {},
    };
  }

  // Returns the sun, { color, intensity, node }, of the first directional light; null without one.
  function findSun(json) {
    const lights = ((json.extensions || {}).KHR_lights_punctual || {}).lights || [];
    for (let node = 0; node < json.nodes.length; ++node) {
      const use = (json.nodes[node].extensions || {}).KHR_lights_punctual;
      const light = use && lights[use.light];
      if (light && light.type === 'directional') {
        return {node, color: light.color || [1, 1, 1], intensity: light.intensity};
      }
    }
    return null;
  }

  // Returns the camera, { node, fov }, of the first perspective camera; null without one.
  function findCamera(json) {
    for (let node = 0; node < json.nodes.length; ++node) {
      const camera = json.nodes[node].camera !== undefined && json.cameras[json.nodes[node].camera];
      if (camera && camera.perspective) return {node, fov: camera.perspective.yfov};
    }
    return null;
  }

  function readTracks(file) {
    const cache = new Map();
    const read = index => {
      if (!cache.has(index)) cache.set(index, readAccessor(file, index));
      return cache.get(index);
    };
    const tracks = [];
    for (const animation of file.json.animations || []) {
      for (const {sampler, target} of animation.channels) {
        if (target.node === undefined || target.path === 'weights') continue;
        const {input, output, interpolation} = animation.samplers[sampler];
        tracks.push({
          node: target.node, path: target.path, times: read(input), values: read(output),
          isStep: interpolation === 'STEP', isCubic: interpolation === 'CUBICSPLINE',
        });
      }
    }
    return tracks;
  }

  // Returns a blob address for each image of the file; null for images outside of it.
  function readImages(file) {
    return (file.json.images || []).map(image => {
      if (image.bufferView === undefined) return image.uri && image.uri.startsWith('data:') ? image.uri : null;
      const view = file.json.bufferViews[image.bufferView];
      const at = view.byteOffset || 0;
      return URL.createObjectURL(
          new Blob([file.binary.slice(at, at + view.byteLength)], {type: image.mimeType}));
    });
  }

  function read(bytes) {
    const file = parseChunks(bytes);
    const json = file.json;
    json.nodes = json.nodes || [];
    return {
      nodes: json.nodes,
      meshes: (json.meshes || []).map(mesh => readMesh(file, mesh)),
      materials: (json.materials || []).map(readMaterial),
      textures: (json.textures || []).map(texture => texture.source),
      images: readImages(file),
      tracks: readTracks(file),
      camera: findCamera(json),
      sun: findSun(json),
      run: ((json.asset || {}).extras || {}).sunder || {},
    };
  }

  return {read};
})();
