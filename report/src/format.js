// Numbers as a physicist writes them.

const minus = "\u2212";
const rounding = 1e-11; // errors below it, relative to their value, are rounding noise

function signed(text) {
  return text.replace(/^-/, minus);
}

/// Four digits, or as many as are asked for.
export function number(value, digits = 4) {
  if (value === null || value === undefined || Number.isNaN(value)) return "\u2013";
  if (!Number.isFinite(value)) return value > 0 ? "no limit" : `${minus} no limit`;
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (Number.isInteger(value) && size < 1e6) return signed(String(value));
  if (size >= 1e6 || size < 1e-4) {
    const [digitsOf, exponent] = value.toExponential(digits - 1).split("e");
    return `${signed(Number.isInteger(value) ? String(Number(digitsOf)) : digitsOf)}\u00d710${superscript(Number(exponent))}`;
  }
  return signed(Number(value.toPrecision(digits)).toString());
}

export function superscript(n) {
  const digits = "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079";
  return String(n).replace("-", "\u207b").replace(/\d/g, (d) => digits[d]);
}

/// 0.5913(12): the error's first two digits, in units of the last digit of the value.
export function withError(value, error) {
  if (!Number.isFinite(value) || !Number.isFinite(error) || error <= rounding * Math.abs(value)) return number(value, 5);
  if (error > 1e3 * Math.max(Math.abs(value), 1e-300)) return `${number(value, 2)} \u00b1 ${number(error, 2)}`;
  const scale = Math.floor(Math.log10(Math.max(Math.abs(value), error)));
  if (scale >= 6 || scale < -4) {
    const factor = 10 ** scale;
    return `${withError(value / factor, error / factor)}\u00d710${superscript(scale)}`;
  }
  const place = 1 - Number(error.toExponential(1).split("e")[1]);
  if (place <= 0) {
    const unit = 10 ** -place;
    const rounded = (n) => (Math.round(n / unit) * unit).toFixed(0);
    return `${signed(rounded(value))}(${rounded(error)})`;
  }
  const inUnits = Math.round(error * 10 ** place);
  return `${signed(value.toFixed(place))}(${error >= 1 ? error.toFixed(place) : inUnits})`;
}

export function count(n) {
  if (n < 1e6) return Number(n).toLocaleString("en").replaceAll(",", "\u202f");
  const exponent = Math.floor(Math.log10(n));
  return `${(n / 10 ** exponent).toFixed(2)}\u00d710${superscript(exponent)}`;
}

export function plural(n, word) {
  return `${count(n)} ${word}${n === 1 || word.endsWith("s") ? "" : "s"}`;
}

export function duration(seconds) {
  if (!(seconds > 0)) return "no time";
  if (seconds < 120) return `${number(seconds, 3)} s`;
  if (seconds < 7200) return `${number(seconds / 60, 3)} min`;
  return seconds < 172800 ? `${number(seconds / 3600, 3)} h` : `${number(seconds / 86400, 3)} days`;
}

/// Names of a scene, as their words.
export function words(name) {
  return name.replaceAll("_", " ");
}

/// A cell of CSV.
export function csvCell(value) {
  if (value === null || value === undefined || (typeof value === "number" && Number.isNaN(value))) return "";
  const text = String(value);
  // A text that a spreadsheet would read as a formula begins with an apostrophe.
  const safe = typeof value === "string" && /^[=+\-@\t\r]/.test(text) ? `'${text}` : text;
  return /[",\n\r]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
}

export function csv(head, rows) {
  return [head, ...rows].map((row) => row.map(csvCell).join(",")).join("\n") + "\n";
}

export function fileName(...parts) {
  return parts.join("-").toLowerCase().replace(/[^a-z0-9.]+/g, "-").replace(/^-|-$/g, "").slice(0, 100);
}
