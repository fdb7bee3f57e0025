// What is dragged on the map of the editor: a square at each place, and a circle at each number that is seen there, which
// is a heading or a radius. Markers of Leaflet.

const { L } = window;
const AHEAD = 44; // of a start, where its heading is dragged [px]
const TURN = Math.PI / 180, TENTH = 10;
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }; // a pixel; with Shift ten
const SETTLED_MS = 400; // after the last one

const same = (one, other) => one !== null && other !== null && one.join() === other.join();

export class Handles {
  // asked: { picked(key), dragged(), moved(key, north, east), changed(key, value) }
  constructor(plane, asked) {
    Object.assign(this, { plane, asked, places: [], numbers: [], markers: new Map(), picked: null, dragged: null });
  }

  // places: {key, north_m, east_m}; numbers: {key, of, value}, each of the place with the key `of`
  show(places, numbers) {
    Object.assign(this, { places, numbers: numbers.filter(one => places.some(place => same(place.key, one.of))) });
    const wanted = new Map([...places, ...this.numbers].map(one => [one.key.join(), one]));
    for (const name of this.markers.keys()) if (!wanted.has(name)) this.forget(name);
    for (const [name, one] of wanted) {
      if (!this.markers.has(name)) this.markers.set(name, this.made(name, "of" in one));
      const marker = this.markers.get(name);
      marker.what = one;
      if (name === this.dragged) this.take(marker); // the text may change elsewhere meanwhile
    }
    if (!wanted.has(this.picked?.join())) this.pick(null);
    this.lay();
  }

  forget(name) {
    const marker = this.markers.get(name);
    clearTimeout(marker.settled);
    marker.remove();
    this.markers.delete(name);
    if (name === this.dragged) this.dragged = null;
  }

  pick(key) {
    this.picked = key;
    for (const [name, marker] of this.markers) marker.getElement()?.classList.toggle("picked", name === key?.join());
    this.asked.picked(key);
  }

  made(name, round) {
    const icon = L.divIcon({ className: `handle${round ? " round" : ""}`, iconSize: null });
    const title = `${name.replaceAll(",", " ")}: drag, or arrow keys`;
    const marker = L.marker([0, 0], { icon, title, draggable: true, zIndexOffset: round ? 1000 : 0 }).addTo(this.plane.leaflet);
    marker.getElement().dataset.key = name;
    marker.getElement().addEventListener("keydown", event => this.step(name, marker, event));
    marker.on("mousedown click", () => this.pick(marker.what.of ?? marker.what.key));
    marker.on("dragstart", () => { this.pick(marker.what.of ?? marker.what.key); this.dragged = name; });
    marker.on("drag", () => { this.take(marker); this.asked.dragged(); });
    marker.on("dragend", () => this.drop(marker));
    return marker;
  }

  drop(marker) {
    const { key, of, north_m, east_m, value } = this.take(marker);
    this.dragged = null;
    this.asked.dragged(); // a heading is turned about its vehicle at once
    if (of) this.asked.changed(key, value); else this.asked.moved(key, north_m, east_m);
  }

  // by an arrow key; the mission is changed once no further one follows
  step(name, marker, event) {
    const { leaflet } = this.plane, way = ARROWS[event.key];
    if (!way) return;
    L.DomEvent.stop(event);
    if (this.dragged !== name) this.pick(marker.what.of ?? marker.what.key);
    this.dragged = name;
    const to = leaflet.latLngToContainerPoint(marker.getLatLng()).add(L.point(way).multiplyBy(event.shiftKey ? 10 : 1));
    marker.setLatLng(leaflet.containerPointToLatLng(to));
    this.take(marker);
    this.asked.dragged();
    clearTimeout(marker.settled);
    marker.settled = setTimeout(() => this.drop(marker), SETTLED_MS);
  }

  // what it is dragged to
  take(marker) {
    const { lat, lng } = marker.getLatLng(), { what } = marker;
    if (!("of" in what)) return Object.assign(what, { north_m: lat, east_m: lng });
    const { north_m, east_m } = this.place(what), north = lat - north_m, east = lng - east_m;
    const heading = (Math.round(Math.atan2(east, north) / TURN * TENTH) / TENTH + 360) % 360;
    return Object.assign(what, { value: turns(what) ? heading : Math.max(Math.round(Math.hypot(north, east) * TENTH) / TENTH, 1 / TENTH) });
  }

  place(number) { return this.places.find(place => same(place.key, number.of)); }

  // each one where it is in the present view, but for the one that is being dragged
  lay() {
    const { scale } = this.plane.origin();
    for (const [name, marker] of this.markers) {
      if (name === this.dragged) continue;
      const { what } = marker, { north_m, east_m } = "of" in what ? this.rim(what, scale) : what, at = marker.getLatLng();
      if (at.lat !== north_m || at.lng !== east_m) marker.setLatLng([north_m, east_m]);
    }
  }

  // where a number is dragged: ahead of the vehicle, or on the east of the circle
  rim(number, scale) {
    const { north_m, east_m } = this.place(number), { value } = number;
    if (!turns(number)) return { north_m, east_m: east_m + value };
    return { north_m: north_m + Math.cos(value * TURN) * AHEAD / scale, east_m: east_m + Math.sin(value * TURN) * AHEAD / scale };
  }

  // the circle of a radius that is being dragged: {north_m, east_m, radius_m}; null while none is
  circle() {
    const what = this.markers.get(this.dragged)?.what;
    return what && "of" in what && !turns(what) ? { ...this.place(what), radius_m: what.value } : null;
  }

  // headings [deg] of the places that have one, by the key of the place
  headings() { return new Map(this.numbers.filter(turns).map(one => [one.of.join(), one.value])); }
}

function turns(number) { return number.key.at(-1) === "heading_deg"; }
