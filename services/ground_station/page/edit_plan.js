// A plan beside the mission: who does what when, its routes on the map, its constraints.

const SVG = "http://www.w3.org/2000/svg", ROW = 26, LEFT = 90, WIDE = 640;

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

// asked: called with the task that is picked
export function gantt(plan, vehicles, ink, asked) {
  const height = ROW * (vehicles.length + 1) + 6, end = Math.max(plan.makespan_ms, 1);
  const x = ms => LEFT + (WIDE - LEFT - 10) * ms / end;
  const svg = element("svg", { viewBox: `0 0 ${WIDE} ${height}`, role: "img", "aria-label": "Tasks of each vehicle over time" });
  for (let k = 0; k <= 4; k++) {
    const at = x(end * k / 4);
    svg.append(element("line", { class: "axis", x1: at, x2: at, y1: 0, y2: height - ROW + 4 }));
    svg.append(element("text", { x: at, y: height - 8, "text-anchor": k === 4 ? "end" : "middle" }, `${(end * k / 4000).toFixed(0)} s`));
  }
  vehicles.forEach((vehicle, row) => {
    const y = ROW * row + 4, tall = ROW - 8;
    svg.append(element("text", { x: 2, y: y + tall - 4 }, `${vehicle.label || ""} ${vehicle.id}`.trim()));
    for (const item of plan.items.filter(one => one.vehicle_id === vehicle.id)) {
      const bar = (name, from, to, more = {}) => element("rect", { class: name, x: x(from), y, height: tall, width: Math.max(x(to) - x(from), 0.5), ...more });
      svg.append(bar("transit", item.depart_ms, item.arrive_ms));
      if (item.start_ms > item.arrive_ms) svg.append(bar("wait", item.arrive_ms, item.start_ms));
      const work = bar("bar", item.start_ms, item.end_ms, { fill: ink(vehicle.id), tabindex: 0, role: "button", "data-task": item.task_id });
      const said = `p${item.task_id}: ${(item.start_ms / 1000).toFixed(1)} to ${(item.end_ms / 1000).toFixed(1)} s. Why this vehicle?`;
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
