// Commands of the operator that change the mission in flight: picked, drawn on the map, confirmed, and sent.

import { AltitudeField } from "./altitude_field.js";

const by = id => document.getElementById(id);
// obeyed by the flight as it is, at its next step
const DIRECT = ["hold_at", "hold_here", "resume"];
// what is drawn for each: least and most places; null: it is picked from a list
const DRAWN = { hold_at: [1, 1], hold_here: [0, 0], resume: [0, 0], keep_out: [3, 38], go_to: [1, 1], loiter: [1, 1], drop_task: null, end_zone: null };
const HINTS = { hold_at: "Click the place on the map; Esc gives it up.", keep_out: "Click the corners of the keep-out on the map; Enter ends it, Esc gives it up.", go_to: "Click the place on the map; Esc gives it up.", loiter: "Click the place on the map; Esc gives it up." };
const NAMES = { hold_at: "Go to a place, and circle through it until it is to resume", hold_here: "Circle where it is, until it is to resume", resume: "Resume the plan", keep_out: "A keep-out zone", go_to: "A task to fly through a place", loiter: "A task to loiter at a place", drop_task: "A task is dropped", end_zone: "A zone ends" };

// what it is where no altitude is typed; the others have none
const HEIGHTS = { hold_at: "the altitude that it has then", hold_here: "the altitude that it has then", go_to: "the altitude at which the vehicle starts", loiter: "the altitude at which the vehicle starts" };

const AT_ONCE = "The flight obeys at its next step, without stopping, and the plan stays. Where ICAROUS has the vehicle, or no way keeps the zones, it is refused.";
const ANEW = "It is known from the next step on, and what is left is planned anew where it asks for that. The flight is flown anew up to now, stands there, and its results have the mission with this command.";

export class Operator {
  // live: the flight; map: on which is drawn; station: whose state has the units, and which draws it
  constructor(live, map, recording, station) {
    Object.assign(this, { live, map, recording, station, what: null, places: [] });
    this.altitude = new AltitudeField(recording, () => this.may());
    by("operate").addEventListener("change", () => this.begin(by("operate").value));
    by("command-not").addEventListener("click", () => this.end());
    by("command-yes").addEventListener("click", () => this.send());
    by("confirm-command").addEventListener("cancel", () => this.end());
    map.at("click", (...place) => { if (this.what && DRAWN[this.what]) this.place(place); });
    window.addEventListener("keydown", event => {
      if (!this.what || by("confirm-command").open) return;
      if (event.key === "Escape") this.end();
      else if (event.key === "Enter" && this.places.length >= DRAWN[this.what][0]) this.confirm();
      else return;
      event.preventDefault();
    });
  }

  async begin(what) {
    by("operate").value = "";
    if (!(what in DRAWN)) return;
    if (this.live.status.state === "flying" && !DIRECT.includes(what)) await this.live.order({ do: "pause" });
    Object.assign(this, { what, places: [] });
    by("operate-hint").textContent = HINTS[what] ?? "";
    if (!DRAWN[what]?.[1]) this.confirm();
  }

  place(place) {
    this.places.push(place.map(x => Math.round(x * 10) / 10));
    if (this.places.length >= DRAWN[this.what][1]) this.confirm(); else this.station.draw(true);
  }

  draw() {
    if (!this.places.length) return;
    const { map } = this;
    map.path(this.places, false);
    map.stroke("#888", 3, [6, 6]);
    for (const place of this.places) map.label("×", ...map.xy(...place), "#888");
  }

  confirm() {
    const { recording, what } = this, fill = (id, rows) => by(id).replaceChildren(...rows.map(([value, text]) => new Option(text, value)));
    const now = recording.end_ms, vehicles = recording.vehicles.map(one => [one.id, `${one.id} ${one.label || ""}`]);
    fill("command-vehicle", vehicles);
    const listed = what === "end_zone" ? recording.zones.filter(one => one.from_ms <= now && (one.to_ms ?? Infinity) > now) : recording.tasks;
    fill("command-id", listed.map(one => [one.id, `${one.id} ${one.label || ""}`]));
    by("command-vehicle-box").hidden = ![...DIRECT, "go_to", "loiter"].includes(what);
    by("command-seconds-box").hidden = what !== "loiter";
    by("command-id-box").hidden = DRAWN[what] !== null;
    this.none = DRAWN[what] === null && !listed.length;
    if (HEIGHTS[what]) this.altitude.open(this.station.state.aviation, HEIGHTS[what]); else this.altitude.close();
    this.may();
    by("command-text").textContent = `${NAMES[what]}${this.places.length ? `, at ${this.places.map(([n, e]) => `north ${n} m, east ${e} m`).join("; ")}` : ""}. ${DIRECT.includes(what) ? AT_ONCE : ANEW}`;
    by("confirm-command").showModal();
  }

  // whether it can be commanded as it stands
  may() { by("command-yes").disabled = this.none || !this.altitude.good; }

  async send() {
    const { what, places } = this, command = { what, ...this.altitude.told };
    if (places.length) command.places = places;
    if (!by("command-vehicle-box").hidden) command.vehicle = Number(by("command-vehicle").value);
    if (!by("command-seconds-box").hidden) command.duration_s = Number(by("command-seconds").value);
    if (!by("command-id-box").hidden) command.id = Number(by("command-id").value);
    by("command-yes").disabled = true;
    if (!DIRECT.includes(what)) await this.live.settled();
    await this.live.order({ do: "command", command });
    this.end();
  }

  end() {
    Object.assign(this, { what: null, places: [] });
    by("operate-hint").textContent = "";
    by("confirm-command").close();
    this.station.draw(true);
  }
}
