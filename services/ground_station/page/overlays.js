// What the user has of the place, beneath all else on the map: coast, roads, airspace.

import { color } from "./canvas.js";

// shapes in a frame of a recording, and what is said of tiles, null without; none where the server does not answer
export async function overlays(frame) {
  const none = { shapes: [], tiles: null };
  if (!frame) return none;
  try {
    const response = await fetch(`/overlays.json?latitude=${frame.latitude_deg}&longitude=${frame.longitude_deg}`);
    return response.ok ? await response.json() : none;
  } catch { return none; }
}

// names only of what is near enough to be seen as more than a dot
export function draw(map, shapes) {
  for (const shape of shapes) {
    const [x, y] = map.xy(...shape.places[0]);
    if (shape.places.length === 1) {
      map.pen.beginPath();
      map.pen.arc(x, y, 3, 0, 7);
      map.fill(color("soft"), 1);
    } else {
      map.path(shape.places, shape.area);
      if (shape.area) map.fill(color("soft"), 0.08);
      map.stroke(color("soft"), 1, [], 0.7);
    }
    if (shape.name && x >= 0 && x <= map.width) map.labels.add(shape.name, x, y, 5, -5, color("soft"));
  }
}
