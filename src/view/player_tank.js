'use strict';
// The player of `lilytank view`, first part: the packed numbers, and a tank at any time.
// Lengths are in m with y up, headings in rad, times in s.

const $ = id => document.getElementById(id);
const head = JSON.parse($('head').textContent);
const TURN = 2 * Math.PI, TRAIL = 4;  // s
const clamp = (v, low, high) => Math.min(high, Math.max(low, v));
/** The turn from one heading to another on the shorter arc. */
const shortTurn = (from, to) => to - from - TURN * Math.round((to - from) / TURN);

async function unpacked() {
  const text = atob($('data').textContent), raw = Uint8Array.from(text, c => c.charCodeAt(0));
  const stream = new Blob([raw]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Reads a column (src/view/pack.hpp): planes of bytes, zigzag code, differences within each series. */
function column(bytes, {at, count, length, order, planes}) {
  const out = new Int32Array(count);
  for (let p = 0; p < planes; ++p)
    for (let i = 0, from = at + p * count; i < count; ++i) out[i] |= bytes[from + i] << 8 * p;
  for (let i = 0; i < count; ++i) out[i] = out[i] >>> 1 ^ -(out[i] & 1);
  for (let k = 0; k < order; ++k)
    for (let i = 1; i < count; ++i) if (i % length) out[i] += out[i - 1];
  return out;
}

/** How many of `count` ascending values, value(0), value(1), ..., are at most v. */
function countUpTo(v, count, value) {
  let low = 0, high = count;
  while (low < high) {
    const middle = low + high >> 1;
    if (value(middle) <= v) low = middle + 1; else high = middle;
  }
  return low;
}

class Tank {
  constructor(h, bytes) {
    const {name, note, radius, side, ball, bodies, modules, frames, latches, possible, ids} = h;
    Object.assign(this, {name, note, radius, side, ball, bodies, modules, frames, latches, possible, ids});
    const read = c => c && column(bytes, c), times = c => Float64Array.from(read(c), t => t / h.ticks);
    this.time = times(h.time), this.begin = this.time[0], this.end = this.time[frames - 1];
    for (const c of ['x', 'y', 'theta', 'seen', 'label', 'last', 'faces']) this[c] = read(h[c]);
    this.flows = h.flows.map(({power, lengths, x, y, tone}) =>
      ({power, lengths: read(lengths), x: read(x), y: read(y), tone: read(tone)}));
    this.flowChanges = h.flow_changes;
    this.events = {count: 0, kinds: [], rules: []};
    this.copies = [[this.begin, 0]];  // time and number from then on
    if (h.events) this.readEvents(h.events, read, times);
    this.now = {time: 0, frame: -1, state: new Int32Array(bodies)};
    this.groups = {frame: -1, of: [], held: new Uint8Array(bodies)};
    for (const numbers of ['x', 'y', 'theta']) this.now[numbers] = new Float64Array(bodies);
    for (const bits of ['shown', 'latched', 'bonded']) this.now[bits] = new Uint8Array(bodies);
  }

  readEvents(h, read, times) {
    const e = this.events = {kinds: h.kinds, rules: h.rules, count: h.time.count, time: times(h.time)};
    for (const c of ['kind', 'a', 'b', 'face_a', 'face_b', 'label_a', 'label_b', 'copies', 'rule']) e[c] = read(h[c]);
    e.copies.forEach((copies, i) => { if (copies >= 0) this.copies.push([e.time[i], copies]); });
  }

  nameOf(b) { return this.ids.length ? this.ids[b] : String(b); }
  frameAt(t) { return Math.max(0, countUpTo(t, this.frames, f => this.time[f]) - 1); }
  copiesAt(t) { return this.copies[Math.max(0, countUpTo(t, this.copies.length, i => this.copies[i][0]) - 1)][1]; }
  flowAt(t) { return (this.flowChanges.findLast(([since]) => since <= t) || [0, 0])[1]; }
  place(b, frame) {
    const i = b * this.frames + frame;
    return {x: this.x[i] * head.position_step, y: this.y[i] * head.position_step,
            theta: this.theta ? this.theta[i] * head.heading_step : 0, seen: !this.seen || this.seen[i] > 0};
  }
  /** Bits 0-3: latched faces; 4-7: bonded faces; 8: in a complete copy. */
  facesOf(b, frame = this.now.state[b]) {
    return this.faces && b < this.modules ? this.faces[b * this.frames + frame] : 0;
  }
  /** The state of a module; null where none is stored. */
  markings(b) {
    const i = b * this.frames + this.now.state[b];
    if (!this.label || b >= this.modules) return null;
    return {label: this.label[i], last: this.last[i], complete: this.faces[i] >> 8 & 1};
  }

  /** Sets `now`. Modules that hold each other in both frames around the time move as one rigid body. */
  moveTo(time) {
    const t = clamp(time, this.begin, this.end), now = this.now;
    const frame = this.frameAt(t), next = Math.min(frame + 1, this.frames - 1);
    const span = this.time[next] - this.time[frame], w = span > 0 ? (t - this.time[frame]) / span : 0;
    now.time = t, now.frame = frame;
    this.setStates(t, frame, next);
    for (let b = 0; b < this.bodies; ++b) {
      const p = this.place(b, frame), q = w > 0 ? this.place(b, next) : p, faces = this.facesOf(b);
      const both = p.seen && q.seen, from = both || w < 0.5 ? p : q, v = both ? w : 0;
      now.shown[b] = from.seen;
      now.x[b] = from.x + v * (q.x - from.x), now.y[b] = from.y + v * (q.y - from.y);
      now.theta[b] = from.theta + v * shortTurn(from.theta, q.theta);
      now.latched[b] = faces & 15, now.bonded[b] = faces >> 4 & 15;
    }
    if (w > 0 && this.faces) this.moveGroups(frame, next, w);
  }

  /** Sets the frame that holds the state of each module: the next one as soon as an event has changed it. */
  setStates(t, frame, next) {
    const {count, time, kinds, kind, a, b} = this.events, state = this.now.state.fill(frame);
    const upTo = at => countUpTo(at + 1e-9, count, i => time[i]);
    for (let i = upTo(this.time[frame]), end = upTo(t); i < end; ++i) {
      if (kinds[kind[i]] === 'copy') state.fill(next);
      else for (const module of [a[i], b[i]]) if (module >= 0) state[module] = next;
    }
  }

  moveGroups(frame, next, w) {
    if (this.groups.frame !== frame) this.findGroups(frame, next);
    const {of, held} = this.groups, now = this.now;
    for (let root = 0; root < this.modules; ++root) {
      if (now.state[root] === frame) now.latched[root] &= held[root], now.bonded[root] &= held[root];
      const members = of[root] === root ? [...of.keys()].filter(b => of[b] === root) : [];
      if (members.length < 2) continue;
      const mean = (f, axis) => members.reduce((sum, b) => sum + this.place(b, f)[axis], 0) / members.length;
      const x = mean(frame, 'x'), y = mean(frame, 'y'), dx = w * (mean(next, 'x') - x), dy = w * (mean(next, 'y') - y);
      const turn = w * shortTurn(this.place(root, frame).theta, this.place(root, next).theta);
      const c = Math.cos(turn), s = Math.sin(turn);
      for (const b of members) {
        const p = this.place(b, frame), u = p.x - x, v = p.y - y;
        now.x[b] = x + dx + c * u - s * v, now.y[b] = y + dy + s * u + c * v, now.theta[b] = p.theta + turn;
      }
    }
  }

  /** The face of module i that holds module j in a frame and in the next one; -1: none. */
  heldFace(i, j, frame, next = frame) {
    const from = f => {  // place of j seen from i
      const p = this.place(i, f), q = this.place(j, f), c = Math.cos(p.theta), s = Math.sin(p.theta);
      return [c * (q.x - p.x) + s * (q.y - p.y), c * (q.y - p.y) - s * (q.x - p.x)];
    };
    const [x, y] = from(frame), face = Math.round(Math.atan2(y, x) / (TURN / 4)) & 3;
    if (Math.abs(Math.hypot(x, y) - this.side) > 0.1 * this.side || !(this.facesOf(i, frame) >> face & 1)) return -1;
    const [u, v] = next === frame ? [x, y] : from(next);
    return Math.hypot(x - u, y - v) < 0.05 * this.side ? face : -1;
  }
  findGroups(frame, next) {
    const of = Array.from({length: this.modules}, (_, b) => b), held = this.groups.held.fill(0);
    const latched = of.filter(b => this.facesOf(b, frame) & 15);
    for (const i of latched) for (const j of latched) {
      const face = i < j ? this.heldFace(i, j, frame, next) : -1;
      const other = face < 0 ? -1 : this.heldFace(j, i, frame, next);
      if (other < 0) continue;
      held[i] |= 1 << face, held[j] |= 1 << other;
      const keep = Math.min(of[i], of[j]), drop = Math.max(of[i], of[j]);
      of.forEach((root, b) => { if (root === drop) of[b] = keep; });
    }
    Object.assign(this.groups, {frame, of});
  }

  /** [face, neighbour] of every face of a module that holds one in the present frame. */
  neighbours(b) {
    const faces = [...Array(this.modules).keys()].map(j => [j === b ? -1 : this.heldFace(b, j, this.now.state[b]), j]);
    return faces.filter(([face]) => face >= 0).sort();
  }
  /** Names and values of all that is known of a body now. */
  describe(b) {
    const now = this.now, m = this.markings(b), rows = [], cm = v => (100 * v).toFixed(1).replace('-', '\u2212');
    if (m) {
      rows.push(['state', m.label ? m.label + (m.complete ? ', in a complete copy' : '') : '0, isolated']);
      if (m.last >= 0) rows.push(['engaged last', `connector ${m.last}`]);
      const bonded = face => this.facesOf(b) >> 4 + face & 1;
      const faces = this.neighbours(b).map(([f, j]) => `${f} ${bonded(f) ? 'bonded' : 'latched'} to ${this.nameOf(j)}`);
      rows.push(['faces', faces.join(', ') || 'all free']);
      const members = new Set([b]);
      for (const i of members) {
        for (const [face, j] of this.neighbours(i)) if (this.facesOf(i) >> 4 + face & 1) members.add(j);
      }
      if (members.size > 1) rows.push(['assembly', `${members.size} modules`]);
    }
    if (!now.shown[b]) return [...rows, ['position', 'not seen']];
    rows.push(['position', `${cm(now.x[b])}, ${cm(now.y[b])} cm`]);
    const degrees = Math.round((now.theta[b] / TURN % 1 + 1) % 1 * 360);
    if (this.theta && b < this.modules) rows.push(['heading', `${degrees}\u00b0`]);
    const f = Math.min(now.frame, this.frames - 2);
    if (f < 0) return rows;
    const p = this.place(b, f), q = this.place(b, f + 1), way = Math.hypot(q.x - p.x, q.y - p.y);
    if (p.seen && q.seen) rows.push(['speed', `${cm(way / (this.time[f + 1] - this.time[f]))} cm/s`]);
    return rows;
  }
  /** Points of a body's way in the last seconds, the present one last; null where it was not seen. */
  trail(b, most) {
    const {time, frame, x, y} = this.now, begin = Math.max(this.begin, time - TRAIL), first = this.frameAt(begin) + 1;
    const points = [];
    const add = (t, f) => {  // f: the frame at or before t
      const g = Math.min(f + 1, this.frames - 1), p = this.place(b, f), q = this.place(b, g);
      const w = g > f ? (t - this.time[f]) / (this.time[g] - this.time[f]) : 0;
      points.push(p.seen && q.seen ? [p.x + w * (q.x - p.x), p.y + w * (q.y - p.y)] : null);
    };
    add(begin, first - 1);
    for (let f = first; f <= frame; f += Math.ceil((frame - first + 1) / most)) add(this.time[f], f);
    return [...points, [x[b], y[b]]];
  }
}
