// Three tapes, of speed, climb and altitude: bands of the vehicle that is shown, and its own value.

import { DIMENSIONS, fill, own, pieces, said, scale } from "./band_style.js";
import { color, sized } from "./canvas.js";
import { niceStep } from "./units.js";

const TOP = 24, BOTTOM = 8, LEFT = 44, WIDE = 18;

// rows: all of the vehicle, row: of this instant
export function tapes(canvas, rows, row, words) {
  canvas.hidden = !row;
  if (!row) return;
  const { pen, width, height } = sized(canvas);
  DIMENSIONS.slice(1).forEach((dimension, k) => tape(pen, k * width / 3, height, dimension, rows, row, words));
}

// where a word stands that would be at `y`, but not on the own value
const beside = (y, taken) => Math.abs(y - taken) < 16 ? taken + (y > taken ? 16 : -16) : y;

function tape(pen, x, height, dimension, rows, row, words) {
  const [low, high] = scale(rows, dimension), value = own(row, dimension);
  const number = v => said(v, dimension, words).split(" ");
  const y = v => height - BOTTOM - (height - TOP - BOTTOM) * (Math.min(Math.max(v, low), high) - low) / (high - low);
  pen.fillStyle = color("soft");
  pen.fillText(`${dimension}, ${number(0)[1]}`, x, 11);
  pen.fillStyle = color("rule");
  pen.fillRect(x + LEFT, TOP, WIDE, height - TOP - BOTTOM);
  for (const [from, to, region] of pieces(row, dimension)) {
    if (to <= low || from >= high) continue;
    pen.fillStyle = fill(pen, region);
    pen.fillRect(x + LEFT, y(to), WIDE, y(from) - y(to));
    pen.fillStyle = color(`band-${region}`);
    if (y(from) - y(to) > 12) pen.fillText(region, x + LEFT + WIDE + 4, beside((y(to) + y(from)) / 2, value === null ? -1e9 : y(value)) + 4);
  }
  pen.fillStyle = color("soft");
  const { [dimension]: unit } = words.unit, step = niceStep((high - low) / unit / 4) * unit;
  for (let level = Math.ceil(low / step) * step; level <= high; level += step) pen.fillText(number(level)[0], x, y(level) + 4);
  if (value === null) return;
  const at = y(value), text = number(value)[0];
  pen.fillStyle = color("ink");
  pen.beginPath();
  pen.moveTo(x + LEFT + WIDE - 2, at); pen.lineTo(x + LEFT + WIDE + 9, at - 7); pen.lineTo(x + LEFT + WIDE + 9, at + 7);
  pen.fill();
  pen.fillRect(x + LEFT - 2, at - 1, WIDE + 4, 2);
  pen.fillRect(x + LEFT + WIDE + 9, at - 8, pen.measureText(text).width + 6, 16);
  pen.fillStyle = color("paper");
  pen.fillText(text, x + LEFT + WIDE + 12, at + 4);
}
