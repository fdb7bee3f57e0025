// What is drawn on the map of the editor: how many places are clicked, and what they make of the mission.

const point = ([north_m, east_m]) => ({ north_m, east_m });
const far = (a, b) => Math.round(Math.hypot(a[0] - b[0], a[1] - b[1]) * 10) / 10;
const clicks = least => `Click ${least} places or more, then Enter.`;
const zone = kind => ({ list: "zones", least: 3, closed: true, hint: clicks(3), item: vertices => ({ kind, vertices }) });
const task = (kind, least, more) => ({ list: "tasks", least, hint: clicks(least), item: places => ({ kind, points: places.map(point) }), ...more });

// the lists of the mission whose items are drawn and deleted on the map
export const OF_MAP = ["vehicles", "tasks", "zones"];

// list: to which it is added; least, most: places, without `most` as many as are clicked; item: what the places make
export const TOOLS = {
  vehicle: { list: "vehicles", least: 1, most: 1, hint: "Click where it starts; all else is as of the first vehicle.", item: ([start]) => ({ position: point(start) }) },
  keep_out: zone("keep_out"),
  keep_in: zone("keep_in"),
  must_fly: task("must_fly", 1, { most: 1, hint: "Click where it is to be." }),
  line_search: task("line_search", 2),
  area_search: task("area_search", 3, { closed: true }),
  loiter: task("loiter", 2, { most: 2, circles: true, hint: "Click the centre, then where its circle passes.", item: ([centre, rim], duration_s) => ({ kind: "loiter", points: [point(centre)], radius_m: far(centre, rim), duration_s }) }),
};

// the places that were clicked; a double click is two at one point
export function places(drawing) {
  return drawing.filter((place, k) => !k || place[0] !== drawing[k - 1][0] || place[1] !== drawing[k - 1][1]);
}
