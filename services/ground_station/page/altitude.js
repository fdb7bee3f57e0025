// Altitudes over time, with the spans under ICAROUS and the instant that is shown.

import { Layer, color, colorOf, sized } from "./canvas.js";
import { UNSEEN_MS } from "./instant.js";
import { niceStep } from "./units.js";

export const LEFT = 66, RIGHT = 10;
const TOP = 8, BOTTOM = 18;
export const LEAST_PX = 0.5; // what has moved by less is not drawn anew

// a click on a chart goes to its instant
export function listen(canvas, recording, go) {
  canvas.addEventListener("pointerdown", event => {
    const box = canvas.getBoundingClientRect();
    go((event.offsetX - LEFT) / (box.width - LEFT - RIGHT) * recording.end_ms);
  });
}

export class AltitudeChart {
  constructor(canvas, recording, go) {
    this.canvas = canvas;
    this.recording = recording;
    listen(canvas, recording, go);
    this.layer = new Layer();
    this.grown();
  }

  // the recording has grown
  grown() {
    let low = Infinity, high = -Infinity;
    for (const track of Object.values(this.recording.tracks)) for (const row of track) { low = Math.min(low, row[3]); high = Math.max(high, row[3]); }
    this.low = low; this.high = high;
    this.end_ms = Math.max(this.recording.end_ms, 1000);
    this.layer.forget();
  }

  // whole: also where the instant has not moved to be seen
  draw(state, words, whole = true) {
    const end = this.end_ms;
    if (!whole && Math.abs(state.time - this.shown) / end * this.canvas.width < LEAST_PX) return;
    const { pen, width, height } = sized(this.canvas);
    this.shown = state.time;
    if (this.low > this.high) return;
    const kept = this.layer.for(this.canvas, words.altitude(0));
    if (kept.empty) this.tracks(kept.pen, width, height, end, words);
    this.layer.onto(pen, width, height);
    const x = LEFT + (width - LEFT - RIGHT) * Math.min(state.time / end, 1);
    pen.strokeStyle = color("ink"); pen.lineWidth = 1.5;
    pen.beginPath(); pen.moveTo(x, 0); pen.lineTo(x, height - BOTTOM + 4); pen.stroke();
  }

  // all but the instant
  tracks(pen, width, height, end, words) {
    const step = niceStep(Math.max(this.high - this.low, 40) / words.unit.altitude / 2) * words.unit.altitude;
    const low = (Math.ceil(this.low / step) - 1) * step, high = (Math.floor(this.high / step) + 1) * step;
    const x = t => LEFT + (width - LEFT - RIGHT) * t / end, y = alt => height - BOTTOM - (height - TOP - BOTTOM) * (alt - low) / (high - low);
    pen.fillStyle = color("icarous");
    pen.globalAlpha = 0.2;
    for (const t of this.recording.takeovers) pen.fillRect(x(t.from_ms), TOP, Math.max(1, x(t.to_ms ?? end) - x(t.from_ms)), height - TOP - BOTTOM);
    pen.globalAlpha = 1;
    for (const t of this.recording.takeovers) pen.fillText(`ICAROUS, ${t.vehicle}`, x(t.from_ms) + 3, TOP + 11);
    pen.strokeStyle = color("rule"); pen.fillStyle = color("soft"); pen.lineWidth = 1;
    for (let level = low; level <= high + step / 2; level += step) {
      pen.beginPath(); pen.moveTo(LEFT, y(level)); pen.lineTo(width - RIGHT, y(level)); pen.stroke();
      pen.fillText(words.altitude(level), 2, y(level) + 4);
    }
    const every = niceStep(end / 1000 / 8) * 1000;
    for (let t = 0; t <= end; t += every) {
      const said = `${t / 1000} s`;
      pen.fillText(said, Math.min(x(t) - 8, width - pen.measureText(said).width - 2), height - 4);
    }
    pen.lineWidth = 2;
    for (const [id, track] of Object.entries(this.recording.tracks)) {
      pen.strokeStyle = colorOf(this.recording, id);
      pen.beginPath();
      for (const [row, on] of seen(track, (end / (width - LEFT - RIGHT)) / 2)) {
        if (on) pen.lineTo(x(row[0]), y(row[3])); else pen.moveTo(x(row[0]), y(row[3]));
      }
      pen.stroke();
    }
  }
}

// the rows of a track that are seen, and whether a line leads there: of those within `apart_ms` (half a pixel) the first,
// the lowest, the highest and the last
export function* seen(track, apart_ms) {
  for (let k = 0; k < track.length;) {
    const first = k, on = k > 0 && track[k][0] - track[k - 1][0] <= UNSEEN_MS;
    let low = k, high = k;
    while (k + 1 < track.length && track[k + 1][0] - track[first][0] < apart_ms && track[k + 1][0] - track[k][0] <= UNSEEN_MS) {
      k++;
      if (track[k][3] < track[low][3]) low = k;
      if (track[k][3] > track[high][3]) high = k;
    }
    yield [track[first], on];
    for (const one of new Set([Math.min(low, high), Math.max(low, high), k])) if (one !== first) yield [track[one], true];
    k++;
  }
}
