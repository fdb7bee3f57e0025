// The state that is in the page's address, behind #: what is not as it should be there is left out.

import { DIMENSIONS } from "./band_style.js";
import { digits } from "./units.js";

export const RATES = [0.25, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
const FARTHEST_M = 1e9; // of a view: nothing is there, and tiles so far away that numbers have no digits for them are endless

export function read(end_ms, ids) {
  const given = new URLSearchParams(location.hash.slice(1)), state = {};
  const number = name => given.has(name) && given.get(name) !== "" ? Number(given.get(name)) : NaN;
  const t = number("t");
  if (Number.isFinite(t)) state.time = Math.min(Math.max(t * 1000, 0), end_ms);
  if (RATES.includes(number("rate"))) state.rate = number("rate");
  if (ids.includes(given.get("aircraft"))) state.picked = given.get("aircraft");
  if (["dark", "light"].includes(given.get("theme"))) state.theme = given.get("theme");
  if (["si", "aviation"].includes(given.get("units"))) state.aviation = given.get("units") === "aviation";
  if (DIMENSIONS.includes(given.get("bands"))) state.dimension = given.get("bands");
  const view = (given.get("map") || "").split(",").map(Number);
  if (view.length === 3 && view.every(Number.isFinite) && Math.max(Math.abs(view[0]), Math.abs(view[1])) <= FARTHEST_M && view[2] > 0) state.view = { north: view[0], east: view[1], scale: view[2] };
  return state;
}

export function write(state) {
  const said = { t: (state.time / 1000).toFixed(1), rate: state.rate };
  if (state.picked) said.aircraft = state.picked;
  if (state.theme) said.theme = state.theme;
  if (state.aviation) said.units = "aviation";
  if (state.dimension !== DIMENSIONS[0]) said.bands = state.dimension;
  if (state.view) said.map = [...[state.view.north, state.view.east].map(m => m.toFixed(digits(state.view.scale))), state.view.scale.toPrecision(4)].join(",");
  const hash = `#${Object.entries(said).map(([key, value]) => `${key}=${value}`).join("&")}`;
  if (hash !== location.hash) history.replaceState(null, "", hash);
}
