// Loads the recording, holds the state, and draws it whenever it changes.

import * as address from "./address.js";
import { AltitudeChart } from "./altitude.js";
import { Live } from "./live.js";
import { FlightMap } from "./map.js";
import * as panels from "./panels.js";
import { clock, words } from "./units.js";

const by = id => document.getElementById(id);
const SLOW_MS = 200; // tables and address follow at this pace while it plays

function theme(name) {
  const dark = name ? name === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  document.documentElement.className = dark ? "dark" : "";
}

function fail(text) {
  by("message").textContent = text;
  by("message").className = "error";
  by("message").setAttribute("role", "alert");
}

async function load() {
  let response, data;
  try {
    response = await fetch("/recording.json");
    data = await response.json();
  } catch (error) {
    throw new Error(`The server does not answer (${error.message}). Is \`cratous serve\` still running?`);
  }
  if (response.ok) return data;
  const rest = ["where", "item", "expected", "got"].filter(key => data[key]).map(key => `${key}: ${data[key]}`);
  throw new Error([`This log cannot be shown: ${data.error}`, ...rest].join("\n"));
}

class Station {
  constructor(recording) {
    this.recording = recording;
    const ids = Object.keys(recording.tracks);
    this.ids = ids;
    this.state = { time: 0, rate: 1, picked: null, theme: null, aviation: false, view: null, ...address.read(recording.end_ms, ids) };
    this.playing = false;
    this.slow = 0;
    const go = time => this.go(time);
    this.map = new FlightMap(by("map"), recording, view => { this.state.view = view; this.draw(true); });
    this.chart = new AltitudeChart(by("altitude"), recording, go);
    by("name").textContent = recording.name;
    document.title = `${recording.name} – CRATOUS ground station`;
    const log = recording.log;
    by("source").textContent = recording.live ? "flown now" : [`${log.file} (${log.kind})`, recording.outcome, log.end && !log.digest ? log.end : "", log.missing ? `${log.missing} messages are missing` : "", recording.unread ? `${recording.unread} messages could not be decoded` : ""].filter(Boolean).join(" · ");
    by("slider").max = recording.end_ms;
    by("rate").append(...address.RATES.map(rate => new Option(`${rate}×`, rate)));
    panels.events(recording, go);
    panels.verdicts(recording, this.state, go);
    panels.tasks(recording, this.state);
    this.live = null;
    this.listen();
    if (recording.live) this.fly();
  }

  // a flight that is flown now: the newest instant is shown unless the operator looks back
  fly() {
    this.follow = true;
    for (const id of ["play", "rate-box"]) by(id).hidden = true;
    this.live = new Live(this.recording, updates => this.grown(updates));
  }

  grown(updates) {
    const { recording } = this, go = time => this.go(time);
    this.ids = Object.keys(recording.tracks);
    this.map.grown();
    this.chart.grown();
    by("slider").max = recording.end_ms;
    if (updates.some(update => update.more?.events)) panels.events(recording, go);
    if (updates.some(update => update.set?.verdicts)) panels.verdicts(recording, this.state, go);
    if (this.follow) this.state.time = recording.end_ms;
    this.draw(true);
  }

  go(time) {
    this.follow = time >= this.recording.end_ms;
    this.state.time = Math.min(Math.max(time, 0), this.recording.end_ms);
    this.draw(true);
  }

  event(way) {
    const times = this.recording.events.map(event => event.time_ms), now = this.state.time;
    const found = way > 0 ? times.filter(t => t > now) : times.filter(t => t < now);
    if (found.length) this.go(way > 0 ? Math.min(...found) : Math.max(...found));
  }

  play(on) {
    if (this.live) { this.live.toggle(); return; }
    if (on && this.state.time >= this.recording.end_ms) this.state.time = 0;
    this.playing = on;
    this.last = performance.now();
    if (on) requestAnimationFrame(now => this.frame(now));
    this.draw(true);
  }

  frame(now) {
    if (!this.playing) return;
    this.state.time = Math.min(this.state.time + Math.max(0, now - this.last) * this.state.rate, this.recording.end_ms);
    this.last = now;
    if (this.state.time >= this.recording.end_ms) this.playing = false;
    this.draw(!this.playing);
    if (this.playing) requestAnimationFrame(later => this.frame(later));
  }

  // whole: the tables and the address too; else they follow at their own pace
  draw(whole) {
    const { state, recording } = this, said = words(state.aviation);
    theme(state.theme);
    this.map.draw(state, said);
    this.chart.draw(state, said);
    by("slider").value = state.time;
    by("clock").textContent = `${clock(state.time)} of ${clock(recording.end_ms)}`;
    const now = performance.now();
    if (!whole && now - this.slow < SLOW_MS) return;
    this.slow = now;
    by("play").textContent = this.playing ? "Pause" : "Play";
    by("rate").value = state.rate;
    by("units").textContent = state.aviation ? "aviation units" : "SI units";
    panels.aircraft(recording, state, said);
    panels.pairs(recording, state, said);
    panels.tasks(recording, state);
    panels.mark(recording, state);
    address.write(state);
  }

  rate(by_) {
    if (this.live) { this.live.rate(by_); return; }
    const k = address.RATES.indexOf(this.state.rate) + by_;
    this.state.rate = address.RATES[Math.min(Math.max(k, 0), address.RATES.length - 1)];
    this.draw(true);
  }

  turn(what) {
    if (what === "theme") this.state.theme = document.documentElement.className === "dark" ? "light" : "dark";
    if (what === "units") this.state.aviation = !this.state.aviation;
    if (what === "whole") this.state.view = null;
    this.draw(true);
  }

  listen() {
    const on = (id, act) => by(id).addEventListener("click", act);
    on("play", () => this.play(!this.playing));
    on("step", () => this.go(this.state.time + 1000));
    on("back", () => this.go(this.state.time - 1000));
    on("now", () => this.go(this.recording.end_ms));
    on("after", () => this.event(1));
    on("before", () => this.event(-1));
    on("units", () => this.turn("units"));
    on("theme", () => this.turn("theme"));
    on("whole", () => this.turn("whole"));
    on("closer", () => this.map.zoom(1.5));
    on("farther", () => this.map.zoom(1 / 1.5));
    by("slider").addEventListener("input", () => this.go(Number(by("slider").value)));
    by("rate").addEventListener("change", () => { this.state.rate = Number(by("rate").value); this.draw(true); });
    by("aircraft").addEventListener("click", event => {
      const id = event.target.closest("tr")?.dataset.aircraft;
      if (id) { this.state.picked = this.state.picked === id ? null : id; this.draw(true); }
    });
    by("map").addEventListener("pointermove", event => {
      const [north, east] = this.map.under(event.offsetX, event.offsetY);
      by("cursor").textContent = `north ${north.toFixed(0)} m, east ${east.toFixed(0)} m`;
    });
    window.addEventListener("resize", () => this.draw(true));
    window.addEventListener("hashchange", () => {
      Object.assign(this.state, address.read(this.recording.end_ms, this.ids));
      this.draw(true);
    });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw(true));
    window.addEventListener("keydown", event => this.key(event));
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const tag = event.target.tagName, onMap = event.target === by("map");
    if (tag === "SELECT" || (tag === "BUTTON" && [" ", "Enter"].includes(event.key))) return;
    const time = event.shiftKey ? 10000 : 1000, moves = { ArrowLeft: [60, 0], ArrowRight: [-60, 0], ArrowUp: [0, 60], ArrowDown: [0, -60] };
    const acts = {
      " ": () => this.play(!this.playing), n: () => this.event(1), p: () => this.event(-1),
      ArrowLeft: () => this.go(this.state.time - time), ArrowRight: () => this.go(this.state.time + time),
      Home: () => this.go(0), End: () => this.go(this.recording.end_ms),
      "[": () => this.rate(-1), "]": () => this.rate(1), "+": () => this.map.zoom(1.5), "-": () => this.map.zoom(1 / 1.5),
      f: () => this.turn("whole"), u: () => this.turn("units"), d: () => this.turn("theme"),
    };
    if (onMap && event.shiftKey && moves[event.key]) this.map.move(...moves[event.key]);
    else if (acts[event.key]) acts[event.key]();
    else return;
    event.preventDefault();
  }
}

theme(new URLSearchParams(location.hash.slice(1)).get("theme"));
try {
  const recording = await load();
  by("message").hidden = true;
  by("station").hidden = false;
  const station = new Station(recording);
  station.draw(true);
  if (!recording.live && !Object.keys(recording.tracks).length) {
    by("message").hidden = false;
    by("message").textContent = "This log has no positions of aircraft; its events are listed beside the map.";
  }
} catch (error) {
  by("station").hidden = true;
  by("message").hidden = false;
  fail(error.message);
}
