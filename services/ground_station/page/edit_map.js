// The map of the editor: zones, tasks, starts and a plan; places are dragged, shapes drawn by clicks.

import { color, colorOf } from "./canvas.js";
import { Handles } from "./handles.js";
import { named } from "./labels.js";
import { FlightMap } from "./map.js";

export class EditMap extends FlightMap {
  // asked: { moved(key, north, east), changed(key, value), picked(key), clicked(north, east), finished() }
  constructor(element, asked) {
    super(element, { vehicles: [], tracks: {}, tasks: [], zones: [], footprints: [], routes: [], takeovers: [] }, view => { this.state.view = view; this.redraw(); }, true);
    Object.assign(this, { asked, state: { time: 0, view: null }, starts: [], tool: null, drawing: null, pointed: null });
    this.handles = new Handles(this.plane, { ...asked, dragged: () => this.redraw() });
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
      this.handles.show(found.places, found.numbers);
      this.grown();
    }
    this.redraw();
  }

  routes(routes) { this.recording.routes = routes; this.redraw(); }

  get picked() { return this.handles.picked; }

  redraw() {
    this.begin(this.state);
    this.handles.lay();
    for (const zone of this.recording.zones) this.zone(zone);
    for (const task of this.recording.tasks) this.task(task);
    for (const route of this.recording.routes) this.route(String(route.vehicle), route);
    const headings = this.handles.headings();
    this.starts.forEach((start, k) => this.start(start, headings.get(`vehicles,${k},position`) ?? start.heading_deg));
    this.names();
    const circle = this.handles.circle();
    if (circle) {
      this.round(...this.xy(circle.north_m, circle.east_m), circle.radius_m * this.view.scale);
      this.stroke(color("icarous"), 2.5, [6, 4]);
    }
    if (this.drawing) {
      this.begun();
      this.stroke(color("icarous"), 2.5, [6, 4]);
      for (const [north, east] of this.drawing) this.square(north, east, color("icarous"));
    }
  }

  // tool: of TOOLS, or none any more
  take(tool) {
    Object.assign(this, { tool, drawing: tool ? [] : null, pointed: null });
    this.plane.element.classList.toggle("drawn-on", Boolean(tool)); // handles beneath the pointer take no clicks
    this.redraw();
  }

  // the path of what is being drawn: a circle through the pointer, or from place to place to it
  begun() {
    const places = this.pointed && this.drawing.length ? [...this.drawing, this.pointed] : this.drawing;
    if (!this.tool.circles || places.length < 2) { this.path(places, this.tool.closed && places.length > 2); return; }
    const [[x, y], [px, py]] = places.map(place => this.xy(...place));
    this.round(x, y, Math.hypot(px - x, py - y));
  }

  round(x, y, radius) {
    this.pen.beginPath();
    this.pen.arc(x, y, radius, 0, 7);
  }

  start(start, heading_deg) {
    const [x, y] = this.xy(start.north_m, start.east_m), { pen } = this;
    pen.save();
    pen.translate(x, y);
    pen.rotate(heading_deg * Math.PI / 180);
    pen.beginPath();
    pen.moveTo(0, -13); pen.lineTo(8, 10); pen.lineTo(0, 6); pen.lineTo(-8, 10);
    pen.closePath();
    this.fill(colorOf(this.recording, start.id), 1);
    pen.restore();
    const vehicle = this.recording.vehicles.find(one => one.id === start.id);
    this.labels.add(vehicle ? named(vehicle) : String(start.id), x, y, 14, -8, colorOf(this.recording, start.id), true);
  }

  square(north, east, ink) {
    const [x, y] = this.xy(north, east);
    this.pen.beginPath();
    this.pen.rect(x - 4, y - 4, 8, 8);
    this.fill(ink, 1);
    this.stroke(ink, 1.5);
  }

  edit() {
    this.at("click", (...place) => { if (this.drawing) this.asked.clicked(...place); else this.handles.pick(null); });
    this.at("mousemove", (...place) => { if (this.drawing?.length) { this.pointed = place; this.redraw(); } });
    this.at("dblclick", () => { if (this.drawing) this.asked.finished(); });
    new ResizeObserver(() => this.redraw()).observe(this.plane.element);
  }
}
