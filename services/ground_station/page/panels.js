// The tables beside the map. All text is set as text, never as markup.

import { alertsAt, authorityAt, lastOf, pairsAt, positionAt } from "./instant.js";
import * as proofs from "./proofs.js";
import { seconds } from "./units.js";

const FEW = 6;
const by = id => document.getElementById(id);

export function cell(row, text, classes = "", tag = "td") {
  const made = document.createElement(tag);
  made.textContent = text;
  if (classes) made.className = classes;
  row.append(made);
  return made;
}

export function table(id, heads, rows) {
  const head = document.createElement("tr");
  for (const [text, classes] of heads) cell(head, text, classes, "th");
  replace(by(id), rows.length ? [head, ...rows] : []);
}

// what stands there and is not the same as what is to: the browser lays out anew no more than that
function replace(place, wanted) {
  wanted.forEach((made, k) => {
    const old = place.children[k];
    if (!old) place.append(made);
    else if (old.tagName === made.tagName && old.tagName === "TR" && !made.querySelector("button") && !old.querySelector("button")) same(old, made);
    else old.replaceWith(made);
  });
  while (place.children.length > wanted.length) place.lastChild.remove();
}

// a row without buttons, whose listeners would be another's
function same(old, made) {
  if (old.isEqualNode(made)) return;
  if (old.className !== made.className) old.className = made.className;
  if (old.dataset.aircraft !== made.dataset.aircraft) { old.replaceWith(made); return; }
  replaceCells(old, [...made.children]);
}

function replaceCells(old, cells) {
  cells.forEach((made, k) => {
    const there = old.children[k];
    if (!there) old.append(made);
    else if (!there.isEqualNode(made)) there.replaceWith(made);
  });
  while (old.children.length > cells.length) old.lastChild.remove();
}

export function row(...cells) {
  const made = document.createElement("tr");
  for (const [text, classes] of cells) cell(made, text, classes);
  return made;
}

export function aircraft(recording, state, words) {
  by("at").textContent = seconds(state.time);
  const alerts = alertsAt(recording, state), names = new Map(recording.vehicles.map(v => [String(v.id), v]));
  const rows = Object.keys(recording.tracks).flatMap(id => {
    const at = positionAt(recording.tracks[id], state.time), ours = names.get(id), seen = at && at.seen;
    const name = ours ? `${id} ${ours.label || ""}` : `${id} (traffic)`;
    const first = row([name], ...(seen
      ? [[words.altitude(at.alt), "n"], [words.speed(at.speed), "n"], [words.climb(at.climb), "n"], [words.course(at.course), "n"]]
      : [["–", "n"], ["–", "n"], ["–", "n"], ["–", "n"]]));
    const second = document.createElement("tr");
    const told = cell(second, "", "told");
    told.colSpan = 5;
    if (seen && ours) {
      const who = authorityAt(recording, Number(id), state.time), badge = document.createElement("b");
      badge.textContent = who.name ?? "not in the log";
      badge.className = who.name === "ICAROUS" ? "icarous" : "";
      const why = who.away ? ` since ${seconds(who.since)}: it takes no part in the mission` : who.name === "ICAROUS" ? ` since ${seconds(who.since)}: ${who.reason}` : "";
      told.append("authority ", badge, `${why} · link ${link(recording, Number(id), state.time)}${phase(recording, Number(id), state.time)}`);
    } else {
      told.append(seen ? "others' traffic" : at ? `not seen since ${seconds(at.last)}` : "not there yet");
    }
    if (seen && alerts[id]) told.append(alarm(alerts[id]));
    for (const made of [first, second]) {
      made.dataset.aircraft = id;
      made.classList.toggle("picked", state.picked === id);
    }
    return [first, second];
  });
  table("aircraft", [["aircraft"], ["altitude", "n"], ["speed", "n"], ["climb", "n"], ["course", "n"]], rows.length ? rows : [row(["none yet"])]);
}

function alarm({ level, time_s, own }) {
  const badge = document.createElement("b");
  badge.className = `alert level-${Math.min(Math.ceil(level), 3)}`;
  badge.textContent = `alert ${level} for ${own}${time_s === null ? "" : `, violation in ${time_s.toFixed(1)} s`}`;
  return badge;
}

function link(recording, id, time) {
  if (recording.links === null) return "not in the log";
  const said = lastOf(recording.links, id, time);
  return said ? (said.alive ? "alive" : "silent") : "not in the log";
}

function phase(recording, id, time) {
  const now = lastOf(recording.phases, id, time);
  return now ? ` · p${now.task} ${now.phase.toLowerCase()}` : "";
}

export function pairs(recording, state, words) {
  const found = pairsAt(recording, state.time), volume = recording.volume;
  by("pairs-note").textContent = volume
    ? `Measured between positions, not judged. Well clear uses ${words.distance(volume.dthr_m)} across, ${words.altitude(volume.zthr_m)} in altitude, and ${volume.tthr_s} s.`
    : "Measured between positions, not judged.";
  table("pairs", [["aircraft"], ["across", "n"], ["in altitude", "n"]],
    found.slice(0, FEW).map(p => row([`${p.one} and ${p.other}`], [words.distance(p.across), "n"], [words.altitude(p.above), "n"])));
  if (!found.length) by("pairs-note").textContent = "No two aircraft are there.";
  if (found.length > FEW) by("pairs-note").textContent += ` The nearest ${FEW} of ${found.length}.`;
}

export function verdicts(recording, words, go) {
  const said = recording.verdicts;
  if (said.why_none) {
    by("overall").textContent = by("overall").className = by("verdicts-at").textContent = "";
    by("verdicts-note").textContent = `Not judged here: ${said.why_none}.`;
    table("verdicts", [], []);
    return;
  }
  const so_far = said.so_far_ms !== undefined;
  by("overall").textContent = so_far ? `so far ${said.overall}` : said.overall;
  by("overall").className = said.overall;
  by("verdicts-at").textContent = so_far ? `so far, at ${seconds(said.so_far_ms)}` : "on the whole flight";
  by("verdicts-note").textContent = so_far ? "What is not broken is unknown unless the flight is flown to its end; margins are the least so far." : "As report.json says; `cratous certify` holds it against the log. A time is where the margin is least, or where it broke.";
  const rank = { violated: 0, unknown: 1, excused: 2, holds: 3 };
  const parts = said.details.filter(one => one.verdict !== "holds" || one.time_ms !== null)
    .sort((a, b) => rank[a.verdict] - rank[b.verdict]);
  const rows = [...said.requirements, ...parts].map((one, k) => {
    const whole = k < said.requirements.length;
    const made = row([whole ? `${one.requirement} ${one.title}` : one.item, whole ? "whole" : "part"], [one.verdict, one.verdict],
      [one.margin === null ? "–" : words.margin(one.margin, one.unit), "margin"]);
    made.title = one.note;
    const when = cell(made, "", "n");
    if (one.time_ms !== null && (one.margin !== null || one.verdict !== "holds")) {
      const jump = document.createElement("button");
      jump.type = "button";
      jump.className = "jump";
      jump.textContent = seconds(one.time_ms);
      jump.addEventListener("click", () => go(one.time_ms));
      when.append(jump);
    }
    if (said.proofs) {
      const parts = [...said.details.keys()].filter(n => whole ? said.details[n].requirement === one.requirement : said.details[n] === one);
      const why = document.createElement("button");
      why.type = "button";
      why.textContent = "proofs";
      why.addEventListener("click", () => proofs.show(recording, whole ? `${one.requirement} ${one.title}: ${one.verdict}` : `${one.requirement}: ${one.verdict}`, parts));
      cell(made, "", "n").append(why);
    }
    return made;
  });
  table("verdicts", [["requirement"], ["verdict"], ["margin", "n"], ["at", "n"], ...(said.proofs ? [["why", "n"]] : [])], rows);
}

export function tasks(recording, state) {
  by("tasks").parentElement.hidden = !recording.tasks.length;
  const rows = recording.tasks.map(task => {
    let now;
    for (const one of recording.phases) if (one.task === task.id && one.time_ms <= state.time) now = one;
    const told = recording.source !== "mission" ? "not in the log" : now ? `${now.phase.toLowerCase()} (vehicle ${now.vehicle}) since ${seconds(now.time_ms)}` : "not begun";
    return row([`p${task.id} ${task.label || ""}`], [task.kind.replaceAll("_", " ")], [told]);
  });
  table("tasks", [["task"], ["kind"], ["now"]], rows);
}

const listed = new WeakMap(); // of a list of events the first one, and how many of them it has

// `mark` shows which of them is the last at an instant; where there are only more, those are made
export function events(recording, go, list = by("events")) {
  const { events } = recording, kept = listed.get(list), grown = kept && kept.count && kept.first === events[0] && kept.count <= events.length;
  if (!grown) list.replaceChildren();
  listed.set(list, { first: events[0], count: events.length });
  list.append(...events.slice(grown ? kept.count : 0).map(event => {
    const item = document.createElement("li"), jump = document.createElement("button");
    jump.type = "button";
    jump.textContent = `${seconds(event.time_ms)}  ${event.vehicle === null ? "" : `vehicle ${event.vehicle}: `}${event.text}`;
    jump.addEventListener("click", () => go(event.time_ms));
    item.append(jump);
    return item;
  }));
}

export function mark(recording, state, list = by("events")) {
  let last = -1;
  recording.events.forEach((event, k) => { if (event.time_ms <= state.time) last = k; });
  [...list.children].forEach((item, k) => {
    const wanted = k === last ? "now" : k > last ? "ahead" : "";
    if (item.className !== wanted) item.className = wanted;
  });
}
