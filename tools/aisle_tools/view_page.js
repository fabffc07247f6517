"use strict";
// Plays the run in #data: a time t (s) and a view decide every drawing. The attributes of #run tell the state to tests.

const $ = (id) => document.getElementById(id);
const run = $("run");
let D; // the run
const S = { t: 0, playing: false, rate: 1, scale: 40, cx: 0, cy: 0, follow: false, reply: null, mover: null, last: 0, asked: false };
const C = {}; // colours of the theme
const STATES = ["idle", "idle", "idle", "idle", "drive", "stop", "held", "fault"];
const MOVERS = ["unknown mover", "person", "vehicle", "standing thing"];
const KINDS = ["unknown", "person", "mover", "static"];
const YIELDING = 301, BLOCKED_BY = 204, TRAIL = 5;

// ---- data
async function unpack(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).json();
}

function column(steps, scale) {
  const out = new Float64Array(steps.length);
  let sum = 0;
  for (let i = 0; i < steps.length; i++) out[i] = (sum += steps[i]) / scale;
  return out;
}

function decodePath(p) {
  if (!p.x) return;
  p.x = column(p.x, 1000);
  p.y = column(p.y, 1000);
  p.v = column(p.v, 100);
  if (p.t && p.th) {
    p.at = column(p.t, 1000);
    p.th = column(p.th, 1000);
  }
}

function decodePoses(q) {
  const v = column(q.v, 1000);
  return { t: column(q.t, 1000), x: column(q.x, 1000), y: column(q.y, 1000), th: column(q.th, 1000), v, speed: v.map(Math.abs), lost: new Set(q.lost) };
}

function decodeSource(s) {
  s.t = column(s.t, 1000);
  s.stamp = column(s.stamp, 1000);
  s.first = new Uint32Array(s.count.length + 1);
  for (let i = 0; i < s.count.length; i++) s.first[i + 1] = s.first[i] + s.count[i];
  for (const key of Object.keys(D.movers.scales)) s[key] = perMover(s.id, s[key], D.movers.scales[key]);
  s.tracks = tracksOf(s);
}

// Of each mover its rows and their times.
function tracksOf(s) {
  const tracks = new Map();
  for (let k = 0; k < s.t.length; k++) {
    for (let row = s.first[k]; row < s.first[k + 1]; row++) {
      if (!tracks.has(s.id[row])) tracks.set(s.id[row], { t: [], rows: [] });
      tracks.get(s.id[row]).t.push(s.t[k]);
      tracks.get(s.id[row]).rows.push(row);
    }
  }
  return tracks;
}

function perMover(ids, steps, scale) {
  const last = new Map(), out = new Float32Array(steps.length);
  for (let i = 0; i < steps.length; i++) {
    const value = (last.get(ids[i]) || 0) + steps[i];
    last.set(ids[i], value);
    out[i] = value / scale;
  }
  return out;
}

function decode() {
  D.poses = decodePoses(D.poses);
  D.gap = column(D.gap, 100);
  for (const s of D.movers.sources) decodeSource(s);
  D.paths.forEach(decodePath);
  D.replies.forEach(decodePath);
  const r = D.remaining;
  r.t = column(r.t, 1000);
  r.m = column(r.m, 100);
  r.s = column(r.s, 10);
  D.ofQueries = D.poses.t.length === 0 && D.paths.length === 0;
  D.run = { poses: D.poses, begin: D.begin, end: D.end };
}

// Index of the last entry at or before t, -1 if none.
function before(times, t) {
  let lo = 0, hi = times.length;
  while (lo < hi) {
    const mid = (lo + hi) >> 1;
    if (times[mid] <= t) lo = mid + 1;
    else hi = mid;
  }
  return lo - 1;
}

function entryAt(list, t) {
  let found = null;
  for (const e of list) {
    if (e.t > t + 1e-9) break;
    found = e;
  }
  return found;
}

// Of a reply to look at: its own layout and vehicle; else those in force.
function layoutAt(t) {
  const own = D.ofQueries && S.reply && D.layouts.find((l) => String(l.key) === String(S.reply.map));
  return own || entryAt(D.layouts, t) || D.layouts[0];
}

function bodyAt(t) {
  const own = D.ofQueries && S.reply && D.bodies.find((b) => b.rev === S.reply.vehicle);
  return own || entryAt(D.bodies, t) || D.bodies[0];
}

function poseAt(t) {
  const p = D.run.poses;
  const i = before(p.t, t + 1e-6);
  if (i < 0) return null;
  const pose = { i, t: p.t[i], x: p.x[i], y: p.y[i], th: p.th[i], v: p.v[i], lost: p.lost.has(i) };
  const gap = p.t[i + 1] - p.t[i];
  if (!(gap < (D.ofQueries ? Infinity : 1))) return pose; // poses that stay away are not made up
  const f = (t - p.t[i]) / gap;
  for (const k of ["x", "y", "th", "v"]) pose[k] += f * (p[k][i + 1] - p[k][i]);
  return pose;
}

function leaseLeft(path, t) {
  let until = null;
  for (const [sent, end] of path.lease) if (sent <= t + 1e-9) until = end;
  return until === null ? null : until - t;
}

function goalsAt(t) {
  return entryAt(D.goals, t);
}

// ---- movers
function moversAt(t) {
  const list = [];
  for (const s of D.movers.sources) {
    const k = before(s.t, t + 1e-6);
    if (k < 0) continue;
    for (let row = s.first[k]; row < s.first[k + 1]; row++) list.push(moverOf(s, k, row, t));
  }
  return list;
}

// As measured, and moved on with its speed to t for the eye (at most a second).
function moverOf(s, k, row, t) {
  const [id, source, kind, r, whole, spread, bound, corners] = D.movers.traits[s.trait[row]];
  const age = Math.max(0, t - s.stamp[k]);
  const on = Math.min(age, 1);
  return {
    from: s, id, source, kind, r, whole, corners, age, bound, x0: s.x[row], y0: s.y[row], x: s.x[row] + on * s.vx[row], y: s.y[row] + on * s.vy[row],
    th: s.theta[row], vx: s.vx[row], vy: s.vy[row], reach: whole + spread + bound * age,
  };
}

function trailOf(s, id, t) {
  const track = s.tracks.get(id), points = [];
  for (let i = before(track.t, t + 1e-6); i >= 0 && track.t[i] > t - TRAIL; i--) {
    points.push([s.x[track.rows[i]], s.y[track.rows[i]]]);
  }
  return points;
}

// ---- colours
function readTheme() {
  const style = getComputedStyle(document.documentElement);
  const names = "page panel line text soft accent floor outside solid wall obstacle keepout limit penalty directed vehicle old-path";
  for (const name of (names + " person mover unknown static drive idle wait stop held fault").split(" ")) {
    C[name] = style.getPropertyValue("--" + name).trim();
  }
  for (const l of D.layouts) if (l.image) l.picture = paintGrid(l.image);
  drawLegend();
  redraw();
}

function setTheme(name) {
  document.documentElement.dataset.theme = name;
  run.dataset.theme = name;
  readTheme();
}

function rgb(text) {
  const n = parseInt(text.slice(1), 16);
  return [n >> 16, (n >> 8) & 255, n & 255];
}

function paintGrid(image) {
  const canvas = document.createElement("canvas");
  canvas.width = image.width;
  canvas.height = image.height;
  const ctx = canvas.getContext("2d");
  ctx.drawImage(image, 0, 0);
  const data = ctx.getImageData(0, 0, canvas.width, canvas.height);
  const shades = [rgb(C.floor), rgb(C.solid), rgb(C.wall)];
  for (let i = 0; i < data.data.length; i += 4) data.data.set(shades[Math.round(data.data[i] / 100)], i);
  ctx.putImageData(data, 0, 0);
  return canvas;
}

// Slow red over yellow to fast blue-green, by share of the top speed.
function speedColour(share) {
  return `hsl(${Math.round(5 + 165 * Math.min(1, Math.max(0, share)))} 80% ${run.dataset.theme === "dark" ? 58 : 42}%)`;
}

const kindColour = (kind) => C[KINDS[kind]] || C.unknown;

// ---- drawing the scene
function fitCanvas(canvas) {
  const ratio = window.devicePixelRatio || 1;
  const w = Math.max(1, Math.round(canvas.clientWidth * ratio)), h = Math.max(1, Math.round(canvas.clientHeight * ratio));
  if (canvas.width !== w || canvas.height !== h) {
    canvas.width = w;
    canvas.height = h;
  }
  const ctx = canvas.getContext("2d");
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  ctx.clearRect(0, 0, canvas.clientWidth, canvas.clientHeight);
  return ctx;
}

const sx = (x) => $("scene").clientWidth / 2 + (x - S.cx) * S.scale;
const sy = (y) => $("scene").clientHeight / 2 - (y - S.cy) * S.scale;

function inMetres(ctx) {
  const ratio = window.devicePixelRatio || 1, k = S.scale * ratio;
  ctx.setTransform(k, 0, 0, -k, ratio * sx(0), ratio * sy(0));
}

const px = (n) => n / S.scale; // metres of so many pixels

function shapePath(corners) {
  const path = new Path2D();
  corners.forEach(([x, y], i) => (i ? path.lineTo(x, y) : path.moveTo(x, y)));
  path.closePath();
  return path;
}

function drawLayout(ctx, layout) {
  const [x0, y0, x1, y1] = layout.bounds;
  ctx.fillStyle = C.floor;
  ctx.fillRect(x0, y0, x1 - x0, y1 - y0);
  if (layout.picture) drawGrid(ctx, layout);
  layout.shapes = layout.shapes || layout.polygons.map((p) => shapePath(p.v));
  const looks = [C.obstacle, C.keepout, C.limit, C.penalty, C.directed];
  for (const kind of [3, 4, 2, 1, 0]) {
    layout.polygons.forEach((p, i) => p.kind === kind && drawPolygon(ctx, p, layout.shapes[i], looks[kind]));
  }
  ctx.strokeStyle = C.soft;
  ctx.lineWidth = px(1.5);
  ctx.strokeRect(x0, y0, x1 - x0, y1 - y0);
}

function drawGrid(ctx, layout) {
  const g = layout.grid;
  ctx.save();
  ctx.scale(1, -1);
  ctx.imageSmoothingEnabled = S.scale * (g.w / layout.picture.width) < 1;
  ctx.drawImage(layout.picture, g.x, -(g.y + g.h), g.w, g.h);
  ctx.restore();
}

function drawPolygon(ctx, p, shape, colour) {
  ctx.fillStyle = colour;
  ctx.globalAlpha = p.kind >= 2 ? 0.55 : 1;
  ctx.fill(shape);
  ctx.globalAlpha = 1;
  ctx.strokeStyle = colour;
  ctx.lineWidth = px(1);
  ctx.stroke(shape);
  if (p.kind === 4) drawDirection(ctx, p);
}

function drawDirection(ctx, p) {
  const n = p.v.length, x = p.v.reduce((a, v) => a + v[0], 0) / n, y = p.v.reduce((a, v) => a + v[1], 0) / n;
  arrow(ctx, x, y, x + 0.6 * Math.cos(p.dir), y + 0.6 * Math.sin(p.dir), C.soft, 1.5);
}

function arrow(ctx, x0, y0, x1, y1, colour, width) {
  const a = Math.atan2(y1 - y0, x1 - x0), h = px(8);
  ctx.strokeStyle = colour;
  ctx.lineWidth = px(width);
  ctx.beginPath();
  ctx.moveTo(x0, y0);
  ctx.lineTo(x1, y1);
  ctx.moveTo(x1 - h * Math.cos(a - 0.45), y1 - h * Math.sin(a - 0.45));
  ctx.lineTo(x1, y1);
  ctx.lineTo(x1 - h * Math.cos(a + 0.45), y1 - h * Math.sin(a + 0.45));
  ctx.stroke();
}

function lineOf(path) {
  if (!path.line) {
    path.line = new Path2D();
    for (let i = 0; i < path.x.length; i++) path.line[i ? "lineTo" : "moveTo"](path.x[i], path.y[i]);
  }
  return path.line;
}

function drawOldPaths(ctx, t) {
  ctx.strokeStyle = C["old-path"];
  ctx.lineWidth = px(1);
  ctx.globalAlpha = 0.3;
  for (const p of D.paths) {
    if (p.t > t) break;
    if (p.x) ctx.stroke(lineOf(p));
  }
  ctx.globalAlpha = 1;
}

function drawPath(ctx, path, vMax) {
  if (!path.x) return drawHints(ctx, path.hints);
  path.strokes = path.strokes || strokesOf(path, vMax);
  ctx.lineCap = ctx.lineJoin = "round";
  for (const s of path.strokes) {
    ctx.strokeStyle = speedColour(s.share);
    ctx.lineWidth = px(s.base ? 7 : 3.5);
    ctx.stroke(s.line);
  }
  if (path.status === 1 || path.status === 2) drawEnd(ctx, path);
}

// Stretches of nearly one speed, of the base and of the rest.
function strokesOf(path, vMax) {
  const out = [];
  for (let i = 1; i < path.x.length; i++) {
    const base = i <= path.base, share = Math.round((20 * (path.v[i - 1] + path.v[i])) / 2 / vMax) / 20;
    let s = out[out.length - 1];
    if (!s || s.base !== base || s.share !== share) {
      out.push((s = { base, share, line: new Path2D() }));
      s.line.moveTo(path.x[i - 1], path.y[i - 1]);
    }
    s.line.lineTo(path.x[i], path.y[i]);
  }
  return out;
}

function drawEnd(ctx, path) {
  const i = path.x.length - 1;
  ctx.fillStyle = C.stop;
  ctx.fillRect(path.x[i] - px(5), path.y[i] - px(5), px(10), px(10));
}

function drawHints(ctx, h) {
  if (!h) return;
  if (h.place) cross(ctx, h.place, C.stop);
  if (h.place && h.free) arrow(ctx, ...h.place, ...h.free, C.mover, 2);
  if (h.gap.length === 2) strokeLine(ctx, h.gap, C.stop, 3);
  for (const [x, y] of h.without) {
    ctx.strokeStyle = C.mover;
    ctx.lineWidth = px(2);
    ctx.strokeRect(x - px(7), y - px(7), px(14), px(14));
  }
}

function cross(ctx, [x, y], colour) {
  strokeLine(ctx, [[x - px(7), y - px(7)], [x + px(7), y + px(7)]], colour, 3);
  strokeLine(ctx, [[x - px(7), y + px(7)], [x + px(7), y - px(7)]], colour, 3);
}

function strokeLine(ctx, points, colour, width) {
  ctx.strokeStyle = colour;
  ctx.lineWidth = px(width);
  ctx.beginPath();
  points.forEach(([x, y], i) => (i ? ctx.lineTo(x, y) : ctx.moveTo(x, y)));
  ctx.stroke();
}

function drawBody(ctx, x, y, th, corners, r, colour, alpha) {
  ctx.save();
  ctx.translate(x, y);
  ctx.rotate(th);
  const shape = corners.length ? shapePath(corners) : new Path2D();
  if (!corners.length) shape.arc(0, 0, r, 0, 2 * Math.PI);
  ctx.fillStyle = ctx.strokeStyle = colour;
  ctx.lineJoin = "round";
  ctx.globalAlpha = alpha;
  ctx.fill(shape);
  ctx.globalAlpha = 1;
  ctx.lineWidth = px(2) + (corners.length ? 2 * r : 0);
  ctx.stroke(shape);
  ctx.restore();
}

function drawVehicle(ctx, pose, body) {
  ctx.setLineDash([px(4), px(3)]);
  drawMargin(ctx, pose, body);
  ctx.setLineDash([]);
  drawBody(ctx, pose.x, pose.y, pose.th, body.v, body.r, pose.lost ? C.stop : C.vehicle, 0.3);
  const ahead = body.r + Math.max(0, ...body.v.map((v) => v[0]));
  arrow(ctx, pose.x, pose.y, pose.x + ahead * Math.cos(pose.th), pose.y + ahead * Math.sin(pose.th), pose.lost ? C.stop : C.vehicle, 2.5);
}

// Outline of footprint + margin: rounding strokes would fill, so corners are pushed outwards from the middle of each side.
function drawMargin(ctx, pose, body) {
  ctx.save();
  ctx.translate(pose.x, pose.y);
  ctx.rotate(pose.th);
  ctx.strokeStyle = C.vehicle;
  ctx.lineWidth = px(1);
  const d = body.r + body.margin;
  ctx.beginPath();
  if (!body.v.length) ctx.arc(0, 0, d, 0, 2 * Math.PI);
  body.v.forEach((a, i) => {
    const b = body.v[(i + 1) % body.v.length], normal = Math.atan2(b[1] - a[1], b[0] - a[0]) - Math.PI / 2;
    const z = body.v[(i + body.v.length - 1) % body.v.length], from = Math.atan2(a[1] - z[1], a[0] - z[0]) - Math.PI / 2;
    ctx.arc(a[0], a[1], d, from, normal);
  });
  ctx.closePath();
  ctx.stroke();
  ctx.restore();
}

function drawMovers(ctx, t, movers, blocker) {
  if ($("show-reach").checked) for (const m of movers) drawReach(ctx, m, m.id === blocker);
  for (const m of movers) {
    const colour = kindColour(m.kind);
    if ($("show-trails").checked) {
      ctx.globalAlpha = 0.5;
      strokeLine(ctx, [[m.x, m.y], ...trailOf(m.from, m.id, t)], colour, 1.5);
      ctx.globalAlpha = 1;
    }
    drawBody(ctx, m.x, m.y, m.th, m.corners, m.r, colour, 0.55);
    if (Math.hypot(m.vx, m.vy) > 0.05) arrow(ctx, m.x, m.y, m.x + m.vx, m.y + m.vy, colour, 2);
  }
}

function drawReach(ctx, m, isBlocker) {
  ctx.beginPath();
  ctx.arc(m.x0, m.y0, m.reach, 0, 2 * Math.PI);
  ctx.fillStyle = ctx.strokeStyle = isBlocker ? C.stop : kindColour(m.kind);
  ctx.globalAlpha = 0.12;
  ctx.fill();
  ctx.globalAlpha = isBlocker ? 1 : 0.6;
  ctx.lineWidth = px(isBlocker ? 2 : 1);
  ctx.setLineDash([px(5), px(4)]);
  ctx.stroke();
  ctx.setLineDash([]);
  ctx.globalAlpha = 1;
}

function drawTie(ctx, pose, movers, blocker) {
  const m = movers.find((q) => q.id === blocker);
  if (!m || !pose) return;
  ctx.setLineDash([px(2), px(5)]);
  strokeLine(ctx, [[pose.x, pose.y], [m.x, m.y]], C.stop, 2);
  ctx.setLineDash([]);
}

function drawGoals(ctx, t) {
  const list = goalsAt(t);
  if (!list) return;
  for (const g of list.goals) {
    const done = g.done !== null && g.done <= t;
    ctx.fillStyle = ctx.strokeStyle = done ? C.drive : C.accent;
    ctx.lineWidth = px(2);
    ctx.beginPath();
    ctx.arc(g.x, g.y, px(8), 0, 2 * Math.PI);
    if (done) ctx.fill();
    ctx.stroke();
    if (g.th !== null) arrow(ctx, g.x, g.y, g.x + px(22) * Math.cos(g.th), g.y + px(22) * Math.sin(g.th), ctx.strokeStyle, 2);
  }
}

function label(ctx, x, y, text, colour) {
  ctx.font = "600 12px system-ui, sans-serif";
  ctx.lineWidth = 3;
  ctx.strokeStyle = C.floor;
  ctx.fillStyle = colour;
  const wide = ctx.measureText(text).width, right = sx(x) + 10 + wide > $("scene").clientWidth;
  const left = right ? sx(x) - 10 - wide : sx(x) + 10;
  ctx.strokeText(text, left, sy(y) - 9);
  ctx.fillText(text, left, sy(y) - 9);
}

function drawLabels(ctx, t, movers) {
  if (!$("show-names").checked) return;
  for (const m of movers) label(ctx, m.x, m.y, String(m.id), kindColour(m.kind));
  const list = goalsAt(t);
  for (const g of list ? list.goals : []) label(ctx, g.x, g.y, (g.done !== null && g.done <= t ? "✓ goal " : "goal ") + g.id, g.done !== null && g.done <= t ? C.drive : C.accent);
  if (S.reply) S.reply.stops.forEach(([x, y], i) => label(ctx, x, y, i ? "goal " + i : "start", C.accent));
  const h = S.reply && S.reply.hints;
  if (h) h.without.forEach(([x, y, id]) => label(ctx, x, y, "without " + id, C.mover));
}

function drawStops(ctx, reply) {
  reply.stops.forEach(([x, y], i) => {
    ctx.beginPath();
    ctx.arc(x, y, px(7), 0, 2 * Math.PI);
    ctx.lineWidth = px(2);
    ctx.strokeStyle = C.accent;
    ctx.stroke();
    ctx.fillStyle = i ? C.accent : C.floor;
    ctx.fill();
  });
  if (!reply.x && reply.stops.length > 1) {
    ctx.setLineDash([px(4), px(5)]);
    strokeLine(ctx, reply.stops, C.stop, 1);
    ctx.setLineDash([]);
  }
}

const blockerAt = (status) => (status && (status.cause === YIELDING || status.cause === BLOCKED_BY) ? status.by : null);

function drawScene(now) {
  const ctx = fitCanvas($("scene"));
  ctx.fillStyle = C.outside;
  ctx.fillRect(0, 0, $("scene").clientWidth, $("scene").clientHeight);
  inMetres(ctx);
  drawLayout(ctx, layoutAt(S.t));
  if ($("show-old").checked) drawOldPaths(ctx, S.t);
  const body = bodyAt(S.t);
  if (S.reply) {
    drawStops(ctx, S.reply);
    ctx.globalAlpha = D.ofQueries ? 1 : 0.45;
    drawPath(ctx, S.reply, body.v_max);
    ctx.globalAlpha = 1;
  }
  if (now.path) drawPath(ctx, now.path, body.v_max);
  drawGoals(ctx, S.t);
  drawMovers(ctx, S.t, now.movers, now.blocker);
  drawTie(ctx, now.pose, now.movers, now.blocker);
  if (now.pose) drawVehicle(ctx, now.pose, body);
  const ratio = window.devicePixelRatio || 1;
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  drawLabels(ctx, S.t, now.movers);
  drawScaleBar();
}

function drawScaleBar() {
  const want = 90 / S.scale, ten = 10 ** Math.floor(Math.log10(want));
  const metres = [5, 2, 1].find((k) => k * ten <= want) * ten;
  $("scalebar").firstElementChild.textContent = metres + " m";
  $("scalebar").lastElementChild.style.width = metres * S.scale + "px";
}

// ---- plots under the scene
const timeX = (t, w) => ((t - D.run.begin) / (D.run.end - D.run.begin || 1)) * w;

function drawPlot(id, values, times, top, unit, colour, extra) {
  const canvas = $(id), ctx = fitCanvas(canvas), w = canvas.clientWidth, h = canvas.clientHeight;
  const y = (v) => h - 3 - (Math.min(v, top) / top) * (h - 20);
  ctx.strokeStyle = C.line;
  ctx.beginPath();
  ctx.moveTo(0, y(0));
  ctx.lineTo(w, y(0));
  ctx.stroke();
  if (extra !== null) dashed(ctx, y(extra), w);
  ctx.strokeStyle = colour;
  ctx.lineWidth = 1.4;
  ctx.stroke(curveOf(id, values, times, w, y));
  caption(ctx, unit);
  cursor(ctx, w, h);
}

const curves = {};

// A line with gaps where nothing is known; made anew only for another run or size.
function curveOf(id, values, times, w, y) {
  const key = [w, y(0), y(1), D.run.end].join();
  if (!curves[id] || curves[id].key !== key || curves[id].values !== values) {
    curves[id] = { key, values, path: trace(values, times, w, y) };
  }
  return curves[id].path;
}

function trace(values, times, w, y) {
  const path = new Path2D();
  let open = false;
  for (let i = 0; i < values.length; i++) {
    if (values[i] < 0 || !(values[i] <= 1e9)) {
      open = false;
      continue;
    }
    const x = timeX(times[i], w);
    path[open ? "lineTo" : "moveTo"](x, y(values[i]));
    open = true;
  }
  return path;
}

function dashed(ctx, y, w) {
  ctx.save();
  ctx.setLineDash([3, 4]);
  ctx.strokeStyle = C.stop;
  ctx.beginPath();
  ctx.moveTo(0, y);
  ctx.lineTo(w, y);
  ctx.stroke();
  ctx.restore();
}

function caption(ctx, text) {
  ctx.font = "11px system-ui, sans-serif";
  ctx.fillStyle = C.soft;
  ctx.fillText(text, 4, 12);
}

function cursor(ctx, w, h) {
  ctx.strokeStyle = C.accent;
  ctx.lineWidth = 1.5;
  ctx.beginPath();
  ctx.moveTo(timeX(S.t, w), 0);
  ctx.lineTo(timeX(S.t, w), h);
  ctx.stroke();
}

function drawStrip() {
  const canvas = $("strip"), ctx = fitCanvas(canvas), w = canvas.clientWidth, h = canvas.clientHeight;
  D.status.forEach((s, i) => {
    const next = D.status[i + 1], end = next ? next.t : D.run.end;
    if (end < D.run.begin || s.t > D.run.end) return;
    ctx.fillStyle = C[toneOf(s)];
    ctx.fillRect(timeX(Math.max(s.t, D.run.begin), w), 2, Math.max(1, timeX(end, w) - timeX(Math.max(s.t, D.run.begin), w)), h - 4);
  });
  cursor(ctx, w, h);
}

function drawPlots(now) {
  const p = D.run.poses;
  if (D.ofQueries && !S.reply) return;
  drawPlot("speed", p.speed, p.t, 1.15 * Math.max(bodyAt(S.t).v_max, 0.1), "speed, m/s" + (now.pose ? ": " + Math.abs(now.pose.v).toFixed(2) : ""), C.vehicle, null);
  if (D.ofQueries) return;
  const gap = now.pose ? D.gap[now.pose.i] : -1;
  drawPlot("gap", D.gap, p.t, 5, "least gap to movers, m" + (gap >= 0 ? ": " + gap.toFixed(2) : "") + " (up to 5)", C.mover, bodyAt(S.t).margin);
  drawStrip();
}

function toneOf(s) {
  if (!s) return "idle";
  return s.state === 4 && s.cause ? "wait" : STATES[s.state] || "idle";
}

// ---- texts
function fact(list, name, value) {
  if (value === null || value === "") return;
  const dt = document.createElement("dt"), dd = document.createElement("dd");
  dt.textContent = name;
  dd.append(...[value].flat());
  list.append(dt, dd);
}

function meter(share) {
  const box = document.createElement("span"), bar = document.createElement("i");
  box.className = "meter";
  bar.style.width = 100 * Math.min(1, Math.max(0, share)) + "%";
  if (share < 0.2) bar.style.background = C.stop;
  box.append(bar);
  return box;
}

function showFacts(now) {
  const list = document.createElement("dl");
  if (now.pose) {
    fact(list, "pose", `${now.pose.x.toFixed(2)}, ${now.pose.y.toFixed(2)} m, ${((now.pose.th * 180) / Math.PI).toFixed(0)}°` + (now.pose.lost ? ", not localised" : ""));
    fact(list, "speed", now.pose.v.toFixed(2) + " m/s");
  }
  if (!D.ofQueries) factsOfRun(list, now);
  if (S.reply) factsOfReply(list, S.reply);
  const chosen = now.movers.find((m) => m.id === S.mover);
  if (chosen) factsOfMover(list, chosen, now.pose);
  $("facts").replaceChildren(...list.childNodes);
}

function factsOfRun(list, now) {
  const r = before(D.remaining.t, S.t), status = now.status;
  if (r >= 0) fact(list, "to go", `${D.remaining.m[r].toFixed(1)} m, ${D.remaining.s[r].toFixed(0)} s`);
  if (status && status.goal) fact(list, "goal", String(status.goal));
  if (!now.path) return;
  fact(list, "path", `revision ${now.path.rev}, ${now.path.result}: ${now.path.why}`);
  const left = leaseLeft(now.path, S.t);
  if (now.path.x) fact(list, "lease", [left > 0 ? left.toFixed(2) + " s left" : "run out", meter(left)]);
  const gap = now.pose ? D.gap[now.pose.i] : -1;
  if (gap >= 0) fact(list, "least gap", gap >= 10 ? "10 m or more" : gap.toFixed(2) + " m");
}

function factsOfMover(list, m, pose) {
  const away = pose ? `, ${Math.hypot(m.x - pose.x, m.y - pose.y).toFixed(2)} m away` : "";
  const measured = `, measured ${m.age.toFixed(2)} s ago`;
  fact(list, "mover " + m.id, `${MOVERS[m.kind] || "mover"}, ${Math.hypot(m.vx, m.vy).toFixed(2)} of at most ${m.bound.toFixed(2)} m/s${away}${measured}, reach ${m.reach.toFixed(2)} m`);
}

function factsOfReply(list, r) {
  fact(list, "query", `${r.query}: ${r.result}${r.x ? "" : ", " + r.why}`);
  if (r.x) fact(list, "length", `${r.length.toFixed(2)} m (at least ${r.bound.toFixed(2)}), ${r.duration.toFixed(1)} s, clearance ${r.clearance.toFixed(3)} m`);
}

function eventRows() {
  const rows = [];
  for (const s of D.status) rows.push({ t: s.t, text: s.text, tone: toneOf(s) });
  for (const c of D.commands) rows.push({ t: c.t, text: c.text, tone: "held" });
  for (const g of D.goals) {
    rows.push({ t: g.t, text: g.goals.length ? `${g.goals.length} goal${g.goals.length > 1 ? "s" : ""} given` : "goals cancelled", tone: "held" });
    for (const one of g.goals) if (one.done !== null) rows.push({ t: one.done, text: `goal ${one.id} done`, tone: "drive" });
  }
  for (const l of D.layouts.slice(1)) rows.push({ t: l.t, text: "layout changed", tone: "held" });
  return rows.filter((r) => r.t <= D.end).sort((a, b) => a.t - b.t);
}

function buildEvents() {
  D.events = eventRows();
  for (const e of D.events) {
    const li = document.createElement("li"), button = document.createElement("button"), time = document.createElement("time"), text = document.createElement("span");
    button.className = "row tone-" + e.tone;
    time.textContent = e.t.toFixed(1) + " s";
    text.textContent = e.text;
    button.append(time, text);
    button.onclick = () => seek(e.t);
    li.append(button);
    $("events").append(li);
    e.row = button;
  }
}

function cells(tr, values) {
  for (const [text, numeric] of values) {
    const td = document.createElement("td");
    td.textContent = text;
    if (numeric) td.className = "n";
    tr.append(td);
  }
}

function rowFor(body, tone, values, onclick) {
  const tr = document.createElement("tr");
  tr.className = "tone-" + tone;
  tr.tabIndex = 0;
  cells(tr, values);
  tr.onclick = onclick;
  tr.onkeydown = (e) => {
    if (e.key === "Enter") onclick();
  };
  body.append(tr);
  return tr;
}

function toneOfPath(p) {
  if (p.status === 3) return "stop";
  return p.status !== 0 || p.cause ? "wait" : "drive";
}

function buildTables() {
  $("paths-count").textContent = `(${D.paths.length})`;
  for (const p of D.paths) {
    const why = p.change + (p.why === "free way" ? "" : "; " + p.why);
    p.row = rowFor($("paths"), toneOfPath(p), [[p.t.toFixed(2), 1], [p.rev, 1], [why], [p.x ? p.length.toFixed(1) : "-", 1], [p.x ? p.duration.toFixed(1) : "-", 1]], () => seek(p.t));
  }
  $("replies-count").textContent = `(${D.replies.length})`;
  for (const r of D.replies) {
    const values = [[r.query, 1], [r.x ? r.result : r.why], [r.x ? r.length.toFixed(2) : "-", 1], [r.x ? r.bound.toFixed(2) : "-", 1], [r.x ? r.duration.toFixed(1) : "-", 1]];
    r.row = rowFor($("replies"), toneOfPath(r), values, () => choose(S.reply === r && !D.ofQueries ? null : r));
  }
  $("paths-box").classList.toggle("hide", D.paths.length === 0);
  $("events-box").classList.toggle("hide", D.events.length === 0 || D.ofQueries);
  $("replies-box").classList.toggle("hide", D.replies.length === 0);
  if (D.paths.length) $("replies-box").classList.replace("grow2", "small");
  for (const id of ["gap", "strip"]) $(id).classList.toggle("hide", D.ofQueries);
}

function mark(list, current) {
  if (list.marked === current) return;
  if (list.marked) list.marked.row.classList.remove("now");
  list.marked = current;
  if (!current) return;
  current.row.classList.add("now");
  const box = current.row.closest(".scroll"), row = current.row;
  const top = row.getBoundingClientRect().top - box.getBoundingClientRect().top + box.scrollTop;
  if (top < box.scrollTop + 24 || top + row.offsetHeight > box.scrollTop + box.clientHeight) box.scrollTop = top - box.clientHeight / 2;
}

// A swatch for each thing drawn.
function drawLegend() {
  const used = new Set(D.layouts.flatMap((l) => l.polygons.map((p) => p.kind)));
  const box = (colour, o = 1) => `<rect x="2" y="2" width="16" height="12" rx="2" fill="${colour}" fill-opacity="${o}" stroke="${colour}"/>`;
  const line = (colour, w, dash = "") => `<path d="M1 8H19" stroke="${colour}" stroke-width="${w}" stroke-dasharray="${dash}"/>`;
  const ring = (colour, fill, dash = "") => `<circle cx="10" cy="8" r="6" stroke="${colour}" stroke-width="1.5" fill="${fill}" stroke-dasharray="${dash}"/>`;
  const items = [[box(C.vehicle, 0.3), "vehicle, margin dashed"], [line(speedColour(1), 3), "path, fast"], [line(speedColour(0), 3), "path, slow"]];
  items.push([line(speedColour(0.5), 7), "base: cannot change"]);
  if (!D.ofQueries) items.push([ring(C.accent, "none"), "goal"], [ring(C.drive, C.drive), "goal done"]);
  if (D.movers.traits.length) items.push(...legendOfMovers(ring));
  ["obstacle", "keepout", "limit", "penalty", "directed"].forEach((name, kind) => used.has(kind) && items.push([box(C[name], kind >= 2 ? 0.55 : 1), D.kinds[kind]]));
  if (D.layouts.some((l) => l.grid)) items.push([box(C.wall), "scanned wall"]);
  $("legend").innerHTML = items.map(([svg, text]) => `<span><svg width="20" height="16" aria-hidden="true">${svg}</svg>${text}</span>`).join("");
}

function legendOfMovers(ring) {
  const kinds = new Set(D.movers.traits.map((t) => t[2]));
  const items = [...kinds].sort().map((k) => [ring(kindColour(k), kindColour(k)), MOVERS[k] || "mover"]);
  return [...items, [ring(C.soft, "none", "3 2"), "where it may be by now"], [ring(C.stop, "none", "3 2"), "the one given way to"]];
}

// ---- one frame
function stateAt(t) {
  const path = D.ofQueries ? null : entryAt(D.paths, t), status = entryAt(D.status, t);
  return { pose: poseAt(t), path, status, movers: moversAt(t), blocker: blockerAt(status) };
}

function causeText(now) {
  if (!D.ofQueries) return now.status ? now.status.text : "no status yet";
  if (!S.reply) return "choose a reply";
  return S.reply.x ? `query ${S.reply.query}: ${S.reply.result}` : `query ${S.reply.query}: ${S.reply.why}`;
}

function showState(now) {
  const tone = D.ofQueries ? (S.reply ? toneOfPath(S.reply) : "idle") : toneOf(now.status);
  $("cause").className = "tone-" + tone;
  if ($("cause").textContent !== causeText(now)) $("cause").textContent = causeText(now);
  $("clock").textContent = `${S.t.toFixed(2)} of ${D.run.end.toFixed(1)} s`;
  $("slider").value = S.t;
  $("slider").setAttribute("aria-valuetext", S.t.toFixed(1) + " s, " + causeText(now));
  mark(D.events, entryAt(D.events, S.t));
  mark(D.paths, now.path);
  mark(D.replies, S.reply);
  const shown = { time: S.t.toFixed(3), scale: S.scale.toFixed(3), cx: S.cx.toFixed(3), cy: S.cy.toFixed(3), playing: S.playing, cause: now.status ? now.status.name : "", revision: now.path ? now.path.rev : "", reply: S.reply ? S.reply.query : "" };
  if (now.pose) Object.assign(shown, { x: now.pose.x.toFixed(3), y: now.pose.y.toFixed(3), theta: now.pose.th.toFixed(3) });
  Object.assign(run.dataset, shown);
}

function draw() {
  const now = stateAt(S.t);
  if (S.follow && now.pose) [S.cx, S.cy] = [now.pose.x, now.pose.y];
  drawScene(now);
  drawPlots(now);
  showFacts(now);
  showState(now);
}

function frame(stamp) {
  S.asked = false;
  if (S.playing) advance(Math.min(250, Math.max(0, stamp - S.last)));
  S.last = stamp;
  draw();
  if (S.playing) redraw();
}

function advance(ms) {
  S.t = Math.min(D.run.end, S.t + (S.rate * ms) / 1000);
  if (S.t >= D.run.end) setPlaying(false);
}

// Once a screen refresh at most.
function redraw() {
  if (S.asked) return;
  S.asked = true;
  requestAnimationFrame(frame);
}

// ---- controls
function seek(t) {
  S.t = Math.min(D.run.end, Math.max(D.run.begin, t));
  redraw();
}

function setPlaying(on) {
  if (on && S.t >= D.run.end) S.t = D.run.begin;
  S.playing = on;
  $("play").querySelector("path").setAttribute("d", on ? "M4 3h2.5v10H4zM9.5 3H12v10H9.5z" : "M4 2.5 13 8l-9 5.5z");
  $("play").setAttribute("aria-label", on ? "Pause" : "Play");
  S.last = performance.now();
  redraw();
}

function stepEvent(way) {
  const list = D.events.map((e) => e.t);
  const next = way > 0 ? list.find((t) => t > S.t + 1e-3) : list.filter((t) => t < S.t - 1e-3).pop();
  if (next !== undefined) seek(next);
}

function stepPose(way) {
  const p = D.run.poses.t, i = before(p, S.t + 1e-6) + way;
  if (i >= 0 && i < p.length) seek(p[i]);
}

// A reply's own path is played where the log has no run.
function choose(reply) {
  S.reply = reply;
  if (D.ofQueries) {
    const none = { t: [], x: [], y: [], th: [], v: [], speed: [], lost: new Set() };
    const poses = reply.x ? { ...none, t: reply.at, x: reply.x, y: reply.y, th: reply.th, v: reply.v, speed: reply.v } : none;
    D.run = { poses, begin: 0, end: reply.x ? reply.at[reply.at.length - 1] : 0 };
    setRange();
    S.t = 0;
  }
  redraw();
}

function zoom(factor, x, y) {
  const w = $("scene").clientWidth, h = $("scene").clientHeight;
  const ax = x === undefined ? w / 2 : x, ay = y === undefined ? h / 2 : y;
  const scale = Math.min(2000, Math.max(0.5, S.scale * factor));
  S.cx += (ax - w / 2) * (1 / S.scale - 1 / scale);
  S.cy -= (ay - h / 2) * (1 / S.scale - 1 / scale);
  S.scale = scale;
  redraw();
}

function fitAll() {
  const [x0, y0, x1, y1] = layoutAt(S.t).box, pad = 16;
  const w = $("scene").clientWidth - 2 * pad, h = $("scene").clientHeight - 2 * pad;
  S.scale = Math.max(0.5, Math.min(w / (x1 - x0), h / (y1 - y0)));
  [S.cx, S.cy] = [(x0 + x1) / 2, (y0 + y1) / 2];
  setFollow(false);
}

function setFollow(on) {
  S.follow = on;
  $("follow").setAttribute("aria-pressed", on);
  redraw();
}

function toggle(id) {
  $(id).checked = !$(id).checked;
  redraw();
}

const KEYS = {
  " ": () => setPlaying(!S.playing),
  ArrowLeft: (e) => seek(S.t - (e.shiftKey ? 10 : 1)),
  ArrowRight: (e) => seek(S.t + (e.shiftKey ? 10 : 1)),
  ",": () => stepPose(-1),
  ".": () => stepPose(1),
  "[": () => stepEvent(-1),
  "]": () => stepEvent(1),
  Home: () => seek(D.run.begin),
  End: () => seek(D.run.end),
  "+": () => zoom(1.25),
  "=": () => zoom(1.25),
  "-": () => zoom(0.8),
  0: () => fitAll(),
  f: () => setFollow(!S.follow),
  r: () => toggle("show-reach"),
  t: () => toggle("show-trails"),
  n: () => toggle("show-names"),
  o: () => toggle("show-old"),
  "?": () => $("keys").showModal(),
};

function onKey(e) {
  if (e.ctrlKey || e.metaKey || e.altKey || $("keys").open) return;
  const tag = e.target.tagName;
  if (tag === "SELECT" || (e.key === " " && ["BUTTON", "SUMMARY", "INPUT"].includes(tag) && e.target.id !== "slider")) return;
  const act = KEYS[e.key.length === 1 ? e.key.toLowerCase() : e.key];
  if (!act) return;
  e.preventDefault();
  act(e);
}

// Drag with one pointer, pinch with two.
function wirePointers() {
  const scene = $("scene"), held = new Map();
  const spread = () => {
    const [a, b] = [...held.values()];
    return { d: Math.hypot(a.x - b.x, a.y - b.y) || 1, x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
  };
  scene.addEventListener("pointerdown", (e) => {
    scene.setPointerCapture(e.pointerId);
    held.set(e.pointerId, { x: e.offsetX, y: e.offsetY });
  });
  scene.addEventListener("pointermove", (e) => {
    const last = held.get(e.pointerId);
    if (!last) return;
    const was = held.size === 2 ? spread() : last;
    held.set(e.pointerId, { x: e.offsetX, y: e.offsetY });
    const now = held.size === 2 ? spread() : held.get(e.pointerId);
    pan(now.x - was.x, now.y - was.y);
    if (held.size === 2) zoom(now.d / was.d, now.x, now.y);
  });
  for (const name of ["pointerup", "pointercancel"]) scene.addEventListener(name, (e) => held.delete(e.pointerId));
  scene.addEventListener("click", (e) => chooseMover(e.offsetX, e.offsetY));
  scene.addEventListener("wheel", (e) => {
    e.preventDefault();
    zoom(Math.exp(-Math.sign(e.deltaY) * Math.min(0.35, Math.abs(e.deltaY) / 400)), e.offsetX, e.offsetY);
  }, { passive: false });
}

// The mover under the pointer is told of; where there is none, nobody.
function chooseMover(x, y) {
  const off = (m) => Math.hypot(sx(m.x) - x, sy(m.y) - y);
  const hit = moversAt(S.t).filter((m) => off(m) < Math.max(14, m.whole * S.scale)).sort((a, b) => off(a) - off(b))[0];
  S.mover = hit ? hit.id : null;
  redraw();
}

function pan(dx, dy) {
  S.cx -= dx / S.scale;
  S.cy += dy / S.scale;
  if (S.follow && Math.hypot(dx, dy) > 2) setFollow(false);
  redraw();
}

function wirePlot(id) {
  const canvas = $(id), go = (e) => seek(D.run.begin + (e.offsetX / canvas.clientWidth) * (D.run.end - D.run.begin));
  canvas.addEventListener("pointerdown", (e) => {
    canvas.setPointerCapture(e.pointerId);
    go(e);
  });
  canvas.addEventListener("pointermove", (e) => e.buttons && go(e));
}

function setRange() {
  $("slider").min = D.run.begin;
  $("slider").max = D.run.end;
}

function wire() {
  $("slider").oninput = () => seek(+$("slider").value);
  $("play").onclick = () => setPlaying(!S.playing);
  $("rate").onchange = () => (S.rate = +$("rate").value);
  $("back").onclick = () => stepEvent(-1);
  $("on").onclick = () => stepEvent(1);
  $("zoom-in").onclick = () => zoom(1.4);
  $("zoom-out").onclick = () => zoom(1 / 1.4);
  $("fit").onclick = fitAll;
  $("follow").onclick = () => setFollow(!S.follow);
  $("help").onclick = () => $("keys").showModal();
  $("theme").onclick = () => setTheme(run.dataset.theme === "dark" ? "light" : "dark");
  for (const id of ["reach", "trails", "names", "old"]) $("show-" + id).onchange = redraw;
  ["speed", "gap", "strip"].forEach(wirePlot);
  wirePointers();
  addEventListener("keydown", onKey);
  new ResizeObserver(redraw).observe($("scene"));
  const dark = matchMedia("(prefers-color-scheme: dark)");
  dark.addEventListener("change", () => setTheme(dark.matches ? "dark" : "light"));
}

function loadGrids() {
  return Promise.all(D.layouts.filter((l) => l.grid).map((l) => {
    l.image = new Image();
    l.image.src = l.grid.png;
    return l.image.decode();
  }));
}

function fail(error) {
  $("fault").textContent = "This page cannot be shown: " + error.message;
  $("fault").classList.remove("hide");
  throw error;
}

async function start() {
  D = await unpack($("data").textContent);
  decode();
  await loadGrids();
  buildEvents();
  buildTables();
  S.t = D.run.begin;
  if (D.ofQueries) choose(D.replies[0]);
  setRange();
  wire();
  setTheme(matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
  fitAll();
  const at = /^#t=([\d.]+)$/.exec(location.hash);
  if (at) seek(+at[1]);
  requestAnimationFrame(() => (run.dataset.ready = "true"));
}

start().catch(fail);
