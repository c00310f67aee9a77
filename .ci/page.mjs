// Opens pages of results in a headless browser and uses them as a reader would. Arguments: the folder that holds rise/,
// hinges/, path/, finite/, report/ and space/ with a report.html each, where screenshots and PDFs are written; the folder of the crate.
import puppeteer from 'puppeteer-core';
import path from 'node:path';
import { readFileSync, statSync, writeFileSync } from 'node:fs';

const out = path.resolve(process.argv[2]);
const browser = await puppeteer.launch({ executablePath: process.env.CHROMIUM, args: ['--no-sandbox', '--disable-gpu'] });
let failures = 0;
const expect = (truth, words) => {
  if (!truth) failures += 1;
  console.log(`${truth ? 'ok    ' : 'FAILED'} ${words}`);
};

async function open(name, width, dark) {
  const page = await browser.newPage();
  const seen = [];
  page.on('console', message => ['error', 'warn'].includes(message.type()) && seen.push(message.text()));
  page.on('pageerror', error => seen.push(String(error)));
  page.on('request', request => request.url().startsWith('file:') || seen.push(`request to ${request.url()}`));
  await page.setViewport({ width, height: 900 });
  await page.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: dark ? 'dark' : 'light' }]);
  await page.goto(`file://${out}/${name}/report.html`);
  return { page, seen, name: `${name} at ${width} px${dark ? ', dark' : ''}` };
}

const shot = (page, name, fullPage = false) => page.screenshot({ path: `${out}/${name}.png`, fullPage });

for (const [name, width, dark] of [['rise', 1100, false], ['rise', 400, true], ['path', 1100, true], ['path', 400, false], ['report', 1100, false], ['report', 400, true], ['space', 1100, false], ['space', 400, true]]) {
  const { page, seen, name: words } = await open(name, width, dark);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  expect(wide <= 0, `${words}: nothing sticks out (${wide} px)`);
  const [ink, paper] = await page.evaluate(() => [getComputedStyle(document.body).color, getComputedStyle(document.body).backgroundColor]);
  const bright = colour => colour.match(/\d+/g).slice(0, 3).reduce((sum, x) => sum + +x, 0) / 765;
  expect(Math.abs(bright(ink) - bright(paper)) > 0.6 && bright(paper) < 0.5 === dark, `${words}: ink on paper`);
  await shot(page, `${name}-${width}${dark ? '-dark' : ''}`);
  expect(seen.length === 0, `${words}: no error, no request ${seen.join('; ')}`);
  await page.close();
}

{
  const { page, seen } = await open('rise', 1100, false);
  const column = index => page.$$eval('.wide > table', (tables, index) => {
    const table = tables.find(table => table.textContent.includes('load factor'));
    return [...table.tBodies[0].rows].filter(row => !row.hidden).map(row => row.cells[index].textContent);
  }, index);
  const heads = await page.$$eval('.wide > table', tables => [...tables.find(table => table.textContent.includes('load factor')).tHead.rows[0].cells].map(cell => cell.textContent));
  const load = heads.findIndex(head => head.startsWith('load factor'));
  const click = () => page.evaluate(load => [...document.querySelectorAll('.wide > table')].find(table => table.textContent.includes('load factor')).tHead.rows[0].cells[load].querySelector('button').click(), load);
  await click();
  const sorted = (await column(load)).map(parseFloat).filter(x => !isNaN(x));
  expect(sorted.length > 20 && sorted.every((x, i) => i === 0 || sorted[i - 1] <= x), 'the table sorts by load');
  await click();
  const reversed = (await column(load)).map(parseFloat).filter(x => !isNaN(x));
  expect(reversed.every((x, i) => i === 0 || reversed[i - 1] >= x), 'and the other way round');
  await page.type('.filter input', '10 MPa');
  expect((await column(1)).every(text => text === '10 MPa'), 'the field filters rows');
  const chart = await page.$('svg .plot .series polygon');
  const box = await chart.boundingBox();
  await chart.scrollIntoView();
  const moved = await chart.boundingBox();
  await page.mouse.move(moved.x + moved.width / 2, moved.y + moved.height / 2);
  const tip = await page.$eval('.tip', tip => [tip.hidden, tip.textContent, tip.querySelectorAll('svg polygon').length]);
  expect(!tip[0] && / at /.test(tip[1]) && tip[2] > 10, `hovering a chart shows "${tip[1]}" and the drawing`);
  await shot(page, 'hover');
  await page.mouse.move(1, 1);
  await page.$eval('svg[tabindex]', svg => svg.focus());
  await page.keyboard.press('ArrowRight');
  expect(!(await page.$eval('.tip', tip => tip.hidden)), 'arrow keys show points of a chart');
  const slide = value => page.$eval('.scene input[type=range]', (slider, value) => { slider.value = value; slider.dispatchEvent(new Event('input')); }, value);
  const seenNow = () => page.$eval('.scene', scene => [scene.querySelectorAll('.stone').length, scene.querySelectorAll('.ghost').length, scene.querySelectorAll('circle.hinge').length, getComputedStyle(scene.querySelector('.rest')).visibility, scene.querySelector('.stone') && scene.querySelectorAll('.stone')[9].getAttribute('points')]);
  const atRest = await seenNow();
  await slide(50);
  const half = await seenNow();
  await slide(100);
  const end = await seenNow();
  expect(atRest[0] === 0 && atRest[3] === 'visible' && end[0] > 10 && end[1] > 10 && end[2] > 2 && end[3] === 'hidden' && end[4] !== half[4], 'a slider moves the mechanism with its hinges');
  await slide(0);
  await page.click('.scene .tools button');
  await new Promise(done => setTimeout(done, 900));
  const playing = await page.$eval('.scene input[type=range]', slider => +slider.value);
  await page.click('.scene .tools button');
  expect(playing > 5, `a button plays the motion (${playing} after 0.9 s)`);
  const stills = await page.$$eval('.moves + .still', all => all.map(still => getComputedStyle(still).display));
  expect(stills.length > 0 && stills.every(display => display === 'none'), 'one picture for each scene');
  await page.emulateMediaType('print');
  const inPrint = await page.$$eval('.moves + .still', all => all.map(still => getComputedStyle(still).display));
  const small = await page.$$eval('figure svg text', texts => Math.min(...texts.map(text => parseFloat(text.getAttribute('font-size')) * 510 / text.ownerSVGElement.viewBox.baseVal.width)));
  await page.emulateMediaType('screen');
  expect(inPrint.every(display => display !== 'none') && small >= 9, `printed, the mechanism is a second figure; text has ${small.toFixed(1)} pt or more`);
  await page.pdf({ path: `${out}/rise.pdf`, format: 'A4' });
  const size = statSync(`${out}/rise.pdf`).size;
  expect(size > 100000, `the page is printed (${size} bytes)`);
  const html = statSync(`${out}/rise/report.html`).size;
  expect(html < 1.5e6, `the page of 38 cases is small (${html} bytes)`);
  expect(seen.length === 0, `no error while it is used ${seen.join('; ')}`);
  await page.close();
}

{
  const { page, seen } = await open('path', 1100, false);
  const states = await page.$eval('.scene input[type=range]', slider => +slider.max);
  const read = async value => {
    await page.$eval('.scene input[type=range]', (slider, value) => { slider.value = value; slider.dispatchEvent(new Event('input')); }, value);
    return page.evaluate(() => {
      const moving = document.querySelector('.scene'), cursor = document.querySelector('.cursor');
      return [moving.querySelector('output').textContent, cursor && cursor.getAttribute('cy'), moving.querySelectorAll('.stress').length, moving.querySelectorAll('.thrust').length, moving.querySelectorAll('.open').length];
    });
  };
  const [first, last] = [await read(Math.floor(states / 2)), await read(states)];
  expect(states > 10 && first[0] !== last[0] && first[1] !== last[1], `a slider goes through the states of a path: "${last[0]}"`);
  expect(last[2] > 5 && last[3] > 0 && last[4] > 0, 'with contact stresses, thrust line and open joints');
  await (await page.$('.scene')).scrollIntoView();
  await shot(page, 'states');
  expect(seen.length === 0, `no error ${seen.join('; ')}`);
  await page.close();
}

{
  const { page, seen } = await open('report', 1100, false);
  const verdicts = await page.$$eval('.verdict', verdicts => verdicts.map(verdict => verdict.textContent));
  expect(verdicts.join() === 'reproduced,depends on strength', `verdicts: ${verdicts.join(', ')}`);
  expect(await page.$$eval('figure svg', drawn => drawn.length) === 3, 'the report draws what its text names');
  await page.pdf({ path: `${out}/report.pdf`, format: 'A4' });
  expect(seen.length === 0, `no error ${seen.join('; ')}`);
  await page.close();
}
// The page's script moves blocks as displaced.rs does.
const studies = process.argv[3];
const script = readFileSync(`${studies}/report/src/writers/page/draw.js`, 'utf8');
const { carried, twists } = new Function('document', `${script}; return { carried, twists };`)({ getElementById: () => null });
{
  const table = JSON.parse(readFileSync(`${studies}/report/src/figures/placements.json`, 'utf8'));
  const off = table.map(([centre, twist, point, place]) => { const [x, y] = carried(centre, twist, point); return Math.hypot(x - place[0], y - place[1]); });
  expect(table.length > 20 && Math.max(...off) < 1e-12, `draw.js places points as displaced.rs does, to ${Math.max(...off).toExponential(1)} m in ${table.length} cases`);
}
{
  const { page, seen } = await open('space', 1100, false);
  const ink = () => page.$eval('.space canvas', canvas => canvas.toDataURL());
  const first = await ink();
  await page.$eval('.space canvas', canvas => canvas.focus());
  await page.keyboard.press('ArrowRight');
  const turned = await ink();
  expect(turned !== first, 'arrow keys turn a scene in space');
  await page.$eval('.space input[type=range]', slider => { slider.value = 100; slider.dispatchEvent(new Event('input')); });
  expect(await ink() !== turned, 'a slider moves its mechanism');
  await shot(page, 'space-moved');
  await page.emulateMediaType('print');
  expect(await page.$eval('.space', figure => getComputedStyle(figure).display === 'none'), 'paper has the views instead');
  expect(seen.length === 0, `space: no error ${seen.join('; ')}`);
  await page.close();
}

for (const name of ['rise', 'hinges']) {
  const { page, seen } = await open(name, 1100, false);
  const cases = JSON.parse(await page.$eval('#cases', store => store.textContent)).filter(own => own.motion);
  // Joints whose blocks move with one velocity field stay closed. Without crushing every joint touches at one end; some
  // cases of `rise` crush.
  let torn = 0, apart = 0, kept = 0;
  for (const own of cases) {
    const xs = own.bodies.flat(), size = Math.max(...xs) - Math.min(...xs);
    for (const share of [0.1, 0.3, 0.5, 0.7, 0.9, 1]) {
      const moved = twists(own, share);
      for (const [minus, plus, ax, ay, bx, by] of own.joints) {
        const gap = point => { const [p, q] = [minus, plus].map(body => carried(own.centres[body], moved[body], point)); return Math.hypot(p[0] - q[0], p[1] - q[1]) / size; };
        const first = own.motion[minus], second = own.motion[plus], [cx, cy] = own.centres[minus], [dx, dy] = own.centres[plus];
        const other = [second[0] - second[2] * (cy - dy), second[1] + second[2] * (cx - dx), second[2]];
        const one = Math.max(...other.map((u, i) => Math.abs(u - first[i]))) < 1e-6 * size;
        if (one) { kept += 1; torn = Math.max(torn, gap([ax, ay]), gap([bx, by])); }
        apart = Math.max(apart, Math.min(gap([ax, ay]), gap([bx, by])));
      }
    }
  }
  expect(cases.length > 0 && kept > 100 && torn < 1e-6 && (name === 'rise' || apart < 1e-3), `${name}: ${kept} joints that do not open stay closed to ${torn.toExponential(1)} of the scene, blocks touch to ${apart.toExponential(1)}`);
  // At its end the moving drawing is the figure of the mechanism: scale and shift follow from the blocks at rest.
  const differs = await page.evaluate(() => {
    const numbers = text => text.match(/-?[\d.]+/g).map(Number);
    let greatest = 0, figures = 0;
    for (const place of document.querySelectorAll('.scene[data-case]')) {
      const slider = place.querySelector('input[type=range]'), figure = place.nextElementSibling;
      if (!slider || !figure || !figure.querySelector('svg [stroke-dasharray="4 3"]')) continue;
      slider.value = 100;
      slider.dispatchEvent(new Event('input'));
      const outline = dashed => [...figure.querySelectorAll('svg path')].filter(path => dashed ? path.getAttribute('stroke-dasharray') === '4 3' : path.getAttribute('stroke-linejoin') && path.getAttribute('fill') !== 'none' && !path.getAttribute('fill').startsWith('url') && !path.getAttribute('stroke-dasharray'));
      const drawn = cls => numbers([...place.querySelectorAll(cls)].map(one => one.getAttribute('points')).join(' '));
      const [before, after] = [outline(true)[0], outline(false)[0]].map(path => numbers(path.getAttribute('d').replace(/[MLZ]/g, ' ')));
      const [ghost, stone] = [drawn('.ghost'), drawn('.stone')];
      if (before.length !== ghost.length || after.length !== stone.length) return `${before.length} ${ghost.length} ${after.length} ${stone.length}`;
      const span = list => { const xs = list.filter((_, i) => i % 2 === 0); return [Math.min(...xs), Math.max(...xs)]; };
      const [[a, b], [c, d]] = [span(ghost), span(before)], scale = (d - c) / (b - a);
      const shift = [before[0] - scale * ghost[0], before[1] - scale * ghost[1]];
      stone.forEach((x, i) => { greatest = Math.max(greatest, Math.abs(scale * x + shift[i % 2] - after[i]) / (d - c)); });
      figures += 1;
    }
    return [figures, greatest];
  });
  expect(differs[0] > 0 && differs[1] < 1e-4, `${name}: ${differs[0]} moving drawings end as their figures, to ${differs[1]} of the width`);
  expect(seen.length === 0, `no error ${seen.join('; ')}`);
  await page.close();
}
// States of a path with finite displacements: unmagnified, each centre is where results.json has it, and each block has its turn.
{
  const { page } = await open('finite', 1100, false);
  const results = JSON.parse(readFileSync(`${out}/finite/results.json`, 'utf8')).cases;
  let count = 0, off = 0;
  for (const own of JSON.parse(await page.$eval('#cases', store => store.textContent))) {
    results.find(one => one.id === own.id).states.forEach((state, index) => state.bodies.forEach(([x, y, turn], body) => {
      const centre = own.centres[body], twist = own.states[index].bodies[body], arm = [3, 4];
      const place = carried(centre, twist, centre), end = carried(centre, twist, [centre[0] + arm[0], centre[1] + arm[1]]);
      const c = Math.cos(turn), s = Math.sin(turn);
      off = Math.max(off, Math.hypot(place[0] - centre[0] - x, place[1] - centre[1] - y), Math.hypot(end[0] - place[0] - c * arm[0] + s * arm[1], end[1] - place[1] - s * arm[0] - c * arm[1]));
      count += 1;
    }));
  }
  expect(count > 100 && off < 1e-8, `finite: ${count} placements are those of results.json, to ${off.toExponential(1)} m`);
  await page.close();
}
// Whatever finds its way into a page does not run.
const injected = `<script>window.ran = 'element'</script><img src="x" onerror="window.ran = 'handler'">
<svg onload="window.ran = 'onload'"></svg><a id="injected" href="javascript:window.ran='address'">x</a>
<style>body { visibility: hidden }</style><p id="styled" style="display:none">x</p>
<iframe srcdoc="<script>parent.ran = 'frame'</script>"></iframe><base href="https://example.org/">`;
for (const name of ['rise', 'path', 'report']) {
  const html = readFileSync(`${out}/${name}/report.html`, 'utf8');
  writeFileSync(`${out}/${name}/injected.html`, html.replace('<h1>', () => injected + '<h1>'));
  const page = await browser.newPage();
  const requests = [];
  page.on('request', request => /^(file|data|about):/.test(request.url()) || requests.push(request.url()));
  await page.goto(`file://${out}/${name}/injected.html`);
  await page.click('#injected');
  await new Promise(done => setTimeout(done, 300));
  const [ran, shown, styled, base, own] = await page.evaluate(() => [window.ran ?? null, getComputedStyle(document.body).visibility,
    getComputedStyle(document.getElementById('styled')).display, document.baseURI, !!document.querySelector('.tip')]);
  expect(ran === null && shown === 'visible' && styled !== 'none' && base.startsWith('file:') && requests.length === 0 && own, `${name}: injected scripts, styles and addresses do nothing (${ran}), the page's own script runs`);
  await page.close();
}
await browser.close();
process.exit(failures ? 1 : 0);
