// What the user has of the place, beneath all else on the map: coast, roads, airspace.

import { color } from "./canvas.js";

const { L } = window;
const DOT = 3;

// shapes in a frame of a recording, and what is said of tiles, null without; none where the server does not answer
export async function overlays(frame) {
  const none = { shapes: [], tiles: null };
  if (!frame) return none;
  try {
    const response = await fetch(`/overlays.json?latitude=${frame.latitude_deg}&longitude=${frame.longitude_deg}`);
    return response.ok ? await response.json() : none;
  } catch { return none; }
}

// the shapes as vectors of Leaflet, in the colours of the page
export const Shapes = L.FeatureGroup.extend({
  initialize(shapes) {
    const options = { renderer: L.canvas({ pane: "beneath" }), interactive: false, weight: 1, opacity: 0.7, fillOpacity: 0.08 };
    L.FeatureGroup.prototype.initialize.call(this, shapes.map(({ places, area }) => {
      if (places.length === 1) return L.circleMarker(places[0], { ...options, radius: DOT, stroke: false, fillOpacity: 1 });
      return area ? L.polygon(places, options) : L.polyline(places, options);
    }));
  },
  // in the present colours
  dress() {
    const ink = color("soft");
    if (ink === this.ink) return;
    this.ink = ink;
    this.setStyle({ color: ink });
  },
});

// names only of what is near enough to be seen as more than a dot
export function names(map, shapes) {
  for (const shape of shapes) {
    if (!shape.name) continue;
    const [x, y] = map.xy(...shape.places[0]);
    if (x >= 0 && x <= map.width) map.labels.add(shape.name, x, y, 5, -5, color("soft"));
  }
}
