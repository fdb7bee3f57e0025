// A plan beside the mission: who does what when, its routes on the map, its constraints.

import { named } from "./labels.js";

const SVG = "http://www.w3.org/2000/svg", ROW = 30, LEFT = 90, WIDE = 640;

function element(name, attributes, text) {
  const found = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) found.setAttribute(key, value);
  if (text !== undefined) found.textContent = text;
  return found;
}

// the way of each vehicle that the plan uses
export function routes(plan, starts) {
  const found = new Map(starts.map(start => [start.id, [[start.north_m, start.east_m]]]));
  const used = new Set();
  for (const item of [...plan.items].sort((a, b) => a.depart_ms - b.depart_ms)) {
    used.add(item.vehicle_id);
    const points = found.get(item.vehicle_id) || [];
    for (const place of [...item.transit, ...item.path]) points.push([place.north_m, place.east_m]);
    found.set(item.vehicle_id, points);
  }
  return [...used].map(vehicle => ({ time_ms: 0, vehicle, points: found.get(vehicle) }));
}

const seconds = ms => (ms / 1000).toFixed(1);
const span = one => `may be done from ${seconds(one.from_ms)} to ${seconds(one.to_ms)} s`;

// when a task may be done: a band with an edge at each end that is on the chart, and where it comes from
function window_(one, x, end, y) {
  const from = x(Math.min(one.from_ms, end)), to = x(Math.min(one.to_ms, end)), tall = ROW - 2;
  const found = element("g", { class: "window", "data-window": one.task });
  found.append(element("title", {}, [`p${one.task} ${span(one)}`, ...one.texts].join("\n")));
  found.append(element("rect", { x: from, y, height: tall, width: Math.max(to - from, 0.5) }));
  for (const [ms, at] of [[one.from_ms, from], [one.to_ms, to]]) if (ms <= end) found.append(element("line", { x1: at, x2: at, y1: y, y2: y + tall }));
  return found;
}

// windows: when tasks may be done, as bands behind their bars; asked: called with the task that is picked
export function gantt(plan, windows, vehicles, ink, asked) {
  const height = ROW * (vehicles.length + 1) + 6, end = Math.max(plan.makespan_ms, 1);
  const x = ms => LEFT + (WIDE - LEFT - 10) * ms / end;
  const svg = element("svg", { viewBox: `0 0 ${WIDE} ${height}`, role: "img", "aria-label": "Tasks of each vehicle over time" });
  for (let k = 0; k <= 4; k++) {
    const at = x(end * k / 4);
    svg.append(element("line", { class: "axis", x1: at, x2: at, y1: 0, y2: height - ROW + 4 }));
    svg.append(element("text", { x: at, y: height - 8, "text-anchor": k === 4 ? "end" : "middle" }, `${(end * k / 4000).toFixed(0)} s`));
  }
  vehicles.forEach((vehicle, row) => {
    const y = ROW * row + 6, tall = ROW - 12;
    svg.append(element("text", { x: 2, y: y + tall - 4 }, named(vehicle)));
    const items = plan.items.filter(one => one.vehicle_id === vehicle.id);
    for (const { task_id } of items) for (const one of windows) if (one.task === task_id) svg.append(window_(one, x, end, ROW * row + 1));
    for (const item of items) {
      const bar = (name, from, to, more = {}) => element("rect", { class: name, x: x(from), y, height: tall, width: Math.max(x(to) - x(from), 0.5), ...more });
      svg.append(bar("transit", item.depart_ms, item.arrive_ms));
      if (item.start_ms > item.arrive_ms) svg.append(bar("wait", item.arrive_ms, item.start_ms));
      const work = bar("bar", item.start_ms, item.end_ms, { fill: ink(vehicle.id), tabindex: 0, role: "button", "data-task": item.task_id });
      const within = windows.filter(one => one.task === item.task_id).map(one => `; ${span(one)}`).join("");
      const said = `p${item.task_id}: ${seconds(item.start_ms)} to ${seconds(item.end_ms)} s${within}. Why this vehicle?`;
      work.append(element("title", {}, said));
      work.setAttribute("aria-label", said);
      work.addEventListener("click", () => asked(item.task_id));
      work.addEventListener("keydown", event => { if (event.key === "Enter") asked(item.task_id); });
      const late = x(item.start_ms) > WIDE - 40, wide = x(item.end_ms) - x(item.start_ms) > 30;
      const at = { x: x(item.start_ms) + (late ? -3 : 3), y: y + tall - 4, "text-anchor": late ? "end" : "start", "pointer-events": "none", class: wide ? "in" : "" };
      svg.append(work, element("text", at, `p${item.task_id}`));
    }
  });
  return svg;
}
