// The page: time, camera, timeline, chart and card. Begin with startPlayer().
//
// Parts of the address after "#" set the start: t=SECONDS shows that time and does not play.
'use strict';

const kSpeeds = [0.1, 0.25, 0.5, 1, 2];
const kStageColors = ['#e8a87c', '#85b8cb', '#c9b458', '#b08ea2', '#7fb685', '#d98880', '#8e9aaf'];
const kSlowFrame_ms = 40;  // a lower quality is chosen above
const kJudgedFrames = 12;  // number of frames whose median is judged
const kStill_ms = 300;     // time after which a picture that does not move is drawn by the best quality
const kMedianOf = 60;      // number of frames that the shown time is the median of

const element = id => document.getElementById(id);
const seconds = value => value.toFixed(2) + ' s';
function withUnit(value, unit) {
  const scale = [[1e9, 'G'], [1e6, 'M'], [1e3, 'k'], [1, ''], [1e-3, 'm']].find(([factor]) => Math.abs(value) >= factor);
  return scale ? (value / scale[0]).toPrecision(3).replace(/\.0+$/, '') + ' ' + scale[1] + unit : '0 ' + unit;
}
function mass(kg) {
  if (kg >= 1000) return (kg / 1000).toPrecision(3) + ' t';
  return kg >= 1 ? kg.toPrecision(3) + ' kg' : (kg * 1000).toPrecision(3) + ' g';
}
function median(values) {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted.length ? sorted[sorted.length >> 1] : 0;
}
function decodeBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text), bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

// A canvas with as many pixels as its place on the screen has.
function sized(canvas) {
  const ratio = Math.min(window.devicePixelRatio || 1, 2);
  const width = canvas.clientWidth, height = canvas.clientHeight;
  canvas.width = width * ratio;
  canvas.height = height * ratio;
  const context = canvas.getContext('2d');
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return {context, width, height};
}

// The time axis: breaks as marks whose height follows from their energy, and the times of stages.
class Timeline {
  constructor(run, duration) {
    this.duration = duration;
    this.breaks = run.breaks || [];
    this.stages = this.orderStages(run);
    document.body.classList.toggle('untimed', this.stages.length === 0);
  }

  // Returns { name, color, values } of the most expensive stages, the largest first; the last is the
  // sum of the others.
  orderStages(run) {
    const frames = run.stage_ms || [], names = run.stage_names || [];
    const sums = names.map((_, stage) => frames.reduce((sum, frame) => sum + frame[stage], 0));
    const order = sums.map((_, stage) => stage).filter(stage => sums[stage] > 0).sort((a, b) => sums[b] - sums[a]);
    const listed = kStageColors.length - 1;
    const stages = order.slice(0, listed).map((stage, i) => (
        {name: names[stage], color: kStageColors[i], values: frames.map(frame => frame[stage])}));
    const rest = order.slice(listed);
    if (rest.length) {
      stages.push({name: 'others', color: kStageColors[listed],
                   values: frames.map(frame => rest.reduce((sum, stage) => sum + frame[stage], 0))});
    }
    return stages;
  }

  x(time, width) { return this.duration > 0 ? time / this.duration * width : 0; }

  draw() {
    this.drawBreaks(sized(element('track')));
    if (this.stages.length) this.drawStages(sized(element('stages')));
  }

  drawBreaks({context, width, height}) {
    const base = height - 8;
    context.fillStyle = 'rgba(236,234,230,.22)';
    context.fillRect(0, base, width, 3);
    // The energies of a column of pixels are added up.
    const columns = new Map();
    for (const event of this.breaks) {
      const column = Math.round(this.x(event.time_s, width) / 2) * 2;
      columns.set(column, (columns.get(column) || 0) + Math.max(event.energy_J || 0, 0));
    }
    const most = Math.max(1, ...columns.values());
    context.fillStyle = '#ff9a4d';
    for (const [column, energy] of columns) {
      const size = 4 + (base - 6) * Math.max(0, 1 + Math.log10(Math.max(energy, 1e-9) / most) / 5);
      context.globalAlpha = 0.85;
      context.fillRect(Math.min(column, width - 1.5), base - size, 1.5, size);
    }
    context.globalAlpha = 1;
  }

  drawStages({context, width, height}) {
    const frames = this.stages[0].values.length;
    const columns = Math.max(1, Math.min(frames, Math.floor(width)));
    // Of the frames of a column, the one that took longest is drawn.
    const total = frame => this.stages.reduce((sum, stage) => sum + stage.values[frame], 0);
    const drawn = Array.from({length: columns}, (_, column) => {
      const from = Math.floor(column * frames / columns), to = Math.max(from + 1, Math.floor((column + 1) * frames / columns));
      let longest = from;
      for (let frame = from; frame < to; ++frame) if (total(frame) > total(longest)) longest = frame;
      return longest;
    });
    const most = Math.max(...drawn.map(total), 1e-9), top = height - 12;
    const base = new Float64Array(columns);
    for (const stage of this.stages) {
      context.fillStyle = stage.color;
      context.beginPath();
      for (let column = 0; column < columns; ++column) {
        const x = column * width / columns, size = stage.values[drawn[column]] / most * top;
        context.rect(x, height - base[column] - size, width / columns + 0.3, size);
        base[column] += size;
      }
      context.fill();
    }
    context.fillStyle = 'rgba(236,234,230,.62)';
    context.font = '10px system-ui, sans-serif';
    context.fillText(`simulation, up to ${most < 10 ? most.toPrecision(2) : most.toFixed(0)} ms a frame`, 0, 9);
  }

  // Returns the text about a time for the tooltip, as an element: the breaks near it and the stages.
  describe(time, near) {
    const box = document.createDocumentFragment();
    const add = (text, color) => {
      const line = document.createElement('div');
      if (color) line.appendChild(document.createElement('i')).style.background = color;
      line.append(text);
      box.append(line);
    };
    add(seconds(time));
    const close = this.breaks.filter(event => Math.abs(event.time_s - time) <= near)
                      .sort((a, b) => (b.energy_J || 0) - (a.energy_J || 0));
    for (const event of close.slice(0, 3)) {
      add(`${event.name || 'body'} breaks: ${withUnit(event.energy_J || 0, 'J')}, ${event.children.length} pieces`, '#ff9a4d');
    }
    if (close.length > 3) add(`and ${close.length - 3} more breaks`, '#ff9a4d');
    if (this.stages.length) {
      const values = this.stages[0].values;
      const frame = Math.min(values.length - 1, Math.max(0, Math.round(time / this.duration * (values.length - 1))));
      for (const stage of this.stages.slice(0, 4)) add(`${stage.name} ${stage.values[frame].toFixed(2)} ms`, stage.color);
    }
    return box;
  }
}

class Player {
  constructor(file) {
    this.file = file;
    const {run} = file;
    this.motion = new Motion(file);
    this.fps = run.fps || 60;
    this.duration = run.duration_s || this.motion.duration;
    this.stage = new Stage(element('view'), file, this.motion);
    this.timeline = new Timeline(run, this.duration);
    this.quality = this.stage.quality;  // while the picture moves
    this.time = 0;
    this.speed = 1;
    this.isPlaying = false;
    this.intervals = [];
    this.judged = [];  // intervals at the present quality
    this.addCamera();
    this.addControls();
    this.addKeys();
    window.addEventListener('resize', () => this.resize());
    this.stage.setTime(0);
    this.resize();
  }

  addCamera() {
    const {stage, file} = this;
    const canvas = element('view');
    this.controls = new THREE.OrbitControls(stage.camera, canvas);
    this.controls.enableKeys = false;
    this.controls.enableDamping = !Stage.isSoftware();
    this.controls.addEventListener('change', () => { stage.isDirty = true; });
    stage.fov = file.camera ? file.camera.fov : 0.8;
    this.resetCamera();
  }

  // Places the camera where that of the scene is, or where it shows everything.
  resetCamera() {
    const {stage, file, controls} = this;
    const sphere = stage.box.getBoundingSphere(new THREE.Sphere());
    if (file.camera) {
      const matrix = this.motion.matrix(file.camera.node);
      const eye = new THREE.Vector3().setFromMatrixPosition(matrix);
      const ahead = new THREE.Vector3(0, 0, -1).transformDirection(matrix);
      // The camera turns around the point of its axis that is nearest to the middle of the scene.
      const along = Math.max(0.5, sphere.center.clone().sub(eye).dot(ahead));
      stage.camera.position.copy(eye);
      controls.target.copy(eye).addScaledVector(ahead, along);
    } else {
      const distance = 1.3 * sphere.radius / Math.sin(stage.fov / 2);
      stage.camera.position.copy(sphere.center).addScaledVector(new THREE.Vector3(0.5, 0.35, 0.8).normalize(), distance);
      controls.target.copy(sphere.center);
    }
    controls.update();
    stage.isDirty = true;
  }

  addControls() {
    const speed = element('speed');
    for (const value of kSpeeds) speed.add(new Option(value + '×', value, value === 1, value === 1));
    speed.onchange = () => { this.speed = +speed.value; speed.blur(); };
    element('play').onclick = () => this.toggle();
    element('back').onclick = () => this.step(-1);
    element('next').onclick = () => this.step(1);
    element('home').onclick = () => this.resetCamera();
    element('close').onclick = () => this.select(-1);
    this.addScrubbing(element('line'));
    this.addPicking(element('view'));
  }

  addScrubbing(line) {
    const timeAt = event => {
      const box = line.getBoundingClientRect();
      return Math.min(1, Math.max(0, (event.clientX - box.left) / box.width)) * this.duration;
    };
    const tip = element('tip');
    const show = event => {
      const box = line.getBoundingClientRect();
      tip.replaceChildren(this.timeline.describe(timeAt(event), this.duration * 3 / box.width));
      tip.hidden = false;
      const left = event.clientX - tip.offsetWidth / 2;
      tip.style.left = Math.min(Math.max(8, left), window.innerWidth - tip.offsetWidth - 8) + 'px';
    };
    line.addEventListener('pointerdown', event => {
      line.setPointerCapture(event.pointerId);
      this.pause();
      this.seek(timeAt(event));
      show(event);
    });
    line.addEventListener('pointermove', event => {
      if (line.hasPointerCapture(event.pointerId)) this.seek(timeAt(event));
      if (event.pointerType === 'mouse' || line.hasPointerCapture(event.pointerId)) show(event);
    });
    line.addEventListener('pointerleave', () => { tip.hidden = true; });
    line.addEventListener('pointerup', event => { if (event.pointerType !== 'mouse') tip.hidden = true; });
  }

  // A press that does not move selects a piece.
  addPicking(canvas) {
    let start = null;
    canvas.addEventListener('pointerdown', event => { start = event.isPrimary ? [event.clientX, event.clientY] : null; });
    canvas.addEventListener('pointerup', event => {
      if (!start || Math.hypot(event.clientX - start[0], event.clientY - start[1]) > 5) return;
      const box = canvas.getBoundingClientRect();
      const found = this.stage.pick(2 * (event.clientX - box.left) / box.width - 1,
                                    1 - 2 * (event.clientY - box.top) / box.height);
      this.select(found ? found.body : -1);
    });
  }

  addKeys() {
    const actions = {
      ' ': () => this.toggle(), k: () => this.toggle(),
      ArrowLeft: () => this.step(-1), ',': () => this.step(-1),
      ArrowRight: () => this.step(1), '.': () => this.step(1),
      ArrowUp: () => this.changeSpeed(1), ArrowDown: () => this.changeSpeed(-1),
      Home: () => this.seek(0), End: () => this.seek(this.duration),
      c: () => this.resetCamera(), Escape: () => this.select(-1),
    };
    window.addEventListener('keydown', event => {
      const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
      if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
      if (event.target.tagName === 'SELECT') return;
      event.preventDefault();
      action();
    });
  }

  changeSpeed(steps) {
    const at = Math.min(kSpeeds.length - 1, Math.max(0, kSpeeds.indexOf(this.speed) + steps));
    this.speed = kSpeeds[at];
    element('speed').value = this.speed;
  }

  resize() {
    this.stage.panelHeight = document.querySelector('footer').offsetHeight;
    this.stage.resize();
    this.timeline.draw();
    this.showTime();
  }

  toggle() { this.isPlaying ? this.pause() : this.play(); }
  pause() { this.setPlaying(false); }
  play() {
    if (this.time >= this.duration) this.seek(0);
    this.played = [];
    this.setPlaying(true);
  }
  setPlaying(isPlaying) {
    this.isPlaying = isPlaying;
    this.last = null;
    document.body.classList.toggle('playing', isPlaying);
  }
  step(frames) {
    this.pause();
    this.seek((Math.round(this.time * this.fps) + frames) / this.fps);
  }

  seek(time) {
    this.time = Math.min(this.duration, Math.max(0, time));
    this.stage.setTime(this.time);
    this.showTime();
  }

  showTime() {
    const width = element('line').clientWidth;
    element('needle').style.transform = `translateX(${this.timeline.x(this.time, width) - 1}px)`;
    const text = seconds(this.time), pieces = this.stage.visibleBodies.size;
    if (text !== this.shownTime) {
      element('clock').textContent = text;
      const all = document.createElement('span');
      all.textContent = ' / ' + seconds(this.duration);
      element('clock').append(all);
      element('line').setAttribute('aria-valuemax', this.duration);
      element('line').setAttribute('aria-valuenow', this.time.toFixed(3));
      element('line').setAttribute('aria-valuetext', text);
      this.shownTime = text;
    }
    if (pieces !== this.shownPieces) {
      element('count').textContent = pieces.toLocaleString('en') + (pieces === 1 ? ' body' : ' bodies');
      this.shownPieces = pieces;
    }
    document.body.dataset.time = this.time.toFixed(4);
    document.body.dataset.pieces = pieces;
  }

  select(body) {
    this.selected = body;
    this.stage.setMark(body);
    const card = element('card');
    card.hidden = body < 0;
    if (body < 0) return;
    const {extras = {}, name} = this.file.nodes[body];
    card.querySelector('h2').textContent = extras.name || name || 'body';
    const rows = [];
    if (extras.root && extras.root !== extras.name) rows.push(['from', extras.root]);
    if (extras.mass_kg > 0) rows.push(['mass', mass(extras.mass_kg)]);
    if (extras.born_s !== undefined) rows.push(['since', seconds(extras.born_s)]);
    if (extras.gone_s !== undefined && extras.gone_s !== null) rows.push(['until', seconds(extras.gone_s)]);
    if (extras.key !== undefined) rows.push(['key', extras.key]);
    const list = card.querySelector('dl');
    list.replaceChildren();
    for (const [term, value] of rows) {
      list.appendChild(document.createElement('dt')).textContent = term;
      list.appendChild(document.createElement('dd')).textContent = value;
    }
  }

  // Draws the frame of the display at a time in ms.
  frame(now) {
    requestAnimationFrame(next => this.frame(next));
    if (this.isPlaying) {
      if (this.last !== null) this.seek(this.time + (now - this.last) / 1000 * this.speed);
      if (this.last !== null) this.measure(now - this.last);
      this.last = now;
      if (this.time >= this.duration) {
        this.pause();
        this.showCost();
        this.report();
      }
    }
    this.controls.update();
    this.draw(now);
  }

  // Draws, by the best quality once the picture has been still for a while.
  draw(now) {
    const {stage} = this;
    if (stage.isDirty) {
      stage.setQuality(this.quality);
      this.changed = now;
    } else if (!this.isPlaying && now - this.changed > kStill_ms) {
      stage.setQuality(kBestQuality);
    }
    stage.draw(this.isPlaying);
  }

  // Writes the times of the frames since the last start to the console.
  report() {
    console.log(`sunder: ${median(this.played).toFixed(1)} ms a frame, median of ${this.played.length}, ` +
                `longest ${Math.max(...this.played).toFixed(0)} ms, quality ${this.quality}; ` +
                `opened in ${this.openTime.toFixed(0)} ms`);
  }

  // Resolves to the median time in ms of drawing a frame of the run at a quality, each finished before the
  // next: without the intervals of the display. For the console: await player.timeFrames()
  async timeFrames(quality = 0, framesPerSecond = 30) {
    const {stage} = this, times = [];
    this.pause();
    stage.setQuality(quality);
    for (let time = 0; time < this.duration; time += 1 / framesPerSecond) {
      await new Promise(requestAnimationFrame);
      const start = now();
      this.seek(time);
      stage.isDirty = true;
      stage.draw(true);
      stage.finish();
      times.push(now() - start);
    }
    return median(times);
  }

  // Shows the time from frame to frame, and lowers the quality where frames take long.
  measure(interval) {
    this.played.push(interval);
    this.intervals.push(interval);
    if (this.intervals.length > kMedianOf) this.intervals.shift();
    this.judged.push(interval);
    if (this.judged.length > kJudgedFrames) this.judged.shift();
    if (this.judged.length === kJudgedFrames && median(this.judged) > kSlowFrame_ms && this.quality > 0) {
      --this.quality;
      this.judged = [];
    }
    if (this.intervals.length % 15 !== 0 || now() - (this.costTime || 0) < 500) return;
    this.costTime = now();
    this.showCost();
  }

  // Shows the median time of the last frames.
  showCost() {
    this.frameTime = median(this.intervals);
    element('cost').textContent = this.frameTime.toFixed(1) + ' ms a frame';
    document.body.dataset.frameMs = this.frameTime.toFixed(2);
  }
}

const now = () => performance.now();

function startPlayer() {
  const state = element('state');
  try {
    const data = element('run');
    const file = glb.read(decodeBase64(data.textContent.trim()));
    data.remove();
    const player = window.player = new Player(file);
    player.stage.draw();
    player.stage.finish();
    player.openTime = now();
    document.body.dataset.openMs = player.openTime.toFixed(0);
    state.hidden = true;
    const start = new URLSearchParams(location.hash.slice(1)).get('t');
    if (start !== null) player.seek(+start);
    else if (!matchMedia('(prefers-reduced-motion: reduce)').matches) player.play();
    requestAnimationFrame(time => player.frame(time));
  } catch (error) {
    state.textContent = 'This run cannot be shown: ' + error.message;
    throw error;
  }
}
