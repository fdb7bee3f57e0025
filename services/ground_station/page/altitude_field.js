// The altitude of a command: typed in the units of the page, above mean sea level or above the ground; sent in metres MSL.

import { words } from "./units.js";

const by = id => document.getElementById(id);
const MOST_M = 100000; // of a mission file
const SI = words(false), AVIATION = words(true);
const both = m => `${SI.altitude(m)} (${AVIATION.altitude(m)})`;

export class AltitudeField {
  // changed: called whenever it is typed in
  constructor(recording, changed) {
    this.recording = recording;
    this.aviation = false;
    for (const id of ["command-alt", "command-alt-from"]) by(id).addEventListener("input", () => { this.show(); changed(); });
  }

  // for a command that has an altitude; left_empty: what that says
  open(aviation, left_empty) {
    Object.assign(this, { aviation, left_empty });
    by("command-alt-box").hidden = false;
    by("command-alt").value = "";
    by("command-alt-unit").textContent = aviation ? "ft" : "m";
    this.show();
  }

  close() { by("command-alt-box").hidden = true; }

  get empty() { return by("command-alt-box").hidden || (by("command-alt").value.trim() === "" && !by("command-alt").validity.badInput); }

  // of its zero above mean sea level [m]
  get base_m() { return by("command-alt-from").value === "agl" ? this.recording.frame.terrain_m : 0; }

  // above mean sea level, to a decimetre; NaN where it says no number
  get alt_m() {
    const text = by("command-alt").value.trim();
    return text === "" ? NaN : Math.round((this.base_m + Number(text) * words(this.aviation).unit.altitude) * 10) / 10;
  }

  get good() { return this.empty || (this.alt_m > this.recording.floor_m && this.alt_m <= MOST_M); }

  // what goes into the command
  get told() { return this.empty ? {} : { alt_m: this.alt_m }; }

  show() {
    const { recording, alt_m, good } = this, note = by("command-alt-note"), { terrain_m } = recording.frame;
    const bounds = `more than ${both(recording.floor_m)}, ${both(MOST_M)} at most, above mean sea level`;
    note.className = good ? "soft" : "wrong";
    note.textContent = !good ? `Expected ${bounds}.`
      : this.empty ? `Left empty: ${this.left_empty}. Else ${bounds}.`
        : `${both(alt_m)} above mean sea level, ${both(alt_m - terrain_m)} above the ground.`;
    by("command-alt").setAttribute("aria-invalid", String(!good));
  }
}
