// What makes a report answer: sorting, filtering, values under the pointer, drawings that move, printing.
// Tables: a button in each head sorts, a field above filters rows.
const number = text => {
  const plain = text.replace(/[≥≤–]|carries/g, '').trim();
  const found = plain.match(/^[-+]?[\d.]+(e[-+]?\d+)?/i);
  return found ? parseFloat(found[0]) * ({ kN: 1e3, MN: 1e6, ms: 1e-3, 'µs': 1e-6 }[plain.split(/[ ;]/)[1]] || 1) : NaN;
};
for (const table of document.querySelectorAll('.wide > table')) {
  const body = table.tBodies[0], heads = [...table.tHead.rows[0].cells];
  if (2 > body.rows.length) continue;
  const first = [...body.rows];
  heads.forEach((head, column) => {
    const button = make('button', { type: 'button', title: 'sort by this column' });
    button.textContent = head.textContent;
    head.replaceChildren(button);
    button.addEventListener('click', () => {
      const next = { ascending: 'descending', descending: null }[head.getAttribute('aria-sort')];
      const sense = next === undefined ? 'ascending' : next;
      heads.forEach(other => other.removeAttribute('aria-sort'));
      if (sense) head.setAttribute('aria-sort', sense);
      const way = sense === 'descending' ? -1 : 1;
      const cell = row => row.cells[column].textContent;
      const order = (a, b) => {
        const [x, y] = [number(cell(a)), number(cell(b))];
        if (isNaN(x) || isNaN(y)) return isNaN(x) && isNaN(y) ? way * cell(a).localeCompare(cell(b)) : isNaN(x) ? 1 : -1;
        return way * (x - y);
      };
      body.append(...(sense ? [...first].sort(order) : first));
    });
  });
  if (first.length > 7) {
    const label = make('label', { class: 'filter' });
    label.textContent = 'Rows with ';
    const field = make('input', { type: 'search', placeholder: 'words, or > 500', 'aria-label': 'filter rows' }, label);
    table.parentElement.before(label);
    field.addEventListener('input', () => {
      const words = field.value.toLowerCase().split(/\s+(?=[^\d\s])/).map(word => word.trim()).filter(Boolean);
      const fits = (row, word) => {
        const bound = word.match(/^([<>])\s*([-\d.e]+)$/);
        if (!bound) return row.textContent.toLowerCase().includes(word);
        const load = heads.findIndex(head => head.textContent.startsWith('load factor'));
        const value = number(row.cells[load > -1 ? load : 0].textContent);
        return bound[1] === '>' ? value > +bound[2] : +bound[2] > value;
      };
      for (const row of first) row.hidden = !words.every(word => fits(row, word));
    });
  }
}

// Scenes that move: the blocks, the thrust line and the hinges of the drawing make room for those at the slider's place; loads,
// supports and fill stay.
for (const place of document.querySelectorAll('.scene[data-case]')) {
  const own = cases.get(+place.dataset.case), room = place.querySelector('.metres');
  const path = own && own.states && own.states.length > 1;
  if (!room || !path && !(own && own.motion)) continue;
  place.classList.add('moves');
  const tools = make('div', { class: 'tools' });
  place.querySelector('svg').after(tools);
  const play = make('button', { type: 'button' }, tools);
  const label = make('label', {}, tools);
  label.append(path ? 'state ' : 'motion ');
  const slider = make('input', { type: 'range', min: 0, max: path ? own.states.length - 1 : 100, value: path ? own.peak || 0 : 0 }, label);
  const magnify = make('label', {}, tools);
  let factor;
  if (path) {
    magnify.append('displacements × ');
    factor = make('input', { type: 'number', min: 1, value: own.magnify || 1 }, magnify);
  }
  const said = make('output', {}, tools);
  const chart = place.closest('.case').querySelector('svg .plot');
  let cursor, running = null;
  const hinges = moved => {
    for (const [joint, x, y] of own.hinges || []) {
      const [px, py] = follow(own, joint, moved, [x, y]);
      make('circle', { class: 'hinge', cx: px, cy: -py, r: 5 / +room.dataset.scale }, room);
    }
  };
  const show = () => {
    const atRest = !path && +slider.value === 0;
    place.classList.toggle('moved', !atRest);
    if (!path) {
      const moved = twists(own, slider.value / 100);
      if (atRest) room.replaceChildren();
      else {
        paint(room, own, moved, []);
        hinges(moved);
      }
      said.textContent = atRest ? 'at rest' : 'displacements exaggerated';
      return;
    }
    const state = own.states[slider.value], times = Math.max(1, +factor.value || 1);
    const moved = own.bodies.map((_, body) => state.bodies[body].map(u => u * times));
    const line = state.thrust.map((point, joint) => point && follow(own, joint, moved, point));
    paint(room, own, moved, pieces(line), pressures(own, state, moved));
    said.textContent = `${state.stage}, λ = ${short(state.factor)}, ${short(state.displacement * 1e3)} mm`;
    if (chart) {
      if (!cursor) cursor = make('circle', { r: 6, class: 'cursor' }, chart);
      const [x, y] = [axis(chart.dataset.x), axis(chart.dataset.y)];
      cursor.setAttribute('cx', x.place(state.displacement * 1e3));
      cursor.setAttribute('cy', y.place(state.factor));
      cursor.setAttribute('visibility', state.live ? 'visible' : 'hidden');
    }
  };
  const stop = () => {
    cancelAnimationFrame(running);
    running = null;
    play.textContent = '▶ play';
  };
  // Once through all states of a path; there and back for a mechanism.
  const start = () => {
    let begun = null;
    play.textContent = '❚❚ pause';
    const step = now => {
      begun = begun === null ? now : begun;
      const share = Math.min(1, (now - begun) / (path ? 6000 : 4000));
      slider.value = Math.round(slider.max * (path ? share : 1 - Math.abs(1 - 2 * share)));
      show();
      if (share < 1) running = requestAnimationFrame(step); else stop();
    };
    running = requestAnimationFrame(step);
  };
  play.addEventListener('click', () => running === null ? start() : stop());
  slider.addEventListener('input', () => {
    stop();
    show();
  });
  if (factor) factor.addEventListener('input', show);
  // On paper the scene is at rest, with the mechanism beside it.
  addEventListener('beforeprint', () => {
    stop();
    if (!path) slider.value = 0;
    show();
  });
  stop();
  show();
}

// Charts: the nearest point under the pointer, or with arrow keys, with its values and its case's drawing.
function axis(description) {
  const [low, high, from, to, log] = description.split(' ').map(Number);
  const f = log ? Math.log10 : x => x;
  return { place: value => from + (f(value) - f(low)) / (f(high) - f(low)) * (to - from) };
}
const tip = make('div', { class: 'tip', hidden: '' }, document.body);
for (const plot of document.querySelectorAll('svg .plot')) {
  const svg = plot.ownerSVGElement, x = axis(plot.dataset.x), y = axis(plot.dataset.y);
  const points = [];
  for (const line of plot.querySelectorAll('.series')) {
    const ids = (line.dataset.cases || '').split(' ').filter(Boolean).map(Number);
    (line.dataset.points || '').split(' ').filter(Boolean).forEach((pair, index) => {
      const [vx, vy] = pair.split(',').map(Number);
      points.push({ px: x.place(vx), py: y.place(vy), vx, vy, name: line.dataset.name, id: ids[index] });
    });
  }
  if (!points.length) continue;
  // The name becomes a label, so that no second tip hides the values.
  const name = svg.querySelector('title');
  svg.setAttribute('tabindex', '0');
  svg.setAttribute('aria-label', `${name.textContent}; arrow keys step from point to point`);
  name.remove();
  const ring = make('circle', { r: 7, class: 'ring', visibility: 'hidden' }, plot);
  let now = 0;
  const show = (point, left, top) => {
    ring.setAttribute('cx', point.px);
    ring.setAttribute('cy', point.py);
    ring.setAttribute('visibility', 'visible');
    tip.textContent = `${point.name}: ${point.vy} at ${point.vx}`;
    if (point.id !== undefined) {
      tip.append(`, case ${point.id}`);
      const own = cases.get(point.id);
      if (own) {
        draw(make('svg', {}, tip), own, own.motion && twists(own, 0.6), own.motion ? [] : pieces(own.thrust));
      }
    }
    tip.hidden = false;
    const room = tip.getBoundingClientRect();
    tip.style.left = Math.max(4, Math.min(left + 14, innerWidth - room.width - 4)) + 'px';
    tip.style.top = Math.max(4, top + 14 + room.height > innerHeight ? top - room.height - 10 : top + 14) + 'px';
  };
  const hide = () => {
    ring.setAttribute('visibility', 'hidden');
    tip.hidden = true;
  };
  svg.addEventListener('pointermove', event => {
    const matrix = svg.getScreenCTM().inverse(), at = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix);
    const far = point => (point.px - at.x) ** 2 + (point.py - at.y) ** 2;
    now = points.reduce((best, point, i) => far(points[best]) > far(point) ? i : best, 0);
    far(points[now]) > 1600 ? hide() : show(points[now], event.clientX, event.clientY);
  });
  svg.addEventListener('pointerleave', hide);
  svg.addEventListener('blur', hide);
  svg.addEventListener('keydown', event => {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    now = (now + step + points.length) % points.length;
    const at = new DOMPoint(points[now].px, points[now].py).matrixTransform(svg.getScreenCTM());
    show(points[now], at.x, at.y);
  });
}

// On paper everything is open but the pictures of cases: those that the reader has opened are printed.
let closed = [];
addEventListener('beforeprint', () => {
  closed = [...document.querySelectorAll('details:not([open])')].filter(one => !one.querySelector('.case'));
  closed.forEach(one => { one.open = true; });
});
addEventListener('afterprint', () => closed.forEach(one => { one.open = false; }));
