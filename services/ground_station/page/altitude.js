// Altitudes over time, with the spans under ICAROUS and the instant that is shown.

import { Layer, color, colorOf, niceStep, sized } from "./canvas.js";
import { UNSEEN_MS } from "./instant.js";

export const LEFT = 66, RIGHT = 10;
const TOP = 8, BOTTOM = 18;

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
    this.layer.forget();
  }

  draw(state, words) {
    const { pen, width, height } = sized(this.canvas), end = Math.max(this.recording.end_ms, 1000);
    if (this.low > this.high) return;
    const kept = this.layer.for(this.canvas, words.altitude(0));
    if (kept.empty) this.tracks(kept.pen, width, height, end, words);
    this.layer.onto(pen, width, height);
    const x = LEFT + (width - LEFT - RIGHT) * state.time / end;
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
    for (let t = 0; t <= end; t += every) pen.fillText(`${t / 1000} s`, x(t) - 8, height - 4);
    pen.lineWidth = 2;
    for (const [id, track] of Object.entries(this.recording.tracks)) {
      pen.strokeStyle = colorOf(this.recording, id);
      pen.beginPath();
      track.forEach((row, k) => {
        const broken = k && row[0] - track[k - 1][0] > UNSEEN_MS;
        if (k && !broken) pen.lineTo(x(row[0]), y(row[3])); else pen.moveTo(x(row[0]), y(row[3]));
      });
      pen.stroke();
    }
  }
}
