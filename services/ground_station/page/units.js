// Numbers with their units, SI or as aviation has them.

const FOOT = 0.3048, NAUTICAL_MILE = 1852, KNOT = NAUTICAL_MILE / 3600;
const none = "–";
const precise = (value, unit) => `${Math.abs(value) >= 1000 ? value.toFixed(0) : value.toPrecision(4)}\u00a0${unit}`;

// the least of 1, 2, 5, 10, 20 ... that is not below
export function niceStep(least) {
  const power = 10 ** Math.floor(Math.log10(Math.max(least, 1e-3)));
  return [1, 2, 5, 10].map(k => k * power).find(step => step >= least) || 10 * power;
}

// of metres where a metre has so many pixels, so that they say which pixel
export const digits = scale => Math.min(Math.max(0, Math.ceil(Math.log10(scale))), 3);

export function words(aviation) {
  const fixed = (value, digits, unit) => value === null || value === undefined ? none : `${value.toFixed(digits)} ${unit}`;
  const per = (value, one) => value === null || value === undefined ? null : value / one;
  return {
    unit: { speed: aviation ? KNOT : 1, climb: aviation ? FOOT / 60 : 1, altitude: aviation ? FOOT : 1 },
    altitude: m => aviation ? fixed(per(m, FOOT), 0, "ft") : fixed(m, 0, "m"),
    // less than a nautical mile in feet: a hundredth of one is 19 m
    distance: m => aviation && m < NAUTICAL_MILE ? fixed(per(m, FOOT), 0, "ft") : aviation ? fixed(per(m, NAUTICAL_MILE), 2, "NM") : m >= 10000 ? fixed(m / 1000, 2, "km") : fixed(m, 0, "m"),
    speed: v => aviation ? fixed(per(v, KNOT), 0, "kn") : fixed(v, 1, "m/s"),
    // of a verdict, in whose unit it comes; a distance may be along or up, so it is one in feet
    margin: (value, unit) => aviation && unit === "m" ? precise(value / FOOT, "ft") : precise(value, unit),
    // the least length of 1, 2, 5, 10, 20 ... units that is not below [m]
    step: m => aviation && m > NAUTICAL_MILE / 2 ? niceStep(m / NAUTICAL_MILE) * NAUTICAL_MILE : aviation ? niceStep(m / FOOT) * FOOT : niceStep(m),
    climb: v => aviation ? fixed(v === null ? null : v / FOOT * 60, 0, "ft/min") : fixed(v, 1, "m/s"),
    course: deg => deg === null || deg === undefined ? none : `${String(Math.round(deg) % 360).padStart(3, "0")}°`,
  };
}

export const seconds = ms => `${(ms / 1000).toFixed(1)} s`;

export function clock(ms) {
  const tenths = Math.round(ms / 100), s = Math.floor(tenths / 10), two = n => String(n).padStart(2, "0");
  return `${two(Math.floor(s / 3600))}:${two(Math.floor(s / 60) % 60)}:${two(s % 60)}.${tenths % 10}`;
}
