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

// Scenes that move; on paper they are at rest, with the mechanism beside them.
for (const place of document.querySelectorAll('.scene[data-case]')) {
  const scene = moving(place, cases.get(+place.dataset.case), 0);
  if (scene) addEventListener('beforeprint', scene.rest);
}

// Charts: the nearest point under the pointer, or with arrow keys, with its values and its case's drawing.
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
      if (own && own.bodies) {
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
