// The map of the editor: zones, tasks, starts and a plan; places are dragged, shapes drawn by clicks.

import { color, colorOf, sized } from "./canvas.js";
import { named } from "./labels.js";
import { FlightMap } from "./map.js";

const NEAR = 9;

export class EditMap extends FlightMap {
  // asked: { moved(key, north, east), clicked(north, east), finished(), viewed() }
  constructor(canvas, asked) {
    super(canvas, { vehicles: [], tracks: {}, tasks: [], zones: [], footprints: [], routes: [], takeovers: [] }, view => { this.state.view = view; this.redraw(); });
    Object.assign(this, { asked, state: { time: 0, view: null }, places: [], starts: [], picked: null, tool: null, drawing: null, pointed: null, dragged: null });
    this.edit();
  }

  show(found) {
    const { drawn } = found;
    if (drawn) {
      const tracks = Object.fromEntries(drawn.starts.map(start => [start.id, [[0, start.north_m, start.east_m, 0, 0]]]));
      const { frame } = drawn, moved = JSON.stringify(frame) !== JSON.stringify(this.recording.frame);
      Object.assign(this.recording, { ...drawn, tracks, routes: this.recording.routes });
      if (moved) this.lay(frame, () => this.redraw());
      this.starts = drawn.starts;
      this.places = found.places;
      if (!this.places.some(place => this.isPicked(place))) this.pick(null);
      this.grown();
    }
    this.redraw();
  }

  routes(routes) { this.recording.routes = routes; this.redraw(); }

  pick(place) { this.picked = place && place.key; this.asked.picked(this.picked); }

  isPicked(place) { return this.picked !== null && place.key.join() === this.picked.join(); }

  redraw() {
    const { pen, width, height } = sized(this.canvas);
    this.begin(pen, width, height, this.state);
    for (const zone of this.recording.zones) this.zone(zone);
    for (const task of this.recording.tasks) this.task(task);
    for (const route of this.recording.routes) this.route(String(route.vehicle), route);
    for (const start of this.starts) this.start(start);
    this.names();
    for (const place of this.places) this.handle(place);
    if (this.drawing) {
      this.begun();
      this.stroke(color("icarous"), 2.5, [6, 4]);
      for (const [north, east] of this.drawing) this.square(north, east, color("icarous"), true);
    }
  }

  // tool: of TOOLS, or none any more
  take(tool) {
    Object.assign(this, { tool, drawing: tool ? [] : null, pointed: null });
    this.redraw();
  }

  // the path of what is being drawn: a circle through the pointer, or from place to place to it
  begun() {
    const places = this.pointed && this.drawing.length ? [...this.drawing, this.pointed] : this.drawing;
    if (!this.tool.circles || places.length < 2) { this.path(places, this.tool.closed && places.length > 2); return; }
    const [[x, y], [px, py]] = places.map(place => this.xy(...place));
    this.pen.beginPath();
    this.pen.arc(x, y, Math.hypot(px - x, py - y), 0, 7);
  }

  start(start) {
    const [x, y] = this.xy(start.north_m, start.east_m), { pen } = this;
    pen.save();
    pen.translate(x, y);
    pen.rotate(start.heading_deg * Math.PI / 180);
    pen.beginPath();
    pen.moveTo(0, -13); pen.lineTo(8, 10); pen.lineTo(0, 6); pen.lineTo(-8, 10);
    pen.closePath();
    this.fill(colorOf(this.recording, start.id), 1);
    pen.restore();
    const vehicle = this.recording.vehicles.find(one => one.id === start.id);
    this.labels.add(vehicle ? named(vehicle) : String(start.id), x, y, 14, -8, colorOf(this.recording, start.id), true);
  }

  square(north, east, ink, full) {
    const [x, y] = this.xy(north, east);
    this.pen.beginPath();
    this.pen.rect(x - 4, y - 4, 8, 8);
    this.fill(full ? ink : color("paper"), 1);
    this.stroke(ink, 1.5);
  }

  handle(place) { this.square(place.north_m, place.east_m, color("ink"), this.isPicked(place)); }

  // the place that is nearest to a point of the canvas, if it is near
  at(x, y) {
    let found = null, least = NEAR;
    for (const place of this.places) {
      const [px, py] = this.xy(place.north_m, place.east_m), far = Math.hypot(px - x, py - y);
      if (far <= least) { found = place; least = far; }
    }
    return found;
  }

  edit() {
    const { canvas } = this;
    // before the map's own: a place that is dragged does not move the map
    canvas.addEventListener("pointerdown", event => {
      if (this.drawing) {
        event.stopImmediatePropagation();
        this.asked.clicked(...this.under(event.offsetX, event.offsetY));
        return;
      }
      const place = this.at(event.offsetX, event.offsetY);
      this.pick(place);
      if (place) {
        event.stopImmediatePropagation();
        canvas.setPointerCapture(event.pointerId);
        this.dragged = { place, from: [place.north_m, place.east_m] };
      }
      this.redraw();
    }, true);
    canvas.addEventListener("pointermove", event => {
      if (this.drawing?.length) { this.pointed = this.under(event.offsetX, event.offsetY); this.redraw(); }
      if (!this.dragged) return;
      event.stopImmediatePropagation();
      const [north, east] = this.under(event.offsetX, event.offsetY);
      Object.assign(this.dragged.place, { north_m: north, east_m: east });
      this.redraw();
    }, true);
    canvas.addEventListener("pointerup", () => {
      const { dragged } = this;
      this.dragged = null;
      if (!dragged) return;
      const { key, north_m, east_m } = dragged.place;
      if (north_m !== dragged.from[0] || east_m !== dragged.from[1]) this.asked.moved(key, north_m, east_m);
    }, true);
    canvas.addEventListener("dblclick", () => { if (this.drawing) this.asked.finished(); });
    new ResizeObserver(() => this.redraw()).observe(canvas);
  }
}
