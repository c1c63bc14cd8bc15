// Numbers for people: four digits, prefixes for units of SI, readable powers.

const MINUS = "\u2212";
const PREFIXES = [[1e12, "T"], [1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"], [1e-12, "p"], [1e-15, "f"]];
const RAISED = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };
const raise = text => [...String(text)].map(c => RAISED[c] ?? c).join("");

/** `J/m^2` as `J/m²`. */
const unitText = unit => unit.replace(/\^(-?\d+)(?![.\d])/g, (_, power) => raise(power));

/** A number in `digits` significant digits, large and small ones as a power of ten. */
function plain(value, digits = 4) {
  if (value === null || Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : MINUS + "∞";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const sign = value < 0 ? MINUS : "";
  const power = Math.floor(Math.log10(Number(size.toPrecision(digits))));
  if (power < -3 || power >= 6) {
    const mantissa = Number((size / 10 ** power).toPrecision(digits));
    return sign + (mantissa === 1 ? "" : mantissa + "·") + "10" + raise(power);
  }
  const text = String(Number(size.toPrecision(digits)));
  return sign + (size >= 1e4 ? Number(text).toLocaleString("en-GB") : text);
}

/** How a unit is scaled for values of this size: factor and name. */
function scaled(size, unit) {
  const first = /^(Pa|Hz|m|s|J|N|W)(?![\^\w])(.*)$/.exec(unit);
  if (!first || !(size > 0) || !Number.isFinite(size)) return { factor: 1, unit: unitText(unit) };
  const least = unit.startsWith("m/s") ? 1e4 : 1;
  let pick = PREFIXES.find(([f]) => size >= f * 0.9995) ?? [1, ""];
  if (pick[0] > 1 && size < least) pick = [1, ""];
  // seconds have no kilo, metres no mega
  if ((first[1] === "s" && pick[0] > 1) || (first[1] === "m" && pick[0] > 1e3)) pick = [1, ""];
  return { factor: pick[0], unit: unitText(pick[1] + unit) };
}

/** A value with its unit. */
function quantity(value, unit = "", digits = 4) {
  if (typeof value !== "number" || !Number.isFinite(value)) return plain(value ?? null);
  const s = scaled(Math.abs(value), unit);
  const number = plain(value / s.factor, digits);
  return s.unit ? `${number}\u00a0${s.unit}` : number;
}

const count = n => Math.round(n).toLocaleString("en-GB");

/** A whole number of many digits in words: 10.01 million. */
const many = n => (n >= 1e9 ? plain(n / 1e9) + " billion" : n >= 1e6 ? plain(n / 1e6) + " million" : count(n));

/** Between `low` and `high` about `wanted` round numbers. */
function ticks(low, high, wanted) {
  const span = high - low;
  if (!(span > 0)) return [low];
  const raw = span / Math.max(1, wanted);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 2.5, 5, 10].map(m => m * power).find(s => s >= raw * 0.999) ?? 10 * power;
  const all = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * span; k++) all.push(k * step);
  return all.map(t => (Math.abs(t) < 1e-9 * span ? 0 : Number(t.toPrecision(12))));
}

/** Round down to 1, 2 or 5 times a power of ten. */
function round125(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [5, 2, 1].find(m => m * power <= value * 1.0001) * power;
}

const words = name => name.replaceAll("_", " ");
// single letters are symbols
const capital = text => (/^.(\W|$)/.test(text) ? text : text.charAt(0).toUpperCase() + text.slice(1));

const SVG = document.querySelector("svg").namespaceURI;

/** An element with attributes and children. */
function make(tag, attributes = {}, ...children) {
  const svg = ["svg", "g", "path", "line", "text", "rect", "circle", "polyline", "clipPath", "title"].includes(tag);
  const element = svg ? document.createElementNS(SVG, tag) : document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (value !== null && value !== false) element.setAttribute(key, value === true ? "" : value);
  }
  element.append(...children.filter(c => c !== null && c !== undefined));
  return element;
}
