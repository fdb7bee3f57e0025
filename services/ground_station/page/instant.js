// What a recording says of one instant. Between two samples an aircraft is drawn on a straight line.

export const UNSEEN_MS = 2500; // tracks have a sample a second: after this an aircraft is not seen

// index of the last row at or before `time`, by the value that `of` gives; -1 before the first
export function lastAt(rows, time, of) {
  let low = 0, high = rows.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (of(rows[middle]) <= time) low = middle + 1; else high = middle;
  }
  return low - 1;
}

// {north, east, alt, speed, climb, course, owner, seen}: metres, m/s, degrees; null before it is there
export function positionAt(track, time) {
  const k = lastAt(track, time, row => row[0]);
  if (k < 0) return null;
  const a = track[k], b = track[k + 1];
  if (!b || b[0] - a[0] > UNSEEN_MS) {
    const from = track[k - 1], moved = from && motion(from, a);
    return { north: a[1], east: a[2], alt: a[3], owner: a[4], seen: time - a[0] <= UNSEEN_MS, last: a[0], ...(moved || still) };
  }
  const part = (time - a[0]) / (b[0] - a[0]);
  const at = i => a[i] + part * (b[i] - a[i]);
  return { north: at(1), east: at(2), alt: at(3), owner: a[4], seen: true, last: a[0], ...motion(a, b) };
}

const still = { speed: null, climb: null, course: null };

function motion(a, b) {
  const s = (b[0] - a[0]) / 1000;
  if (!(s > 0)) return still;
  const north = (b[1] - a[1]) / s, east = (b[2] - a[2]) / s, speed = Math.hypot(north, east);
  const course = speed > 0.05 ? (Math.atan2(east, north) * 180 / Math.PI + 360) % 360 : null;
  return { speed, climb: (b[3] - a[3]) / s, course };
}

// the last entry about a vehicle at or before `time`; undefined if there is none
export function lastOf(list, vehicle, time) {
  let found;
  for (const entry of list) if (entry.vehicle === vehicle && entry.time_ms <= time) found = entry;
  return found;
}

// while it takes no part: {why, from_ms, to_ms}; undefined while it does
export function absenceAt(recording, vehicle, time) {
  return recording.absences.find(a => a.vehicle === vehicle && a.from_ms <= time && (a.to_ms === null || time < a.to_ms));
}

// who commands: {name, reason, since}; name is null where the log does not say. A vehicle that is lost, or
// has not joined, takes no part (away): its name is why, unless its ICAROUS took over
export function authorityAt(recording, vehicle, time) {
  if (recording.authority === null) return { name: null };
  const change = lastOf(recording.authority, vehicle, time);
  const away = absenceAt(recording, vehicle, time);
  if (away && change?.owner !== "ICAROUS") return { name: away.why, since: away.from_ms, away: true };
  if (!change) return { name: "UxAS", reason: "since the start", since: 0 };
  return { name: change.owner, reason: change.reason, since: change.time_ms };
}

// whose bands are shown: {id, row, since}, of the picked aircraft, or of the only one that has some. row is null
// before the first message, and once the last one is older than an aircraft that is not seen any more; null where none is shown
export function bandsAt(recording, state) {
  const ids = Object.keys(recording.bands), id = state.picked ?? (ids.length === 1 ? ids[0] : null), rows = recording.bands[id];
  if (!rows) return null;
  const row = rows[lastAt(rows, state.time, one => one.time_ms)];
  return { id, row: row && state.time - row.time_ms <= UNSEEN_MS ? row : null, since: row?.time_ms };
}

// of each intruder with an alert the highest one: {level, time_s, own}, of the picked aircraft if it has bands, else of all
export function alertsAt(recording, state) {
  const found = {}, ids = recording.bands[state.picked] ? [state.picked] : Object.keys(recording.bands);
  for (const id of ids) {
    const { row } = bandsAt(recording, { ...state, picked: id });
    for (const [other, time_s, level] of row?.intruders ?? []) if (level > (found[other]?.level ?? 0)) found[other] = { level, time_s, own: id };
  }
  return found;
}

// every two aircraft that are there: horizontal distance and difference of altitude [m], nearest first
export function pairsAt(recording, time) {
  const ours = new Set(recording.vehicles.map(v => String(v.id)));
  const there = Object.keys(recording.tracks)
    .map(id => ({ id, at: positionAt(recording.tracks[id], time) }))
    .filter(one => one.at && one.at.seen);
  const found = [];
  there.forEach((one, k) => there.slice(k + 1).forEach(other => {
    if (!ours.has(one.id) && !ours.has(other.id)) return;
    const across = Math.hypot(one.at.north - other.at.north, one.at.east - other.at.east);
    found.push({ one: one.id, other: other.id, across, above: Math.abs(one.at.alt - other.at.alt) });
  }));
  return found.sort((a, b) => a.across - b.across);
}
