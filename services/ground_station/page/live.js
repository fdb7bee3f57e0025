// A mission that is flown while the page is open: asks the server what is new, and sends the operator's commands.

import { RATES } from "./address.js";
import { seconds } from "./units.js";

const EVERY_MS = 150, PATIENCE = 5, PAGE = "page";
const OVER = ["ended", "stopped", "failed", "lost"];
const FLOWN = {
  loading: "not flown yet", planning: "not flown yet", paused: "flown now", flying: "flown now", ended: "flown to its end",
  stopped: "stopped before its end", failed: "failed before its end", lost: "lost before its end",
};
// of a running system that is watched
const WATCHED = { connecting: "not connected yet", watching: "watched now", silent: "watched now", "cut off": "connecting again", failed: "not watched any more" };
const by = id => document.getElementById(id);

export class Live {
  // recording: what is shown, and grows; changed: called with the updates by which it has grown
  constructor(recording, changed) {
    this.recording = recording;
    this.changed = changed;
    this.token = new URLSearchParams(location.search).get("token") || "";
    this.page = sessionStorage.getItem(PAGE) ?? crypto.randomUUID();
    sessionStorage.removeItem(PAGE); // a copy of this page is another one
    this.next = recording.next ?? 0;
    this.failures = 0;
    this.heads = {};
    this.status = { state: "loading", rate: 1, text: "" };
    this.who = "watch";
    by("live").hidden = false;
    for (const id of ["fly", "fly-step", "live-rate-box", "stop", "operate"]) by(id).hidden = Boolean(recording.attached);
    by("live-rate").append(...RATES.map(rate => new Option(`${rate}×`, rate)));
    const on = (id, act) => by(id).addEventListener("click", act);
    on("fly", () => this.toggle());
    on("fly-step", () => this.order({ do: "step" }));
    on("take", () => this.order({ do: "take" }));
    on("stop", () => by("confirm-stop").showModal());
    on("stop-not", () => by("confirm-stop").close());
    on("stop-yes", () => { by("confirm-stop").close(); this.order({ do: "stop" }); });
    on("results", () => location.reload());
    by("live-rate").addEventListener("change", () => this.order({ do: "rate", rate: Number(by("live-rate").value) }));
    this.show();
    this.poll();
  }

  get over() { return OVER.includes(this.status.state); }

  toggle() { this.order({ do: this.status.state === "flying" ? "pause" : "play" }); }

  rate(way) {
    const k = RATES.indexOf(this.status.rate) + way;
    if (RATES[k]) this.order({ do: "rate", rate: RATES[k] });
  }

  headers() { return { "X-Cratous-Token": this.token, "X-Cratous-Page": this.page }; }

  async order(asked) {
    if (this.recording.attached) return;
    try {
      const headers = { ...this.headers(), "Content-Type": "application/json" };
      const answer = await fetch("/command", { method: "POST", headers, body: JSON.stringify(asked) });
      this.refused = answer.ok ? "" : `Not done: ${(await answer.json()).error}.`;
    } catch (error) {
      this.refused = `Not done: the server does not answer (${error.message}).`;
    }
    this.show();
  }

  // once a pause that was asked for is there
  async settled() {
    while (this.status.state === "flying" && this.who === "you" && this.failures < PATIENCE) await new Promise(done => setTimeout(done, EVERY_MS));
  }

  async poll() {
    let told = null;
    try {
      const answer = await fetch(`/live.json?from=${this.next}`, { headers: this.headers() });
      if (answer.ok) told = await answer.json();
    } catch { /* counted below */ }
    this.failures = told ? 0 : this.failures + 1;
    if (told) {
      if (told.again || told.flight !== this.recording.flight) { // too far behind, or flown anew: all of it anew, by the same page
        sessionStorage.setItem(PAGE, this.page);
        location.reload();
        return;
      }
      told.updates.forEach(update => this.take(update));
      this.next = told.next;
      this.status = told.status;
      this.who = told.who;
      if (told.updates.length) this.changed(told.updates);
    }
    this.show();
    if (!(told && this.over && !told.more)) setTimeout(() => this.poll(), told?.more ? 0 : EVERY_MS);
  }

  // an update into the recording; a head is the newest place, until the next one comes
  take(update) {
    const { tracks } = this.recording;
    for (const [key, rows] of Object.entries(update.more || {})) this.recording[key].push(...rows);
    for (const [id, rows] of Object.entries(update.bands || {})) (this.recording.bands[id] ??= []).push(...rows);
    if (update.heads) for (const id of Object.keys(this.heads)) if (tracks[id].at(-1) === this.heads[id]) tracks[id].pop();
    for (const [id, rows] of Object.entries(update.tracks || {})) (tracks[id] ??= []).push(...rows);
    if (update.heads) {
      this.heads = {};
      for (const [id, row] of Object.entries(update.heads)) {
        tracks[id] ??= [];
        if (!tracks[id].length || tracks[id].at(-1)[0] < row[0]) { tracks[id].push(row); this.heads[id] = row; }
      }
    }
    Object.assign(this.recording, update.set || {});
    if (this.recording.window_ms) this.forget();
  }

  // what the server has let go of, once it is a tenth more than it keeps
  forget() {
    const { recording } = this, { tracks, bands, window_ms } = recording, first = recording.end_ms - window_ms;
    const old = Object.values(tracks).some(track => track.length && track[0][0] < first - window_ms / 10);
    if (!old) return;
    for (const id of Object.keys(tracks)) if (!(tracks[id] = tracks[id].filter(row => row[0] >= first)).length) delete tracks[id];
    for (const id of Object.keys(bands)) if (!(bands[id] = bands[id].filter(row => row.time_ms >= first)).length) delete bands[id];
    const newest = new Map(recording.routes.map(route => [route.vehicle, route]));
    recording.routes = recording.routes.filter(route => route.time_ms >= first || newest.get(route.vehicle) === route);
    recording.events = recording.events.filter(event => event.time_ms >= first);
    this.forgot = true; // what was drawn of tracks is drawn anew
  }

  show() {
    const { state, rate, text } = this.status, lost = this.failures >= PATIENCE;
    const may = this.who === "you" && !this.over && !lost, ready = may && ["paused", "flying"].includes(state);
    by("live-state").textContent = lost ? "server lost" : state;
    by("live-state").className = lost ? "lost" : state;
    by("source").textContent = lost && this.recording.attached ? "" : lost ? "whether it is still flown is unknown" : (this.recording.attached ? WATCHED : FLOWN)[state];
    by("live-text").textContent = lost ? "The server does not answer: what is shown is what it told last. Is `cratous serve` still running?" : text || "";
    by("fly").textContent = state === "flying" ? "Pause" : "Fly";
    for (const id of ["fly", "fly-step", "live-rate"]) by(id).disabled = !ready;
    by("stop").disabled = !may;
    by("operate").disabled = !ready;
    by("take").hidden = this.who !== "other" || this.over;
    by("results").hidden = state !== "ended";
    if (document.activeElement !== by("live-rate") || !ready) by("live-rate").value = rate;
    const roles = { you: "This page commands the flight.", other: "Another page commands this flight; this one watches.", watch: "This page watches: to command, open the whole address that `cratous serve` printed." };
    by("live-who").textContent = [this.over || this.recording.attached ? "" : roles[this.who], this.refused].filter(Boolean).join(" ");
    by("live").setAttribute("aria-label", `${this.recording.attached ? "Watching" : "Flight"}: ${state} at ${seconds(this.recording.end_ms)}`);
  }
}
