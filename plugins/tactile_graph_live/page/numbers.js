// Numbers and units in words.

const UNITS = new Map([
  ["cm2", "cm²"], ["cm", "cm"], ["mm", "mm"], ["deg", "°"], ["rad", "rad"], ["g", "g"],
  ["gram", "g"], ["v", "V"], ["us", "µs"], ["ms", "ms"], ["s", "s"], ["hz", "Hz"], ["kg", "kg"],
  ["cm_per_s", "cm/s"], ["cm_s", "cm/s"], ["cm_s2", "cm/s²"], ["deg_per_s", "°/s"], ["deg_s", "°/s"],
]);

/** Return a field's name without its unit, and the unit: `radius_cm` is ["radius", "cm"]. */
export function named(field) {
  for (const parts of [3, 2, 1]) {
    const words = field.split("_");
    const unit = UNITS.get(words.slice(-parts).join("_"));
    if (words.length > parts && unit !== undefined) {
      return [words.slice(0, -parts).join(" "), unit];
    }
  }
  return [field.replaceAll("_", " "), ""];
}

/** Return a value as short as it can be told: four digits of a number, yes or no. */
export function told(value) {
  if (value === null || value === undefined) return "–";
  if (typeof value === "boolean") return value ? "yes" : "no";
  if (typeof value !== "number") return String(value);
  if (!Number.isFinite(value)) return String(value);
  if (Number.isInteger(value)) return String(value);
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-4) return value.toExponential(2);
  return value.toFixed(Math.max(0, Math.min(4, 3 - Math.floor(Math.log10(size)))));
}

/** Return microseconds in the unit that suits them. */
export function duration(us) {
  if (us === null || us === undefined || !Number.isFinite(us)) return "–";
  if (us < 1000) return `${us < 10 ? us.toFixed(1) : Math.round(us)} µs`;
  if (us < 1e6) return `${(us / 1000).toFixed(us < 10_000 ? 2 : us < 100_000 ? 1 : 0)} ms`;
  return `${(us / 1e6).toFixed(1)} s`;
}

export const counted = (n) => (Number.isFinite(n) ? n.toLocaleString("en").replaceAll(",", "\u202f") : "–");

/** Return a number that was told without the zeros at the end of its decimals: `50.0 ms` is `50 ms`. */
export const short = (text) => text.replace(/(\.\d*?)0+(?=\D|$)/, "$1").replace(/\.(?=\D|$)/, "");

/** Return about `most` round numbers between two ends, two at least. */
export function ticks(low, high, most) {
  const span = high - low;
  if (!(span > 0) || !Number.isFinite(span)) return [low];
  const rough = span / Math.max(1, most);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((n) => n * power).find((s) => s >= rough * 0.999);
  const found = [];
  for (let n = Math.ceil(low / step - 1e-9); n * step <= high + step * 1e-9; n += 1) {
    found.push(Number((n * step).toPrecision(10)));
  }
  return found.length > 1 ? found : ticks(low, high, Math.max(1, most) + 1);
}
