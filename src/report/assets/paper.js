const paper = json('paper-data');

// Table I: ours beside what the paper printed.
function showInitialisation(results) {
  const table = element('initialisation');
  const head = table.createTHead().insertRow();
  ['Field model', 'Mean error', 'SD', 'Least', 'Greatest', 'Within 3.0 m', 'Success', 'Paper: mean error', 'Paper: within 3.0 m']
    .forEach(name => cell(head, name, '', 'col'));
  const body = table.createTBody();
  for (const {model, summary: s} of results.models) {
    const line = body.insertRow(), error = s.initial_error_m, printed = results.paper?.initialisation[model];
    cell(line, model, '', 'row').style.color = colorOf(model);
    [error.mean, error.standard_deviation, error.min, error.max].forEach(v => cell(line, fixed(v, 2) + ' m'));
    cell(line, percent(s.initialised.share), interval(s.initialised));
    cell(line, percent(s.success.share), interval(s.success));
    cell(line, printed ? fixed(printed.initial_error_mean_m, 2) + ' m' : '–');
    cell(line, printed ? percent(printed.initialised) : '–');
  }
}

// Fig. 6 a, d: a row a waypoint would be long; a column each.
function showWaypoints(results) {
  const table = element('waypoints');
  const head = table.createTHead().insertRow();
  cell(head, 'Success at', '', 'col');
  results.models[0].success_by_waypoint.forEach((_, i) => cell(head, `WP${i + 1}`, '', 'col'));
  const body = table.createTBody();
  for (const {model, success_by_waypoint: shares} of results.models) {
    const line = body.insertRow();
    cell(line, model, '', 'row').style.color = colorOf(model);
    for (const share of shares)
      cell(line, percent(share)).style.background = `color-mix(in srgb, #0072b2 ${Math.round(45 * share)}%, transparent)`;
  }
}

const quantileOf = (sorted, share) => {
  const at = share * (sorted.length - 1), low = Math.floor(at);
  return sorted[low] + (at - low) * ((sorted[low + 1] ?? sorted[low]) - sorted[low]);
};

function svg(name, attributes, text) {
  const made = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  return made;
}

// Fig. 6 b, e: boxes after Tukey.
function showBoxes(curves) {
  const width = 420, height = 260, left = 48, bottom = 34, top = 10;
  const most = Math.max(1, ...curves.flatMap(c => c.cld_m)) * 1.05;
  const y = v => top + (height - top - bottom) * (1 - v / most);
  const drawing = svg('svg', {viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': 'Box plots of the correct localization distance'});
  for (let i = 0; i <= 4; ++i) {
    const v = most * i / 4;
    drawing.append(svg('line', {x1: left, x2: width, y1: y(v), y2: y(v), class: 'grid'}),
                   svg('text', {x: left - 8, y: y(v) + 4, 'text-anchor': 'end'}, v.toFixed(1)));
  }
  curves.forEach((c, i) => {
    const x = left + (width - left) * (i + 0.5) / curves.length, half = 34, values = c.cld_m, color = colorOf(c.model);
    drawing.append(svg('text', {x, y: height - 10, 'text-anchor': 'middle'}, c.model));
    if (!values.length) return;
    const [low, middle, high] = [0.25, 0.5, 0.75].map(s => quantileOf(values, s)), reach = 1.5 * (high - low);
    const inside = values.filter(v => v >= low - reach && v <= high + reach);
    drawing.append(svg('line', {x1: x, x2: x, y1: y(inside[0]), y2: y(inside.at(-1)), class: 'whisker'}),
                   svg('rect', {x: x - half, width: 2 * half, y: y(high), height: y(low) - y(high), fill: color, 'fill-opacity': 0.5, stroke: color}),
                   svg('line', {x1: x - half, x2: x + half, y1: y(middle), y2: y(middle), class: 'median'}));
    for (const v of values)
      if (v < low - reach || v > high + reach) drawing.append(svg('circle', {cx: x, cy: y(v), r: 3, fill: 'none', stroke: color}));
  });
  element('boxes').append(drawing);
}

function showPaper({results, curves}) {
  element('paper').hidden = false;
  showInitialisation(results);
  showWaypoints(results);
  showBoxes(curves);
  const end = 2.0;
  plot('plot-first-error', 'error of the first pose (m)', 'share of runs',
       curves.map(c => ({label: c.model, stroke: colorOf(c.model), paths: uPlot.paths.stepped({align: 1})})),
       uPlot.join(curves.map(c => {
         const seen = c.first_error_m.filter(v => v <= end);
         return [[0, ...seen, end], [0, ...seen.map((_, i) => (i + 1) / c.runs), seen.length / c.runs]];
       }), curves.map(() => [2])).map((values, k) => k === 0 ? values : filled(values)),
       {x: {range: [0, end]}, y: {range: [0, 1.02]}});
  const a = results.alignment_deg, p = results.paper;
  element('paper-note').textContent =
    `K = ${results.hypotheses} hypotheses, ${results.fingerprints} fingerprints. Turned parallel to ${fixed(a.mean, 2)}° on average, at worst ${fixed(a.max, 2)}°.`
    + (p ? ` The paper, with gpr: ${fixed(p.alignment_mean_deg, 2)}°; success ${percent(p.success)}; ${percent(p.error.share)} of errors within ${p.error.error_m} m.` : '');
}

if (paper) showPaper(paper);
