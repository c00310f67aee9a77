// How a case is drawn: its blocks, how they move, what presses. Used by every part of the page's script.
const make = (name, attributes, parent) => {
  const svg = ['svg', 'polygon', 'polyline', 'line', 'circle', 'g'].includes(name);
  const element = svg ? document.createElementNS('http://www.w3.org/2000/svg', name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes || {})) element.setAttribute(key, value);
  if (parent) parent.append(element);
  return element;
};
const short = x => x === 0 ? '0' : Math.abs(x) >= 1e7 || 1e-4 > Math.abs(x) ? x.toExponential(3) : String(+x.toPrecision(5));

// Cases: blocks, how they move, and the states of a path.
const store = document.getElementById('cases');
const cases = new Map(store ? JSON.parse(store.textContent).map(own => [own.id, own]) : []);
// Where a point of a body goes in unit time with a twist: velocity [m] of its centre and turn [rad]. This is the formula of
// figures/displaced.rs, exact for any angle; figures/placements.json holds values that both must give.
const carried = ([cx, cy], [u, v, turn], [x, y]) => {
  const small = 1e-6 > Math.abs(turn), half = Math.sin(turn / 2);
  const along = small ? 1 : Math.sin(turn) / turn, across = small ? turn / 2 : 2 * half * half / turn;
  const c = Math.cos(turn), s = Math.sin(turn), dx = x - cx, dy = y - cy;
  return [cx + along * u - across * v + c * dx - s * dy, cy + across * u + along * v + s * dx + c * dy];
};
// Twists of all bodies at a share of the mechanism's way; the second and third power close its hinges.
const twists = (own, share) => own.motion.map((twist, body) => {
  const [second, third] = own.closing[body];
  return twist.map((u, i) => share * (u + share * (second[i] + share * third[i])));
});
const placed = (own, body, twist) => {
  const points = own.bodies[body], out = [];
  for (let i = 0; points.length > i; i += 2) out.push(carried(own.centres[body], twist, [points[i], points[i + 1]]));
  return out;
};
const text = points => points.map(([x, y]) => x.toFixed(4) + ',' + (-y).toFixed(4)).join(' ');
const frame = own => {
  let box = [1e99, 1e99, -1e99, -1e99];
  for (const points of own.bodies) for (let i = 0; points.length > i; i += 2) {
    box = [Math.min(box[0], points[i]), Math.min(box[1], -points[i + 1]), Math.max(box[2], points[i]), Math.max(box[3], -points[i + 1])];
  }
  const margin = 0.08 * Math.max(box[2] - box[0], box[3] - box[1]);
  return [box[0] - margin, box[1] - margin, box[2] - box[0] + 2 * margin, box[3] - box[1] + 2 * margin].map(x => x.toFixed(3)).join(' ');
};
// The blocks of a case, each moved by its twist, in metres; `line` is a thrust line, `joints` what presses there.
const paint = (svg, own, moved, line, joints) => {
  svg.replaceChildren();
  own.bodies.forEach((points, body) => {
    if (moved && own.free[body]) make('polygon', { class: 'ghost', points: text(placed(own, body, [0, 0, 0])) }, svg);
  });
  own.bodies.forEach((points, body) => {
    if (own.free[body]) make('polygon', { class: 'stone', points: text(placed(own, body, moved ? moved[body] : [0, 0, 0])) }, svg);
  });
  for (const piece of joints || []) make(piece.open ? 'polyline' : 'polygon', { class: piece.open ? 'open' : 'stress', points: text(piece.points) }, svg);
  for (const piece of line || []) make('polyline', { class: 'thrust', points: text(piece) }, svg);
};
// The same as a picture of its own.
const draw = (svg, own, moved, line, joints) => {
  svg.setAttribute('viewBox', frame(own));
  paint(svg, own, moved, line, joints);
};
const pieces = line => {
  const out = [[]];
  for (const point of line || []) point ? out[out.length - 1].push(point) : out.push([]);
  return out.filter(piece => piece.length > 1);
};
// Where a joint's points went with the block on its minus side.
const follow = (own, joint, moved, point) => {
  const body = own.joints[joint][0];
  return carried(own.centres[body], moved[body], point);
};
// Diagrams of contact stress, and joints that are open at an end.
const pressures = (own, state, moved) => {
  const out = [];
  let greatest = 1e-300;
  for (const joint of state.stress) for (const [, pressure] of joint) greatest = Math.max(greatest, pressure);
  state.stress.forEach((points, joint) => {
    const [, , ax, ay, bx, by] = own.joints[joint];
    const long = Math.hypot(bx - ax, by - ay), n = [(by - ay) / long, (ax - bx) / long];
    const at = (share, off) => follow(own, joint, moved, [ax + share * (bx - ax) + off * n[0], ay + share * (by - ay) + off * n[1]]);
    const pressed = points.filter(([, pressure]) => pressure > 1e-6 * greatest);
    if (pressed.length) out.push({ points: [...points.map(([share]) => at(share, 0)), ...points.slice().reverse().map(([share, pressure]) => at(share, 0.5 * long * pressure / greatest))] });
    const open = (from, to) => to - from > 0.05 && out.push({ open: true, points: [at(from, 0), at(to, 0)] });
    if (pressed.length) {
      open(0, Math.min(...pressed.map(p => p[0])) - 0.001);
      open(Math.max(...pressed.map(p => p[0])) + 0.001, 1);
    }
  });
  return out;
};
// Places of values on an axis of a chart.
const axis = description => {
  const [low, high, from, to, log] = description.split(' ').map(Number);
  const f = log ? Math.log10 : x => x;
  return { place: value => from + (f(value) - f(low)) / (f(high) - f(low)) * (to - from) };
};

// A button that moves a slider: once through all states of a path, there and back for a mechanism. Returns what stops it.
const player = (play, slider, show, path) => {
  let running = null;
  const stop = () => {
    cancelAnimationFrame(running);
    running = null;
    play.textContent = '▶ play';
  };
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
  stop();
  return stop;
};

// Makes the drawing of a scene move: its blocks, thrust line and hinges make room for those at the slider's place; loads, supports
// and fill stay. `share` is the first place of a mechanism, in percent. Returns nothing if the case does not move.
const moving = (place, own, share) => {
  const room = place.querySelector('.metres');
  const path = own && own.states && own.states.length > 1;
  if (!room || !path && !(own && own.motion)) return null;
  place.classList.add('moves');
  const tools = make('div', { class: 'tools' });
  place.querySelector('svg').after(tools);
  const play = make('button', { type: 'button' }, tools);
  const label = make('label', {}, tools);
  label.append(path ? 'state ' : 'motion ');
  const slider = make('input', { type: 'range', min: 0, max: path ? own.states.length - 1 : 100, value: path ? own.peak || 0 : share }, label);
  const magnify = make('label', {}, tools);
  let factor;
  if (path) {
    magnify.append('displacements × ');
    factor = make('input', { type: 'number', min: 1, value: own.magnify || 1 }, magnify);
  }
  const said = make('output', {}, tools);
  const chart = place.closest('.case').querySelector('svg .plot');
  let cursor;
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
  const stop = player(play, slider, show, path);
  if (factor) factor.addEventListener('input', show);
  const rest = () => {
    stop();
    if (!path) slider.value = 0;
    show();
  };
  show();
  return { stop, rest, share: () => path ? share : +slider.value };
};
