// Where names stand on a map: beside what they name, and not on each other while there is room.

const HEIGHT = 15, RISE = 11, GAP = 2;

// where a name may stand about a point, on a canvas so wide: as asked for, on another side of it, or a line farther off
function sides(x, y, dx, dy, wide, width) {
  if (x < 0 || x > width) return [[x + dx, y + dy]]; // what is not on the canvas is not named there
  const right = Math.max(2, Math.min(x + dx, width - wide - 4)), left = x - dx - wide;
  const other = dy < 0 ? RISE - dy : -dy, off = dy < 0 ? -HEIGHT : HEIGHT;
  // a line farther off last; behind an aircraft, where its trail is, after beneath it
  const rows = [[dy, other], [dy + off, other - off]];
  return rows.flatMap(row => [right, left].flatMap(at => row.map(down => [at, y + down]))).filter(one => one[0] >= 2);
}

// an instant is shown alike whatever was shown before: where names stand follows from what there is to name
export class Labels {
  constructor() { this.waiting = []; }

  // a name of (x, y) on the canvas, dx and dy away from it; first: it goes before others
  add(text, x, y, dx, dy, ink, first = false) { this.waiting.push({ text, x, y, dx, dy, ink, first }); }

  // put(text, x, y, ink) draws one; measure(text): how wide it is
  draw(measure, width, put) {
    const taken = [], waiting = this.waiting.sort((a, b) => b.first - a.first);
    const free = (x, y, wide) => taken.every(([x0, y0, w]) => x + wide + GAP < x0 || x0 + w + GAP < x || Math.abs(y - y0) >= HEIGHT);
    this.waiting = [];
    for (const one of waiting) {
      const wide = measure(one.text), all = sides(one.x, one.y, one.dx, one.dy, wide, width);
      const found = all.find(place => free(...place, wide)) ?? all[0];
      taken.push([...found, wide]);
      put(one.text, ...found, one.ink);
    }
  }
}

// a vehicle's label and id; one whose label is made from its id is called by that alone
export function named(vehicle) {
  const label = vehicle.label || "";
  return label.endsWith(` ${vehicle.id}`) ? label : `${label} ${vehicle.id}`.trim();
}
