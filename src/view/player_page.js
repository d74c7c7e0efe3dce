// The player, third part: time, controls, curve, list of events.

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
const ROW = matchMedia('(pointer: coarse)').matches ? 38 : 25;  // pixels, of an event
/** What the page shows. `chosen`: a body; `hovered`: {view, body, at}; `spot`: {tank, modules, since} of an event. */
const player = {now: 0, begin: 0, end: 1, speed: 1, playing: false, camera: {zoom: 1, x: 0, y: 0}, chosen: -1, tank: 0,
                hovered: null, spot: null, labels: true, trails: true, flow: true, follow: false};
/** The list of events; latches alone are many, so they are not shown at first. */
const list = {tank: 0, kinds: new Set(['copy', 'link', 'unlink', 'update', 'report', 'command']), rows: [], hold: 0};
let tanks = [], views = [], due = false, before = 0, cost = {frames: 0, ms: 0};

function clockText(t) {
  const s = Math.abs(t).toFixed(1), h = Math.floor(s / 3600), m = Math.floor(s / 60) % 60;
  const hours = h ? `${h}:${String(m).padStart(2, '0')}` : m;
  return `${t < 0 ? '\u2212' : ''}${hours}:${(s % 60).toFixed(1).padStart(4, '0')}`;
}
/** Sets a text only where it changes. */
function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}
function add(parent, tag, text = '') {
  const element = parent.appendChild(document.createElement(tag));
  element.textContent = text;
  return element;
}

// Time ----------------------------------------------------------------

function invalidate() {
  if (due || !views.length) return;
  due = true;
  requestAnimationFrame(tick);
}

function tick(at) {
  due = false;
  if (player.playing) {
    player.now += Math.min(0.1, Math.max(0, at - before) / 1000) * player.speed, before = at;
    if (player.now >= player.end) player.now = player.end, setPlaying(false);
  }
  const start = performance.now(), text = clockText(player.now);
  for (const view of views) view.draw(player.now);
  drawCurve(), showModule(), showTip(), showRows();
  setText($('now'), text), $('scrub').value = player.now;
  if (!player.playing) $('scrub').setAttribute('aria-valuetext', text);
  cost.frames += 1, cost.ms += performance.now() - start;
  if (player.playing) invalidate();
}

function setPlaying(on) {
  if (on && player.now >= player.end) player.now = player.begin;
  player.playing = on, before = performance.now();
  document.body.classList.toggle('playing', on), $('play').setAttribute('aria-label', on ? 'Pause' : 'Play');
  invalidate();
}
function seek(t) { player.now = clamp(t, player.begin, player.end), invalidate(); }
function stepFrames(by) {
  const {time, frames} = tanks[0], count = countUpTo(player.now + 1e-9, frames, f => time[f]) - 1;
  const between = count >= 0 && player.now - time[count] > 1e-9;
  setPlaying(false), seek(time[clamp(by < 0 && between ? count : count + by, 0, frames - 1)]);
}
function setSpeed(value) { player.speed = $('speed').value = value; }
const changeSpeed = by => setSpeed(SPEEDS[clamp(SPEEDS.indexOf(player.speed) + by, 0, SPEEDS.length - 1)]);

// Curve of copies -----------------------------------------------------

function niceStep(span, most) {
  const decade = 10 ** Math.floor(Math.log10(span / most));
  return decade * [1, 2, 5, 10].find(k => k * decade >= 0.999 * span / most);
}

function drawCurve() {
  if ($('yield').hidden) return;
  const {begin, end, now} = player, {clientWidth: w, clientHeight: h} = $('curve'), c = fitted($('curve'), w, h);
  const most = Math.max(1, ...tanks.flatMap(t => [t.possible, ...t.copies.map(([, n]) => n)]));
  const left = 22, right = w - 10, top = 8, bottom = h - 32;
  const x = t => left + (right - left) * (clamp(t, begin, end) - begin) / (end - begin);
  const y = n => bottom - (bottom - top) * n / most;
  const [unit, name] = end - begin > 7200 ? [3600, 'h'] : end - begin > 240 ? [60, 'min'] : [1, 's'];
  c.font = '12px system-ui, sans-serif', c.fillStyle = theme.dim, c.textAlign = 'right', c.textBaseline = 'middle';
  for (let n = 0, step = Math.max(1, niceStep(most, 4)); n <= most; n += step) {
    polyline(c, [[left, y(n)], [right, y(n)]]), stroke(c, theme.line, 1), c.fillText(n, left - 6, y(n));
  }
  c.textAlign = 'center', c.textBaseline = 'top', c.fillText(`time (${name})`, (left + right) / 2, bottom + 18);
  const step = niceStep((end - begin) / unit, 5);
  for (let v = Math.ceil(begin / unit / step) * step; v * unit <= end + 1e-6; v += step) {
    c.fillText(+v.toFixed(6), x(v * unit), bottom + 4);
  }
  head.yields.forEach(({time, mean, low, high}, i) => {
    const colour = theme['curve' + i % 4];
    const line = values => time.map((t, k) => [x(t), y(clamp(values[k] ?? 0, 0, most))]);
    if (!low.includes(null)) {  // of a single run the band is unbounded
      polyline(c, [...line(high), ...line(low).reverse()]), c.globalAlpha = 0.18, fill(c, colour), c.globalAlpha = 1;
    }
    c.setLineDash([5, 4]), polyline(c, line(mean)), stroke(c, colour, 1.4), c.setLineDash([]);
  });
  tanks.forEach((t, i) => {
    const steps = t.copies.flatMap(([at, n], k) => [[x(at), y(k ? t.copies[k - 1][1] : 0)], [x(at), y(n)]]);
    if (t.label) polyline(c, [...steps, [x(t.end), steps.at(-1)[1]]]), stroke(c, theme['curve' + i % 4], 2);
  });
  polyline(c, [[x(now), top - 4], [x(now), bottom]]), stroke(c, theme.ink, 1.2);
}

function setUpCurve() {
  $('yield').hidden = !tanks.some(t => t.possible > 0);
  const addName = (name, i, gaps) => {
    const row = add($('curves'), 'li'), colour = `var(--curve${i % 4})`;
    add(row, 'i').style.background = `repeating-linear-gradient(90deg, ${colour} 0 5px, ${gaps} 5px 9px)`;
    row.append(name);
  };
  if (tanks.length + head.yields.length > 1) tanks.forEach((t, i) => addName(t.name, i, `var(--curve${i % 4})`));
  head.yields.forEach((y, i) => addName(`${y.name}, 95 % band`, i, '#0000'));
  const changes = t => t.copies.slice(1).map(([at, n]) => `${n} from ${clockText(at)}`).join(', ') || 'none';
  const text = tanks.map(t => `${t.name}: ${changes(t)}`).join('. ');
  $('curve').setAttribute('aria-label', `Complete copies over time. ${text}`);
  const scrub = e => {
    const share = (e.offsetX - 22) / ($('curve').clientWidth - 32);
    if (e.buttons & 1) seek(player.begin + (player.end - player.begin) * share);
  };
  $('curve').addEventListener('pointerdown', e => { $('curve').setPointerCapture(e.pointerId), scrub(e); });
  $('curve').addEventListener('pointermove', scrub);
}

// Bodies --------------------------------------------------------------

const titleOf = (t, b) => `${b < t.modules ? 'Module' : 'Ball'} ${t.nameOf(b)}`;
function fillList(box, rows) {
  const key = rows.join('|');
  if (box.dataset.key === key) return;
  box.dataset.key = key, box.replaceChildren();
  for (const [name, value] of rows) add(box, 'dt', name), add(box, 'dd', value);
}
function showModule() {
  const t = tanks[player.tank], known = player.chosen in t.now.x;
  $('module').classList.toggle('known', known);
  const title = known ? titleOf(t, player.chosen) + (tanks.length > 1 ? `, ${t.name}` : '') : 'Module';
  setText($('module-name'), title), fillList($('module-state'), known ? t.describe(player.chosen) : []);
}
function showTip() {
  const tip = $('tip'), {hovered} = player;
  tip.hidden = !hovered;
  if (!hovered) return;
  const {view: {tank}, body, at: [x, y]} = hovered;
  setText($('tip-name'), titleOf(tank, body)), fillList($('tip-state'), tank.describe(body));
  tip.style.left = `${clamp(x + 18, 4, innerWidth - tip.offsetWidth - 4)}px`;
  tip.style.top = `${y + 18 + tip.offsetHeight < innerHeight ? y + 18 : Math.max(4, y - tip.offsetHeight - 14)}px`;
}
function choose(body, tank = player.tank) {
  player.chosen = body, player.tank = tank;
  if (body < 0) setShow('follow', false);
  invalidate();
}
/** Switches labels, trails, flow, or following of the chosen body. */
function setShow(what, on) {
  const {camera} = player;
  if (what === 'follow' && on) player.chosen = Math.max(0, player.chosen);
  if (what === 'follow' && on && camera.zoom < 2) camera.zoom = 3;
  if (what === 'follow' && !on) [camera.x, camera.y] = [views[player.tank].cx, views[player.tank].cy];
  player[what] = on, $(what).setAttribute('aria-pressed', on);
  keepInside();
}

// Events --------------------------------------------------------------

/** Kind and text of an event. */
function eventText(e, i) {
  const kind = e.kinds[e.kind[i]], rule = e.rules[e.rule[i]], pair = `${e.a[i]}\u2013${e.b[i]}`;
  if (kind === 'copy') return [kind, `${e.copies[i]} complete`];
  if (kind === 'command') return [kind, rule];
  if (kind === 'report') return [kind, `module ${e.a[i]}, state ${e.label_a[i]}`];
  if (!rule) return [kind, `${pair}, faces ${e.face_a[i]} and ${e.face_b[i]}`];
  return [kind, `${pair}, ${rule} \u2192 ${e.label_a[i]}, ${e.label_b[i]}`];
}

function filterRows() {
  const e = tanks[list.tank].events;
  list.rows = [...e.kind.keys()].filter(i => list.kinds.has(e.kinds[e.kind[i]])), list.key = '';
  $('all-rows').style.height = `${ROW * list.rows.length}px`;
  invalidate();
}

/** Fills the rows in sight, and moves the list along with the time. */
function showRows() {
  if ($('log').hidden) return;
  const box = $('rows'), e = tanks[list.tank].events, rows = list.rows, buttons = $('all-rows').children;
  const current = countUpTo(player.now + 1e-6, rows.length, k => e.time[rows[k]]) - 1;
  const moved = current !== list.current && performance.now() > list.hold;
  if (moved) box.scrollTop = ROW * (current + 0.5) - box.clientHeight / 2;
  const first = Math.max(0, Math.floor(box.scrollTop / ROW) - 4), key = [current, first, box.clientHeight].join();
  list.current = current;
  if (key === list.key) return;
  list.key = key;
  const count = clamp(Math.ceil(box.clientHeight / ROW) + 8, 0, rows.length - first);
  for (let k = 0; k < Math.max(count, buttons.length); ++k) {
    const button = buttons[k] || add($('all-rows'), 'button');
    button.hidden = k >= count;
    if (k >= count) continue;
    if (!button.firstChild) add(button, 'span'), add(button, 'b'), button.append('');
    const [time, kind, text] = button.childNodes, i = rows[first + k];
    [kind.textContent, text.data] = eventText(e, i), time.textContent = clockText(e.time[i]);
    button.value = i, button.style.top = `${ROW * (first + k)}px`, button.style.height = `${ROW}px`;
    button.setAttribute('aria-current', first + k === current), button.classList.toggle('later', first + k > current);
  }
}

function goToEvent(i) {
  const e = tanks[list.tank].events, modules = [e.a[i], e.b[i]].filter(b => b >= 0);
  list.hold = performance.now() + 400;  // the row stays under the pointer
  player.spot = {tank: list.tank, modules, since: performance.now()};
  setPlaying(false), seek(e.time[i]);
}

function addChip(parent, text, on, act) {
  const button = add(parent, 'button', text);
  button.setAttribute('aria-pressed', on), button.addEventListener('click', () => act(button));
}
/** Shows the events of a tank. */
function chooseLog(tank) {
  const e = tanks[tank].events, counts = e.kinds.map((_, kind) => e.kind.reduce((n, k) => n + (k === kind), 0));
  list.tank = tank, $('kinds').replaceChildren();
  e.kinds.map((name, k) => [name, counts[k]]).reverse().filter(([, n]) => n).forEach(([name, n]) =>
    addChip($('kinds'), `${name} ${n}`, list.kinds.has(name), button => {
      if (!list.kinds.delete(name)) list.kinds.add(name);
      button.setAttribute('aria-pressed', list.kinds.has(name)), filterRows();
    }));
  filterRows();
}

function setUpEvents() {
  const logs = [...tanks.keys()].filter(i => tanks[i].events.count);
  $('log').hidden = !logs.length;
  if (!logs.length) return;
  if (logs.length > 1) logs.forEach(i => addChip($('tank-choice'), tanks[i].name, i === logs[0], button => {
    for (const other of $('tank-choice').children) other.setAttribute('aria-pressed', other === button);
    chooseLog(i);
  }));
  const rows = $('rows'), hold = () => { list.hold = performance.now() + 3000; };
  rows.addEventListener('click', e => {
    const row = e.target.closest('button');
    if (row) goToEvent(+row.value);
  });
  rows.addEventListener('scroll', invalidate);
  for (const kind of ['wheel', 'pointerdown', 'touchmove']) rows.addEventListener(kind, hold, {passive: true});
  for (const [t] of tanks[logs[0]].copies.slice(1)) {
    add($('marks'), 'i').style.left = `${100 * (t - player.begin) / (player.end - player.begin)}%`;
  }
  chooseLog(logs[0]);
}

// Pointer and keys ----------------------------------------------------

function keepInside() {
  const {camera} = player, most = tanks[0].radius * (1 - 1 / camera.zoom), far = Math.hypot(camera.x, camera.y);
  if (far > most) camera.x *= most / far, camera.y *= most / far;
  for (const {canvas} of views) canvas.style.touchAction = camera.zoom > 1 ? 'none' : 'pan-y';
  invalidate();
}
/** Zooms by a factor; the point at (px, py) of a view stays where it is. */
function zoom(factor, view = views[0], px = view.width / 2, py = view.height / 2) {
  const {camera} = player, [x, y] = view.metres(px, py);
  camera.zoom = clamp(camera.zoom * factor, 1, 60), view.aim();
  const [u, v] = view.metres(px, py);
  if (!player.follow) camera.x += x - u, camera.y += y - v;
  keepInside();
}
function fitAll() { setShow('follow', false), Object.assign(player.camera, {zoom: 1, x: 0, y: 0}), keepInside(); }

function watchPointers(view) {
  const {canvas, figure} = view, fingers = new Map(), {camera} = player;
  let travelled = 0;
  const hover = (e, body) => {
    player.hovered = body < 0 ? null : {view, body, at: [e.clientX, e.clientY]};
    figure.classList.toggle('over', body >= 0), invalidate();
  };
  const drag = (from, to) => {
    if (player.follow) setShow('follow', false);
    figure.classList.add('moving'), player.hovered = null;
    camera.x -= (to[0] - from[0]) / view.scale, camera.y += (to[1] - from[1]) / view.scale, keepInside();
  };
  const pinch = (from, to, other) => {
    const span = p => Math.max(10, Math.hypot(p[0] - other[0], p[1] - other[1]));
    zoom(span(to) / span(from), view, (to[0] + other[0]) / 2, (to[1] + other[1]) / 2);
  };
  const lift = e => { fingers.delete(e.pointerId), figure.classList.remove('moving'); };
  canvas.addEventListener('pointerdown', e => {
    canvas.setPointerCapture(e.pointerId), fingers.set(e.pointerId, [e.offsetX, e.offsetY]);
    if (fingers.size === 1) travelled = 0;
  });
  canvas.addEventListener('pointermove', e => {
    const from = fingers.get(e.pointerId), to = [e.offsetX, e.offsetY];
    if (!from) return hover(e, e.pointerType === 'touch' ? -1 : view.bodyAt(...to));
    travelled += Math.hypot(to[0] - from[0], to[1] - from[1]);
    if (fingers.size === 2) pinch(from, to, [...fingers].find(([id]) => id !== e.pointerId)[1]);
    else if (travelled > 5 && camera.zoom > 1) drag(from, to);
    fingers.set(e.pointerId, to);
  });
  canvas.addEventListener('pointerup', e => {
    if (fingers.size === 1 && travelled < 6) choose(view.bodyAt(e.offsetX, e.offsetY), view.index);
    lift(e);
  });
  canvas.addEventListener('pointercancel', lift), canvas.addEventListener('pointerleave', e => hover(e, -1));
  canvas.addEventListener('dblclick', e => zoom(2, view, e.offsetX, e.offsetY));
  canvas.addEventListener('wheel', e => {
    if (e.deltaY > 0 && camera.zoom === 1) return;  // the page scrolls
    e.preventDefault(), zoom(Math.exp(-clamp(e.deltaY, -80, 80) / 260), view, e.offsetX, e.offsetY);
  }, {passive: false});
}

const jumpOr = by => e => e.shiftKey ? seek(player.now + 10 * by) : stepFrames(by);
const keys = {
  ' ': () => setPlaying(!player.playing), ArrowLeft: jumpOr(-1), ArrowRight: jumpOr(1), ArrowUp: () => changeSpeed(1),
  ArrowDown: () => changeSpeed(-1), Home: () => seek(player.begin), End: () => seek(player.end), '+': () => zoom(1.4),
  '=': () => zoom(1.4), '-': () => zoom(1 / 1.4), 0: fitAll, f: () => setShow('follow', !player.follow),
  n: () => choose((player.chosen + 1) % tanks[player.tank].bodies), Escape: () => choose(-1),
  '?': () => $('about').showModal(),
};
function watchKeys(e) {
  const on = e.target, presses = /^( |Enter)$/.test(e.key) && on.tagName === 'BUTTON';
  const scrolls = on.closest('#rows') && /^(Arrow|Home|End)/.test(e.key), typing = on.closest('select, dialog');
  if (typing || presses || scrolls || e.ctrlKey || e.metaKey || e.altKey || !keys[e.key]) return;
  e.preventDefault(), keys[e.key](e);
}

// Start ---------------------------------------------------------------

function setUpControls() {
  const press = (id, act) => $(id).addEventListener('click', e => {
    act(e);
    if (e.detail) $(id).blur();  // after a click of the mouse, space still plays
  });
  press('play', keys[' ']), press('back', () => stepFrames(-1)), press('next', () => stepFrames(1));
  press('in', keys['+']), press('out', keys['-']), press('fit', fitAll), press('help', keys['?']);
  for (const what of ['labels', 'trails', 'flow', 'follow']) press(what, () => setShow(what, !player[what]));
  for (const v of SPEEDS) $('speed').add(new Option(`${v}\u00d7`, v));
  $('speed').addEventListener('change', () => { setSpeed(+$('speed').value), $('speed').blur(); });
  Object.assign($('scrub'), {min: player.begin, max: player.end});
  $('scrub').addEventListener('input', () => seek(+$('scrub').value));
  $('flow').hidden = !tanks.some(t => t.flows.length);
  addEventListener('keydown', watchKeys);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { readTheme(), invalidate(); });
}

function setUpTexts() {
  const mm = 1000 * head.position_step, degrees = head.heading_step * 360 / TURN;
  const thinned = head.tanks.filter(t => t.stored > t.frames + 1);
  setText($('title'), head.title), setText($('subtitle'), head.subtitle), setText($('total'), clockText(player.end));
  setText($('command'), `${head.command} (lilytank ${head.version})`);
  setText($('exact'), `Positions are rounded to ${mm} mm and headings to ${degrees.toFixed(1)}\u00b0: errors of at ` +
    `most ${mm / 2} mm and ${(degrees / 2).toFixed(2)}\u00b0. Between stored frames, positions move on straight ` +
    'lines, headings on the shorter arc, and modules that hold each other as one body. States change with events. ' +
    thinned.map(t => `${t.name || head.title}: ${t.frames} of ${t.stored} stored frames.`).join(' '));
}

async function start() {
  if (!window.DecompressionStream) throw new Error('it needs a browser of 2023 or later (DecompressionStream)');
  const bytes = await unpacked();
  tanks = head.tanks.map(t => new Tank(t, bytes));
  player.begin = player.now = Math.min(...tanks.map(t => t.begin));
  player.end = Math.max(player.begin + 1e-3, ...tanks.map(t => t.end));
  readTheme(), setUpTexts(), setUpControls(), setUpCurve(), setUpEvents();
  document.body.classList.toggle('plain', $('yield').hidden && $('log').hidden);
  $('tanks').classList.toggle('four', tanks.length === 4);
  views = tanks.map((t, i) => new View(t, i)), views.forEach(watchPointers), keepInside();
  setSpeed(SPEEDS.findLast(v => v <= clamp((player.end - player.begin) / 60, 1, 10)));
  seek(+(/t=([\d.]+)/.exec(location.hash) || [0, player.begin])[1]);
}

/** For scripts and tests. */
window.lilytank = {
  seek, play: () => setPlaying(true), get time() { return player.now; }, get tanks() { return tanks; },
  get millisecondsPerFrame() { return cost.ms / cost.frames; },
  /** The pose and state of a body that the page shows at a time. */
  poseAt(t, body, tank = 0) {
    const {now} = tanks[tank];
    tanks[tank].moveTo(t);
    const pose = {x: now.x[body], y: now.y[body], theta: now.theta[body], ...tanks[tank].markings(body)};
    tanks[tank].moveTo(player.now);
    return pose;
  },
  ready: start().catch(problem => {
    $('fault').hidden = false, setText($('fault'), `The page cannot be shown: ${problem.message}`);
    console.error(problem);
  }),
};
