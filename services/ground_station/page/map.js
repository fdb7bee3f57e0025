// The map: north up, one scale, metres of the mission frame. Everything is drawn anew for an instant.

import { alertColor } from "./band_style.js";
import { ring } from "./bands.js";
import { UNSEEN_MS, alertsAt, authorityAt, bandsAt, lastAt, positionAt } from "./instant.js";
import { Layer, color, colorOf, sized } from "./canvas.js";
import { Labels } from "./labels.js";
import * as overlays from "./overlays.js";
import { Tiles } from "./tiles.js";
import { words } from "./units.js";

const EDGE = 50;
const LEAST_PX = 0.25; // what has moved by less is not drawn anew

export class FlightMap {
  constructor(canvas, recording, changed) {
    this.canvas = canvas;
    this.recording = recording;
    this.changed = changed; // called when the user moved the map
    this.view = null;
    this.trails = new Layer();
    this.labels = new Labels();
    this.beneath = [];
    this.tiles = null;
    this.drawn = { time: 0, to: {} }; // until when, and of each track to which row, the trails stand on their layer
    this.measured = {};
    this.grown();
    this.listen();
  }

  // the recording has grown
  grown() { this.bounds = extent(this.recording, this.measured); }

  // the view that shows everything
  whole() {
    const box = this.canvas.getBoundingClientRect(), b = this.bounds;
    const scale = Math.min((box.width - 2 * EDGE) / Math.max(b.east1 - b.east0, 100), (box.height - 2 * EDGE) / Math.max(b.north1 - b.north0, 100));
    return { north: (b.north0 + b.north1) / 2, east: (b.east0 + b.east1) / 2, scale: Math.max(scale, 1e-5) };
  }

  // what is drawn on: the view, where a place is on the canvas, and the grid
  begin(pen, width, height, state, said = words(state.aviation)) {
    this.view = state.view || this.whole();
    this.xy = (north, east) => [width / 2 + (east - this.view.east) * this.view.scale, height / 2 - (north - this.view.north) * this.view.scale];
    this.pen = pen;
    this.width = width;
    this.tiles?.draw(this, height);
    overlays.draw(this, this.beneath);
    this.grid(width, height, said);
  }

  // what lies beneath, once it is known in which frame; drawn: draws the map anew
  async lay(frame, drawn) {
    const { shapes, tiles } = await overlays.overlays(frame);
    this.beneath = shapes;
    this.tiles = tiles === null ? null : new Tiles(frame, tiles, drawn);
    if (shapes.length || this.tiles) drawn();
  }

  // whether all aircraft are where they were drawn
  still(time) {
    const s = (time - this.shown) / 1000;
    return s >= 0 && s * this.bounds.fastest * this.view.scale * (window.devicePixelRatio || 1) < LEAST_PX;
  }

  // whole: also where nothing has moved to be seen; gives whether it has drawn
  draw(state, words, whole = true) {
    if (!whole && this.still(state.time)) return false;
    this.shown = state.time;
    const { pen, width, height } = sized(this.canvas);
    this.begin(pen, width, height, state, words);
    const { time } = state, recording = this.recording;
    for (const zone of recording.zones) if (zone.from_ms <= time && time < (zone.to_ms ?? Infinity)) this.zone(zone);
    for (const seen of recording.footprints) if (seen.time_ms <= time) this.footprint(seen);
    for (const task of recording.tasks) if (time < (task.to_ms ?? Infinity)) this.task(task);
    for (const [id, route] of routesAt(recording, time)) this.route(id, route);
    this.past(pen, width, height, time);
    for (const takeover of recording.takeovers) if (takeover.from_ms <= time) this.takeover(takeover);
    const said = bandsAt(recording, state), at = said?.row && positionAt(recording.tracks[said.id] ?? [], time);
    if (at && at.seen) ring(this, ...this.xy(at.north, at.east), said.row);
    const alerts = alertsAt(recording, state);
    for (const id of Object.keys(recording.tracks)) this.aircraft(id, state, words, alerts[id]);
    this.names();
    return true;
  }

  path(places, closed) {
    this.pen.beginPath();
    places.forEach((place, k) => {
      const [x, y] = this.xy(place[0], place[1]);
      if (k) this.pen.lineTo(x, y); else this.pen.moveTo(x, y);
    });
    if (closed) this.pen.closePath();
  }

  stroke(ink, width, dash = [], alpha = 1) {
    Object.assign(this.pen, { strokeStyle: ink, lineWidth: width, globalAlpha: alpha, lineJoin: "round", lineCap: "round" });
    this.pen.setLineDash(dash);
    this.pen.stroke();
    this.pen.setLineDash([]);
    this.pen.globalAlpha = 1;
  }

  fill(ink, alpha) {
    Object.assign(this.pen, { fillStyle: ink, globalAlpha: alpha });
    this.pen.fill();
    this.pen.globalAlpha = 1;
  }

  // text on a plate of its own, so that it is read on anything
  label(text, x, y, ink) {
    const wide = this.pen.measureText(text).width;
    if (x < this.width) x = Math.max(2, Math.min(x, this.width - wide - 4)); // what would end beyond the edge
    Object.assign(this.pen, { fillStyle: color("paper"), globalAlpha: 0.75 });
    this.pen.fillRect(x - 2, y - 11, wide + 4, 15);
    Object.assign(this.pen, { fillStyle: ink, globalAlpha: 1 });
    this.pen.fillText(text, x, y);
  }

  // what is named on the map, once all else is drawn
  names() { this.labels.draw(text => this.pen.measureText(text).width, this.width, (...one) => this.label(...one)); }

  grid(width, height, words) {
    const step = words.step(110 / this.view.scale), pen = this.pen;
    const east0 = this.view.east - width / 2 / this.view.scale, north0 = this.view.north - height / 2 / this.view.scale;
    pen.beginPath();
    for (let k = Math.ceil(east0 / step); this.xy(0, k * step)[0] < width; k++) {
      const x = this.xy(0, k * step)[0];
      pen.moveTo(x, 0); pen.lineTo(x, height);
    }
    for (let k = Math.ceil(north0 / step); this.xy(k * step, 0)[1] > 0; k++) {
      const y = this.xy(k * step, 0)[1];
      pen.moveTo(0, y); pen.lineTo(width, y);
    }
    this.stroke(color("rule"), 1, [], 0.6);
    pen.beginPath();
    pen.moveTo(14, height - 14); pen.lineTo(14 + step * this.view.scale, height - 14);
    this.stroke(color("ink"), 2);
    this.label(`${words.distance(step)}, north up`, 14, height - 22, color("ink"));
  }

  zone(zone) {
    const ink = color(zone.kind === "keep_out" ? "keepout" : "keepin");
    this.path(zone.vertices, true);
    if (zone.kind === "keep_out") this.fill(ink, 0.16);
    this.stroke(ink, 2, zone.kind === "keep_out" ? [] : [10, 5]);
    const [x, y] = this.xy(...zone.vertices[0]);
    this.labels.add(`${zone.kind.replace("_", " ")} ${zone.id} ${zone.label || ""}`.trim(), x, y, 4, -4, ink);
  }

  footprint(seen) {
    this.path(seen.corners, true);
    this.fill(colorOf(this.recording, seen.vehicle), 0.05);
  }

  task(task) {
    const [x, y] = this.xy(...task.points[0]);
    if (task.points.length > 1) {
      this.path(task.points, task.closed);
      if (task.closed) this.fill(color("ink"), 0.06);
      this.stroke(color("ink"), task.closed ? 2 : 8, [], 0.25);
    }
    this.pen.beginPath();
    this.pen.arc(x, y, Math.max(5, (task.radius_m || 0) * this.view.scale), 0, 7);
    this.stroke(color("ink"), 1.5, [], 0.8);
    this.labels.add(`p${task.id} ${task.label || ""}`.trim(), x, y, 9, 16, color("ink"));
  }

  route(id, route) {
    this.path(route.points, false);
    this.stroke(colorOf(this.recording, id), 1.5, [3, 5], 0.8);
  }

  // all trails; on their layer only what is new is drawn, and all anew where the view is another or time went back
  past(pen, width, height, time) {
    const { view } = this, layer = this.trails.for(this.canvas, [view.north, view.east, view.scale].join());
    if (!layer.empty && time < this.drawn.time) {
      layer.pen.clearRect(0, 0, width, height);
      layer.empty = true;
    }
    if (layer.empty) this.drawn.to = {};
    this.drawn.time = time;
    const ids = Object.keys(this.recording.tracks);
    this.pen = layer.pen;
    for (const id of ids) this.trail(id, time);
    this.pen = pen;
    this.trails.onto(pen, width, height);
    for (const id of ids) this.newest(id, time);
  }

  // a piece of a track, in the colour of who commands
  piece(id, owner, places) {
    this.path(places, false);
    if (owner === 1) this.stroke(color("icarous"), 5); else this.stroke(colorOf(this.recording, id), 2.5);
  }

  // up to the last row but one that is past: the last one may be replaced while it is flown
  trail(id, time) {
    const track = this.recording.tracks[id], done = lastAt(track, time, row => row[0]) - 1;
    this.rows(id, this.drawn.to[id] ?? 0, done);
    this.drawn.to[id] = Math.max(done, 0);
  }

  // from row to row of a track, but for what nobody saw
  rows(id, first, last) {
    const track = this.recording.tracks[id];
    for (let from = first; from < last;) {
      let to = from + 1;
      if (!broken(track, from)) {
        while (to < last && track[to][4] === track[from][4] && !broken(track, to)) to++;
        this.piece(id, track[from][4], track.slice(from, to + 1).map(row => [row[1], row[2]]));
      }
      from = to;
    }
  }

  // the rest of it, to where it is now
  newest(id, time) {
    const track = this.recording.tracks[id], last = lastAt(track, time, row => row[0]), now = positionAt(track, time);
    this.rows(id, Math.max(last - 1, 0), last);
    if (now && now.seen) this.piece(id, track[last][4], [[track[last][1], track[last][2]], [now.north, now.east]]);
  }

  takeover(takeover) {
    const [x, y] = this.xy(takeover.north_m, takeover.east_m);
    this.pen.beginPath();
    this.pen.moveTo(x, y - 7); this.pen.lineTo(x + 7, y); this.pen.lineTo(x, y + 7); this.pen.lineTo(x - 7, y);
    this.pen.closePath();
    this.fill(color("paper"), 1);
    this.stroke(color("icarous"), 2.5);
  }

  aircraft(id, state, words, alert) {
    const at = positionAt(this.recording.tracks[id], state.time);
    if (!at) return;
    const [x, y] = this.xy(at.north, at.east), ink = colorOf(this.recording, id), pen = this.pen;
    const who = authorityAt(this.recording, Number(id), state.time), commands = who.name;
    pen.save();
    pen.translate(x, y);
    pen.rotate((at.course || 0) * Math.PI / 180);
    pen.beginPath();
    pen.moveTo(0, -11); pen.lineTo(7, 9); pen.lineTo(0, 5); pen.lineTo(-7, 9);
    pen.closePath();
    if (at.seen) this.fill(ink, 1);
    this.stroke(at.seen ? color("paper") : ink, 1.5);
    pen.restore();
    if (at.seen && (commands === "ICAROUS" || state.picked === id)) {
      pen.beginPath();
      pen.arc(x, y, 17, 0, 7);
      this.stroke(commands === "ICAROUS" ? color("icarous") : ink, 2.5, commands === "ICAROUS" ? [] : [4, 3]);
    }
    if (at.seen && alert) {
      pen.beginPath();
      pen.rect(x - 14, y - 14, 28, 28);
      this.stroke(alertColor(alert.level), 1 + alert.level);
    }
    const vehicle = this.recording.vehicles.find(v => String(v.id) === id);
    const name = vehicle ? vehicle.label || id : `traffic ${id}`;
    const away = who.away ? ` ${who.name}` : "";
    const rest = at.seen ? words.altitude(at.alt) : "not seen any more";
    const alerted = at.seen && alert ? ` alert ${alert.level}` : "";
    this.labels.add(`${name} ${rest}${alerted}${at.seen && commands === "ICAROUS" ? " ICAROUS" : away}`, x, y, 15, -10, ink, true);
  }

  zoom(by, x, y) {
    const box = this.canvas.getBoundingClientRect(), view = this.view;
    const dx = (x ?? box.width / 2) - box.width / 2, dy = (y ?? box.height / 2) - box.height / 2;
    const scale = Math.min(Math.max(view.scale * by, 1e-5), 100);
    this.changed({
      north: view.north - dy / view.scale + dy / scale,
      east: view.east + dx / view.scale - dx / scale,
      scale,
    });
  }

  move(dx, dy) {
    const view = this.view;
    this.changed({ ...view, east: view.east - dx / view.scale, north: view.north + dy / view.scale });
  }

  // north and east [m] under a place of the canvas
  under(x, y) {
    const box = this.canvas.getBoundingClientRect();
    return [this.view.north - (y - box.height / 2) / this.view.scale, this.view.east + (x - box.width / 2) / this.view.scale];
  }

  listen() {
    const canvas = this.canvas;
    let from = null;
    canvas.addEventListener("pointerdown", event => { from = [event.clientX, event.clientY]; canvas.setPointerCapture(event.pointerId); });
    canvas.addEventListener("pointerup", () => { from = null; });
    canvas.addEventListener("pointermove", event => {
      if (!from) return;
      this.move(event.clientX - from[0], event.clientY - from[1]);
      from = [event.clientX, event.clientY];
    });
    canvas.addEventListener("wheel", event => {
      event.preventDefault();
      this.zoom(Math.exp(-event.deltaY / 400), event.offsetX, event.offsetY);
    }, { passive: false });
  }
}

// whether nobody saw an aircraft between a row of its track and the next one
function broken(track, k) { return k + 1 < track.length && track[k + 1][0] - track[k][0] > UNSEEN_MS; }

// the route of each vehicle that was commanded last
function routesAt(recording, time) {
  const found = new Map();
  for (const route of recording.routes) if (route.time_ms <= time) found.set(String(route.vehicle), route);
  return found;
}

const nowhere = () => ({ north0: Infinity, north1: -Infinity, east0: Infinity, east1: -Infinity });

function widened(found, north, east) {
  found.north0 = Math.min(found.north0, north); found.north1 = Math.max(found.north1, north);
  found.east0 = Math.min(found.east0, east); found.east1 = Math.max(found.east1, east);
}

// what is shown by default, and the speed of the fastest aircraft [m/s]; measured: of each track how many rows have been
// looked at and what they gave, so that a track that grows is not looked at again
function extent(recording, measured) {
  const ours = new Set(recording.vehicles.map(v => String(v.id))), found = { ...nowhere(), fastest: 0 };
  for (const [id, track] of Object.entries(recording.tracks)) {
    let of = measured[id];
    // a row may have been replaced by a newer one, and old ones let go of
    if (!of || of.count > track.length || of.first !== track[0]) of = measured[id] = { ...nowhere(), count: 0, fastest: 0, first: track[0] };
    for (let k = Math.max(of.count - 1, 0); k < track.length; k++) {
      const row = track[k], before = track[k - 1];
      widened(of, row[1], row[2]);
      if (before && row[0] > before[0] && row[0] - before[0] <= UNSEEN_MS) of.fastest = Math.max(of.fastest, Math.hypot(row[1] - before[1], row[2] - before[2]) / (row[0] - before[0]) * 1000);
    }
    of.count = track.length;
    found.fastest = Math.max(found.fastest, of.fastest);
    if (ours.has(id) && track.length) { widened(found, of.north0, of.east0); widened(found, of.north1, of.east1); }
  }
  for (const task of recording.tasks) for (const point of task.points) widened(found, point[0], point[1]);
  for (const zone of recording.zones) if (zone.kind === "keep_out") for (const point of zone.vertices) widened(found, point[0], point[1]);
  return found.north0 <= found.north1 ? found : { north0: -500, north1: 500, east0: -500, east1: 500, fastest: found.fastest };
}
