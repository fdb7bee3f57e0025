// How bands and alerts are drawn: told apart by colour and pattern, and by words beside them.

import { color } from "./canvas.js";

// in the order of the own values of a row
export const DIMENSIONS = ["heading", "speed", "climb", "altitude"];
export const REGIONS = ["near", "mid", "far", "recovery"];
const SIDE = 8;
const made = { theme: null, of: {} };

export const own = (row, dimension) => row.own[DIMENSIONS.indexOf(dimension)];

export function said(value, dimension, words) {
  return value === null ? "not known" : { heading: v => `${v.toFixed(1)}°`, speed: words.speed, climb: words.climb, altitude: words.altitude }[dimension](value);
}

// near is full, mid has stripes, far has dots, recovery has bars
const LINES = {
  mid: [[0, SIDE, SIDE, 0], [-2, 2, 2, -2], [SIDE - 2, SIDE + 2, SIDE + 2, SIDE - 2]],
  far: [[1, 2, 3, 2], [5, 6, 7, 6]],
  recovery: [[0, 2, SIDE, 2], [0, 6, SIDE, 6]],
};

export function fill(pen, region) {
  const theme = document.documentElement.className;
  if (made.theme !== theme) Object.assign(made, { theme, of: {} });
  return made.of[region] ??= pattern(pen, region);
}

function pattern(pen, region) {
  const ink = color(`band-${region}`);
  if (region === "near") return ink;
  const tile = document.createElement("canvas"), on = tile.getContext("2d");
  tile.width = tile.height = SIDE;
  Object.assign(on, { fillStyle: ink, strokeStyle: ink, globalAlpha: 0.28 });
  on.fillRect(0, 0, SIDE, SIDE);
  on.globalAlpha = 1;
  on.lineWidth = region === "mid" ? 2.5 : 2;
  on.beginPath();
  for (const [x0, y0, x1, y1] of LINES[region]) { on.moveTo(x0, y0); on.lineTo(x1, y1); }
  on.stroke();
  return pen.createPattern(tile, "repeat");
}

// a level's colour; whoever draws it also makes a higher one bigger
export const alertColor = level => color(`band-${level >= 3 ? "near" : level >= 2 ? "mid" : "far"}`);

const scales = new WeakMap();

// [low, high] of what is drawn of a dimension: the own values, and of each band its end that is nearest to them
export function scale(rows, dimension) {
  if (dimension === "heading") return [0, 360];
  const kept = scales.get(rows) ?? { count: 0, of: {} };
  if (kept.count !== rows.length) Object.assign(kept, { count: rows.length, of: {} });
  scales.set(rows, kept);
  return kept.of[dimension] ??= spanned(rows, dimension);
}

function spanned(rows, dimension) {
  let low = Infinity, high = -Infinity;
  const take = value => { low = Math.min(low, value); high = Math.max(high, value); };
  for (const row of rows) {
    const value = own(row, dimension);
    if (value === null) continue;
    take(value);
    for (const [from, to] of row.bands[dimension] ?? []) take(Math.abs(from - value) < Math.abs(to - value) ? from : to);
  }
  if (low > high) return [0, 1];
  const edge = Math.max(0.15 * (high - low), 0.02 * Math.max(Math.abs(low), Math.abs(high)), 0.5);
  return [low - edge, high + edge];
}

// bands of a row as [from, to, region], none of which goes past north
export function pieces(row, dimension) {
  return (row.bands[dimension] ?? []).flatMap(([from, to, region]) => {
    const name = region.toLowerCase();
    return dimension === "heading" && to < from ? [[from, 360, name], [0, to, name]] : [[from, to, name]];
  });
}
