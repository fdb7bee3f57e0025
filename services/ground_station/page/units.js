// Numbers with their units, SI or as aviation has them.

const FOOT = 0.3048, NAUTICAL_MILE = 1852, KNOT = NAUTICAL_MILE / 3600;
const none = "–";

export function words(aviation) {
  const fixed = (value, digits, unit) => value === null || value === undefined ? none : `${value.toFixed(digits)} ${unit}`;
  const per = (value, one) => value === null || value === undefined ? null : value / one;
  return {
    unit: { speed: aviation ? KNOT : 1, climb: aviation ? FOOT / 60 : 1, altitude: aviation ? FOOT : 1 },
    altitude: m => aviation ? fixed(per(m, FOOT), 0, "ft") : fixed(m, 0, "m"),
    distance: m => aviation ? fixed(per(m, NAUTICAL_MILE), 2, "NM") : m >= 10000 ? fixed(m / 1000, 2, "km") : fixed(m, 0, "m"),
    speed: v => aviation ? fixed(per(v, KNOT), 0, "kn") : fixed(v, 1, "m/s"),
    climb: v => aviation ? fixed(v === null ? null : v / FOOT * 60, 0, "ft/min") : fixed(v, 1, "m/s"),
    course: deg => deg === null || deg === undefined ? none : `${String(Math.round(deg) % 360).padStart(3, "0")}°`,
  };
}

export const seconds = ms => `${(ms / 1000).toFixed(1)} s`;

export function clock(ms) {
  const s = Math.floor(ms / 1000), two = n => String(n).padStart(2, "0");
  return `${two(Math.floor(s / 3600))}:${two(Math.floor(s / 60) % 60)}:${two(s % 60)}.${Math.floor(ms % 1000 / 100)}`;
}
