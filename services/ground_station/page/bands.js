// Bands and alerts of one vehicle, as the log has them: a compass ring around it on the map, tapes, and the same as text.

import { DIMENSIONS, own, said } from "./band_style.js";
import { color } from "./canvas.js";
import { bandsAt } from "./instant.js";
import * as panels from "./panels.js";
import { tapes } from "./tapes.js";
import { seconds } from "./units.js";

const by = id => document.getElementById(id);
const RADIUS = 66, TURN = Math.PI / 180;
// told apart by colour, width, dashes (whose round ends add their width) and word
const STYLES = {
  NEAR: { width: 10, dash: [] }, MID: { width: 8, dash: [10, 14] }, FAR: { width: 6, dash: [4, 12] }, RECOVERY: { width: 6, dash: [0.1, 10] },
};

// degrees clockwise from `from` to `to`; 0 to 360 is all of them
const wide = (from, to) => to - from >= 360 ? 360 : ((to - from) % 360 + 360) % 360;

export function ring(map, x, y, row) {
  const pen = map.pen, at = (deg, radius) => [x + radius * Math.sin(deg * TURN), y - radius * Math.cos(deg * TURN)];
  const bands = row.bands.heading ?? [], heading = own(row, "heading");
  pen.beginPath();
  pen.arc(x, y, RADIUS, 0, 7);
  for (let deg = 0; deg < 360; deg += 30) { pen.moveTo(...at(deg, RADIUS - 4)); pen.lineTo(...at(deg, RADIUS + 4)); }
  map.stroke(color("soft"), 1);
  for (const [from, to, region] of bands) {
    const { width, dash } = STYLES[region];
    pen.beginPath();
    pen.arc(x, y, RADIUS, (from - 90) * TURN, (from - 90 + wide(from, to)) * TURN);
    map.stroke(color(`band-${region.toLowerCase()}`), width, dash);
  }
  if (heading !== null) {
    pen.beginPath();
    pen.moveTo(...at(heading, RADIUS - 14)); pen.lineTo(...at(heading, RADIUS + 12));
    map.stroke(color("ink"), 2.5);
  }
  for (const [from, to, region] of bands) {
    const word = region.toLowerCase(), [right, down] = at(from + wide(from, to) / 2, RADIUS + 14);
    const size = pen.measureText(word).width, middle = from + wide(from, to) / 2;
    map.labels.add(word, right + size / 2 * (Math.sin(middle * TURN) - 1), down + 4, 0, 0, color(`band-${word}`), true);
  }
}

// all that is told beside the map of the vehicle whose bands are shown
export function panel(recording, state, words) {
  const shown = bandsAt(recording, state), ids = Object.keys(recording.bands), row = shown?.row ?? null;
  let rows = [], intruders = [], note;
  if (!ids.length) note = "Not in the log: it has no WellClearViolationIntervals.";
  else if (!shown) note = `Pick an aircraft: the log has bands of ${ids.join(", ")}.`;
  else if (!row) note = shown.since === undefined ? `Aircraft ${shown.id}: none told yet.` : `Aircraft ${shown.id}: none told since ${seconds(shown.since)}.`;
  else {
    note = `Aircraft ${shown.id}, told at ${seconds(row.time_ms)}: ${DIMENSIONS.map(one => `${one} ${said(own(row, one), one, words)}`).join(", ")}. ${Object.keys(row.bands).length ? "" : "No band. "}As the log's WellClearViolationIntervals say, not judged here.`;
    rows = DIMENSIONS.flatMap(one => (row.bands[one] ?? []).map(([from, to, region]) => panels.row([one], [`${said(from, one, words)} to ${said(to, one, words)}`], [region.toLowerCase(), `band ${region.toLowerCase()}`])));
    intruders = row.intruders.map(([id, time_s, level]) => panels.row([id], [time_s === null ? "–" : `${time_s.toFixed(1)} s`, "n"], [level ?? "–", "n"]));
  }
  by("bands-note").textContent = note;
  tapes(by("tapes"), shown && recording.bands[shown.id], row, words);
  panels.table("bands", [["of"], ["from, to"], ["band"]], rows);
  panels.table("intruders", [["intruder"], ["time to violation", "n"], ["alert level", "n"]], intruders);
}
