// What makes a served page follow its controls: requests an answer, draws it, moves loads that are dragged.
const live = document.getElementById('live'), by = id => document.getElementById(id);
const query = new URLSearchParams(location.search), token = query.get('token') || '';
const name = Math.random().toString(36).slice(2);
const changed = new Map(), swapped = new Map();
let followed = null, controls = false;

// Controls: a slider and a field for each key, a list for each table with a law or a solver, a switch for each load that moves.
// `first` has the values and tags of the study file.
const inputs = new Map(), first = new Map(), tags = new Map();
function register() {
  inputs.clear();
  for (const input of live.querySelectorAll('[data-key]')) {
    const own = inputs.get(input.dataset.key) || {};
    own[input.type === 'range' ? 'slider' : 'field'] = input;
    inputs.set(input.dataset.key, own);
  }
  for (const [key, own] of inputs) {
    if (!first.has(key)) first.set(key, [own.slider && own.slider.value, own.field.value]);
    const value = changed.get(key);
    if (value !== undefined) put(key, value);
  }
  for (const list of live.querySelectorAll('select[data-table]')) {
    const table = list.dataset.table;
    if (!tags.has(table)) tags.set(table, list.value);
    if (swapped.has(table)) list.value = swapped.get(table);
  }
  for (const box of live.querySelectorAll('[data-follow]')) box.checked = box.dataset.follow === followed;
}
const ask = path => fetch(`${path}?token=${encodeURIComponent(token)}`, {
  method: 'POST', headers: { 'Content-Type': 'application/json' },
  body: JSON.stringify({ case: +live.dataset.case, set: [...changed], swap: [...swapped], follow: followed, controls, page: name }),
});
const pause = ms => new Promise(done => setTimeout(done, ms));

// One request at a time, always about the newest values. A request that takes longer than this is replaced by a newer one; the server
// ends it. The time counts from the input that is answered.
const SLOW = 250;
let busy = null, waiting = null, answer = null;
function refresh(since) {
  waiting = since;
  const left = busy ? busy.from + SLOW - performance.now() : 0;
  if (!(left > 0)) next();
  else if (!busy.timer) busy.timer = setTimeout(next, left);
}
async function next() {
  if (waiting === null) return;
  const since = waiting, mine = { from: performance.now() };
  [waiting, busy] = [null, mine];
  watch(mine);
  let reply;
  try {
    const response = await ask('/answer');
    if (!response.ok) throw new Error(await response.text());
    reply = await response.json();
  } catch (error) {
    reply = { mistakes: `no answer: ${error.message}. Is voussoir serve still running?` };
  }
  if (busy !== mine) return;
  busy = null;
  by('progress').hidden = true;
  show(reply);
  requestAnimationFrame(() => {
    live.dataset.ms = (performance.now() - since).toFixed(1);
    live.dataset.answers = 1 + +(live.dataset.answers || 0);
    if (!reply.mistakes) by('time').textContent = `Updated in ${short(+live.dataset.ms)} ms.`;
  });
  next();
}

// Progress of a slow request.
async function watch(mine) {
  await pause(400);
  while (busy === mine) {
    const at = await ask('/progress').then(response => response.json()).catch(() => null);
    if (busy !== mine) return;
    const path = at && at.path, seconds = ((performance.now() - mine.from) / 1e3).toFixed(0);
    const what = followed ? 'Searching for the most onerous position' : path
      ? `Following the path: ${path.stage}${path.gravity ? ' (gravity)' : ''}, λ = ${short(path.factor)}, ${path.states} states` : 'Computing';
    say('doing', `${what}; ${seconds} s.${answer ? ' The picture shows the values before.' : ''}`);
    by('progress').hidden = false;
    live.classList.add('stale');
    await pause(300);
  }
}
by('stop').addEventListener('click', () => ask('/stop'));

const say = (id, words) => { by(id).textContent = words || ''; };
function show(reply) {
  by('mistakes').hidden = !reply.mistakes;
  say('mistakes', reply.mistakes);
  live.classList.toggle('stale', !!(reply.mistakes || reply.stopped));
  if (reply.controls) {
    by('controls').innerHTML = reply.controls;
    controls = false;
    register();
  }
  if (reply.toml) say('toml', reply.toml);
  by('sampled').hidden = !reply.sampled;
  say('sampled', reply.sampled);
  if (reply.mistakes) return;
  say('headline', reply.stopped || reply.headline);
  by('headline').classList.toggle('bad', !reply.stopped && !reply.certified);
  if (reply.stopped) return;
  for (const [key, value] of reply.position || []) put(key, value);
  const found = reply.positions > 1 ? ` The most onerous of ${reply.positions} positions.` : '';
  say('proof', `${reply.solver}: ${reply.proof}.${found}`);
  say('kind', reply.mechanism ? `Mechanism: ${reply.mechanism}.` : 'No mechanism.');
  by('notes').replaceChildren(...reply.notes.map(note => {
    const item = make('li');
    item.textContent = note;
    return item;
  }));
  answer = reply;
  picture();
}

// The drawing of the scene, which moves, with the loads that can be dragged; below it the curve of a path. The server writes both.
let scene = null;
function picture() {
  const focused = document.activeElement && document.activeElement.dataset && document.activeElement.dataset.handle;
  const share = scene ? scene.share() : 0;
  if (scene) scene.stop();
  by('curve').hidden = !answer.curve;
  by('curve').innerHTML = answer.curve || '';
  by('picture').innerHTML = answer.scene;
  by('scene').classList.remove('moves', 'moved');
  const svg = by('picture').querySelector('svg'), room = svg.querySelector('.metres');
  svg.setAttribute('role', 'group');
  svg.setAttribute('aria-label', answer.headline);
  by('scene').hidden = false;
  scene = moving(by('scene'), answer.drawing, share);
  // Under the arrows and the texts of the loads.
  const top = make('g', { transform: room.getAttribute('transform') }), unit = 1 / +room.dataset.scale;
  room.after(top);
  answer.handles.forEach((handle, index) => {
    const group = make('g', { class: 'handle', tabindex: 0, role: 'slider', 'data-handle': index,
      'aria-label': `load at ${handle.keys[0]}`, 'aria-valuenow': handle.values[0] }, top);
    vehicle(group, handle, unit);
  });
  by('drag').hidden = !answer.handles.length;
  clear(svg, top);
  if (focused) {
    const again = top.querySelector(`[data-handle="${focused}"]`);
    if (again) again.focus({ preventScroll: true });
  }
}
// Moves the texts under vehicles above their roofs.
function clear(svg, top) {
  const zoom = svg.getScreenCTM().a || 1;
  for (const vehicle of top.querySelectorAll('.handle:has(.wheel)')) {
    const box = vehicle.getBoundingClientRect();
    for (const words of svg.querySelectorAll('text')) {
      const own = words.getBoundingClientRect();
      const apart = own.right < box.left || own.left > box.right || own.bottom < box.top || own.top > box.bottom;
      if (!apart) words.setAttribute('y', +words.getAttribute('y') - (own.bottom - box.top) / zoom - 2);
    }
  }
}
// A vehicle with its wheels on the road, or a disc on the arrow of another load; `unit` is a pixel in metres.
function vehicle(group, handle, unit) {
  const axles = handle.axles || [], wheel = 9 * unit;
  if (!axles.length) {
    make('circle', { cx: handle.x, cy: -handle.y - 20 * unit, r: 12 * unit }, group);
    return;
  }
  const at = axles.map(([x]) => x), [left, right] = [Math.min(...at) - 2 * wheel, Math.max(...at) + 2 * wheel];
  const bed = Math.max(...axles.map(([, y]) => y)) + 1.6 * wheel, roof = bed + 2.2 * wheel;
  make('polygon', { points: text([[left, bed], [right, bed], [right, roof], [left, roof]]) }, group);
  for (const [x, y] of axles) make('circle', { class: 'wheel', cx: x, cy: -y - wheel, r: wheel }, group);
}

// Values. A field takes units; if it is empty, the key is as the study file has it.
function put(key, value, from) {
  changed.set(key, value);
  const own = inputs.get(key);
  if (!own) return;
  if (own.slider && own.slider !== from && typeof value === 'number') {
    own.slider.max = Math.max(own.slider.max, value);
    own.slider.min = Math.min(own.slider.min, value);
    own.slider.value = value;
  }
  if (own.field !== from) own.field.value = typeof value === 'number' ? +value.toPrecision(7) : value;
}
const rounded = (value, step) => +(Math.round(value / step) * step).toPrecision(10);
live.addEventListener('input', event => {
  const input = event.target;
  if (input.type !== 'range' || !input.dataset.key) return;
  const value = rounded(+input.value, +input.dataset.step);
  leave(input.dataset.key);
  put(input.dataset.key, Math.min(input.max, Math.max(input.min, value)), input);
  refresh(performance.now());
});
live.addEventListener('change', event => {
  const input = event.target, { key, table, follow } = input.dataset;
  if (table) {
    if (input.value === tags.get(table)) swapped.delete(table); else swapped.set(table, input.value);
    controls = true;
  } else if (follow) {
    followed = input.checked ? follow : null;
    for (const box of live.querySelectorAll('[data-follow]')) box.checked = box.dataset.follow === followed;
  } else if (key && input.type !== 'range') {
    const words = input.value.trim();
    leave(key);
    if (words === '') {
      changed.delete(key);
      back(key);
    } else {
      put(key, isFinite(words) ? +words : words, input);
    }
  } else return;
  refresh(performance.now());
});
// A load that the reader moves no longer follows its most onerous position.
function leave(key) {
  if (key !== followed) return;
  followed = null;
  for (const box of live.querySelectorAll('[data-follow]')) box.checked = false;
}
by('controls').addEventListener('submit', event => event.preventDefault());
function back(key) {
  const own = inputs.get(key), [slider, field] = first.get(key) || [];
  if (own && own.slider) own.slider.value = slider;
  if (own) own.field.value = field;
}

// Loads are dragged along the scene. The picture is replaced meanwhile, so its parent has the events.
let drag = null;
const place = event => new DOMPoint(event.clientX, event.clientY).matrixTransform(drag.matrix).x;
function shift(handle, values, dx) {
  // Span fractions end with the span.
  const fraction = handle.per_metre !== 1;
  let by_key = dx * handle.per_metre;
  if (fraction) by_key = Math.min(1 - Math.max(...values), Math.max(-Math.min(...values), by_key));
  handle.keys.forEach((key, i) => {
    leave(key);
    put(key, rounded(values[i] + by_key, 0.001));
  });
}
const held = event => {
  const group = event.target.closest('[data-handle]');
  return group && answer.handles[group.dataset.handle];
};
by('picture').addEventListener('pointerdown', event => {
  const handle = held(event);
  if (!handle) return;
  event.preventDefault();
  drag = { handle, values: [...handle.values], matrix: by('picture').querySelector('.metres').getScreenCTM().inverse() };
  drag.from = place(event);
  by('picture').setPointerCapture(event.pointerId);
});
by('picture').addEventListener('pointermove', event => {
  if (!drag) return;
  shift(drag.handle, drag.values, place(event) - drag.from);
  refresh(performance.now());
});
for (const end of ['pointerup', 'pointercancel']) by('picture').addEventListener(end, () => { drag = null; });
by('picture').addEventListener('keydown', event => {
  const step = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key], handle = held(event);
  if (!step || !handle) return;
  event.preventDefault();
  shift(handle, handle.values, step * (handle.per_metre !== 1 ? 0.01 / handle.per_metre : 0.05));
  refresh(performance.now());
});

by('reset').addEventListener('click', () => {
  changed.clear();
  swapped.clear();
  [followed, controls] = [null, true];
  refresh(performance.now());
});
by('copy').addEventListener('click', async () => {
  try {
    await navigator.clipboard.writeText(by('toml').textContent);
    say('said', 'Copied.');
  } catch {
    by('toml').closest('details').open = true;
    getSelection().selectAllChildren(by('toml'));
    say('said', 'The browser does not let a page copy: the text below is selected.');
  }
});
by('report').addEventListener('click', async () => {
  const tab = open('about:blank');
  const reply = await ask('/report'), words = await reply.text();
  const type = reply.headers.get('Content-Type') || 'text/plain';
  if (tab) tab.location = URL.createObjectURL(new Blob([words], { type }));
});
if (by('case')) by('case').addEventListener('change', () => {
  query.set('case', by('case').value);
  location.search = query.toString();
});
register();
refresh(performance.now());
