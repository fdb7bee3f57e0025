// Two runs side by side: one clock, a map, events and altitudes of each, and the rows in which they differ.

import { AltitudeChart } from "./altitude.js";
import { authorityAt } from "./instant.js";
import { FlightMap } from "./map.js";
import { open, source, theme } from "./opening.js";
import { cell, events, mark, row, table } from "./panels.js";
import { Playback } from "./playback.js";
import { seconds, words } from "./units.js";

const by = id => document.getElementById(id);
const NEAR_MS = 50; // a row is marked while the clock stands on its instant, to a tenth of a second

// a run that ends before the other one, on the clock of both
function onClockTo(end_ms, recording) {
  return { ...recording, end_ms, ended_ms: recording.end_ms,
    takeovers: recording.takeovers.map(one => ({ ...one, to_ms: one.to_ms ?? recording.end_ms })) };
}

// a pane of the page for a side, before the differences
function pane(side) {
  const made = by("pane").content.cloneNode(true), letter = side.toUpperCase();
  for (const one of made.querySelectorAll("*")) {
    if (one.id) one.id = `${one.id}-${side}`;
    if (one.ariaLabel) one.ariaLabel = one.ariaLabel.replace("{side}", letter);
  }
  made.querySelector(".side").textContent = letter;
  by("station").querySelector("aside").before(made);
}

class Pane {
  constructor(side, recording, alone, station) {
    this.side = side;
    pane(side);
    this.recording = recording;
    this.alone = alone; // places of the events that the other run does not have
    this.map = new FlightMap(this.by("map"), recording, view => { station.state.view = view; station.draw(true); });
    this.map.lay(recording.frame, () => station.draw(true));
    this.chart = new AltitudeChart(this.by("altitude"), recording, time => station.go(time));
    const said = recording.verdicts;
    this.by("overall").textContent = said.overall ?? "not judged";
    this.by("overall").classList.add(said.overall ?? "unknown");
    this.by("run").textContent = recording.run;
    this.by("source").textContent = source({ ...recording, outcome: `${recording.outcome} at ${seconds(recording.ended_ms)}` });
    events(recording, time => station.go(time), this.by("events"));
  }

  by(name) { return by(`${name}-${this.side}`); }

  draw(state, said, due) {
    this.map.draw(state, said, due);
    this.chart.draw(state, said, due);
  }

  lists(state) {
    const { recording } = this;
    const list = this.by("events");
    mark(recording, state, list);
    [...list.children].forEach((item, k) => item.classList.toggle("differs", this.alone.has(k)));
    const last = list.querySelector(".now");
    if (last !== this.last) list.scrollTop = last ? last.offsetTop - list.offsetTop - last.offsetHeight : 0;
    this.last = last;
    const who = recording.vehicles.map(vehicle => {
      const at = authorityAt(recording, vehicle.id, state.time), since = at.name === "ICAROUS" || at.away ? ` since ${seconds(at.since)}` : "";
      return `${vehicle.id} ${vehicle.label || ""}: ${at.name ?? "not in the log"}${since}`;
    });
    const over = state.time > recording.ended_ms ? ` · the flight ended at ${seconds(recording.ended_ms)}` : "";
    this.by("now").textContent = `authority ${who.join(" · ")}${over}`;
  }
}

// the places of the events that the other run does not have at the same instant
function alone(mine, others) {
  const key = event => JSON.stringify([event.time_ms, event.vehicle, event.text]), count = new Map();
  for (const event of others) count.set(key(event), (count.get(key(event)) || 0) + 1);
  return new Set(mine.flatMap((event, k) => {
    const left = count.get(key(event)) || 0;
    count.set(key(event), left - 1);
    return left > 0 ? [] : [k];
  }));
}

class Pair extends Playback {
  constructor(found) {
    super();
    this.end_ms = Math.max(found.a.end_ms, found.b.end_ms);
    this.differences = found.differences;
    this.panes = [["a", "b"], ["b", "a"]].map(([side, other]) => new Pane(side, onClockTo(this.end_ms, found[side]), alone(found[side].events, found[other].events), this));
    const [a, b] = this.panes;
    this.maps = [a.map, b.map];
    this.ids = [...new Set(this.panes.flatMap(pane => Object.keys(pane.recording.tracks)))];
    this.instants = [...found.a.events, ...found.b.events, ...this.differences.flatMap(one => [one.a, one.b])]
      .filter(one => one && one.time_ms !== null).map(one => one.time_ms);
    // both maps and both charts have the same scale
    const [one, two] = this.maps.map(map => map.bounds);
    const bounds = { north0: Math.min(one.north0, two.north0), north1: Math.max(one.north1, two.north1), east0: Math.min(one.east0, two.east0), east1: Math.max(one.east1, two.east1), fastest: Math.max(one.fastest, two.fastest) };
    const low = Math.min(a.chart.low, b.chart.low), high = Math.max(a.chart.high, b.chart.high);
    for (const pane of this.panes) { pane.map.bounds = bounds; Object.assign(pane.chart, { low, high }); }
    const names = found.a.name === found.b.name ? found.a.name : `${found.a.name} and ${found.b.name}`;
    by("name").textContent = names;
    document.title = `${names}, two runs – CRATOUS ground station`;
    this.table(found);
    this.listen();
  }

  table(found) {
    this.rows = this.differences.map(one => {
      const made = row([`${one.item} `]), side = document.createElement("div");
      side.textContent = one.side;
      side.className = `mark ${one.side.toLowerCase().replace(" ", "-")}`;
      made.firstChild.append(side);
      for (const said of [one.a, one.b]) this.said(cell(made, ""), said);
      return made;
    });
    // each kind has a line of its own above its rows
    const shown = this.rows.flatMap((made, k) => {
      if (k && this.differences[k - 1].kind === this.differences[k].kind) return [made];
      const kind = document.createElement("tr");
      cell(kind, this.differences[k].kind, "kind", "th").colSpan = 3;
      return [kind, made];
    });
    table("differences", [["what"], ["A"], ["B"]], shown);
    by("count").textContent = `(${this.rows.length})`;
    const digests = [found.a.log.digest, found.b.log.digest];
    const same = !digests.every(Boolean) ? "A log that was not closed has no digest." : digests[0] === digests[1] ? "Both logs have the same digest." : "The digests of the logs are not the same.";
    const missing = found.verdicts_why_none.map(why => `Verdicts are not compared. ${why}.`);
    const told = this.rows.length ? "A time goes there." : "None in what is compared.";
    const verdicts = missing.length ? "" : "verdicts and margins of report.json, ";
    by("differences-note").textContent = [told, same, ...missing, `Compared: settings and mission, ${verdicts}takeovers, tasks, plans, routes (waypoints north and east, to 0.1 m), events, the end, positions of aircraft once a second, to 0.1 m (from the first that is not the same). What comes several times is paired in its order.`].join(" ");
  }

  said(place, said) {
    if (!said) { place.textContent = "–"; return; }
    if (said.time_ms !== null) {
      const jump = document.createElement("button");
      jump.type = "button";
      jump.textContent = seconds(said.time_ms);
      jump.addEventListener("click", () => this.go(said.time_ms));
      place.append(jump, " ");
    }
    place.append(said.text);
  }

  draw(whole) {
    const { state } = this, said = words(state.aviation), due = this.due(whole);
    if (due) theme(state.theme);
    // one view for both: of two maps of other heights the whole flight fits into either
    const view = state.view || this.maps.map(map => map.whole()).sort((one, two) => one.scale - two.scale)[0];
    for (const pane of this.panes) pane.draw({ ...state, view }, said, due);
    if (!this.bar(due)) return;
    for (const pane of this.panes) pane.lists(state);
    const near = one => one && one.time_ms !== null && Math.abs(one.time_ms - state.time) <= NEAR_MS;
    this.rows.forEach((made, k) => made.classList.toggle("near", !!(near(this.differences[k].a) || near(this.differences[k].b))));
    this.address();
  }
}

await open(found => new Pair(found).draw(true));
