'use strict';
// The player of `lilytank view`. Everything is in this file: reading of the packed numbers, interpolation, drawing,
// controls. Lengths are in m with y up, headings in rad, times in s.

// ---------------------------------------------------------------- numbers

const $ = id => document.getElementById(id);
const head = JSON.parse($('head').textContent);
const TURN = 2 * Math.PI;
const clamp = (v, low, high) => Math.min(high, Math.max(low, v));
/** The turn from one heading to another on the shorter arc. */
const shortTurn = (from, to) => to - from - TURN * Math.round((to - from) / TURN);

async function unpacked() {
  const text = atob($('data').textContent), raw = new Uint8Array(text.length);
  for (let i = 0; i < raw.length; ++i) raw[i] = text.charCodeAt(i);
  const stream = new Blob([raw]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Reads a column (src/view/pack.hpp): planes of bytes, zigzag code, differences of an order within each series. */
function column(bytes, {at, count, length, order, planes}) {
  const out = new Int32Array(count);
  for (let p = 0; p < planes; ++p)
    for (let i = 0, from = at + p * count; i < count; ++i) out[i] |= bytes[from + i] << 8 * p;
  for (let i = 0; i < count; ++i) out[i] = out[i] >>> 1 ^ -(out[i] & 1);
  for (let k = 0; k < order; ++k)
    for (let i = 1; i < count; ++i) if (i % length) out[i] += out[i - 1];
  return out;
}

/** Index of the last of ascending values that is at most v; -1: none. */
function lastUpTo(values, v, count = values.length) {
  let low = 0, high = count;
  while (low < high) {
    const middle = low + high >> 1;
    if (values[middle] <= v) low = middle + 1; else high = middle;
  }
  return low - 1;
}

// ---------------------------------------------------------------- a tank over time

class Tank {
  constructor(h, bytes) {
    Object.assign(this, {name: h.name, note: h.note, radius: h.radius, side: h.side, ball: h.ball, bodies: h.bodies,
                         modules: h.modules, frames: h.frames, latches: h.latches, possible: h.possible, ids: h.ids});
    const read = c => c && column(bytes, c);
    this.time = Float64Array.from(read(h.time), t => t * h.clock);
    for (const c of ['x', 'y', 'theta', 'seen', 'label', 'last', 'faces']) this[c] = read(h[c]);
    this.flows = h.flows.map(f => ({power: f.power, lengths: read(f.lengths), x: read(f.x), y: read(f.y), tone: read(f.tone)}));
    this.flowChanges = h.flow_changes;
    this.readEvents(h.events, read, h.clock);
    this.now = {frame: -1, x: new Float64Array(h.bodies), y: new Float64Array(h.bodies), theta: new Float64Array(h.bodies),
                shown: new Uint8Array(h.bodies), latched: new Uint8Array(h.bodies), bonded: new Uint8Array(h.bodies)};
    this.groups = {frame: -1, of: new Int32Array(h.bodies), held: new Uint8Array(h.bodies)};
  }

  readEvents(e, read, clock) {
    this.events = {count: 0, kinds: [], rules: [], time: new Float64Array(0)};
    this.copies = {time: [this.time[0]], value: [0]};
    if (!e) return;
    this.events = {kinds: e.kinds, rules: e.rules, count: e.time.count, time: Float64Array.from(read(e.time), t => t * clock)};
    for (const c of ['kind', 'a', 'b', 'face_a', 'face_b', 'label_a', 'label_b', 'copies', 'rule']) this.events[c] = read(e[c]);
    for (let i = 0; i < this.events.count; ++i) {
      if (this.events.copies[i] < 0) continue;
      this.copies.time.push(this.events.time[i]), this.copies.value.push(this.events.copies[i]);
    }
  }

  get begin() { return this.time[0]; }
  get end() { return this.time[this.frames - 1]; }
  nameOf(b) { return this.ids.length ? this.ids[b] : String(b); }
  frameAt(t) { return Math.max(0, lastUpTo(this.time, t)); }
  copiesAt(t) { return this.copies.value[Math.max(0, lastUpTo(this.copies.time, t))]; }
  flowAt(t) {
    let flow = 0;
    for (const [since, number] of this.flowChanges) if (since <= t) flow = number;
    return flow;
  }
  place(b, frame) {
    const i = b * this.frames + frame;
    return {x: this.x[i] * head.position_step, y: this.y[i] * head.position_step,
            theta: this.theta ? this.theta[i] * head.heading_step : 0, seen: !this.seen || this.seen[i] > 0};
  }
  facesOf(b, frame) { return this.faces && b < this.modules ? this.faces[b * this.frames + frame] : 0; }
  markings(b, frame = this.now.frame) {
    if (!this.label || b >= this.modules) return null;
    const i = b * this.frames + frame;
    return {label: this.label[i], last: this.last[i], complete: this.faces[i] >> 8 & 1};
  }

  /** Colours by the control state; of recordings, which have none, by the body. */
  look(b) {
    const m = this.markings(b);
    return m ? lookOf(m.label, m.complete) : lookOf(b < this.modules ? b % 9 + 1 : 0, 0);
  }

  /** Sets `now` to all bodies at a time. Modules that hold each other in both frames around it move as one rigid body. */
  moveTo(t) {
    const now = this.now, frame = this.frameAt(t), next = Math.min(frame + 1, this.frames - 1);
    const span = this.time[next] - this.time[frame], w = span > 0 ? clamp((t - this.time[frame]) / span, 0, 1) : 0;
    now.frame = frame;
    for (let b = 0; b < this.bodies; ++b) {
      const p = this.place(b, frame), q = w > 0 ? this.place(b, next) : p, faces = this.facesOf(b, frame);
      const both = p.seen && q.seen, first = both || w < 0.5 ? p : q, v = both ? w : 0;
      now.shown[b] = first.seen;
      now.x[b] = first.x + v * (q.x - first.x), now.y[b] = first.y + v * (q.y - first.y);
      now.theta[b] = first.theta + v * shortTurn(first.theta, q.theta);
      now.latched[b] = faces & 15, now.bonded[b] = faces >> 4 & 15;
    }
    if (w > 0 && this.faces) this.moveGroups(frame, next, w);
  }

  moveGroups(frame, next, w) {
    if (this.groups.frame !== frame) this.findGroups(frame, next);
    const {of, held} = this.groups, now = this.now;
    for (let root = 0; root < this.modules; ++root) {
      now.latched[root] &= held[root], now.bonded[root] &= held[root];
      if (of[root] !== root) continue;
      const members = [];
      for (let b = root; b < this.modules; ++b) if (of[b] === root) members.push(b);
      if (members.length < 2) continue;
      const mean = f => members.map(b => this.place(b, f)).reduce((s, p) => [s[0] + p.x / members.length, s[1] + p.y / members.length], [0, 0]);
      const from = mean(frame), to = mean(next);
      const turn = w * shortTurn(this.place(root, frame).theta, this.place(root, next).theta), c = Math.cos(turn), s = Math.sin(turn);
      for (const b of members) {
        const p = this.place(b, frame), dx = p.x - from[0], dy = p.y - from[1];
        now.x[b] = from[0] + w * (to[0] - from[0]) + c * dx - s * dy;
        now.y[b] = from[1] + w * (to[1] - from[1]) + s * dx + c * dy;
        now.theta[b] = p.theta + turn;
      }
    }
  }

  /** Place of module j seen from module i. */
  seenFrom(i, j, frame) {
    const p = this.place(i, frame), q = this.place(j, frame), c = Math.cos(p.theta), s = Math.sin(p.theta);
    return [c * (q.x - p.x) + s * (q.y - p.y), c * (q.y - p.y) - s * (q.x - p.x)];
  }
  /** The face of module i that holds module j in a frame, and in the next one if it is given; -1: none. */
  heldFace(i, j, frame, next = frame) {
    const [x, y] = this.seenFrom(i, j, frame);
    if (Math.abs(Math.hypot(x, y) - this.side) > 0.1 * this.side) return -1;
    const face = Math.round(Math.atan2(y, x) / (TURN / 4)) & 3;
    if (!(this.facesOf(i, frame) >> face & 1)) return -1;
    const [u, v] = this.seenFrom(i, j, next);
    return Math.hypot(x - u, y - v) < 0.05 * this.side ? face : -1;
  }
  findGroups(frame, next) {
    const {of, held} = this.groups;
    this.groups.frame = frame;
    held.fill(0), of.forEach((_, b) => of[b] = b);
    for (let i = 0; i < this.modules; ++i) {
      if (!(this.facesOf(i, frame) & 15)) continue;
      for (let j = i + 1; j < this.modules; ++j) {
        if (!(this.facesOf(j, frame) & 15)) continue;
        const face = this.heldFace(i, j, frame, next), other = face < 0 ? -1 : this.heldFace(j, i, frame, next);
        if (other < 0) continue;
        held[i] |= 1 << face, held[j] |= 1 << other;
        const keep = Math.min(of[i], of[j]), drop = Math.max(of[i], of[j]);
        of.forEach((g, b) => { if (g === drop) of[b] = keep; });
      }
    }
  }

  /** [face, neighbour] of all faces of a module that hold one in the present frame. */
  neighbours(b) {
    const out = [];
    for (let j = 0; j < this.modules; ++j) {
      const face = j === b ? -1 : this.heldFace(b, j, this.now.frame);
      if (face >= 0) out.push([face, j]);
    }
    return out;
  }
  assemblySize(b) {
    const found = new Set([b]);
    for (const i of found) for (const [, j] of this.neighbours(i)) found.add(j);
    return found.size;
  }
  /** Name and value of everything that is known of a body now. */
  describe(b) {
    const now = this.now, rows = [], m = this.markings(b), cm = v => (100 * v).toFixed(1).replace('-', '\u2212');
    if (m) {
      rows.push(['state', m.label === 0 ? '0, isolated' : `${m.label}` + (m.complete ? ', in a complete copy' : '')]);
      if (m.last >= 0) rows.push(['engaged last', `connector ${m.last}`]);
      const faces = this.facesOf(b, now.frame), text = this.neighbours(b).sort((p, q) => p[0] - q[0])
        .map(([face, j]) => `${face} ${faces >> 4 + face & 1 ? 'bonded' : 'latched'} to ${this.nameOf(j)}`);
      rows.push(['faces', text.join(', ') || 'all free']);
      const size = this.assemblySize(b);
      if (size > 1) rows.push(['assembly', `${size} modules`]);
    }
    if (!now.shown[b]) return [...rows, ['position', 'not seen']];
    rows.push(['position', `${cm(now.x[b])}, ${cm(now.y[b])} cm`]);
    if (this.theta && b < this.modules) rows.push(['heading', `${Math.round((now.theta[b] / TURN % 1 + 1) % 1 * 360)}\u00b0`]);
    const f = Math.min(now.frame, this.frames - 2), p = this.place(b, Math.max(0, f)), q = this.place(b, f + 1);
    if (f >= 0 && p.seen && q.seen) rows.push(['speed', `${cm(Math.hypot(q.x - p.x, q.y - p.y) / (this.time[f + 1] - this.time[f]))} cm/s`]);
    return rows;
  }
}

// ---------------------------------------------------------------- colours

// Nine hues after P. Tol's "muted" scheme, as in films (render/palette.cpp); they begin again lighter, then darker.
const STATES = [0x44AA99, 0xDDCC77, 0xCC6677, 0x332288, 0x88CCEE, 0xAA4499, 0x999933, 0x117733, 0x882255];
const PAPER = [255, 255, 255], INK = [31, 41, 51];
const theme = {};
const parts = hex => [hex >> 16 & 255, hex >> 8 & 255, hex & 255];
const mix = (a, b, w) => a.map((v, i) => v + (b[i] - v) * w);
const css = ([r, g, b], alpha = 1) => `rgba(${r | 0},${g | 0},${b | 0},${alpha})`;

function readTheme() {
  const style = getComputedStyle(document.documentElement);
  for (const name of ['ink', 'dim', 'paper', 'line', 'accent', 'water', 'water-edge', 'stream', 'rim', 'rim-line', 'isolated', 'halo', 'ball',
                      'shadow', 'curve0', 'curve1', 'curve2', 'curve3']) theme[name] = style.getPropertyValue('--' + name).trim();
  theme.neutral = parts(parseInt(theme.isolated.slice(1), 16)), theme.ground = parts(parseInt(theme['water-edge'].slice(1), 16));
  looks.clear();
}

const looks = new Map();
/** Fill, outline and text colour of a module in a control state. */
function lookOf(label, complete) {
  const key = 2 * label + complete;
  if (!looks.has(key)) {
    let fill = theme.neutral;
    if (label > 0) {
      const round = Math.floor((label - 1) / STATES.length) % 3;
      fill = parts(STATES[(label - 1) % STATES.length]);
      if (round) fill = round === 1 ? mix(fill, PAPER, 0.42) : mix(fill, INK, 0.38);
      if (!complete) fill = mix(fill, PAPER, 0.28);
    }
    const linear = v => v <= 10.3 ? v / 3294.6 : ((v / 255 + 0.055) / 1.055) ** 2.4;
    const dark = 0.2126 * linear(fill[0]) + 0.7152 * linear(fill[1]) + 0.0722 * linear(fill[2]) > 0.24;
    looks.set(key, {fill: css(fill), line: css(mix(fill, INK, 0.55)), text: css(dark ? INK : PAPER), bar: dark ? '#005a9c' : '#fff',
                    notch: css(dark ? INK : PAPER, 0.55), trail: label > 0 ? mix(fill, theme.ground, 0.1) : mix(theme.neutral, parts(parseInt(theme.dim.slice(1), 16)), 0.6)});
  }
  return looks.get(key);
}

// ---------------------------------------------------------------- drawing

const TRAIL = 4, TRAIL_POINTS = 24;  // s
const camera = {zoom: 1, x: 0, y: 0};
const show = {labels: true, trails: true, flow: true, follow: false};
let chosen = -1, hovered = null, spot = null;  // body; {view, body, at}; {tank, modules, until}

/** A square with round corners and one unit a side, in the module's frame. */
const SQUARE = new Path2D();
SQUARE.roundRect(-0.5, -0.5, 1, 1, 0.14);

function drawFace(c, look, how, line) {
  c.beginPath();
  if (how === 'bonded') {  // half of a bridge; the neighbour draws the other half
    c.fillStyle = css(INK), c.fillRect(0.37, -0.15, 0.14, 0.3);
  } else if (how === 'latched') {  // half of an open ring
    c.arc(0.5, 0, 0.115, TURN / 4, 3 * TURN / 4), c.fillStyle = '#fff', c.fill();
    c.strokeStyle = css(INK), c.lineWidth = 1.3 * line, c.stroke();
  } else if (how === 'free') {
    c.arc(0.5 - line, 0, 0.06, TURN / 4, 3 * TURN / 4), c.fillStyle = look.notch, c.fill();
  } else {
    c.moveTo(0.445, -0.1), c.lineTo(0.445, 0.1), c.strokeStyle = look.notch, c.lineWidth = 1.2 * line, c.stroke();
  }
}

/** A module in its own frame: one unit a side, y up. `size`: its side in pixels. */
function drawModule(c, look, faces, size) {
  c.fillStyle = look.fill, c.fill(SQUARE);
  c.strokeStyle = look.line, c.lineWidth = 1.4 / size, c.stroke(SQUARE);
  if (size < 9) return;
  if (!faces) {  // of a recording: a mark on the side of the heading
    c.beginPath(), c.moveTo(0.44, 0), c.lineTo(0.27, 0.12), c.lineTo(0.27, -0.12), c.fillStyle = look.notch, c.fill();
    return;
  }
  const {latched = 0, bonded = 0, last = -1, off = false} = faces;
  for (let face = 0; face < 4; ++face) {
    if (last === face) {
      c.beginPath(), c.moveTo(0.415, -0.29), c.lineTo(0.415, 0.29), c.lineCap = 'round';
      c.strokeStyle = look.bar, c.lineWidth = Math.max(0.062, 1.5 / size), c.stroke();
    }
    drawFace(c, look, bonded >> face & 1 ? 'bonded' : latched >> face & 1 ? 'latched' : off ? 'off' : 'free', 1 / size);
    c.rotate(TURN / 4);
  }
}

class View {
  constructor(tank, index) {
    this.tank = tank, this.index = index;
    this.figure = document.createElement('figure');
    this.canvas = this.figure.appendChild(document.createElement('canvas'));
    this.canvas.setAttribute('role', 'img'), this.canvas.tabIndex = 0;
    this.context = this.canvas.getContext('2d');
    this.caption = this.figure.appendChild(document.createElement('figcaption'));
    for (const [tag, text] of [['b', head.tanks.length > 1 ? tank.name : ''], ['span', tank.note], ['span', '']]) {
      this.caption.appendChild(document.createElement(tag)).textContent = text;
    }
    this.state = this.caption.lastChild, this.state.className = 'state';
    this.ground = document.createElement('canvas'), this.groundKey = '';
    $('tanks').append(this.figure);
    new ResizeObserver(() => this.resize()).observe(this.figure);
    this.resize();
  }

  resize() {
    const box = this.figure.getBoundingClientRect(), density = Math.min(3, devicePixelRatio || 1);
    this.width = Math.max(1, box.width), this.height = Math.max(1, box.height), this.density = density;
    for (const c of [this.canvas, this.ground]) c.width = Math.round(this.width * density), c.height = Math.round(this.height * density);
    this.groundKey = '';
    if (views.includes(this)) this.draw(now);  // at once, as a canvas of another size is empty
    invalidate();
  }

  /** Pixels per metre, and the point in the middle. */
  aim() {
    const t = this.tank;
    this.scale = camera.zoom * Math.min(this.width, this.height) / (2.12 * t.radius);
    const follows = show.follow && chosen >= 0 && chosen < t.bodies;
    this.cx = follows ? t.now.x[chosen] : camera.x, this.cy = follows ? t.now.y[chosen] : camera.y;
  }
  px(x) { return this.width / 2 + (x - this.cx) * this.scale; }
  py(y) { return this.height / 2 - (y - this.cy) * this.scale; }
  mx(px) { return this.cx + (px - this.width / 2) / this.scale; }
  my(py) { return this.cy - (py - this.height / 2) / this.scale; }

  bodyAt(px, py) {
    const t = this.tank, x = this.mx(px), y = this.my(py), slack = 6 / this.scale;
    let best = -1, least = Infinity;
    for (let b = 0; b < t.bodies; ++b) {
      const d = Math.hypot(t.now.x[b] - x, t.now.y[b] - y);
      if (t.now.shown[b] && d < least && d < (b < t.modules ? 0.62 * t.side : t.ball) + slack) best = b, least = d;
    }
    return best;
  }

  draw(time) {
    const c = this.context, t = this.tank;
    t.moveTo(clamp(time, t.begin, t.end));
    this.aim();
    this.drawGround(show.flow ? t.flowAt(time) : -1);
    c.setTransform(1, 0, 0, 1, 0, 0);
    c.clearRect(0, 0, this.canvas.width, this.canvas.height);
    c.drawImage(this.ground, 0, 0);
    c.setTransform(this.density, 0, 0, this.density, 0, 0);
    if (show.trails) this.drawTrails(time);
    this.drawBodies(time);
    this.drawScaleBar();
    this.describe(time);
  }

  /** Water, streamlines and rim: drawn again only when the camera, the flow or the theme changes. */
  drawGround(flow) {
    const key = [this.scale, this.cx, this.cy, flow, theme.paper].join();
    if (key === this.groundKey) return;
    this.groundKey = key;
    const g = this.ground.getContext('2d'), r = this.tank.radius * this.scale, x = this.px(0), y = this.py(0);
    g.setTransform(this.density, 0, 0, this.density, 0, 0);
    g.clearRect(0, 0, this.width, this.height);
    const water = g.createRadialGradient(x, y, 0.15 * r, x, y, r);
    water.addColorStop(0, theme.water), water.addColorStop(1, theme['water-edge']);
    g.beginPath(), g.arc(x, y, r, 0, TURN), g.fillStyle = water, g.fill();
    if (flow >= 0 && this.tank.flows[flow]) this.drawFlow(g, this.tank.flows[flow]);
    const rim = 0.018 * r / camera.zoom + 2;
    for (const [radius, width, colour] of [[r + rim / 2, rim, theme.rim], [r, 1.2, theme['rim-line']], [r + rim, 1, theme['rim-line']]]) {
      g.beginPath(), g.arc(x, y, radius, 0, TURN), g.lineWidth = width, g.strokeStyle = colour, g.stroke();
    }
  }

  drawFlow(g, flow) {
    g.strokeStyle = g.fillStyle = theme.stream, g.lineCap = 'butt';
    const x = i => this.px(flow.x[i] * head.position_step), y = i => this.py(flow.y[i] * head.position_step);
    let first = 0;
    for (const length of flow.lengths) {
      const last = first + length - 1;
      for (let i = first; i < last;) {  // pieces of about equal speed
        const tone = flow.tone[i] >> 4;
        g.beginPath(), g.moveTo(x(i), y(i));
        for (; i < last && flow.tone[i] >> 4 === tone; ++i) g.lineTo(x(i + 1), y(i + 1));
        g.globalAlpha = 0.16 + 0.5 * tone / 16, g.lineWidth = 0.8 + 1.3 * tone / 16, g.stroke();
      }
      const m = first + Math.floor(length / 2), way = Math.atan2(y(m + 1) - y(m), x(m + 1) - x(m)), size = 4 + 4 * flow.tone[m] / 255;
      if (length > 6) {
        g.save(), g.translate(x(m), y(m)), g.rotate(way), g.globalAlpha = 0.3 + 0.5 * flow.tone[m] / 255;
        g.beginPath(), g.moveTo(size, 0), g.lineTo(-size * 0.7, size * 0.65), g.lineTo(-size * 0.7, -size * 0.65), g.fill(), g.restore();
      }
      first += length;
    }
    g.globalAlpha = 1;
  }

  drawTrails(time) {
    const c = this.context, t = this.tank, end = clamp(time, t.begin, t.end), begin = Math.max(t.begin, end - TRAIL);
    if (end <= begin) return;
    const frames = [], weights = [];
    for (let k = 0; k < TRAIL_POINTS; ++k) {
      const at = begin + (end - begin) * k / TRAIL_POINTS, f = t.frameAt(at), span = f + 1 < t.frames ? t.time[f + 1] - t.time[f] : 1;
      frames.push(f), weights.push((at - t.time[f]) / span);
    }
    c.lineCap = 'butt', c.lineJoin = 'round';
    for (let b = 0; b < t.bodies; ++b) {
      if (!t.now.shown[b]) continue;
      const colour = t.look(b).trail;
      const points = frames.map((f, k) => {
        const p = t.place(b, f), q = t.place(b, Math.min(f + 1, t.frames - 1)), w = weights[k];
        return p.seen && q.seen ? [this.px(p.x + w * (q.x - p.x)), this.py(p.y + w * (q.y - p.y))] : null;
      });
      points.push([this.px(t.now.x[b]), this.py(t.now.y[b])]);
      const middle = k => [0, 1].map(i => (points[k - 1][i] + points[k][i]) / 2);
      for (let k = 1; k < points.length - 1; ++k) {  // rounded at the points
        if (!points[k - 1] || !points[k] || !points[k + 1]) continue;
        const age = k / TRAIL_POINTS, to = k + 2 < points.length ? middle(k + 1) : points[k + 1];
        c.beginPath(), c.moveTo(...middle(k)), c.quadraticCurveTo(...points[k], ...to);
        c.strokeStyle = css(colour, 0.7 * age ** 1.4), c.lineWidth = 0.8 + 1.8 * age, c.stroke();
      }
    }
  }

  each(first, last, act) {
    const c = this.context, t = this.tank;
    for (let b = first; b < last; ++b) {
      if (!t.now.shown[b]) continue;
      const x = this.px(t.now.x[b]), y = this.py(t.now.y[b]), size = this.scale * (b < t.modules ? t.side : 2 * t.ball);
      if (x < -size || y < -size || x > this.width + size || y > this.height + size) continue;
      c.save(), c.translate(x, y);
      if (b < t.modules) c.rotate(-t.now.theta[b]), c.scale(size, -size);
      act(b, size, c), c.restore();
    }
  }

  drawBodies(time) {
    const c = this.context, t = this.tank, size = this.scale * t.side;
    this.each(t.modules, t.bodies, (b, d) => {
      c.beginPath(), c.arc(0, 0, d / 2, 0, TURN), c.fillStyle = theme.ball, c.fill();
      c.strokeStyle = '#787166', c.lineWidth = 1.4, c.stroke();
    });
    this.each(0, t.modules, b => {
      if (!t.label || !t.markings(b).complete) return;
      c.strokeStyle = theme.halo, c.lineJoin = 'round';
      c.globalAlpha = 0.3, c.lineWidth = 0.42, c.stroke(SQUARE), c.globalAlpha = 1, c.lineWidth = 0.2, c.stroke(SQUARE);
    });
    this.each(0, t.modules, b => {
      const m = t.markings(b), faces = m && {latched: t.now.latched[b], bonded: t.now.bonded[b], last: show.labels ? m.last : -1, off: !t.latches};
      drawModule(c, t.look(b), faces, size);
    });
    this.drawRings(time);
    if (!show.labels || size < 13) return;
    c.textAlign = 'center', c.textBaseline = 'middle';
    this.each(0, t.bodies, (b, d) => {
      const m = t.markings(b), text = m ? String(m.label) : t.nameOf(b), look = t.look(b);
      c.setTransform(this.density, 0, 0, this.density, 0, 0);
      c.font = `bold ${Math.round(d * (text.length < 3 ? 0.42 : 0.32))}px system-ui, sans-serif`;
      c.fillStyle = b < t.modules ? look.text : css(INK);
      c.fillText(text, this.px(t.now.x[b]), this.py(t.now.y[b]) + 0.03 * d);
    });
  }

  /** Rings around the chosen module, the one under the pointer, and those of an event that was clicked. */
  drawRings() {
    const c = this.context, t = this.tank;
    const ring = (b, colour, width, grow = 0) => {
      if (b < 0 || b >= t.bodies || !t.now.shown[b]) return;
      c.beginPath(), c.arc(this.px(t.now.x[b]), this.py(t.now.y[b]), this.scale * (b < t.modules ? 0.82 * t.side : 1.2 * t.ball) + grow, 0, TURN);
      c.strokeStyle = colour, c.lineWidth = width, c.stroke();
    };
    ring(chosen, theme.accent, 2.5);
    if (hovered && hovered.view === this) ring(hovered.body, theme.ink, 1.5);
    if (!spot || spot.tank !== this.index) return;
    const age = 1 - (spot.until - performance.now()) / 1600;
    if (age > 1) spot = null;
    else for (const b of spot.modules) c.globalAlpha = 1 - age, ring(b, theme.accent, 4, 26 * age), c.globalAlpha = 1;
    invalidate();
  }

  drawScaleBar() {
    const c = this.context, wanted = this.width / 5 / this.scale, decade = 10 ** Math.floor(Math.log10(wanted));
    const length = decade * (wanted >= 5 * decade ? 5 : wanted >= 2 * decade ? 2 : 1), x = 12, y = this.height - 12, end = x + length * this.scale;
    c.strokeStyle = c.fillStyle = theme.ink, c.lineWidth = 2, c.beginPath();
    c.moveTo(x, y - 5), c.lineTo(x, y), c.lineTo(end, y), c.lineTo(end, y - 5), c.stroke();
    c.font = '13px system-ui, sans-serif', c.textAlign = 'center', c.textBaseline = 'bottom';
    const text = length < 0.01 ? `${+(1000 * length).toPrecision(3)} mm` : length < 1 ? `${+(100 * length).toPrecision(3)} cm` : `${length} m`;
    c.fillText(text, (x + end) / 2, y - 4);
  }

  describe(time) {
    const t = this.tank, power = t.flows.length ? t.flows[t.flowAt(time)].power : '';
    const texts = [];
    if (t.possible > 0) texts.push(`${t.copiesAt(time)} of ${t.possible} copies`);
    if (power) texts.push(`pumps at ${power}`);
    if (time > t.end + 1e-9) texts.push('ended');
    const text = texts.join(', ');
    if (this.state.textContent !== text) this.state.textContent = text;
    const label = `Tank ${t.name} at ${clockText(time)}: ${t.modules} modules, ${t.bodies - t.modules} balls. ${text}`;
    if (!playing) this.canvas.setAttribute('aria-label', label);
  }
}

// ---------------------------------------------------------------- time

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
let tanks = [], views = [], begin = 0, end = 1, now = 0, speed = 1, playing = false, due = false, before = 0;
const cost = {frames: 0, ms: 0};

function clockText(t, digits = 1) {
  const sign = t < 0 ? '\u2212' : '', s = Math.abs(t).toFixed(digits), whole = Math.floor(s), rest = s.slice(String(whole).length);
  const two = v => String(v).padStart(2, '0'), h = Math.floor(whole / 3600), m = Math.floor(whole / 60) % 60;
  return sign + (h ? `${h}:${two(m)}` : m) + `:${two(whole % 60)}${rest}`;
}

function invalidate() {
  if (due || !views.length) return;
  due = true;
  requestAnimationFrame(tick);
}

function tick(at) {
  due = false;
  if (playing) {
    now += Math.min(0.1, Math.max(0, at - before) / 1000) * speed;
    before = at;
    if (now >= end) now = end, setPlaying(false);
  }
  const start = performance.now();
  for (const view of views) view.draw(now);
  drawCurve();
  const text = clockText(now);
  $('clock').firstChild.data = text;
  $('scrub').value = now;
  if (!playing) $('scrub').setAttribute('aria-valuetext', text);
  showModule();
  showTip();
  showRows();
  cost.frames += 1, cost.ms += performance.now() - start;
  if (playing) invalidate();
}

function setPlaying(on) {
  if (on && now >= end) now = begin;
  playing = on, before = performance.now();
  document.body.classList.toggle('playing', on);
  $('play').setAttribute('aria-label', on ? 'Pause' : 'Play');
  invalidate();
}

function seek(t) {
  now = clamp(t, begin, end);
  invalidate();
}

function stepFrames(by) {
  setPlaying(false);
  const t = tanks[0], f = lastUpTo(t.time, now + 1e-9), on = f >= 0 && Math.abs(t.time[f] - now) < 1e-9;
  seek(t.time[clamp(by > 0 || on ? f + by : f, 0, t.frames - 1)]);
}

function setSpeed(value) {
  speed = value, $('speed').value = value;
}
const changeSpeed = by => setSpeed(SPEEDS[clamp(SPEEDS.indexOf(speed) + by, 0, SPEEDS.length - 1)]);

// ---------------------------------------------------------------- yield

function niceStep(span, most) {
  const raw = span / most, decade = 10 ** Math.floor(Math.log10(raw));
  return decade * [1, 2, 5, 10].find(k => k * decade >= raw * 0.999);
}

let curveBox = null;
function drawCurve() {
  if ($('yield').hidden) return;
  const canvas = $('curve'), w = canvas.clientWidth, h = canvas.clientHeight, d = devicePixelRatio || 1, c = canvas.getContext('2d');
  if (canvas.width !== Math.round(w * d) || canvas.height !== Math.round(h * d)) canvas.width = Math.round(w * d), canvas.height = Math.round(h * d);
  const most = Math.max(1, ...tanks.map(t => Math.max(t.possible, ...t.copies.value)));
  const left = 22, right = w - 10, top = 8, bottom = h - 32, x = t => left + (right - left) * (t - begin) / (end - begin), y = v => bottom - (bottom - top) * v / most;
  curveBox = {left, right};
  c.setTransform(d, 0, 0, d, 0, 0), c.clearRect(0, 0, w, h);
  const [unit, name] = end - begin > 7200 ? [3600, 'h'] : end - begin > 240 ? [60, 'min'] : [1, 's'];
  c.font = '12px system-ui, sans-serif', c.fillStyle = theme.dim, c.strokeStyle = theme.line, c.lineWidth = 1, c.textBaseline = 'middle', c.textAlign = 'right';
  for (let v = 0, step = Math.max(1, niceStep(most, 4)); v <= most; v += step) {
    c.beginPath(), c.moveTo(left, y(v)), c.lineTo(right, y(v)), c.stroke(), c.fillText(v, left - 6, y(v));
  }
  c.textAlign = 'center', c.textBaseline = 'top';
  for (let step = niceStep((end - begin) / unit, 5), v = Math.ceil(begin / unit / step) * step; v * unit <= end + 1e-9; v += step) {
    c.fillText(+v.toFixed(6), x(v * unit), bottom + 4);
  }
  c.fillText(`time (${name})`, (left + right) / 2, bottom + 18);
  head.yields.forEach((band, i) => drawBand(c, band, theme['curve' + i % 4], x, y));
  tanks.forEach((t, i) => {
    if (!t.label) return;
    c.beginPath(), c.moveTo(x(t.begin), y(0));
    t.copies.time.forEach((at, k) => { c.lineTo(x(at), y(t.copies.value[Math.max(0, k - 1)])), c.lineTo(x(at), y(t.copies.value[k])); });
    c.lineTo(x(t.end), y(t.copies.value.at(-1)));
    c.strokeStyle = theme['curve' + i % 4], c.lineWidth = 2, c.stroke();
  });
  c.beginPath(), c.moveTo(x(now), top - 4), c.lineTo(x(now), bottom), c.strokeStyle = theme.ink, c.lineWidth = 1.2, c.stroke();
}

function drawBand(c, {time, mean, low, high}, colour, x, y) {
  const there = i => time[i] >= begin && time[i] <= end && low[i] !== null && high[i] !== null;
  const points = time.map((_, i) => i).filter(there);
  c.beginPath();
  for (const i of points) c.lineTo(x(time[i]), y(high[i]));
  for (const i of points.reverse()) c.lineTo(x(time[i]), y(low[i]));
  c.globalAlpha = 0.18, c.fillStyle = colour, c.fill(), c.globalAlpha = 1;
  c.beginPath(), c.setLineDash([5, 4]);
  for (const i of time.keys()) if (time[i] >= begin && time[i] <= end) c.lineTo(x(time[i]), y(mean[i]));
  c.strokeStyle = colour, c.lineWidth = 1.4, c.stroke(), c.setLineDash([]);
}

function setUpCurve() {
  $('yield').hidden = !tanks.some(t => t.possible > 0);
  if ($('yield').hidden) return;
  const add = (text, i, dashed) => {
    const row = $('curves').appendChild(document.createElement('li')), line = row.appendChild(document.createElement('i'));
    if (dashed) line.style.background = `repeating-linear-gradient(90deg, var(--curve${i % 4}) 0 5px, transparent 5px 9px)`;
    else line.style.background = `var(--curve${i % 4})`;
    row.append(text);
  };
  if (tanks.length > 1 || head.yields.length) tanks.forEach((t, i) => add(t.name, i, false));
  head.yields.forEach((y, i) => add(`${y.name}, 95 % band`, i, true));
  $('curve').setAttribute('aria-label', 'Complete copies over time. ' + tanks.map(t =>
    `${t.name}: ` + (t.copies.time.slice(1).map((at, k) => `${t.copies.value[k + 1]} from ${clockText(at)}`).join(', ') || 'none')).join('. '));
  const scrub = e => { if (e.buttons & 1) seek(begin + (end - begin) * (e.offsetX - curveBox.left) / (curveBox.right - curveBox.left)); };
  $('curve').addEventListener('pointerdown', e => { $('curve').setPointerCapture(e.pointerId), scrub(e); });
  $('curve').addEventListener('pointermove', scrub);
}

// ---------------------------------------------------------------- module and tip

function fill(list, rows) {
  const key = rows.join('|');
  if (list.dataset.key === key) return;
  list.dataset.key = key;
  list.replaceChildren(...rows.flatMap(([name, value]) => {
    const dt = document.createElement('dt'), dd = document.createElement('dd');
    dt.textContent = name, dd.textContent = value;
    return [dt, dd];
  }));
}

const kindOf = (t, b) => b < t.modules ? 'Module' : 'Ball';
let moduleTank = 0;
function showModule() {
  const t = tanks[moduleTank], known = chosen >= 0 && chosen < t.bodies;
  $('module').classList.toggle('known', known);
  const title = known ? `${kindOf(t, chosen)} ${t.nameOf(chosen)}` + (tanks.length > 1 ? `, ${t.name}` : '') : 'Module';
  if ($('module-name').textContent !== title) $('module-name').textContent = title;
  if (known) fill($('module-state'), t.describe(chosen));
}

function showTip() {
  $('tip').hidden = !hovered;
  if (!hovered) return;
  const {view, body, at} = hovered, t = view.tank, tip = $('tip');
  if (!tip.firstChild) tip.append(document.createElement('b'), document.createElement('dl'));
  tip.firstChild.textContent = `${kindOf(t, body)} ${t.nameOf(body)}`;
  fill(tip.lastChild, t.describe(body));
  tip.style.left = `${clamp(at[0] + 18, 4, innerWidth - tip.offsetWidth - 4)}px`;
  tip.style.top = `${at[1] + 18 + tip.offsetHeight < innerHeight ? at[1] + 18 : Math.max(4, at[1] - tip.offsetHeight - 14)}px`;
}

function choose(body, tank = moduleTank) {
  chosen = body, moduleTank = tank;
  if (body < 0) setShow('follow', false);
  invalidate();
}

function setShow(what, on) {
  if (what === 'follow') {
    if (on && chosen < 0) chosen = 0;
    const t = tanks[moduleTank];
    if (on && camera.zoom < 2) camera.zoom = 3;
    if (!on && show.follow && chosen >= 0) camera.x = t.now.x[chosen], camera.y = t.now.y[chosen], keepInside();
  }
  show[what] = on;
  $(what).setAttribute('aria-pressed', on);
  invalidate();
}

// ---------------------------------------------------------------- events

const HEIGHT = matchMedia('(pointer: coarse)').matches ? 38 : 25;
const USUAL = ['link', 'unlink', 'update', 'report', 'command', 'copy'];  // latches alone are many
const list = {tank: 0, kinds: new Set(USUAL), rows: new Int32Array(0), current: -2, first: -1, hold: 0};

function eventText(e, i) {
  const kind = e.kinds[e.kind[i]], rule = e.rules[e.rule[i]], states = e.label_b[i] >= 0 ? ` \u2192 ${e.label_a[i]}, ${e.label_b[i]}` : '';
  if (kind === 'copy') return ['copy', `${e.copies[i]} complete`];
  if (kind === 'command') return ['command', rule];
  if (kind === 'report') return ['report', `module ${e.a[i]}, state ${e.label_a[i]}`];
  const pair = `${e.a[i]}\u2013${e.b[i]}`;
  return [kind, kind === 'latch' || kind === 'unlatch' ? `${pair}, faces ${e.face_a[i]} and ${e.face_b[i]}` : `${pair}, ${rule}${states}`];
}

function filterRows() {
  const e = tanks[list.tank].events, wanted = e.kinds.map(k => list.kinds.has(k)), rows = [];
  for (let i = 0; i < e.count; ++i) if (wanted[e.kind[i]]) rows.push(i);
  list.rows = Int32Array.from(rows), list.current = -2, list.first = -1;
  $('all-rows').style.height = `${HEIGHT * rows.length}px`;
  invalidate();
}

/** Draws the rows in sight, and moves the list along with the time. */
function showRows() {
  if ($('log').hidden) return;
  const box = $('rows'), e = tanks[list.tank].events, rows = list.rows;
  let low = 0, high = rows.length;
  while (low < high) {
    const middle = low + high >> 1;
    if (e.time[rows[middle]] <= now + 1e-6) low = middle + 1; else high = middle;
  }
  const current = low - 1, moved = current !== list.current;
  list.current = current;
  if (moved && performance.now() > list.hold) box.scrollTop = HEIGHT * (current + 0.5) - box.clientHeight / 2;
  const first = Math.max(0, Math.floor(box.scrollTop / HEIGHT) - 4), last = Math.min(rows.length, first + Math.ceil(box.clientHeight / HEIGHT) + 8);
  if (!moved && first === list.first && last === list.last) return;
  list.first = first, list.last = last;
  const buttons = $('all-rows').children;
  for (let k = 0; k < last - first; ++k) {
    const button = buttons[k] || $('all-rows').appendChild(document.createElement('button')), i = rows[first + k];
    if (!button.firstChild) button.append(document.createElement('span'), document.createElement('b'), '');
    const [kind, text] = eventText(e, i);
    button.hidden = false, button.value = i, button.style.top = `${HEIGHT * (first + k)}px`, button.style.height = `${HEIGHT}px`;
    button.children[0].textContent = clockText(e.time[i]), button.children[1].textContent = kind, button.lastChild.data = text;
    button.setAttribute('aria-current', first + k === current), button.classList.toggle('later', first + k > current);
  }
  for (let k = last - first; k < buttons.length; ++k) buttons[k].hidden = true;
}

function goToEvent(i) {
  const e = tanks[list.tank].events, modules = [e.a[i], e.b[i]].filter(b => b >= 0);
  list.hold = performance.now() + 400;
  spot = modules.length ? {tank: list.tank, modules, until: performance.now() + 1600} : null;
  setPlaying(false);
  seek(e.time[i]);
}

function chip(parent, text, on, act) {
  const button = parent.appendChild(document.createElement('button'));
  button.textContent = text, button.setAttribute('aria-pressed', on);
  button.addEventListener('click', () => act(button));
}

function setUpKinds() {
  const e = tanks[list.tank].events, counts = new Int32Array(e.kinds.length);
  for (let i = 0; i < e.count; ++i) ++counts[e.kind[i]];
  $('kinds').replaceChildren();
  [...e.kinds.keys()].reverse().filter(k => counts[k]).forEach(k => chip($('kinds'), `${e.kinds[k]} ${counts[k]}`, list.kinds.has(e.kinds[k]), button => {
    if (!list.kinds.delete(e.kinds[k])) list.kinds.add(e.kinds[k]);
    button.setAttribute('aria-pressed', list.kinds.has(e.kinds[k]));
    filterRows();
  }));
  filterRows();
}

function setUpEvents() {
  const with_events = tanks.map((t, i) => i).filter(i => tanks[i].events.count);
  $('log').hidden = !with_events.length;
  if (!with_events.length) return;
  list.tank = with_events[0];
  if (with_events.length > 1) with_events.forEach(i => chip($('tank-choice'), tanks[i].name, i === list.tank, button => {
    list.tank = i;
    for (const other of $('tank-choice').children) other.setAttribute('aria-pressed', other === button);
    setUpKinds();
  }));
  $('rows').addEventListener('click', e => { const row = e.target.closest('button'); if (row) goToEvent(+row.value); });
  $('rows').addEventListener('scroll', invalidate);
  for (const kind of ['wheel', 'pointerdown', 'touchmove']) $('rows').addEventListener(kind, () => list.hold = performance.now() + 3000, {passive: true});
  setUpKinds();
  tanks[with_events[0]].copies.time.slice(1).forEach(t => {
    $('marks').appendChild(document.createElement('i')).style.left = `${100 * (t - begin) / (end - begin)}%`;
  });
}

// ---------------------------------------------------------------- pointer and keys

function keepInside() {
  const r = tanks[0].radius * (1 - 1 / camera.zoom), far = Math.hypot(camera.x, camera.y);
  if (far > r) camera.x *= r / far, camera.y *= r / far;
  for (const v of views) v.canvas.style.touchAction = camera.zoom > 1 ? 'none' : 'pan-y';
  invalidate();
}

/** Zooms by a factor; the point under (px, py) of a view stays where it is. */
function zoom(factor, view = views[0], px = view.width / 2, py = view.height / 2) {
  const x = view.mx(px), y = view.my(py);
  camera.zoom = clamp(camera.zoom * factor, 1, 60);
  view.aim();
  if (!show.follow) camera.x += x - view.mx(px), camera.y += y - view.my(py);
  keepInside();
}

function fitAll() {
  setShow('follow', false);
  Object.assign(camera, {zoom: 1, x: 0, y: 0});
  keepInside();
}

function watchPointers(view) {
  const canvas = view.canvas, fingers = new Map();
  let travelled = 0;
  const place = e => [e.offsetX, e.offsetY];
  const hover = e => {
    const body = e.pointerType === 'touch' ? -1 : view.bodyAt(...place(e));
    hovered = body < 0 ? null : {view, body, at: [e.clientX, e.clientY]};
    view.figure.classList.toggle('over', body >= 0);
    invalidate();
  };
  canvas.addEventListener('pointerdown', e => {
    canvas.setPointerCapture(e.pointerId), fingers.set(e.pointerId, place(e));
    if (fingers.size === 1) travelled = 0;
  });
  canvas.addEventListener('pointermove', e => {
    const from = fingers.get(e.pointerId), to = place(e);
    if (!from) return hover(e);
    travelled += Math.hypot(to[0] - from[0], to[1] - from[1]);
    if (fingers.size === 2) {
      const other = [...fingers].find(([id]) => id !== e.pointerId)[1], span = p => Math.max(10, Math.hypot(p[0] - other[0], p[1] - other[1]));
      zoom(span(to) / span(from), view, (to[0] + other[0]) / 2, (to[1] + other[1]) / 2);
    } else if (travelled > 5 && camera.zoom > 1) {
      if (show.follow) setShow('follow', false);
      view.figure.classList.add('moving'), hovered = null;
      camera.x -= (to[0] - from[0]) / view.scale, camera.y += (to[1] - from[1]) / view.scale;
      keepInside();
    }
    fingers.set(e.pointerId, to);
  });
  const lift = e => { fingers.delete(e.pointerId), view.figure.classList.remove('moving'); };
  canvas.addEventListener('pointerup', e => {
    if (fingers.size === 1 && travelled < 6) choose(view.bodyAt(...place(e)), view.index);
    lift(e);
  });
  canvas.addEventListener('pointercancel', lift);
  canvas.addEventListener('pointerleave', () => { hovered = null, invalidate(); });
  canvas.addEventListener('dblclick', e => zoom(2, view, ...place(e)));
  canvas.addEventListener('wheel', e => {
    if (e.deltaY < 0 || camera.zoom > 1) e.preventDefault(), zoom(Math.exp(-clamp(e.deltaY, -80, 80) / 260), view, ...place(e));
  }, {passive: false});
}

const keys = {
  ' ': () => setPlaying(!playing), ArrowLeft: e => e.shiftKey ? seek(now - 10) : stepFrames(-1), ArrowRight: e => e.shiftKey ? seek(now + 10) : stepFrames(1),
  ArrowUp: () => changeSpeed(1), ArrowDown: () => changeSpeed(-1), '+': () => zoom(1.4), '=': () => zoom(1.4), '-': () => zoom(1 / 1.4), 0: fitAll,
  f: () => setShow('follow', !show.follow), n: () => choose((chosen + 1) % tanks[moduleTank].bodies), Home: () => seek(begin), End: () => seek(end),
  Escape: () => choose(-1), '?': () => $('about').showModal(),
};

function watchKeys(e) {
  const on = e.target, typing = on.tagName === 'SELECT' || on.closest('dialog');
  const presses = e.key === ' ' && on.tagName === 'BUTTON', scrolls = on.closest('#rows') && /^(Arrow|Home|End)/.test(e.key);
  if (typing || presses || scrolls || e.ctrlKey || e.metaKey || e.altKey || !keys[e.key]) return;
  e.preventDefault();
  keys[e.key](e);
}

function setUpControls() {
  const press = (id, act) => $(id).addEventListener('click', e => { act(); if (e.detail) e.currentTarget.blur(); });  // space stays play
  press('play', keys[' ']), press('back', () => stepFrames(-1)), press('next', () => stepFrames(1));
  press('in', () => zoom(1.4)), press('out', () => zoom(1 / 1.4)), press('fit', fitAll), press('help', keys['?']);
  for (const what of ['labels', 'trails', 'flow', 'follow']) press(what, () => setShow(what, !show[what]));
  for (const v of SPEEDS) $('speed').add(new Option(`${v}\u00d7`, v));
  $('speed').addEventListener('change', () => { setSpeed(+$('speed').value), $('speed').blur(); });
  Object.assign($('scrub'), {min: begin, max: end});
  $('scrub').addEventListener('input', () => seek(+$('scrub').value));
  addEventListener('keydown', watchKeys);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { readTheme(), drawLegend(), invalidate(); });
  $('clock').append('', Object.assign(document.createElement('small'), {textContent: ` / ${clockText(end)}`}));
  $('flow').hidden = !tanks.some(t => t.flows.length);
}

function drawLegend() {
  const canvas = $('legend'), d = devicePixelRatio || 1, c = canvas.getContext('2d'), size = 26;
  canvas.width = 620 * d, canvas.height = 52 * d, canvas.style.maxWidth = '620px', canvas.style.height = 'auto';
  c.setTransform(d, 0, 0, d, 0, 0), c.clearRect(0, 0, 620, 52);
  const entries = [['free', {}], ['latched', {latched: 1}], ['bonded', {bonded: 1}], ['engaged last', {last: 0}], ['complete copy', {halo: true}]];
  entries.forEach(([name, faces], i) => {
    const x = 18 + i * 118 + (i > 3 ? 20 : 0), pair = faces.latched || faces.bonded;
    for (let k = 0; k <= (pair ? 1 : 0); ++k) {
      c.save(), c.translate(x + k * size, 26), c.scale(size, -size);
      if (faces.halo) c.strokeStyle = theme.halo, c.lineWidth = 0.3, c.stroke(SQUARE);
      drawModule(c, lookOf(0, 0), k ? {latched: (faces.latched || 0) << 2, bonded: (faces.bonded || 0) << 2} : faces, size), c.restore();
    }
    c.font = '13px system-ui, sans-serif', c.fillStyle = theme.ink, c.textBaseline = 'middle', c.fillText(name, x + size * (pair ? 1.7 : 0.8), 26);
  });
}

function setUpTexts() {
  $('title').textContent = head.title, $('subtitle').textContent = head.subtitle;
  $('command').textContent = `${head.command} (lilytank ${head.version})`;
  const mm = 500 * head.position_step, degrees = head.heading_step * 90 / Math.PI;
  const thinned = head.tanks.filter(t => t.stored > t.frames + 1).map(t => `${t.name}: ${t.frames} of ${t.stored} stored frames.`).join(' ');
  $('exact').textContent = `Stored positions are rounded to ${2 * mm} mm and headings to ${(2 * degrees).toFixed(1)}\u00b0: errors of at most ${mm} mm and ` +
    `${degrees.toFixed(2)}\u00b0. Between stored frames, positions move on straight lines, headings on the shorter arc, and bonded modules as one body; ` +
    `states are those of the last stored frame. ${thinned}`;
}

// ---------------------------------------------------------------- start

/** For scripts and tests: the pose that the page shows of a body at a time. */
window.lilytank = {
  poseAt(t, body, tank = 0) {
    const k = tanks[tank], at = now;
    k.moveTo(clamp(t, k.begin, k.end));
    const pose = {x: k.now.x[body], y: k.now.y[body], theta: k.now.theta[body], seen: k.now.shown[body] > 0, ...k.markings(body)};
    k.moveTo(clamp(at, k.begin, k.end));
    return pose;
  },
  seek, play: () => setPlaying(true), get time() { return now; }, get tanks() { return tanks; }, get millisecondsPerFrame() { return cost.ms / cost.frames; },
};

async function start() {
  if (!window.DecompressionStream) throw new Error('this page needs a browser of 2023 or later (DecompressionStream)');
  const bytes = await unpacked();
  tanks = head.tanks.map(t => new Tank(t, bytes));
  begin = Math.min(...tanks.map(t => t.begin)), end = Math.max(...tanks.map(t => t.end));
  if (!(end > begin)) end = begin + 1;
  now = begin;
  readTheme(), setUpTexts(), setUpControls(), setUpCurve(), setUpEvents();
  $('tanks').classList.toggle('four', tanks.length === 4);
  document.body.classList.toggle('plain', $('yield').hidden && $('log').hidden);
  views = tanks.map((t, i) => new View(t, i));
  views.forEach(watchPointers), keepInside(), drawLegend();
  setSpeed(SPEEDS.filter(v => v <= Math.max(1, Math.min(10, (end - begin) / 60))).at(-1));
  const wanted = /[#&]t=([\d.]+)/.exec(location.hash);
  seek(wanted ? +wanted[1] : begin);
}

lilytank.ready = start().catch(problem => {
  $('fault').hidden = false, $('fault').textContent = `The page cannot be shown: ${problem.message}`;
  console.error(problem);
});
