// The page of one flight or log: holds its state, and draws it whenever it changes.

import { AltitudeChart } from "./altitude.js";
import { panel } from "./bands.js";
import { Live } from "./live.js";
import { FlightMap } from "./map.js";
import { Operator } from "./operate.js";
import { open, source, theme } from "./opening.js";
import * as panels from "./panels.js";
import { Playback } from "./playback.js";
import { Spectrum } from "./spectrum.js";
import { words } from "./units.js";

const by = id => document.getElementById(id);
const CHARTS_MS = 1000;

class Station extends Playback {
  constructor(recording) {
    super();
    this.recording = recording;
    const go = time => this.go(time);
    this.map = new FlightMap(by("map"), recording, view => { this.state.view = view; this.draw(true); });
    this.chart = new AltitudeChart(by("altitude"), recording, go);
    this.spectrum = new Spectrum(by("spectrum-box"), by("spectrum"), by("dimension"), recording, go);
    by("name").textContent = recording.name;
    document.title = `${recording.name} – CRATOUS ground station`;
    if (!recording.live) by("source").textContent = source(recording);
    this.listen();
    panels.events(recording, go);
    this.verdicts();
    panels.tasks(recording, this.state);
    this.live = null;
    this.charted = -CHARTS_MS;
    this.later = null;
    if (recording.live) this.fly();
    this.map.lay(recording.located === false ? null : recording.frame, () => this.draw(true));
  }

  get end_ms() { return this.recording.end_ms; }
  get instants() { return this.recording.events.map(event => event.time_ms); }
  get ids() { return Object.keys(this.recording.tracks); }
  get maps() { return [this.map]; }

  // a flight that is flown now: the newest instant is shown unless the operator looks back
  fly() {
    this.follow = true;
    for (const id of ["play", "rate-box"]) by(id).hidden = true;
    this.live = new Live(this.recording, updates => this.grown(updates));
    if (!this.recording.attached) this.operator = new Operator(this.live, this.map, this.recording, this);
  }

  grown(updates) {
    const { recording } = this, go = time => this.go(time);
    if (this.live?.forgot) { this.map.trails.forget(); this.live.forgot = false; }
    this.map.grown();
    this.charts();
    by("slider").max = recording.end_ms;
    if (updates.some(update => update.more?.events)) panels.events(recording, go);
    if (updates.some(update => update.set?.verdicts)) this.verdicts();
    if (updates.some(update => update.set?.frame)) this.map.lay(recording.frame, () => this.draw(true));
    if (this.follow) this.state.time = recording.end_ms;
    this.draw(true);
  }

  verdicts() {
    this.verdicts_aviation = this.state.aviation;
    panels.verdicts(this.recording, words(this.state.aviation), time => this.go(time));
  }

  // charts are drawn anew for a flight that grows, all of them, so less often than the rest
  charts() {
    const now = performance.now(), wait = this.charted + CHARTS_MS - now;
    if (wait > 0) {
      this.later ??= setTimeout(() => { this.later = null; this.charts(); this.draw(true); }, wait);
      return;
    }
    this.charted = now;
    this.chart.grown();
    this.spectrum.grown();
  }

  go(time) {
    this.follow = time >= this.end_ms;
    super.go(time);
  }

  play(on) { if (this.recording.attached) this.go(this.end_ms); else if (this.live) this.live.toggle(); else super.play(on); }

  rate(by_) { if (this.live) this.live.rate(by_); else super.rate(by_); }

  // whole: the tables and the address too; else they follow at their own pace
  draw(whole) {
    const { state, recording } = this, said = words(state.aviation), due = this.due(whole);
    if (due) theme(state.theme);
    this.spectrum.draw(state, said, due); // first: where it comes up, the map gets smaller
    if (this.map.draw(state, said, due)) this.operator?.draw();
    this.chart.draw(state, said, due);
    if (!this.bar(due)) return;
    if (this.verdicts_aviation !== state.aviation) this.verdicts();
    panels.aircraft(recording, state, said);
    panels.pairs(recording, state, said);
    panel(recording, state, said);
    panels.tasks(recording, state);
    panels.mark(recording, state);
    this.address();
  }

  listen() {
    super.listen();
    by("dimension").addEventListener("change", () => { this.state.dimension = by("dimension").value; this.draw(true); });
    by("now").addEventListener("click", () => this.go(this.end_ms));
    by("aircraft").addEventListener("click", event => {
      const id = event.target.closest("tr")?.dataset.aircraft;
      if (id) { this.state.picked = this.state.picked === id ? null : id; this.draw(true); }
    });
    by("map").addEventListener("pointermove", event => {
      const [north, east] = this.map.under(event.offsetX, event.offsetY);
      by("cursor").textContent = `north ${north.toFixed(0)} m, east ${east.toFixed(0)} m`;
    });
  }
}

await open(recording => {
  const station = new Station(recording);
  station.draw(true);
  if (!recording.live && !station.ids.length) {
    by("message").hidden = false;
    by("message").textContent = "This log has no positions of aircraft; its events are listed beside the map.";
  }
});
