const names = json('run-names');
const STATUS = ['searching', 'localized', 'lost'];
let run = null, now = 0, playing = null;

// The last index whose time is no later than t; -1 before the first.
function before(times, t) {
  let low = 0, high = times.length;
  while (low < high) { const middle = (low + high) >> 1; times[middle] <= t ? low = middle + 1 : high = middle; }
  return low - 1;
}

function truePose(t) {
  if (!run.truth.t.length) return null;
  const i = before(run.truth.t, t);
  return i < 0 ? null : [run.truth.x[i], run.truth.y[i], run.truth.yaw[i]];
}
const bestOf = (method, i) => method.pose[i] ?? method.hypotheses[i][0] ?? null;

class View {
  constructor(method) {
    this.method = method;
    this.box = Object.assign(document.createElement('div'), {className: 'view'});
    this.title = Object.assign(document.createElement('h3'), {textContent: method.name});
    this.title.style.color = colorOf(method.name);
    this.says = document.createElement('p');
    this.canvas = document.createElement('canvas');
    this.canvas.setAttribute('role', 'img');
    this.box.append(this.title, this.says, this.canvas);
    element('views').append(this.box);
  }
  // The map frame's metres on the canvas: all of the map, or 20 m around the robot.
  frame(pose) {
    const [x0, y0, x1, y1] = run.place.extent(), follow = element('follow').checked && pose;
    const width = follow ? 20 : x1 - x0, wide = this.box.clientWidth - 22;
    const height = follow ? 14 : y1 - y0, high = Math.min(560, Math.max(160, wide * height / width));
    const ratio = devicePixelRatio || 1;
    this.canvas.width = wide * ratio; this.canvas.height = high * ratio; this.canvas.style.height = high + 'px';
    const scale = Math.min(wide / width, high / height) * ratio;
    const middle = follow ? pose : [(x0 + x1) / 2, (y0 + y1) / 2];
    const context = this.canvas.getContext('2d');
    context.setTransform(scale, 0, 0, -scale, this.canvas.width / 2 - scale * middle[0], this.canvas.height / 2 + scale * middle[1]);
    this.pixel_m = ratio / scale;
    return context;
  }
  show(t) {
    const i = before(this.method.t, t), truth = truePose(t), best = i < 0 ? null : bestOf(this.method, i);
    const context = this.frame(truth ?? best);
    if (element('field').checked && run.place.colors) {
      Place.draw(context, run.place.walls, run.place.data.map);
      Place.draw(context, run.place.colors, run.place.data.field);
      context.globalAlpha = 0.25;
    }
    Place.draw(context, run.place.walls, run.place.data.map);
    context.globalAlpha = 1;
    this.drawWay(context, t);
    if (best) this.drawScan(context, t, best);
    if (i >= 0) for (const h of this.method.hypotheses[i].slice().reverse()) this.drawArrow(context, h, h[3]);
    if (i >= 0 && this.method.pose[i]) this.drawRobot(context, this.method.pose[i], colorOf(this.method.name));
    if (truth) this.drawRobot(context, truth, null);
    this.say(i, i < 0 ? null : truePose(this.method.t[i]), best);
  }
  say(i, truth, best) {
    let text = 'nothing yet';
    if (i >= 0) {
      text = `${STATUS[this.method.status[i]]}, probability ${this.method.p[i].toFixed(4)}, ${this.method.hypotheses[i].length} hypotheses`;
      if (truth && best) text += `, best one off by ${Math.hypot(best[0] - truth[0], best[1] - truth[1]).toFixed(2)} m`;
    }
    this.says.textContent = text;
    this.canvas.setAttribute('aria-label', `${this.method.name}: ${text}`);
    this.box.dataset.best = best ? best.slice(0, 3).map(v => v.toFixed(2)).join(' ') : '';
  }
  drawWay(context, t) {
    const {truth} = run, until = before(truth.t, t);
    context.lineWidth = 2 * this.pixel_m; context.strokeStyle = css('--truth');
    context.beginPath();
    for (let i = 0; i <= until; ++i) {
      // Being carried is no driving.
      const carried = i > 0 && Math.hypot(truth.x[i] - truth.x[i - 1], truth.y[i] - truth.y[i - 1]) > 1;
      i === 0 || carried ? context.moveTo(truth.x[i], truth.y[i]) : context.lineTo(truth.x[i], truth.y[i]);
    }
    context.stroke();
  }
  drawScan(context, t, [x, y, yaw]) {
    const i = before(run.scans.map(s => s.t), t);
    if (i < 0) return;
    const c = Math.cos(yaw), s = Math.sin(yaw), points = run.scans[i].points, r = 1.5 * this.pixel_m;
    context.fillStyle = '#e31a1c';
    for (let k = 0; k < points.length; k += 2) {
      const u = points[k] / 100, v = points[k + 1] / 100;
      context.fillRect(x + c * u - s * v - r, y + s * u + c * v - r, 2 * r, 2 * r);
    }
  }
  drawArrow(context, [x, y, yaw], weight) {
    const size = 12 * this.pixel_m;
    context.save();
    context.translate(x, y); context.rotate(yaw); context.scale(size, size);
    context.globalAlpha = 0.6 + 0.4 * weight;
    context.fillStyle = colorOf(this.method.name); context.strokeStyle = weight > 0.05 ? '#fff' : context.fillStyle;
    context.lineWidth = weight > 0.05 ? 0.15 : 0.18;
    context.beginPath(); context.moveTo(0.7, 0); context.lineTo(-0.5, 0.45); context.lineTo(-0.25, 0); context.lineTo(-0.5, -0.45); context.closePath();
    context.stroke();
    if (weight > 0.05) context.fill();
    context.restore();
  }
  drawRobot(context, [x, y, yaw], fill) {
    const r = 8 * this.pixel_m;
    context.lineWidth = 2.5 * this.pixel_m; context.strokeStyle = fill ? '#fff' : css('--truth');
    context.beginPath(); context.arc(x, y, r, 0, 2 * Math.PI);
    if (fill) { context.fillStyle = fill; context.fill(); }
    context.stroke();
    context.beginPath(); context.moveTo(x, y); context.lineTo(x + 1.6 * r * Math.cos(yaw), y + 1.6 * r * Math.sin(yaw)); context.stroke();
  }
}

function lines(valuesOf, ...plotArguments) {
  const curves = run.methods.map(m => [m.d.map((d, i) => d + 1e-7 * i), m.t.map((_, i) => valuesOf(m, i))]);
  // uPlot wants one x for all, growing.
  return plot(...plotArguments.slice(0, 3), run.methods.map(m => ({label: m.name, stroke: colorOf(m.name), spanGaps: true})),
              uPlot.join(curves), {...plotArguments[3], hooks: {draw: [markNow]}});
}
function markNow(u) {
  const method = run.methods[0], i = before(method.t, now);
  if (i < 0) return;
  const x = u.valToPos(method.d[i], 'x', true);
  u.ctx.save(); u.ctx.strokeStyle = css('--quiet'); u.ctx.lineWidth = 1; u.ctx.beginPath();
  u.ctx.moveTo(x, u.bbox.top); u.ctx.lineTo(x, u.bbox.top + u.bbox.height); u.ctx.stroke(); u.ctx.restore();
}

const places = new Map();
async function open(index) {
  element('views').replaceChildren();
  const data = JSON.parse(await inflated(element(`run-${index}`).textContent.trim()));
  if (!places.has(data.place)) places.set(data.place, new Place(JSON.parse(await inflated(element(`place-${data.place}`).textContent.trim()))));
  run = {...data, place: places.get(data.place)};
  run.begin = Math.min(...run.methods.map(m => m.t[0] ?? Infinity), run.scans[0]?.t ?? Infinity);
  run.end = Math.max(...run.methods.map(m => m.t[m.t.length - 1] ?? 0), run.scans[run.scans.length - 1]?.t ?? 0);
  run.views = run.methods.map(m => new View(m));
  const field = run.place.data.field;
  element('legend').textContent = 'Black or white ring: where the robot truly is. Arrows: hypotheses, full where they weigh more than 5 %. '
    + 'Red: the scan, seen from the best hypothesis.' + (field ? ` Field: |B| from ${field.low_uT.toFixed(0)} (violet) to ${field.high_uT.toFixed(0)} µT (yellow).` : '');
  run.plots = [lines((m, i) => m.p[i], 'plot-probability', 'driven (m)', 'probability', {y: {range: [0, 1.02]}})];
  element('figure-off').hidden = !run.truth.t.length;
  if (run.truth.t.length)
    run.plots.push(lines((m, i) => {
      const truth = truePose(m.t[i]), best = bestOf(m, i);
      return truth && best ? Math.max(0.001, Math.hypot(best[0] - truth[0], best[1] - truth[1])) : null;
    }, 'plot-off', 'driven (m)', 'm', {y: {distr: 3}}));
  show(run.begin);
}

function show(t) {
  now = t;
  element('time').value = Math.round(1000 * (t - run.begin) / Math.max(run.end - run.begin, 1e-9));
  const i = before(run.methods[0].t, t);
  element('now').textContent = `${(t - run.begin).toFixed(1)} s, ${i < 0 ? '0.0' : run.methods[0].d[i].toFixed(1)} m`;
  run.views.forEach(view => view.show(t));
  run.plots.forEach(p => p.redraw(false));
}

function play() {
  if (playing) { cancelAnimationFrame(playing); playing = null; element('play').textContent = 'Play'; return; }
  if (now >= run.end) show(run.begin);
  element('play').textContent = 'Pause';
  let last = performance.now();
  const step = time => {
    show(Math.min(run.end, now + 2 * (time - last) / 1000));  // twice as fast as it was
    last = time;
    if (now < run.end) playing = requestAnimationFrame(step); else play();
  };
  playing = requestAnimationFrame(step);
}

if (names.length) {
  element('replay').hidden = false;
  names.forEach((name, i) => element('run').append(new Option(name, i)));
  element('run').addEventListener('change', e => open(Number(e.target.value)));
  element('time').addEventListener('input', e => show(run.begin + e.target.value / 1000 * (run.end - run.begin)));
  element('play').addEventListener('click', play);
  for (const id of ['follow', 'field']) element(id).addEventListener('change', () => show(now));
  addEventListener('resize', () => run && show(now));
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { places.forEach(p => p.paint()); if (run) show(now); });
  open(0).then(() => document.body.dataset.ready = 'yes');
}
