// Poses of the nodes of a file at a time. A track remembers its last segment, so that playing costs
// one comparison for each track whose node rests.
'use strict';

class Motion {
  constructor(file) {
    const count = file.nodes.length;
    this.count = count;
    this.translations = new Float64Array(3 * count);
    this.rotations = new Float64Array(4 * count);
    this.scales = new Float64Array(3 * count).fill(1);
    // Rows of the 3x4 matrix from a node to the world.
    this.worlds = new Float32Array(12 * count);
    this.versions = new Uint32Array(count);  // of the matrices: the number of changes
    this.isVisible = new Uint8Array(count);
    this.parents = new Int32Array(count).fill(-1);
    this.isDirty = new Uint8Array(count).fill(1);
    for (let node = 0; node < count; ++node) this.readPose(file.nodes[node], node);
    for (let node = 0; node < count; ++node) {
      for (const child of file.nodes[node].children || []) this.parents[child] = node;
    }
    this.order = this.parentsFirst();
    this.tracks = file.tracks.filter(track => track.times.length > 0).map(track => this.open(track));
    this.duration = this.tracks.reduce(
        (end, track) => Math.max(end, track.times[track.times.length - 1]), 0);
  }

  readPose(node, index) {
    this.rotations[4 * index + 3] = 1;
    if (node.matrix) {
      const position = new THREE.Vector3(), turn = new THREE.Quaternion(), scale = new THREE.Vector3();
      new THREE.Matrix4().fromArray(node.matrix).decompose(position, turn, scale);
      this.translations.set(position.toArray(), 3 * index);
      this.rotations.set(turn.toArray(), 4 * index);
      this.scales.set(scale.toArray(), 3 * index);
    }
    if (node.translation) this.translations.set(node.translation, 3 * index);
    if (node.rotation) this.rotations.set(node.rotation, 4 * index);
    if (node.scale) this.scales.set(node.scale, 3 * index);
  }

  parentsFirst() {
    const order = new Uint32Array(this.count), depth = new Uint16Array(this.count);
    for (let node = 0; node < this.count; ++node) {
      for (let at = this.parents[node]; at >= 0; at = this.parents[at]) ++depth[node];
      order[node] = node;
    }
    return order.sort((a, b) => depth[a] - depth[b] || a - b);
  }

  open(track) {
    const arrays = {translation: this.translations, rotation: this.rotations, scale: this.scales};
    const width = track.path === 'rotation' ? 4 : 3;
    return {
      ...track, width, target: arrays[track.path], at: track.node * width,
      segment: -1,      // index of the key before the time
      isApplied: false  // true if the pose is that of the key and the segment is constant
    };
  }

  // Returns the index of the last key at or before a time, 0 before the first.
  static find(times, time, near) {
    let low = 0, high = times.length;
    if (near >= 0 && times[near] <= time) {
      low = near;
      if (near + 2 >= times.length || time < times[near + 2]) high = Math.min(near + 2, high);
    }
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle] <= time) low = middle; else high = middle;
    }
    return low;
  }

  // Sets the pose of a track's node. Returns true if it changed.
  static sample(track, time) {
    const {times, values, width, target, at} = track;
    const segment = Motion.find(times, time, track.segment);
    const isLast = segment + 1 >= times.length || time <= times[segment];
    const isHeld = isLast || track.isStep;
    if (segment === track.segment && track.isApplied && isHeld) return false;
    track.segment = segment;
    track.isApplied = isHeld;
    const step = track.isCubic ? 3 * width : width;
    const from = segment * step + (track.isCubic ? width : 0), to = from + step;
    if (isHeld) {
      for (let i = 0; i < width; ++i) target[at + i] = values[from + i];
      return true;
    }
    const share = (time - times[segment]) / (times[segment + 1] - times[segment]);
    if (track.isCubic) {
      const length = times[segment + 1] - times[segment];
      const s2 = share * share, s3 = s2 * share;
      for (let i = 0; i < width; ++i) {
        target[at + i] = (2 * s3 - 3 * s2 + 1) * values[from + i] +
            (s3 - 2 * s2 + share) * length * values[from + width + i] +
            (3 * s2 - 2 * s3) * values[to + i] + (s3 - s2) * length * values[to - width + i];
      }
      return true;
    }
    let sign = 1;
    if (width === 4) {
      let cosine = 0;
      for (let i = 0; i < 4; ++i) cosine += values[from + i] * values[to + i];
      if (cosine < 0) sign = -1;
    }
    let isMoving = false;
    for (let i = 0; i < width; ++i) {
      const value = values[from + i] + share * (sign * values[to + i] - values[from + i]);
      if (target[at + i] !== value) isMoving = true;
      target[at + i] = value;
    }
    return isMoving;
  }

  // Returns the pose of a node in its parent at a time, without moving anything.
  poseAt(node, time) {
    const position = new THREE.Vector3().fromArray(this.translations, 3 * node);
    const rotation = new THREE.Quaternion().fromArray(this.rotations, 4 * node);
    for (const track of this.tracksOf(node)) {
      if (track.path === 'scale') continue;
      const value = {...track, target: [0, 0, 0, 0], at: 0, segment: -1, isApplied: false};
      Motion.sample(value, time);
      (track.path === 'rotation' ? rotation : position).fromArray(value.target);
    }
    return {position, rotation: rotation.normalize()};
  }

  tracksOf(node) {
    if (!this.byNode) {
      this.byNode = new Map();
      for (const track of this.tracks) {
        if (!this.byNode.has(track.node)) this.byNode.set(track.node, []);
        this.byNode.get(track.node).push(track);
      }
    }
    return this.byNode.get(node) || [];
  }

  // Moves all nodes to a time. Returns { moved, shown }: true if a visible node moved, and if a node
  // appeared or disappeared.
  set(time) {
    const {isDirty, isVisible, parents, scales, order} = this;
    for (const track of this.tracks) {
      if (Motion.sample(track, time)) isDirty[track.node] = 1;
    }
    let moved = false, shown = false;
    for (let i = 0; i < order.length; ++i) {
      const node = order[i], parent = parents[node];
      if (parent >= 0 && isDirty[parent]) isDirty[node] = 1;
      if (!isDirty[node]) continue;
      const visible = scales[3 * node] !== 0 && (parent < 0 || isVisible[parent]) ? 1 : 0;
      if (visible !== isVisible[node]) shown = true;
      isVisible[node] = visible;
      if (!visible) continue;
      moved = true;
      this.place(node, parent);
    }
    isDirty.fill(0);
    return {moved, shown};
  }

  // Computes the matrix of a node from its pose and that of its parent.
  place(node, parent) {
    const {rotations, translations, scales, worlds} = this;
    let x = rotations[4 * node], y = rotations[4 * node + 1], z = rotations[4 * node + 2],
        w = rotations[4 * node + 3];
    const inverse = 1 / Math.sqrt(x * x + y * y + z * z + w * w);
    x *= inverse; y *= inverse; z *= inverse; w *= inverse;
    const sx = scales[3 * node], sy = scales[3 * node + 1], sz = scales[3 * node + 2];
    const a = (1 - 2 * (y * y + z * z)) * sx, b = 2 * (x * y - z * w) * sy, c = 2 * (x * z + y * w) * sz;
    const e = 2 * (x * y + z * w) * sx, f = (1 - 2 * (x * x + z * z)) * sy, g = 2 * (y * z - x * w) * sz;
    const h = 2 * (x * z - y * w) * sx, j = 2 * (y * z + x * w) * sy, k = (1 - 2 * (x * x + y * y)) * sz;
    const tx = translations[3 * node], ty = translations[3 * node + 1], tz = translations[3 * node + 2];
    const to = 12 * node;
    ++this.versions[node];
    if (parent < 0) {
      worlds[to] = a; worlds[to + 1] = b; worlds[to + 2] = c; worlds[to + 3] = tx;
      worlds[to + 4] = e; worlds[to + 5] = f; worlds[to + 6] = g; worlds[to + 7] = ty;
      worlds[to + 8] = h; worlds[to + 9] = j; worlds[to + 10] = k; worlds[to + 11] = tz;
      return;
    }
    for (let row = 0, from = 12 * parent, out = to; row < 3; ++row, from += 4, out += 4) {
      const p = worlds[from], q = worlds[from + 1], r = worlds[from + 2];
      worlds[out] = p * a + q * e + r * h;
      worlds[out + 1] = p * b + q * f + r * j;
      worlds[out + 2] = p * c + q * g + r * k;
      worlds[out + 3] = p * tx + q * ty + r * tz + worlds[from + 3];
    }
  }

  // Returns the matrix of a node as three.js has it.
  matrix(node) {
    const m = this.worlds.subarray(12 * node, 12 * node + 12);
    return new THREE.Matrix4().set(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9], m[10],
                                   m[11], 0, 0, 0, 1);
  }
}
