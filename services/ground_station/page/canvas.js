// A canvas that is sharp on any screen, and the colours of the page's style sheet.

const FONT = "12px system-ui, sans-serif";

export function sized(canvas) {
  const ratio = window.devicePixelRatio || 1, box = canvas.getBoundingClientRect();
  const width = Math.max(1, Math.round(box.width * ratio)), height = Math.max(1, Math.round(box.height * ratio));
  if (canvas.width !== width) canvas.width = width;
  if (canvas.height !== height) canvas.height = height;
  const pen = canvas.getContext("2d");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, box.width, box.height);
  pen.font = FONT;
  return { pen, width: box.width, height: box.height };
}

// a canvas behind a canvas: what was drawn on it stays until size, colours or `key` are others
export class Layer {
  constructor() { this.canvas = document.createElement("canvas"); this.key = null; }

  forget() { this.key = null; }

  // {pen, empty}: empty where nothing is drawn on it yet
  for(canvas, key) {
    const ratio = window.devicePixelRatio || 1, all = [canvas.width, canvas.height, ratio, document.documentElement.className, key].join();
    const pen = this.canvas.getContext("2d"), empty = this.key !== all;
    if (empty) {
      Object.assign(this.canvas, { width: canvas.width, height: canvas.height }); // clears it
      pen.setTransform(ratio, 0, 0, ratio, 0, 0);
      pen.font = FONT;
      this.key = all;
    }
    return { pen, empty };
  }

  onto(pen, width, height) { pen.drawImage(this.canvas, 0, 0, width, height); }
}

let kept = { theme: null, of: new Map() };

export function color(name) {
  const theme = document.documentElement.className;
  if (kept.theme !== theme) kept = { theme, of: new Map() };
  if (!kept.of.has(name)) kept.of.set(name, getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());
  return kept.of.get(name);
}

// ours get six colours in turn; other traffic has one
export function colorOf(recording, id) {
  const k = recording.vehicles.findIndex(v => String(v.id) === String(id));
  return color(k < 0 ? "traffic" : `c${k % 6}`);
}
