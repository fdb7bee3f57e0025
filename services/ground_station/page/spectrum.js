// Bands over time: one dimension of the vehicle that is shown, and beneath it the alert level of each intruder.

import { LEAST_PX as MOVED_PX, LEFT, RIGHT, listen } from "./altitude.js";
import { DIMENSIONS, REGIONS, alertColor, fill, own, pieces, said, scale } from "./band_style.js";
import { Layer, color, sized } from "./canvas.js";
import { UNSEEN_MS, bandsAt } from "./instant.js";
import { niceStep } from "./units.js";

const TOP = 4, STRIP = 11, MOST = 4, LEAST_PX = 1;

export class Spectrum {
  constructor(box, canvas, select, recording, go) {
    Object.assign(this, { box, canvas, select, recording });
    select.append(...DIMENSIONS.map(one => new Option(one, one)));
    listen(canvas, recording, go);
    this.layer = new Layer();
    this.grown();
  }

  // the recording has grown
  grown() {
    this.end_ms = Math.max(this.recording.end_ms, 1000);
    this.layer.forget();
  }

  // whole: also where the instant has not moved to be seen
  draw(state, words, whole = true) {
    if (!whole && (this.box.hidden || Math.abs(state.time - this.shown) / this.end_ms * this.canvas.width < MOVED_PX)) return;
    this.shown = state.time;
    const shown = bandsAt(this.recording, state);
    this.box.hidden = !Object.keys(this.recording.bands).length;
    if (this.box.hidden) return;
    this.select.value = state.dimension;
    const { pen, width, height } = sized(this.canvas), end = this.end_ms;
    if (!shown) {
      pen.fillStyle = color("soft");
      pen.fillText(`Pick an aircraft: the log has bands of ${Object.keys(this.recording.bands).join(", ")}.`, LEFT, 20);
      return;
    }
    const kept = this.layer.for(this.canvas, [shown.id, state.dimension, words.altitude(0)].join());
    if (kept.empty) this.all(kept.pen, width, height, end, shown.id, state.dimension, words);
    this.layer.onto(pen, width, height);
    const x = LEFT + (width - LEFT - RIGHT) * Math.min(state.time / end, 1);
    pen.strokeStyle = color("ink"); pen.lineWidth = 1.5;
    pen.beginPath(); pen.moveTo(x, 0); pen.lineTo(x, height); pen.stroke();
  }

  // all but the instant
  all(pen, width, height, end, id, dimension, words) {
    const rows = this.recording.bands[id], intruders = alerted(rows), bottom = height - STRIP * Math.min(Math.max(intruders.length, 1), MOST) - 4;
    const [low, high] = scale(rows, dimension), x = t => Math.round(LEFT + (width - LEFT - RIGHT) * t / end);
    const y = v => bottom - (bottom - TOP) * (Math.min(Math.max(v, low), high) - low) / (high - low);
    const until = k => Math.min(rows[k + 1]?.time_ms ?? Infinity, rows[k].time_ms + UNSEEN_MS, end);
    const wide = k => Math.max(x(until(k)) - x(rows[k].time_ms), LEAST_PX);
    rows.forEach((row, k) => {
      for (const [from, to, region] of pieces(row, dimension)) {
        if (to <= low || from >= high) continue;
        pen.fillStyle = fill(pen, region);
        pen.fillRect(x(row.time_ms), y(to), wide(k), Math.max(y(from) - y(to), 1));
      }
    });
    pen.strokeStyle = pen.fillStyle = color("soft"); pen.lineWidth = 1;
    pen.strokeRect(LEFT, TOP, width - LEFT - RIGHT, bottom - TOP);
    const step = dimension === "heading" ? 90 : niceStep((high - low) / words.unit[dimension] / 3) * words.unit[dimension];
    for (let level = Math.ceil(low / step) * step; level <= high; level += step) pen.fillText(dimension === "heading" ? `${level}°` : said(level, dimension, words), 2, Math.min(Math.max(y(level) + 4, 12), bottom));
    this.line(pen, rows, dimension, x, y);
    intruders.slice(0, MOST).forEach((one, n) => this.strip(pen, rows, one, bottom + 3 + n * STRIP, x, wide));
    pen.fillStyle = color("soft");
    if (!intruders.length) pen.fillText("no alert in the log", LEFT, height - 4);
    if (intruders.length > MOST) pen.fillText(`and ${intruders.length - MOST} more`, width - RIGHT - 70, height - 4);
    legend(pen, width - RIGHT);
  }

  // the own value; broken where none was told, and where it goes past north
  line(pen, rows, dimension, x, y) {
    pen.strokeStyle = color("ink"); pen.lineWidth = 2;
    pen.beginPath();
    rows.forEach((row, k) => {
      const value = own(row, dimension), before = k ? own(rows[k - 1], dimension) : null;
      if (value === null) return;
      const on = before !== null && row.time_ms - rows[k - 1].time_ms <= UNSEEN_MS && !(dimension === "heading" && Math.abs(value - before) > 180);
      if (on) pen.lineTo(x(row.time_ms), y(value)); else pen.moveTo(x(row.time_ms), y(value));
    });
    pen.stroke();
  }

  // a bar that is the higher, the higher the level
  strip(pen, rows, id, top, x, wide) {
    pen.fillStyle = color("soft");
    pen.fillText(`alert ${id}`, 2, top + STRIP - 2);
    rows.forEach((row, k) => {
      const level = row.intruders.find(one => one[0] === id)?.[2] ?? 0;
      if (!(level > 0)) return;
      const size = (STRIP - 1) * Math.min(level, 3) / 3;
      pen.fillStyle = alertColor(level);
      pen.fillRect(x(row.time_ms), top + STRIP - 1 - size, wide(k), size);
    });
  }
}

// the intruders with an alert, those of the highest level first
function alerted(rows) {
  const found = new Map();
  for (const row of rows) for (const [id, , level] of row.intruders) if (level > 0) found.set(id, Math.max(level, found.get(id) ?? 0));
  return [...found.keys()].sort((a, b) => found.get(b) - found.get(a) || a - b);
}

function legend(pen, right) {
  let x = right - 4;
  for (const region of [...REGIONS].reverse()) {
    const wide = pen.measureText(region).width;
    x -= wide + 24;
    pen.globalAlpha = 0.8; pen.fillStyle = color("paper");
    pen.fillRect(x - 2, TOP + 1, wide + 24, 15);
    pen.globalAlpha = 1; pen.fillStyle = fill(pen, region);
    pen.fillRect(x, TOP + 3, 14, 10);
    pen.fillStyle = color("ink");
    pen.fillText(region, x + 17, TOP + 12);
  }
}
