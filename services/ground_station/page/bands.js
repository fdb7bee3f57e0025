// Heading bands of one vehicle, as the log has them: a compass ring around it on the map, and the same as text.

import { color } from "./canvas.js";
import { bandsAt } from "./instant.js";
import * as panels from "./panels.js";
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
  pen.beginPath();
  pen.arc(x, y, RADIUS, 0, 7);
  for (let deg = 0; deg < 360; deg += 30) { pen.moveTo(...at(deg, RADIUS - 4)); pen.lineTo(...at(deg, RADIUS + 4)); }
  map.stroke(color("soft"), 1);
  for (const [from, to, region] of row.bands) {
    const { width, dash } = STYLES[region];
    pen.beginPath();
    pen.arc(x, y, RADIUS, (from - 90) * TURN, (from - 90 + wide(from, to)) * TURN);
    map.stroke(color(`band-${region.toLowerCase()}`), width, dash);
  }
  if (row.heading_deg !== null) {
    pen.beginPath();
    pen.moveTo(...at(row.heading_deg, RADIUS - 14)); pen.lineTo(...at(row.heading_deg, RADIUS + 12));
    map.stroke(color("ink"), 2.5);
  }
  for (const [from, to, region] of row.bands) {
    const word = region.toLowerCase(), [right, down] = at(from + wide(from, to) / 2, RADIUS + 14);
    const size = pen.measureText(word).width, middle = from + wide(from, to) / 2;
    map.label(word, right + size / 2 * (Math.sin(middle * TURN) - 1), down + 4, color(`band-${word}`));
  }
}

export function table(recording, state) {
  const said = bandsAt(recording, state), ids = Object.keys(recording.bands);
  let rows = [], intruders = [], note;
  if (!ids.length) note = "Not in the log: it has no WellClearViolationIntervals.";
  else if (!said) note = `Pick an aircraft: the log has bands of ${ids.join(", ")}.`;
  else if (!said.row) note = said.since === undefined ? `Aircraft ${said.id}: none told yet.` : `Aircraft ${said.id}: none told since ${seconds(said.since)}.`;
  else {
    const { row } = said, heading = row.heading_deg === null ? "not known" : `${row.heading_deg.toFixed(1)}°`;
    note = `Aircraft ${said.id}, told at ${seconds(row.time_ms)}: heading ${heading}. ${row.bands.length ? "" : "No band. "}As the log's WellClearViolationIntervals say, not judged here.`;
    rows = row.bands.map(([from, to, region]) => panels.row([`${from.toFixed(1)}° to ${to.toFixed(1)}°`], [region.toLowerCase(), `band ${region.toLowerCase()}`]));
    intruders = row.intruders.map(([id, time_s, level]) => panels.row([id], [time_s === null ? "–" : `${time_s.toFixed(1)} s`, "n"], [level ?? "–", "n"]));
  }
  by("bands-note").textContent = note;
  panels.table("bands", [["heading, clockwise"], ["band"]], rows);
  panels.table("intruders", [["intruder"], ["time to violation", "n"], ["alert level", "n"]], intruders);
}
