const summary = json('summary-data');

const interval = rate => rate.of === 0 ? '' : `[${rate.wilson_95.map(v => (100 * v).toFixed(1)).join(', ')}]`;
const share = rate => rate.of === 0 ? null : rate.hits / rate.of;

function showMethods(rows, costs) {
  const table = element('methods');
  const head = table.createTHead().insertRow();
  const carried = rows.some(r => r.kidnap.noticed_within_3_m.of > 0), errors = rows.some(r => r.error_after_fix_m.count);
  ['Method', 'Runs', 'Right', 'Tight', 'Wrong claims', 'Way to the first right pose', ...(errors ? ['Error after'] : []),
   'False alarms', ...(carried ? ['Carrying noticed', 'Found again'] : []), 'CPU a scan'].forEach(name => cell(head, name, '', 'col'));
  const body = table.createTBody();
  for (const row of rows.filter(r => r.world === '*' && r.disturbance === '*')) {
    const cost = costs.find(c => c.method === row.method && c.world === '*' && c.disturbance === '*');
    const line = body.insertRow();
    cell(line, row.method, '', 'row').style.color = colorOf(row.method);
    cell(line, row.runs);
    cell(line, percent(share(row.success)), interval(row.success));
    cell(line, percent(share(row.tight_success)), interval(row.tight_success));
    const claims = row['first_wrong_at_0.999'];
    cell(line, `${claims.hits} of ${claims.of}`, interval(claims));
    cell(line, fixed(row.correct_distance_m.median, 1) + ' m', `95 %: ${fixed(row.correct_distance_m.p95, 1)} m`);
    if (errors)
      cell(line, row.error_after_fix_m.count ? fixed(100 * row.error_after_fix_m.median, 1) + ' cm' : '–',
           row.error_after_fix_m.count ? `95 %: ${fixed(100 * row.error_after_fix_m.p95, 1)} cm` : '');
    cell(line, row.false_alarms, `in ${fixed(row.right_km, 1)} km`);
    if (carried) {
      cell(line, percent(share(row.kidnap.noticed_within_3_m)), `within 3 m; median ${fixed(row.kidnap.noticed_m.median, 1)} m`);
      cell(line, percent(share(row.kidnap.recovered_within_10_m)), `within 10 m; median ${fixed(row.kidnap.recovered_m.median, 1)} m`);
    }
    cell(line, cost ? fixed(cost.tracking.median_ms, 2) + ' ms' : '–', cost ? `searching, 95 %: ${fixed(cost.searching.p95_ms, 0)} ms` : '');
  }
}

const methodNames = summary ? summary.curves.map(c => c.method) : [];
function colorOf(method) {
  if (!methodNames.includes(method)) methodNames.push(method);
  return COLORS[methodNames.indexOf(method) % COLORS.length];
}

function showCases(rows) {
  const single = rows.filter(r => r.world !== '*' && r.disturbance !== '*');
  const worlds = [...new Set(single.map(r => r.world))];
  const columns = [...new Set(single.map(r => `${r.disturbance}\n${r.method}`))].map(c => c.split('\n'));
  columns.sort((a, b) => methodNames.indexOf(a[1]) - methodNames.indexOf(b[1]));
  const table = element('cases');
  const head = table.createTHead().insertRow();
  cell(head, 'Building', '', 'col');
  columns.forEach(([disturbance, method]) => cell(head, method, disturbance, 'col').style.color = colorOf(method));
  const body = table.createTBody();
  for (const world of worlds) {
    const line = body.insertRow();
    cell(line, world, '', 'row');
    for (const [disturbance, method] of columns) {
      const row = single.find(r => r.world === world && r.disturbance === disturbance && r.method === method);
      if (!row) { cell(line, '–'); continue; }
      const right = share(row.success);
      const made = cell(line, percent(right), `${fixed(row.correct_distance_m.median, 1)} m of ${row.runs}`);
      // From pale to strong blue: the number says it too.
      made.style.background = `color-mix(in srgb, #0072b2 ${Math.round(45 * right)}%, transparent)`;
    }
  }
}

// One x axis for curves that each have their own: joined, gaps filled by the step before.
function showCurves(curves) {
  const series = curves.map(c => ({label: c.method, stroke: colorOf(c.method)}));
  plot('plot-cld', 'driven (m)', 'share of runs', series.map(s => ({...s, paths: uPlot.paths.stepped({align: 1})})),
       uPlot.join(curves.map(c => [[0, ...c.correct_distance_m, 14],
                                   [0, ...c.correct_distance_m.map((_, i) => (i + 1) / c.runs), c.correct_distance_m.length / c.runs]]),
                  curves.map(() => [2])).map((values, k) => k === 0 ? values : filled(values)),
       {x: {range: [0, 14]}, y: {range: [0, 1.02]}});
  const points = curves.map(c => [c.reliability.map(b => b.mean_claim), c.reliability.map(b => b.right)]);
  plot('plot-reliability', 'claimed probability', 'share right',
       [...series.map(s => ({...s, spanGaps: true, points: {show: true, size: 7}})),
        {label: 'true', stroke: () => css('--quiet'), dash: [6, 4], width: 1}],
       uPlot.join([...points, [[0, 1], [0, 1]]]), {x: {range: [0, 1.01]}, y: {range: [0, 1.02]}});
  element('figure-error').hidden = !curves.some(c => c.error_m.length);
  plot('plot-error', 'error (m)', 'share of poses', series,
       uPlot.join(curves.map(c => [c.error_m, c.error_m.map((_, i) => i / Math.max(1, c.error_m.length - 1))]))
         .map((values, k) => k === 0 ? values : filled(values)),
       {x: {range: [0, 0.5]}, y: {range: [0, 1.02]}});
}

function filled(values) {
  let last = 0;
  return values.map(v => v === null || v === undefined ? last : (last = v));
}

if (summary) {
  element('summary').hidden = false;
  showMethods(summary.results.rows, summary.cost.rows);
  showCases(summary.results.rows);
  showCurves(summary.curves);
}
