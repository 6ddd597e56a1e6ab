// Draws a panel of the catalogue (study/drawing/figures/catalogue.hpp): series with errors on axes that know taps.
import * as Plot from "@observablehq/plot";
import {nice, ticks as ticksOf} from "d3-array";
import {element} from "./dom.js";
import {number, superscript, withError} from "./format.js";
import {cutTo, typeset} from "./typeset.js";

// The place of tap 0, in decades: to the left of tap 1, behind a break of the axis.
const zeroPlace = -0.55;
const narrowTaps = 30;  // with fewer taps the axis is linear
const dashes = [undefined, "7,4", "2,3", "9,3,2,3"];
const markers = ["circle", "square", "diamond", "triangle", "star", "cross", "wye"];
const longestName = 60;

const themes = {
  light: {ink: "#222222", faint: "#d8d8d8", paper: "#ffffff"},
  dark: {ink: "#dedede", faint: "#3c4148", paper: "#15181c"},
};

/// Places on the axis, and the axis itself.
function axisOf(axis, values) {
  const finite = values.filter(Number.isFinite);
  const most = Math.max(...finite, 1);
  if (axis.scale === "taps" && most > narrowTaps) {
    const ticks = [], minor = [];
    const hasZero = finite.some((value) => value <= 0);
    if (hasZero) ticks.push(zeroPlace);
    for (let decade = 0; 10 ** decade <= most * 1.001; ++decade) {
      ticks.push(decade);
      for (let k = 2; k < 10 && k * 10 ** decade <= most; ++k) minor.push(decade + Math.log10(k));
    }
    return {
      place: (value) => value <= 0 ? zeroPlace : Math.log10(value),
      scale: {type: "linear", domain: [hasZero ? zeroPlace - 0.1 : -0.05, Math.log10(most) + 0.04]},
      ticks, minor, hasBreak: hasZero, isTaps: true,
      tickFormat: (place) => place === zeroPlace ? "0" : place < 4 ? String(10 ** place) : `10${superscript(place)}`,
    };
  }
  if (axis.scale === "log") {
    const positive = finite.filter((value) => value > 0);
    const low = Math.min(...positive), high = Math.max(...positive);
    const margin = Math.max((high / low) ** 0.03, 1.02);
    const domain = [low / margin, high * margin], ticks = [], minor = [];
    const decades = Math.log10(domain[1] / domain[0]), step = Math.max(1, Math.ceil(decades / 7));
    for (let k = Math.ceil(Math.log10(domain[0]) - 1e-9); 10 ** k <= domain[1]; ++k) if (k % step === 0) ticks.push(10 ** k);
    const isShort = ticks.length < 2;
    for (let k = Math.floor(Math.log10(domain[0])); 10 ** k <= domain[1]; ++k) {
      for (let m = 2; m < 10; ++m) {
        const value = m * 10 ** k;
        if (value < domain[0] || value > domain[1]) continue;
        if (isShort && [2, 3, 5].includes(m)) ticks.push(value);
        else minor.push(value);
      }
    }
    return {
      place: (value) => value > 0 ? value : NaN,
      placeLow: (value) => Math.max(value, domain[0]),
      scale: {type: "log", domain},
      ticks: ticks.sort((a, b) => a - b), minor,
      tickFormat: (value) => {
        const power = Math.log10(value);
        return Math.abs(power - Math.round(power)) < 1e-9 && Math.abs(power) > 3
          ? `10${superscript(Math.round(power))}` : number(value, 3);
      },
    };
  }
  if (axis.scale === "names") {
    const names = axis.names;
    return {place: (value) => value, ticks: names.map((_, i) => i), minor: [],
            scale: {type: "linear", domain: [-0.5, names.length - 0.5]}, tickFormat: (i) => names[i]};
  }
  let low = Math.min(...finite), high = Math.max(...finite);
  if (!(low <= high)) [low, high] = [0, 1];
  if (axis.from_zero) [low, high] = [Math.min(low, 0), Math.max(high, 0)];
  if (low === high) [low, high] = low === 0 ? [0, 1] : [low - Math.abs(low) * 0.1, high + Math.abs(high) * 0.1];
  const [niceLow, niceHigh] = nice(axis.low ?? low, axis.high ?? high, 8);
  const domain = [axis.low ?? niceLow, axis.high ?? niceHigh];
  return {place: (value) => value, scale: {type: "linear", domain}, minor: [], isClipped: axis.low !== undefined || axis.high !== undefined, ticks: ticksOf(...domain, axis.ticks ?? 6),
          tickFormat: (value) => number(value, 6)};
}

/// The smallest distance at which two taps can be distinguished, on an axis that has a place for each decade.
const closestPlaces = 1 / 36;

function thinned(rows, isTapAxis) {
  if (!isTapAxis) return rows;
  let last = -Infinity;
  return rows.filter((at, i) => {
    const keep = i === rows.length - 1 || at.x - last >= closestPlaces || at.row.x <= 1;
    if (keep) last = at.x;
    return keep;
  });
}

function bounds(row) {
  if (Number.isFinite(row.low) || Number.isFinite(row.high)) return [row.low ?? row.y, row.high ?? row.y];
  return Number.isFinite(row.error) ? [row.y - row.error, row.y + row.error] : [row.y, row.y];
}

/// The values that an axis of y must show. A logarithmic axis leaves out errors as large as their value, which would
/// reach down without end, and laws without a band, which may have any size.
function extentOf(series, axis) {
  const isEven = axis.scale !== "log";
  return series.filter((one) => isEven || !one.no_band).flatMap((one) => one.rows.flatMap((row) => {
    const [low, high] = bounds(row);
    return isEven || low > row.y / 10 ? [row.y, low, high] : [row.y, high];
  }));
}

/// Rows with their places, those that cannot be drawn left out.
function placed(series, xAxis, yAxis) {
  return series.map((one, i) => ({...one, i, rows: one.rows.map((row) => {
    const [low, high] = bounds(row);
    const at = {x: xAxis.place(row.x), y: yAxis.place(row.y), low: (yAxis.placeLow ?? yAxis.place)(low),
                high: yAxis.place(high)};
    return {...at, row, series: one};
  }).filter((at) => Number.isFinite(at.x) && Number.isFinite(at.y))}))
    .map((one) => ({...one, rows: thinned(one.rows, xAxis.isTaps)}));
}

function marksOf(one, colour, xAxis, isClipped, ink) {
  const marks = [];
  if (one.thin) {
    const connected = xAxis.hasBreak ? one.rows.filter((at) => at.row.x > 0) : one.rows;
    return [Plot.line(connected, {x: "x", y: "y", stroke: colour, strokeWidth: 0.7, strokeOpacity: 0.45})];
  }
  const along = {x: "x", y: "y"};
  const connected = xAxis.hasBreak ? one.rows.filter((at) => at.row.x > 0) : one.rows;
  const dash = dashes[one.dash % dashes.length];
  const alone = xAxis.hasBreak ? one.rows.filter((at) => at.row.x <= 0) : [];
  const spread = one.rows.filter((at) => at.low < at.high || !Number.isFinite(at.low));
  const hasErrors = spread.length > 0;
  const bottom = (at) => Number.isFinite(at.low) ? at.low : at.y;
  const ruled = (rows) => rows.filter((at) => Number.isFinite(at.high));
  if (one.mark === "line") {
    if (hasErrors && !one.no_band) {
      const banded = connected.filter((at) => Number.isFinite(at.low) && Number.isFinite(at.high));
      marks.push(Plot.areaY(banded, {x: "x", y1: "low", y2: "high", fill: colour, fillOpacity: 0.2, clip: isClipped}));
    }
    marks.push(Plot.line(connected, {...along, stroke: colour, strokeWidth: 1.8, strokeDasharray: dash, strokeLinejoin: "round",
                                     clip: isClipped || one.no_band}));
    if (alone.length > 0 && !one.guide) {
      marks.push(Plot.ruleX(ruled(alone), {x: "x", y1: bottom, y2: "high", stroke: colour, strokeWidth: 1.2}));
      marks.push(Plot.dot(alone, {...along, fill: colour, r: 3.2}));
    }
    if (connected.length === 1) marks.push(Plot.dot(connected, {...along, fill: colour, r: 3.2}));
  } else {
    if (one.mark !== "points") {
      marks.push(Plot.line(connected, {...along, stroke: colour, strokeWidth: 1.2, strokeOpacity: 0.75,
                                       strokeDasharray: dash, curve: one.mark === "steps" ? "step-after" : "linear",
                                       clip: isClipped}));
    }
    if (hasErrors) {
      marks.push(Plot.ruleX(ruled(one.rows), {x: "x", y1: bottom, y2: "high", stroke: colour, strokeWidth: 1.1, clip: isClipped}));
    }
    marks.push(Plot.dot(one.rows, {clip: isClipped, ...along, stroke: colour, fill: one.hollow ? "none" : colour, fillOpacity: 0.85,
                                   r: one.rows.length > 120 ? 1.8 : 3, symbol: markers[one.symbol % markers.length]}));
  }
  if (one.labelled) {
    marks.push(Plot.text(one.rows, {...along, text: (at) => at.row.label, dy: -9, fontSize: 10.5, fill: ink,
                                    stroke: one.paper, strokeWidth: 3}));
  }
  return marks;
}

function hoverText(at, spec) {
  const {row, series} = at;
  const where = row.label || `${spec.x.label}: ${number(row.x, 5)}`;
  const interval = Number.isFinite(row.low) && Number.isFinite(row.high) && !Number.isFinite(row.error)
    ? ` [${number(row.low)}, ${number(row.high)}]` : "";
  return [series.name, where, `${spec.y.label}: ${withError(row.y, row.error)}${interval}`]
    .filter(Boolean).join("\n");
}

/// The names of the series above the plot, in as many lines as they need.
function legend(series, width, colours, theme) {
  const named = series.filter((one) => one.name && !one.thin);
  if (named.length < 2) return {height: 0, node: null};
  const group = element("g", {"aria-hidden": "true", "font-size": 12, "text-anchor": "start", class: "legend"});
  let x = 4, y = 12;
  for (const one of named) {
    const text = cutTo(one.name, Math.min(longestName, Math.floor((width - 36) / 6.8)));
    const length = 30 + 6.6 * text.length;
    if (x > 4 && x + length > width) {
      x = 4;
      y += 18;
    }
    const colour = colours.get(one);
    if (one.mark !== "points") {
      group.append(element("line", {x1: x, x2: x + 18, y1: y - 4, y2: y - 4, stroke: colour, "stroke-width": 2.4,
                                    "stroke-dasharray": dashes[one.dash % dashes.length]}));
    }
    if (one.mark !== "line") {
      group.append(element("path", {d: paths[markers[one.symbol % markers.length]],
                                    transform: `translate(${x + 9},${y - 4})`, fill: one.hollow ? theme.paper : colour,
                                    stroke: colour}));
    }
    group.append(element("text", {x: x + 23, y, fill: theme.ink}, typeset(text)));
    x += length;
  }
  return {height: y + 10, node: group};
}

const paths = {
  circle: "M3.4,0A3.4,3.4,0,1,1,-3.4,0A3.4,3.4,0,1,1,3.4,0", square: "M-3,-3h6v6h-6z", triangle: "M0,-4L3.6,2.6H-3.6z",
  diamond: "M0,-4.4L3,0L0,4.4L-3,0z", star: "M0,-4.5L1.1,-1.4L4.3,-1.4L1.7,.6L2.6,3.6L0,1.8L-2.6,3.6L-1.7,.6L-4.3,-1.4L-1.1,-1.4z",
  cross: "M-1.3,-4h2.6v2.7h2.7v2.6h-2.7v2.7h-2.6v-2.7h-2.7v-2.6h2.7z", wye: "M-1,4v-4l-3,-2l1,-1.6l3,1.9l3,-1.9l1,1.6l-3,2v4z",
};

/// The SVG of a spec; `still`: to be saved, without what answers to a pointer.
export function drawn(spec, {width, dark, still = false}) {
  const theme = dark ? themes.dark : themes.light;
  const narrow = width < 420;
  const hasNames = spec.x.scale === "names";
  const height = Math.round(Math.min(Math.max(width * 0.58, 240), 400));
  const all = spec.series.flatMap((one) => one.rows);
  const xAxis = axisOf(narrow ? {...spec.x, ticks: 5} : spec.x, [...all.map((row) => row.x), ...spec.rules.map((rule) => rule.x ?? NaN)]);
  const yAxis = axisOf(spec.y, [...extentOf(spec.series, spec.y), ...spec.rules.map((rule) => rule.y ?? NaN)]);
  const series = placed(spec.series, xAxis, yAxis);
  const colours = new Map(series.map((one) => [one, dark ? one.colour.dark : one.colour.light]));
  const key = legend(series, width, colours, theme);
  const marks = [];
  const grid = {stroke: theme.faint, strokeOpacity: 0.7};
  marks.push(Plot.gridX(xAxis.ticks, grid), Plot.gridY(yAxis.ticks, grid));
  for (const rule of spec.rules) {
    const mark = "x" in rule ? Plot.ruleX([xAxis.place(rule.x)], {stroke: theme.ink, strokeOpacity: 0.45, strokeDasharray: "3,3"})
                             : Plot.ruleY([yAxis.place(rule.y)], {stroke: theme.ink, strokeOpacity: 0.45, strokeDasharray: "3,3"});
    marks.push(mark);
  }
  for (const one of series) marks.push(...marksOf({...one, paper: theme.paper}, colours.get(one), xAxis,
    Boolean(xAxis.isClipped || yAxis.isClipped), theme.ink));
  const text = {fill: theme.ink, color: theme.ink, fontSize: 12};
  marks.push(Plot.axisX(xAxis.ticks, {...text, tickFormat: xAxis.tickFormat, label: null, tickSize: 6,
                                      tickRotate: hasNames ? -22 : undefined}));
  marks.push(Plot.axisY(yAxis.ticks, {...text, tickFormat: yAxis.tickFormat, label: null, tickSize: 6}));
  if (xAxis.minor.length > 0) marks.push(Plot.axisX(xAxis.minor, {tickSize: 3, tickFormat: () => "", label: null, color: theme.ink}));
  if (yAxis.minor.length > 0) marks.push(Plot.axisY(yAxis.minor, {tickSize: 3, tickFormat: () => "", label: null, color: theme.ink}));
  if (!still) {
    const rows = series.filter((one) => !one.guide && !one.thin).flatMap((one) => one.rows);
    marks.push(Plot.tip(rows, Plot.pointer({x: "x", y: "y", title: (at) => hoverText(at, spec), fill: theme.paper,
                                            stroke: theme.faint, textColor: theme.ink, fontSize: 12, pathFilter: null})));
  }
  const marginBottom = hasNames ? 84 : 44;
  const marginLeft = 34 + 6.7 * Math.max(3, ...yAxis.ticks.map((value) => String(yAxis.tickFormat(value)).length));
  const svg = Plot.plot({
    width, height: height + key.height, marginLeft, marginRight: 14, marginTop: key.height + 10,
    marginBottom, x: {...xAxis.scale, label: null}, y: {...yAxis.scale, label: null}, marks,
    style: {background: "transparent", color: theme.ink, fontFamily: "system-ui, sans-serif", overflow: "visible"},
  });
  svg.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  if (still) svg.insertBefore(element("rect", {width: "100%", height: "100%", fill: theme.paper}), svg.firstChild);
  const total = height + key.height, middle = marginLeft + (width - marginLeft - 14) / 2;
  svg.append(
    element("text", {x: middle, y: total - 6, "text-anchor": "middle", fill: theme.ink, "font-size": 12.5}, typeset(spec.x.label)),
    element("text", {transform: `translate(13,${key.height + 10 + (height - 54) / 2}) rotate(-90)`, "text-anchor": "middle",
                     fill: theme.ink, "font-size": 12.5}, typeset(spec.y.label)));
  if (xAxis.hasBreak) {
    const at = svg.scale("x").apply((zeroPlace) / 2), base = total - marginBottom;
    svg.append(element("path", {d: `M${at - 5},${base + 5}l4,-10M${at + 1},${base + 5}l4,-10`, stroke: theme.ink,
                                "stroke-width": 1.2, fill: "none"}));
  }
  svg.append(element("line", {x1: marginLeft, x2: width - 14, y1: total - marginBottom,
                              y2: total - marginBottom, stroke: theme.ink}),
             element("line", {x1: marginLeft, x2: marginLeft, y1: key.height + 10, y2: total - marginBottom,
                              stroke: theme.ink}));
  if (key.node) svg.append(key.node);
  return svg;
}
