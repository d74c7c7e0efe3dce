// The player, second part: colours, and drawing of a tank on its canvas.

// Nine hues near P. Tol's "muted" scheme, as in films (render/palette.cpp); they begin again lighter, then darker.
const STATES = ['#39C77B', '#EBD95C', '#B8708D', '#332288', '#9EB1FF', '#9E59A6', '#96932D', '#035312', '#7F0953'];
const PAPER = [255, 255, 255], INK = [31, 41, 51], TRAIL_POINTS = 24, TRAIL_TONES = 6;
const parts = hex => [1, 3, 5].map(i => parseInt(hex.slice(i, i + 2), 16));
const mix = (a, b, w) => a.map((v, i) => v + (b[i] - v) * w);
const css = ([r, g, b], alpha = 1) => `rgba(${r | 0},${g | 0},${b | 0},${alpha})`;
const theme = {}, looks = new Map();

/** Reads the colours of player.css, which follow the light or dark setting of the system. */
function readTheme() {
  const style = getComputedStyle(document.documentElement);
  for (const name of ['ink', 'dim', 'paper', 'line', 'accent', 'water', 'edge', 'stream', 'rim', 'rim-line', 'isolated',
                      'halo', 'ball', 'curve0', 'curve1', 'curve2', 'curve3']) {
    theme[name] = style.getPropertyValue('--' + name).trim();
  }
  looks.clear();
}

/** Colours of a module in a control state. */
function lookOf(label, complete) {
  const key = 2 * label + complete;
  if (!looks.has(key)) looks.set(key, newLook(label, complete));
  return looks.get(key);
}
function newLook(label, complete) {
  let fill = label > 0 ? parts(STATES[(label - 1) % 9]) : parts(theme.isolated);
  const round = Math.floor((label - 1) / 9) % 3;
  if (round > 0) fill = round === 1 ? mix(fill, PAPER, 0.42) : mix(fill, INK, 0.38);
  if (label > 0 && !complete) fill = mix(fill, PAPER, 0.28);
  // Relative luminance as in WCAG 2; at 0.24 ink and white have about equal contrast.
  const linear = fill.map(v => v <= 10.3 ? v / 3294.6 : ((v / 255 + 0.055) / 1.055) ** 2.4);
  const text = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2] > 0.24 ? INK : PAPER;
  const trail = label > 0 ? mix(fill, parts(theme.edge), 0.1) : mix(fill, parts(theme.dim), 0.6);
  return {fill: css(fill), line: css(mix(fill, INK, 0.55)), text: css(text), mark: css(text, 0.55),
          bar: text === INK ? '#005a9c' : '#fff', trails: Array.from({length: TRAIL_TONES},
            (_, k) => css(trail, 0.7 * ((k + 0.7) / TRAIL_TONES) ** 1.4))};
}
/** Colours by the control state; of recordings, which have none, by the body. */
function lookAt(tank, b) {
  const m = tank.markings(b);
  return m ? lookOf(m.label, m.complete) : lookOf(b < tank.modules ? b % 9 + 1 : 0, 0);
}

function stroke(c, colour, width, path) {
  c.strokeStyle = colour, c.lineWidth = width;
  if (path) c.stroke(path); else c.stroke();
}
function fill(c, colour, path) {
  c.fillStyle = colour;
  if (path) c.fill(path); else c.fill();
}
function polyline(c, points) {
  c.beginPath();
  for (const [x, y] of points) c.lineTo(x, y);
}
/** A canvas that covers its element, with a context in CSS pixels. */
function fitted(canvas, width, height) {
  const density = Math.min(3, devicePixelRatio || 1), w = Math.round(width * density), h = Math.round(height * density);
  if (canvas.width !== w || canvas.height !== h) canvas.width = w, canvas.height = h;
  const c = canvas.getContext('2d');
  c.setTransform(density, 0, 0, density, 0, 0), c.clearRect(0, 0, width, height);
  return c;
}

/** A module in its own frame: one unit a side, y up. */
const SQUARE = new Path2D();
SQUARE.roundRect(-0.5, -0.5, 1, 1, 0.14);

/** Draws the face in the direction +x; `pixel` is the width of a pixel. */
function drawFace(c, look, how, pixel) {
  c.beginPath();
  if (how === 'bonded') {  // half of a bridge; the neighbour draws the other half
    c.rect(0.37, -0.15, 0.14, 0.3), fill(c, css(INK));
  } else if (how === 'latched') {  // half of an open ring
    c.arc(0.5, 0, 0.115, TURN / 4, 3 * TURN / 4), fill(c, '#fff'), stroke(c, css(INK), 1.3 * pixel);
  } else if (how === 'free') {  // a notch
    c.arc(0.5 - pixel, 0, 0.06, TURN / 4, 3 * TURN / 4), fill(c, look.mark);
  } else {  // latches are off
    c.moveTo(0.445, -0.1), c.lineTo(0.445, 0.1), stroke(c, look.mark, 1.2 * pixel);
  }
}

/** Draws a module in its own frame; `size`: its side in pixels. Without `faces`, a mark shows the heading. */
function drawModule(c, look, faces, size) {
  fill(c, look.fill, SQUARE), stroke(c, look.line, 1.4 / size, SQUARE);
  if (size < 9) return;
  if (!faces) return polyline(c, [[0.44, 0], [0.27, 0.12], [0.27, -0.12]]), fill(c, look.mark);
  for (let face = 0; face < 4; ++face) {
    const bit = mask => mask >> face & 1, bar = Math.max(0.062, 1.5 / size), free = faces.off ? 'off' : 'free';
    if (faces.last === face) polyline(c, [[0.415, -0.29], [0.415, 0.29]]), stroke(c, look.bar, bar);
    drawFace(c, look, bit(faces.bonded) ? 'bonded' : bit(faces.latched) ? 'latched' : free, 1 / size);
    c.rotate(TURN / 4);
  }
}

class View {
  constructor(tank, index) {
    this.tank = tank, this.index = index;
    this.figure = add($('tanks'), 'figure');
    const caption = add(this.figure, 'figcaption');
    add(caption, 'b', head.tanks.length > 1 ? tank.name : ''), add(caption, 'span', tank.note);
    caption.title = tank.note, this.state = add(caption, 'i'), this.canvas = add(this.figure, 'canvas');
    this.canvas.setAttribute('role', 'img'), this.canvas.tabIndex = 0;
    this.ground = document.createElement('canvas'), this.groundKey = '';
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    this.resize();
  }
  resize() {
    this.width = Math.max(1, this.canvas.clientWidth), this.height = Math.max(1, this.canvas.clientHeight);
    this.draw(player.now), drawCurve();  // at once, as a canvas of another size is empty
  }

  /** Sets pixels per metre, and the point in the middle. */
  aim() {
    const t = this.tank, {zoom, x, y} = player.camera, follows = player.follow && player.chosen in t.now.x;
    this.scale = zoom * Math.min(this.width, this.height) / (2.12 * t.radius);
    this.cx = follows ? t.now.x[player.chosen] : x, this.cy = follows ? t.now.y[player.chosen] : y;
  }
  px(x) { return this.width / 2 + (x - this.cx) * this.scale; }
  py(y) { return this.height / 2 - (y - this.cy) * this.scale; }
  metres(px, py) {
    return [this.cx + (px - this.width / 2) / this.scale, this.cy - (py - this.height / 2) / this.scale];
  }
  radiusOf(b) { return b < this.tank.modules ? 0.62 * this.tank.side : this.tank.ball; }
  bodyAt(px, py) {
    const {now, bodies} = this.tank, [x, y] = this.metres(px, py), far = b => Math.hypot(now.x[b] - x, now.y[b] - y);
    const near = [...Array(bodies).keys()].filter(b => now.shown[b] && far(b) < this.radiusOf(b) + 6 / this.scale);
    return near.length ? near.reduce((a, b) => far(b) < far(a) ? b : a) : -1;
  }

  draw(time) {
    this.tank.moveTo(time), this.aim();
    this.drawGround(player.flow ? this.tank.flowAt(time) : -1);
    const c = this.context = fitted(this.canvas, this.width, this.height);
    c.drawImage(this.ground, 0, 0, this.width, this.height);
    if (player.trails) this.drawTrails(c);
    this.drawBodies(c), this.drawRings(c), this.drawScaleBar(c), this.describe(time);
  }

  /** Water, streamlines and rim: drawn again only when the camera, the flow or the theme changes. */
  drawGround(flow) {
    const key = [this.width, this.height, this.scale, this.cx, this.cy, flow, theme.paper].join();
    if (key === this.groundKey) return;
    this.groundKey = key;
    const c = fitted(this.ground, this.width, this.height);
    const r = this.tank.radius * this.scale, x = this.px(0), y = this.py(0);
    const circle = radius => { c.beginPath(), c.arc(x, y, radius, 0, TURN); };
    const water = c.createRadialGradient(x, y, 0.15 * r, x, y, r);
    water.addColorStop(0, theme.water), water.addColorStop(1, theme.edge);
    circle(r), fill(c, water);
    if (this.tank.flows[flow]) this.drawFlow(c, this.tank.flows[flow]);
    const rim = 0.018 * r / player.camera.zoom + 2;
    circle(r + rim / 2), stroke(c, theme.rim, rim), circle(r), stroke(c, theme['rim-line'], 1.2);
    circle(r + rim), stroke(c, theme['rim-line'], 1);
  }

  drawFlow(c, flow) {
    const at = i => [this.px(flow.x[i] * head.position_step), this.py(flow.y[i] * head.position_step)];
    let first = 0;
    for (const length of flow.lengths) {
      const last = first + length - 1, tone = i => flow.tone[i] >> 4;
      for (let i = first; i < last;) {  // pieces of about equal speed
        const from = i, points = [at(i)];
        for (; i < last && tone(i) === tone(from); ++i) points.push(at(i + 1));
        c.globalAlpha = 0.16 + 0.5 * tone(from) / 16;
        polyline(c, points), stroke(c, theme.stream, 0.8 + 1.3 * tone(from) / 16);
      }
      const m = first + (length >> 1), speed = flow.tone[m] / 255, size = 4 + 4 * speed;
      if (length > 6) {
        const [x, y] = at(m), [u, v] = at(m + 1);
        c.save(), c.translate(x, y), c.rotate(Math.atan2(v - y, u - x)), c.globalAlpha = 0.3 + 0.5 * speed;
        polyline(c, [[size, 0], [-0.7 * size, 0.65 * size], [-0.7 * size, -0.65 * size]]);
        fill(c, theme.stream), c.restore();
      }
      first += length;
    }
    c.globalAlpha = 1;
  }

  drawTrails(c) {
    const t = this.tank, middle = (p, q) => [(p[0] + q[0]) / 2, (p[1] + q[1]) / 2];
    for (let b = 0; b < t.bodies; ++b) {
      if (!t.now.shown[b]) continue;
      const points = t.trail(b, TRAIL_POINTS).map(p => p && [this.px(p[0]), this.py(p[1])]), last = points.length - 2;
      const toneOf = k => Math.floor(TRAIL_TONES * k / (last + 1));
      for (let k = 1; k <= last;) {
        const tone = toneOf(k);
        c.beginPath();
        for (; k <= last && toneOf(k) === tone; ++k) {  // rounded at the points
          const [p, q, r] = points.slice(k - 1, k + 2);
          if (!p || !q || !r) continue;
          c.moveTo(...k === 1 ? p : middle(p, q)), c.quadraticCurveTo(...q, ...k === last ? r : middle(q, r));
        }
        stroke(c, lookAt(t, b).trails[tone], 1 + 1.8 * tone / TRAIL_TONES);
      }
    }
  }

  /** Calls act(body, size in pixels) in the frame of each body in sight. */
  each(c, first, last, act) {
    const {now, modules, side, ball} = this.tank;
    for (let b = first; b < last; ++b) {
      const x = this.px(now.x[b]), y = this.py(now.y[b]), size = this.scale * (b < modules ? side : 2 * ball);
      const out = x < -size || y < -size || x > this.width + size || y > this.height + size;
      if (!now.shown[b] || out) continue;
      c.save(), c.translate(x, y);
      if (b < modules) c.rotate(-now.theta[b]), c.scale(size, -size);
      act(b, size), c.restore();
    }
  }

  drawBodies(c) {
    const t = this.tank, size = this.scale * t.side;
    c.lineJoin = c.lineCap = 'round';
    this.each(c, t.modules, t.bodies, (b, d) => {
      c.beginPath(), c.arc(0, 0, d / 2, 0, TURN), fill(c, theme.ball), stroke(c, '#787166', 1.4);
    });
    this.each(c, 0, t.modules, b => {
      if (!(t.facesOf(b) >> 8)) return;
      c.globalAlpha = 0.3, stroke(c, theme.halo, 0.42, SQUARE), c.globalAlpha = 1, stroke(c, theme.halo, 0.2, SQUARE);
    });
    this.each(c, 0, t.modules, b => {
      const m = t.markings(b), {latched, bonded} = t.now;
      const faces = m && {latched: latched[b], bonded: bonded[b], last: player.labels ? m.last : -1, off: !t.latches};
      drawModule(c, lookAt(t, b), faces, size);
    });
    if (!player.labels || size < 13) return;
    c.textAlign = 'center', c.textBaseline = 'middle';
    this.each(c, 0, t.bodies, (b, d) => {
      const m = t.markings(b), text = m ? String(m.label) : t.nameOf(b);
      if (b < t.modules) c.scale(1 / d, -1 / d), c.rotate(t.now.theta[b]);  // upright
      c.font = `bold ${Math.round(d * (text.length < 3 ? 0.42 : 0.32))}px system-ui, sans-serif`;
      c.fillStyle = b < t.modules ? lookAt(t, b).text : css(INK), c.fillText(text, 0, 0.03 * d);
    });
  }

  /** Rings around the chosen body, the one under the pointer, and those of an event that was clicked. */
  drawRings(c) {
    const {now} = this.tank, {chosen, hovered, spot} = player;
    const ring = (b, colour, width, grow) => {
      if (!now.shown[b]) return;
      c.beginPath(), c.arc(this.px(now.x[b]), this.py(now.y[b]), 1.3 * this.radiusOf(b) * this.scale + grow, 0, TURN);
      stroke(c, colour, width);
    };
    ring(chosen, theme.accent, 2.5, 0);
    if (hovered && hovered.view === this) ring(hovered.body, theme.ink, 1.5, 0);
    const age = spot && spot.tank === this.index ? (performance.now() - spot.since) / 1600 : 1;
    if (age >= 1) return;
    c.globalAlpha = 1 - age, spot.modules.forEach(b => ring(b, theme.accent, 4, 26 * age)), c.globalAlpha = 1;
    invalidate();
  }

  drawScaleBar(c) {
    const wanted = this.width / 5 / this.scale, decade = 10 ** Math.floor(Math.log10(wanted));
    const length = decade * [5, 2, 1].find(k => k * decade <= wanted);
    const [unit, size] = length < 0.01 ? ['mm', 1e-3] : ['cm', 0.01];
    const x = 12, y = this.height - 12, end = x + length * this.scale;
    polyline(c, [[x, y - 5], [x, y], [end, y], [end, y - 5]]), stroke(c, theme.ink, 2);
    c.font = '13px system-ui, sans-serif', c.textAlign = 'center', c.textBaseline = 'bottom', c.fillStyle = theme.ink;
    c.fillText(`${+(length / size).toPrecision(3)} ${unit}`, (x + end) / 2, y - 4);
  }

  /** The line below the caption, and the canvas' text for screen readers. */
  describe(time) {
    const t = this.tank, power = t.flows.length ? t.flows[t.flowAt(time)].power : '', texts = [];
    if (t.possible > 0) texts.push(`${t.copiesAt(time)} of ${t.possible} copies`);
    if (power) texts.push(`pumps at ${power}`);
    if (time > t.end + 1e-9) texts.push('ended');
    const text = texts.join(', ');
    setText(this.state, text);
    if (player.playing) return;
    const bodies = `${t.modules} modules, ${t.bodies - t.modules} balls`;
    this.canvas.setAttribute('aria-label', `Tank ${t.name} at ${clockText(time)}: ${bodies}. ${text}`);
  }
}
