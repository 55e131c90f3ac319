'use strict';
// Okabe & Ito: colours that stay apart for colour-blind eyes, one a method.
const COLORS = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#999999'];
const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const element = id => document.getElementById(id);
const json = id => JSON.parse(element(id).textContent);
const percent = share => share === null ? '–' : (100 * share).toFixed(share === 0 || share === 1 ? 0 : 1) + ' %';
const fixed = (value, digits) => value === null || value === undefined ? '–' : value.toFixed(digits);

function cell(row, text, small, header) {
  const made = document.createElement(header ? 'th' : 'td');
  made.textContent = text;
  if (header) made.scope = header;
  if (small) made.append(Object.assign(document.createElement('small'), {textContent: small}));
  row.append(made);
  return made;
}

// What was deflated and written in base64, as text.
async function inflated(base64) {
  const bytes = Uint8Array.from(atob(base64), c => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Response(stream).text();
}

const plots = [];  // all plots, to be resized and recoloured
function plot(id, xLabel, yLabel, series, data, more = {}) {
  const place = element(id);
  place.replaceChildren();
  // On a logarithmic axis only powers of ten are drawn.
  const decades = more.y?.distr === 3 ? {filter: (u, splits) => splits.map(v => Number.isInteger(+Math.log10(v).toFixed(6)) ? v : null)} : {};
  const axis = (label, shown) => ({label, stroke: () => css('--ink'), grid: {stroke: () => css('--line'), ...shown},
                                   ticks: {stroke: () => css('--line'), ...shown}, size: 56, ...shown});
  const made = new uPlot({
    width: Math.max(280, place.clientWidth), height: 260, scales: {x: {time: false, ...more.x}, y: more.y ?? {}},
    axes: [axis(xLabel, {}), axis(yLabel, decades)], cursor: more.cursor ?? {}, hooks: more.hooks ?? {},
    series: [{label: xLabel, value: (u, v) => fixed(v, 2)},
             ...series.map(s => ({width: 2, value: (u, v) => fixed(v, 4), points: {show: false}, ...s}))],
  }, data, place);
  plots.push({made, place});
  return made;
}
addEventListener('resize', () => plots.forEach(({made, place}) =>
  made.setSize({width: Math.max(280, place.clientWidth), height: 260})));
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => plots.forEach(({made}) => made.redraw()));
