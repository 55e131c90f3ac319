// Opens a report as a reader would, and holds what it shows against the data that is in it.
// usage: node open_page.mjs PAGE; exit status 77: there is no Chromium
import assert from 'node:assert/strict';
import {browser, opened} from './reader.mjs';

const [tab, wrong] = await opened('light');
const data = JSON.parse(await tab.textContent('#summary-data'));

// The table says what the results say.
const rows = await tab.$$eval('#methods tbody tr', lines => lines.map(l => [...l.cells].map(c => c.firstChild.textContent)));
const whole = data.results.rows.filter(r => r.world === '*' && r.disturbance === '*');
assert.equal(rows.length, whole.length);
whole.forEach((row, i) => {
  assert.equal(rows[i][0], row.method);
  assert.equal(rows[i][1], String(row.runs));
  assert.equal(parseFloat(rows[i][2]), +(100 * row.success.hits / row.success.of).toFixed(1));
  assert.equal(rows[i][4], `${row['first_wrong_at_0.999'].hits} of ${row['first_wrong_at_0.999'].of}`);
});

// The curves go through the points of the data.
const [xs, ...curves] = await tab.evaluate(() => plots[0].made.data.map(values => [...values]));
data.curves.forEach((curve, k) => curve.correct_distance_m.forEach((way, i) => {
  if (curve.correct_distance_m[i + 1] !== way) assert.equal(curves[k][xs.indexOf(way)], (i + 1) / curve.runs);
}));

// Scrubbing moves the robot, by mouse and by keyboard.
const best = () => tab.$$eval('.view', views => views.map(v => v.dataset.best));
const at = value => tab.$eval('#time', (s, v) => { s.value = v; s.dispatchEvent(new Event('input')); }, value);
await at(1000);
const end = await best();
const expected = await tab.evaluate(() => run.methods.map(m => (m.pose.at(-1) ?? m.hypotheses.at(-1)[0]).slice(0, 3).map(v => v.toFixed(2)).join(' ')));
assert.deepEqual(end, expected);
await at(500);
assert.notDeepEqual(await best(), end);
await tab.focus('#time');
const now = await tab.textContent('#now');
for (let i = 0; i < 60; ++i) await tab.keyboard.press('ArrowRight');
assert.notEqual(await tab.textContent('#now'), now);

// Something is drawn: the canvas has the wall's colour in it, and follows the robot.
const inked = () => tab.$eval('.view canvas', c => {
  const pixels = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
  let count = 0;
  for (let i = 0; i < pixels.length; i += 4) count += pixels[i + 3] > 0;
  return count;
});
assert(await inked() > 1000);
const before = await tab.$eval('.view canvas', c => c.toDataURL());
await tab.check('#follow');
assert.notEqual(await tab.$eval('.view canvas', c => c.toDataURL()), before);
await tab.selectOption('#run', '1');
await tab.waitForFunction(() => run.name === names[1]);
await tab.click('#play');
await tab.waitForFunction(() => now > run.begin);
assert.deepEqual(wrong, []);

const [dark, wrongInTheDark] = await opened('dark');
assert.notEqual(await dark.evaluate(() => css('--paper')), await tab.evaluate(() => css('--paper')));
assert.deepEqual(wrongInTheDark, []);
await browser.close();
