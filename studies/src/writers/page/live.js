// What makes a page that is served follow its sliders: asks for an answer, draws it, moves loads that are dragged.
const live = document.getElementById('live'), by = id => document.getElementById(id);
const query = new URLSearchParams(location.search), token = query.get('token') || '';
const changed = new Map();
const inputs = new Map();
for (const input of live.querySelectorAll('[data-key]')) {
  const own = inputs.get(input.dataset.key) || {};
  own[input.type === 'range' ? 'slider' : 'field'] = input;
  inputs.set(input.dataset.key, own);
}
const first = new Map([...inputs].map(([key, own]) => [key, [own.slider && own.slider.value, own.field.value]]));
const ask = path => fetch(`${path}?token=${encodeURIComponent(token)}`, {
  method: 'POST', headers: { 'Content-Type': 'application/json' },
  body: JSON.stringify({ case: +live.dataset.case, set: [...changed] }),
});

// One question at a time, always about the newest values; the time counts from the input that it answers.
let busy = false, waiting = null, answer = null;
async function refresh(since) {
  if (busy) {
    waiting = since;
    return;
  }
  busy = true;
  let next = null;
  try {
    const reply = await ask('/answer');
    if (!reply.ok) throw new Error(await reply.text());
    next = await reply.json();
  } catch (error) {
    next = { mistakes: `no answer: ${error.message}. Is voussoir serve still running?` };
  }
  show(next);
  requestAnimationFrame(() => {
    live.dataset.ms = (performance.now() - since).toFixed(1);
    live.dataset.answers = 1 + +(live.dataset.answers || 0);
    if (!next.mistakes) by('time').textContent = `In the picture after ${live.dataset.ms} ms.`;
  });
  busy = false;
  if (waiting !== null) {
    const since = waiting;
    waiting = null;
    refresh(since);
  }
}

const say = (id, words) => { by(id).textContent = words || ''; };
function show(next) {
  by('mistakes').hidden = !next.mistakes;
  say('mistakes', next.mistakes);
  live.classList.toggle('stale', !!(next.mistakes || next.slow));
  if (next.toml) say('toml', next.toml);
  if (next.mistakes) return;
  say('headline', next.slow || next.headline);
  say('proof', next.proof && `${next.solver}: ${next.proof}.`);
  say('kind', next.slow ? '' : next.mechanism ? `Mechanism: ${next.mechanism}.` : 'No mechanism.');
  by('headline').classList.toggle('bad', !next.slow && !next.certified);
  by('notes').replaceChildren(...(next.notes || []).map(note => {
    const item = make('li');
    item.textContent = note;
    return item;
  }));
  if (next.slow) return;
  answer = next;
  picture();
}

// Both drawings, with room above for arrows.
function picture() {
  const own = answer && answer.drawing, statics = by('statics'), mechanism = by('mechanism');
  statics.parentElement.hidden = !own;
  mechanism.parentElement.hidden = !own || !own.motion;
  if (!own) return;
  const focused = document.activeElement && document.activeElement.dataset && document.activeElement.dataset.handle;
  draw(statics, own, null, pieces(own.thrust));
  const [x, y, width, height] = statics.getAttribute('viewBox').split(' ').map(Number);
  const long = 0.1 * Math.max(width, height);
  const box = [x, y - long, width, height + long].map(number => number.toFixed(3)).join(' ');
  statics.setAttribute('viewBox', box);
  for (const [px, py, fx, fy, last] of answer.arrows) {
    const [tx, ty] = [px - long * fx, py - long * fy], size = Math.hypot(fx, fy), head = 0.16 * long;
    const [ux, uy] = [fx / size, fy / size];
    const kind = last ? 'load' : 'load earlier';
    make('line', { class: kind, x1: tx, y1: -ty, x2: px, y2: -py }, statics);
    make('polygon', { class: kind, points: text([[px, py], [px - head * (ux + 0.5 * uy), py - head * (uy - 0.5 * ux)], [px - head * (ux - 0.5 * uy), py - head * (uy + 0.5 * ux)]]) }, statics);
  }
  for (const [px, py] of answer.hinges) make('circle', { class: 'hinge', cx: px, cy: -py, r: 0.09 * long }, statics);
  answer.handles.forEach((handle, index) => {
    make('circle', { class: 'handle', cx: handle.x, cy: -handle.y - 0.5 * long, r: 0.32 * long, tabindex: 0, role: 'slider',
      'data-handle': index, 'aria-label': `load at ${handle.keys[0]}`, 'aria-valuenow': handle.values[0] }, statics);
  });
  if (focused) {
    const again = statics.querySelector(`[data-handle="${focused}"]`);
    if (again) again.focus({ preventScroll: true });
  }
  if (own.motion) draw(mechanism, own, twists(own, by('motion').value / 100), []);
}

// Values: a slider and a field for each key. A field takes units; empty, the key is as the study file has it.
function put(key, value, from) {
  changed.set(key, value);
  const own = inputs.get(key);
  if (!own) return;
  if (own.slider && own.slider !== from && typeof value === 'number') {
    own.slider.max = Math.max(own.slider.max, value);
    own.slider.min = Math.min(own.slider.min, value);
    own.slider.value = value;
  }
  if (own.field !== from) own.field.value = value;
}
const rounded = (value, step) => +(Math.round(value / step) * step).toPrecision(10);
live.addEventListener('input', event => {
  const input = event.target;
  if (input.type !== 'range' || !input.dataset.key) return;
  const value = rounded(+input.value, +input.dataset.step);
  put(input.dataset.key, Math.min(input.max, Math.max(input.min, value)), input);
  refresh(performance.now());
});
live.addEventListener('change', event => {
  const input = event.target, key = input.dataset.key;
  if (input.type === 'range' || !key) return;
  const words = input.value.trim();
  if (words === '') {
    changed.delete(key);
    back(key);
  } else {
    put(key, isFinite(words) ? +words : words, input);
  }
  refresh(performance.now());
});
live.querySelector('form').addEventListener('submit', event => event.preventDefault());
function back(key) {
  const own = inputs.get(key), [slider, field] = first.get(key);
  if (own.slider) own.slider.value = slider;
  own.field.value = field;
}

// Loads are dragged along the scene.
let drag = null;
const place = event => new DOMPoint(event.clientX, event.clientY).matrixTransform(by('statics').getScreenCTM().inverse());
function shift(handle, values, dx) {
  // Span fractions end with the span.
  const fraction = handle.per_metre !== 1;
  let by_key = dx * handle.per_metre;
  if (fraction) by_key = Math.min(1 - Math.max(...values), Math.max(-Math.min(...values), by_key));
  handle.keys.forEach((key, i) => put(key, rounded(values[i] + by_key, 0.001)));
}
by('statics').addEventListener('pointerdown', event => {
  const index = event.target.dataset.handle;
  if (index === undefined) return;
  event.preventDefault();
  const handle = answer.handles[index];
  drag = { handle, values: [...handle.values], from: place(event).x };
  by('statics').setPointerCapture(event.pointerId);
});
by('statics').addEventListener('pointermove', event => {
  if (!drag) return;
  shift(drag.handle, drag.values, place(event).x - drag.from);
  refresh(performance.now());
});
for (const end of ['pointerup', 'pointercancel']) by('statics').addEventListener(end, () => { drag = null; });
by('statics').addEventListener('keydown', event => {
  const step = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
  const index = event.target.dataset.handle;
  if (!step || index === undefined) return;
  event.preventDefault();
  const handle = answer.handles[index], fraction = handle.per_metre !== 1;
  shift(handle, handle.values, step * (fraction ? 0.01 / handle.per_metre : 0.05));
  refresh(performance.now());
});

by('motion').addEventListener('input', picture);
by('reset').addEventListener('click', () => {
  changed.clear();
  inputs.forEach((_, key) => back(key));
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
refresh(performance.now());
