// The map itself: Leaflet on the plane of the mission frame, and one canvas of it on which the flight is drawn.
// North and east in metres stand where Leaflet has latitude and longitude: straight legs are straight, circles are
// circles, and a metre is as long everywhere, as in what is planned, flown and judged.

import { Shapes } from "./overlays.js";
import { FrameTiles } from "./tiles.js";

const { L } = window;
const EDGE = 50, LEAST_M = 100; // of the view that shows everything: its margin [px], and its least extent
const FARTHEST = 1e-5, CLOSEST = 100; // pixels to a metre
export const SQUARE = 110; // of the grid: at least so many pixels
const NOTCH = 180; // of a wheel, for twice the scale [px]

const Canvas = L.Layer.extend({
  onAdd() { this.canvas = L.DomUtil.create("canvas", "drawing", this.getPane()); },
  onRemove() { this.canvas.remove(); },
  // over the whole map, wherever its panes were moved
  cover() {
    const { x, y } = this._map.getSize();
    Object.assign(this.canvas.style, { width: `${x}px`, height: `${y}px` });
    L.DomUtil.setPosition(this.canvas, this._map.containerPointToLayerPoint([0, 0]));
  },
});

// its bar is the side of a square of the grid
const Scale = L.Control.Scale.extend({
  _updateMetric(across_m) {
    const step = this.options.words.step(across_m);
    this._updateScale(this._mScale, `${this.options.words.distance(step)}, north up`, step / across_m);
  },
  speak(words) {
    if (words.unit.altitude === this.options.words.unit.altitude) return;
    this.options.words = words;
    this._update();
  },
});

export class PlaneMap {
  // keyboard: whether arrows move it and plus and minus zoom it, while it has the focus; moved: called with the view
  // to which the user moved it
  constructor(element, words, keyboard, moved) {
    const leaflet = this.leaflet = L.map(element, {
      crs: L.CRS.Simple, minZoom: Math.log2(FARTHEST), maxZoom: Math.log2(CLOSEST), zoomSnap: 0, zoomDelta: Math.log2(1.5),
      zoomControl: false, attributionControl: false, doubleClickZoom: false, inertia: false, trackResize: false,
      zoomAnimation: false, fadeAnimation: false, bounceAtZoomLimits: false, wheelPxPerZoomLevel: NOTCH, wheelDebounceTime: 20, keyboard,
    });
    this.element = element;
    this.shown = null; // the view that is shown
    this.setting = false;
    leaflet.createPane("beneath").style.zIndex = 300;
    leaflet.setView([0, 0], 0);
    leaflet.on("move", () => {
      if (this.setting) return;
      this.shown = this.view();
      moved(this.shown);
    });
    this.layer = new Canvas().addTo(leaflet);
    this.scale = new Scale({ maxWidth: SQUARE, imperial: false, words }).addTo(leaflet);
  }

  get canvas() { return this.layer.canvas; }

  // {north, east, scale}: the place in the middle [m], and pixels to a metre
  view() {
    const { lat, lng } = this.leaflet.getCenter();
    return { north: lat, east: lng, scale: this.leaflet.options.crs.scale(this.leaflet.getZoom()) };
  }

  // the view that shows all of {north0, north1, east0, east1}
  whole({ north0, north1, east0, east1 }) {
    this.fit();
    const north = (north0 + north1) / 2, east = (east0 + east1) / 2, { x, y } = this.leaflet.getSize();
    const tall = Math.max(north1 - north0, LEAST_M) / 2, wide = Math.max(east1 - east0, LEAST_M) / 2;
    const margin = L.point(Math.min(2 * EDGE, x / 2), Math.min(2 * EDGE, y / 2));
    const zoom = this.leaflet.getBoundsZoom([[north - tall, east - wide], [north + tall, east + wide]], false, margin);
    return { north, east, scale: this.leaflet.options.crs.scale(zoom) };
  }

  // takes the size that the page gives it
  fit() {
    const { x, y } = this.leaflet.getSize(), { clientWidth, clientHeight } = this.element;
    if (x === clientWidth && y === clientHeight) return;
    this.quietly(() => this.leaflet.invalidateSize({ pan: false }));
    this.shown = null;
  }

  // shows a view, and takes its canvas there
  show(view) {
    this.fit();
    const { shown } = this;
    if (!shown || view.north !== shown.north || view.east !== shown.east || view.scale !== shown.scale) {
      this.quietly(() => this.leaflet.setView([view.north, view.east], this.leaflet.options.crs.zoom(view.scale), { reset: true }));
      this.shown = view;
    }
    this.layer.cover();
    this.beneath?.dress();
  }

  quietly(act) {
    this.setting = true;
    try { act(); } finally { this.setting = false; }
  }

  // {x, y, scale}: where the canvas has the origin of the frame, and pixels to a metre
  origin() {
    const { x, y } = this.leaflet.getPixelBounds().min, at = this.leaflet.project([0, 0]);
    return { x: at.x - x, y: at.y - y, scale: this.leaflet.options.crs.scale(this.leaflet.getZoom()) };
  }

  // what lies beneath, of a frame: shapes, and what is said of the pictures, null without
  lay(frame, shapes, attribution) {
    this.beneath?.remove();
    this.tiles?.remove();
    this.beneath = new Shapes(shapes).addTo(this.leaflet);
    this.tiles = attribution === null ? null : new FrameTiles(frame, attribution).addTo(this.leaflet);
  }

  zoom(by) { this.leaflet.setZoom(this.leaflet.getZoom() + Math.log2(by)); }

  move(right, down) { this.leaflet.panBy([right, down], { animate: false }); }
}
