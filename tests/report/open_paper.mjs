// The same for the page of the paper's experiment.
// usage: node open_paper.mjs PAGE; exit status 77: there is no Chromium
import assert from 'node:assert/strict';
import {browser, opened} from './reader.mjs';

const [tab] = await opened('light');
const {results, curves} = JSON.parse(await tab.textContent('#paper-data'));
const cells = id => tab.$$eval(`#${id} tbody tr`, lines => lines.map(l => [...l.cells].map(c => c.firstChild.textContent)));

assert(await tab.isVisible('#paper'));
assert(!await tab.isVisible('#summary'), 'the other protocol has no section of its own here');

// Table I and the waypoints say what the results say.
const initialisation = await cells('initialisation'), waypoints = await cells('waypoints');
results.models.forEach(({model, summary, success_by_waypoint: shares}, i) => {
  assert.equal(initialisation[i][0], model);
  assert.equal(parseFloat(initialisation[i][1]), +summary.initial_error_m.mean.toFixed(2));
  assert.equal(parseFloat(initialisation[i][6]), +(100 * summary.success.share).toFixed(1));
  assert.equal(parseFloat(initialisation[i][7]), +results.paper.initialisation[model].initial_error_mean_m.toFixed(2));
  assert.deepEqual(waypoints[i].slice(1).map(parseFloat), shares.map(s => +(100 * s).toFixed(1)));
});

// A box a model; the curve of errors ends at the share of runs that were answered.
assert.equal(await tab.$$eval('#boxes rect', boxes => boxes.length), curves.length);
const [, ...shown] = await tab.evaluate(() => plots[0].made.data.map(values => [...values]));
curves.forEach((curve, k) => assert.equal(shown[k].at(-1), curve.first_error_m.length / curve.runs));
assert(await tab.isVisible('#replay'));
await opened('dark');
await browser.close();
