// The clock of a page that replays: go, play, step, next event, rate; its buttons and keys.

import * as address from "./address.js";
import { DIMENSIONS } from "./band_style.js";
import { clock } from "./units.js";

const by = id => document.getElementById(id);
const SLOW_MS = 200; // what follows at a slower pace while it plays
const CLOCK_MS = 90; // so often, at most, the clock and the slider: each of them lays out the page
const ADDRESS_MS = 1000; // so often, at most, the address: browsers take few of them
const MOVES = { ArrowLeft: [-60, 0], ArrowRight: [60, 0], ArrowUp: [0, -60], ArrowDown: [0, 60] };

// whoever extends it gives `end_ms`, `instants` of the events, `ids` of the aircraft, `maps`, and `draw`
export class Playback {
  constructor() {
    this.state = { time: 0, rate: 1, picked: null, theme: null, aviation: false, view: null, dimension: DIMENSIONS[0] };
    this.playing = false;
    this.slow = this.clocked = this.addressed = 0;
  }

  go(time) {
    this.state.time = Math.min(Math.max(time, 0), this.end_ms);
    this.draw(true);
  }

  event(way) {
    const times = this.instants, now = this.state.time;
    const found = way > 0 ? times.filter(t => t > now) : times.filter(t => t < now);
    if (found.length) this.go(way > 0 ? Math.min(...found) : Math.max(...found));
  }

  play(on) {
    if (on && this.state.time >= this.end_ms) this.state.time = 0;
    this.playing = on;
    this.last = performance.now();
    if (on) requestAnimationFrame(now => this.frame(now));
    this.draw(true);
  }

  frame(now) {
    if (!this.playing) return;
    this.state.time = Math.min(this.state.time + Math.max(0, now - this.last) * this.state.rate, this.end_ms);
    this.last = now;
    if (this.state.time >= this.end_ms) this.playing = false;
    this.draw(!this.playing);
    if (this.playing) requestAnimationFrame(later => this.frame(later));
  }

  rate(by_) {
    const k = address.RATES.indexOf(this.state.rate) + by_;
    this.state.rate = address.RATES[Math.min(Math.max(k, 0), address.RATES.length - 1)];
    this.draw(true);
  }

  turn(what) {
    if (what === "theme") this.state.theme = document.documentElement.className === "dark" ? "light" : "dark";
    if (what === "units") this.state.aviation = !this.state.aviation;
    if (what === "whole") this.state.view = null;
    if (what === "dimension") this.state.dimension = DIMENSIONS[(DIMENSIONS.indexOf(this.state.dimension) + 1) % DIMENSIONS.length];
    this.draw(true);
  }

  // whether it is time for what follows at a slower pace: lists, address, and what has not moved to be seen
  due(whole) {
    const now = performance.now();
    if (!whole && now - this.slow < SLOW_MS) return false;
    this.slow = now;
    return true;
  }

  // the clock, which tells tenths of a second, and if it is time for them the buttons; gives whether it is
  bar(due) {
    const { state } = this, now = performance.now();
    if (due || now - this.clocked >= CLOCK_MS) {
      this.clocked = now;
      by("slider").value = state.time;
      by("clock").textContent = `${clock(state.time)} of ${clock(this.end_ms)}`;
    }
    if (!due) return false;
    by("play").textContent = this.playing ? "Pause" : "Play";
    by("rate").value = state.rate;
    by("units").textContent = state.aviation ? "aviation units" : "SI units";
    return true;
  }

  // the state into the address: at once, but while it plays
  address() {
    const now = performance.now();
    if (this.playing && now - this.addressed < ADDRESS_MS) return;
    this.addressed = now;
    address.write(this.state);
  }

  zoom(factor) { this.maps[0].zoom(factor); }

  listen() {
    const on = (id, act) => by(id).addEventListener("click", act);
    Object.assign(this.state, address.read(this.end_ms, this.ids));
    by("slider").max = this.end_ms;
    by("rate").append(...address.RATES.map(rate => new Option(`${rate}×`, rate)));
    on("play", () => this.play(!this.playing));
    on("step", () => this.go(this.state.time + 1000));
    on("back", () => this.go(this.state.time - 1000));
    on("after", () => this.event(1));
    on("before", () => this.event(-1));
    on("units", () => this.turn("units"));
    on("theme", () => this.turn("theme"));
    on("whole", () => this.turn("whole"));
    on("closer", () => this.zoom(1.5));
    on("farther", () => this.zoom(1 / 1.5));
    by("slider").addEventListener("input", () => this.go(Number(by("slider").value)));
    by("rate").addEventListener("change", () => { this.state.rate = Number(by("rate").value); this.draw(true); });
    window.addEventListener("resize", () => this.draw(true));
    window.addEventListener("hashchange", () => {
      Object.assign(this.state, address.read(this.end_ms, this.ids));
      this.draw(true);
    });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw(true));
    window.addEventListener("keydown", event => this.key(event));
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest?.("dialog")) return;
    const tag = event.target.tagName, onMap = this.maps.find(map => map.plane.element === event.target);
    if (tag === "SELECT" || (tag === "BUTTON" && [" ", "Enter"].includes(event.key))) return;
    const time = event.shiftKey ? 10000 : 1000;
    const acts = {
      " ": () => this.play(!this.playing), n: () => this.event(1), p: () => this.event(-1),
      ArrowLeft: () => this.go(this.state.time - time), ArrowRight: () => this.go(this.state.time + time),
      Home: () => this.go(0), End: () => this.go(this.end_ms),
      "[": () => this.rate(-1), "]": () => this.rate(1), "+": () => this.zoom(1.5), "-": () => this.zoom(1 / 1.5),
      f: () => this.turn("whole"), u: () => this.turn("units"), d: () => this.turn("theme"), b: () => this.turn("dimension"),
    };
    if (onMap && event.shiftKey && MOVES[event.key]) onMap.move(...MOVES[event.key]);
    else if (acts[event.key]) acts[event.key]();
    else return;
    event.preventDefault();
  }
}
