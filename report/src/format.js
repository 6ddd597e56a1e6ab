// Numbers as a physicist writes them.

const minus = "\u2212";

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
  if (!Number.isFinite(value) || !Number.isFinite(error) || error <= 0) return number(value, 5);
  if (error > 1e3 * Math.max(Math.abs(value), 1e-300)) return `${number(value, 2)} \u00b1 ${number(error, 2)}`;
  const scale = Math.floor(Math.log10(Math.max(Math.abs(value), error)));
  if (scale >= 6 || scale < -4) {
    const factor = 10 ** scale;
    return `${withError(value / factor, error / factor)}\u00d710${superscript(scale)}`;
  }
  const place = Math.max(0, 1 - Math.floor(Math.log10(error)));
  const inUnits = Math.round(error * 10 ** place);
  if (place === 0) return `${signed(value.toFixed(0))}(${inUnits})`;
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

const spelled = {s_0_of_line: "S(0) by a line in k", s_0_of_squares: "S(0) by a line in k squared"};

/// Names of the file, as their words.
export function words(name) {
  return spelled[name] ?? name.replaceAll("_", " ");
}

const symbols = {
  mean_height: "\u27e8Z\u27e9", bottom_fraction: "\u03a6_b", corrected_fraction: "\u27e8\u03a6_c\u27e9",
};

const controls = {sqrt_epsilon: "\u221a\u03b5", epsilon: "\u03b5", sqrt_delta: "\u221a\u03b4", gamma: "\u03b3", lambda: "\u03bb",
                  Gamma: "\u0393", amplitude: "A"};

/// Of the strengths of taps.
export function controlSymbol(name) {
  return controls[name] ?? words(name);
}

/// "strength of the taps gamma (diameter)".
export function controlLabel(name, units) {
  const symbol = controls[name];
  return (symbol ? `strength of the taps ${symbol}` : words(name ?? "")) + (!units || units === "1" ? "" : ` (${units})`);
}

/// Which strength a table has as a quantity.
export function controlOf(table) {
  return Object.keys(controls).find((name) => table.has(name)) ?? "";
}

/// "mean height <Z> (diameter)".
export function axisLabel(name, units) {
  const symbol = symbols[name];
  const unit = !units || units === "1" ? "" : ` (${units})`;
  return `${words(name)}${symbol ? " " + symbol : ""}${unit}`;
}

/// A cell of CSV.
export function csvCell(value) {
  if (value === null || value === undefined || (typeof value === "number" && Number.isNaN(value))) return "";
  const text = String(value);
  // What a spreadsheet would take for a formula stands behind an apostrophe.
  const safe = typeof value === "string" && /^[=+\-@\t\r]/.test(text) ? `'${text}` : text;
  return /[",\n\r]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
}

export function csv(head, rows) {
  return [head, ...rows].map((row) => row.map(csvCell).join(",")).join("\n") + "\n";
}

export function fileName(...parts) {
  return parts.join("-").toLowerCase().replace(/[^a-z0-9.]+/g, "-").replace(/^-|-$/g, "").slice(0, 100);
}
