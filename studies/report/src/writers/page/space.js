// Scenes in space: a drawing that turns under the pointer or the arrow keys, and plays the mechanism. Paper has the views beside it.
for (const place of document.querySelectorAll('.space[data-case]')) {
  const own = cases.get(+place.dataset.case);
  if (!own) continue;
  const wide = 680, high = 440;
  const canvas = make('canvas', { width: wide, height: high, tabindex: '0', role: 'img', 'aria-label': 'the blocks; arrow keys turn them' });
  const tools = make('div', { class: 'tools' });
  place.prepend(canvas, tools);
  place.hidden = false;
  const pencil = canvas.getContext('2d');
  let azimuth = -Math.PI / 6, tilt = Math.PI / 6, moved = 0;
  const middle = [0, 1, 2].map(i => (own.low[i] + own.high[i]) / 2);
  const scale = 0.8 * high / Math.hypot(...[0, 1, 2].map(i => own.high[i] - own.low[i]));
  // Where a corner of a block is at a share of the mechanism's way.
  const at = (block, corner) => {
    const p = own.points[block][corner];
    const v = own.motion && own.motion[block];
    if (!v || !moved) return p;
    const d = p.map((x, i) => x - own.centres[block][i]);
    return [0, 1, 2].map(i => p[i] + moved * (v[i] + v[3 + (i + 1) % 3] * d[(i + 2) % 3] - v[3 + (i + 2) % 3] * d[(i + 1) % 3]));
  };
  const repaint = () => {
    const [ca, sa, ct, st] = [Math.cos(azimuth), Math.sin(azimuth), Math.cos(tilt), Math.sin(tilt)];
    const view = p => {
      const [x, y, z] = p.map((value, i) => (value - middle[i]) * scale);
      const right = ca * x - sa * y, into = sa * x + ca * y;
      return [wide / 2 + right, high / 2 - (ct * z + st * into), ct * into - st * z];
    };
    const style = getComputedStyle(place), colour = name => style.getPropertyValue(name).trim();
    const [stone, edge, quiet] = [colour('--stone'), colour('--edge'), colour('--line')];
    const faces = [];
    own.faces.forEach((list, block) => {
      const corners = own.points[block].map((_, corner) => view(at(block, corner)));
      for (const face of list) {
        const points = face.map(corner => corners[corner]);
        let area = 0;
        points.forEach(([x, y], i) => {
          const [u, v] = points[(i + 1) % points.length];
          area += x * v - y * u;
        });
        // Faces that look away are hidden: the sheet's y points down.
        if (area < 0) faces.push({ points, depth: points.reduce((sum, p) => sum + p[2], 0) / points.length, fixed: own.fixed[block] });
      }
    });
    faces.sort((a, b) => b.depth - a.depth);
    pencil.clearRect(0, 0, wide, high);
    pencil.strokeStyle = edge;
    pencil.lineWidth = own.faces.length > 100 ? 0.5 : 1;
    for (const face of faces) {
      pencil.beginPath();
      for (const [x, y] of face.points) pencil.lineTo(x, y);
      pencil.closePath();
      pencil.fillStyle = face.fixed ? quiet : stone;
      pencil.fill();
      pencil.stroke();
    }
  };
  let last = null;
  canvas.addEventListener('pointerdown', event => {
    last = [event.clientX, event.clientY];
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener('pointermove', event => {
    if (!last) return;
    turn((event.clientX - last[0]) / 150, (event.clientY - last[1]) / 150);
    last = [event.clientX, event.clientY];
  });
  for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, () => { last = null; });
  const turn = (across, down) => {
    azimuth += across;
    tilt = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, tilt + down));
    repaint();
  };
  canvas.addEventListener('keydown', event => {
    const step = { ArrowRight: [0.1, 0], ArrowLeft: [-0.1, 0], ArrowDown: [0, 0.1], ArrowUp: [0, -0.1] }[event.key];
    if (!step) return;
    event.preventDefault();
    turn(...step);
  });
  if (own.motion) {
    const play = make('button', { type: 'button' }, tools), label = make('label', {}, tools);
    label.append('motion ');
    const slider = make('input', { type: 'range', min: 0, max: 100, value: 0 }, label);
    const show = () => {
      moved = slider.value / 100;
      repaint();
    };
    player(play, slider, show, false);
  }
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', repaint);
  repaint();
}
