// Where names stand on a map: beside what they name, and not on each other while there is room.

const HEIGHT = 15, RISE = 11, GAP = 2;

// where a name may stand about a point, on a canvas so wide: as asked for, on another side of it, or a line farther off
function sides(x, y, dx, dy, wide, width) {
  if (x < 0 || x > width) return [[x + dx, y + dy]]; // what is not on the canvas is not named there
  const right = Math.max(2, Math.min(x + dx, width - wide - 4)), left = x - dx - wide;
  const other = dy < 0 ? RISE - dy : -dy, off = dy < 0 ? -HEIGHT : HEIGHT;
  // a line farther off last, and where it came from rather than that
  const rows = [[dy, other], [dy + off, other - off]];
  return rows.flatMap(row => [right, left].flatMap(at => row.map(down => [at, y + down]))).filter(one => one[0] >= 2);
}

export class Labels {
  constructor() { this.kept = new Map(); this.begin(); }

  begin() { this.waiting = []; }

  // of what `key` says, at (x, y) of the canvas, dx and dy away from it; first: it goes before others
  add(key, text, x, y, dx, dy, ink, first = false) { this.waiting.push({ key, text, x, y, dx, dy, ink, first }); }

  // put(text, x, y, ink) draws one; measure(text): how wide it is. A name stays on its side while that is free, so that
  // it does not jump while its aircraft flies by.
  draw(measure, width, put) {
    const taken = [], kept = new Map();
    const free = (x, y, wide) => taken.every(([x0, y0, w]) => x + wide + GAP < x0 || x0 + w + GAP < x || Math.abs(y - y0) >= HEIGHT);
    for (const one of this.waiting.sort((a, b) => b.first - a.first)) {
      const wide = measure(one.text), all = sides(one.x, one.y, one.dx, one.dy, wide, width), last = this.kept.get(one.key) ?? 0;
      const found = [last, ...all.keys()].find(k => k < all.length && free(...all[k], wide)) ?? 0;
      kept.set(one.key, found);
      taken.push([...all[found], wide]);
      put(one.text, ...all[found], one.ink);
    }
    this.kept = kept;
    this.begin();
  }
}
