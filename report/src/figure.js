// A plot with its caption, the values behind it, and what saves them.
import {element, dataTable, save} from "./dom.js";
import {csv, fileName, number, withError} from "./format.js";
import {written} from "./typeset.js";
import {drawn} from "./plot.js";
import {isDark, onTheme} from "./theme.js";

const longestTable = 400;  // rows that a page shows; the CSV has all
const figures = new Set();
const pending = [];
let working = false;

/// Figures are drawn when they come into sight, and the others when nothing else is to be done.
const watcher = "IntersectionObserver" in window
  ? new IntersectionObserver((entries) => {
      for (const entry of entries) if (entry.isIntersecting) entry.target.figure?.draw();
    }, {rootMargin: "300px"})
  : null;

function drawPending(deadline) {
  while (pending.length > 0 && deadline.timeRemaining() > 4) pending.shift().draw();
  working = pending.length > 0;
  if (working) whenIdle(drawPending);
}

function whenIdle(work) {
  if ("requestIdleCallback" in window) requestIdleCallback(work, {timeout: 1000});
  else setTimeout(() => work({timeRemaining: () => 10}), 30);
}

export function drawAll() {
  for (const figure of figures) figure.draw();
}

onTheme(() => { for (const figure of figures) figure.drawAgain(); });
addEventListener("beforeprint", drawAll);

const resizes = new ResizeObserver((entries) => {
  for (const entry of entries) entry.target.figure?.resized(entry.contentRect.width);
});

class Figure {
  constructor(make) {
    this.make = make;
    this.canvas = element("div", {class: "canvas"});
    this.caption = element("figcaption");
    this.title = element("h4");
    this.body = element("details", {class: "values", ontoggle: () => this.fillTable()},
      element("summary", {}, "Values as a table"));
    this.node = element("figure", {class: "plot"}, this.title, this.canvas, this.caption,
      element("div", {class: "actions"},
        element("button", {type: "button", onclick: () => this.saveSvg()}, "Save SVG"),
        element("button", {type: "button", onclick: () => this.saveCsv()}, "Save CSV")),
      this.body);
    this.canvas.figure = this.node.figure = this;
    this.width = 0;
    this.isDrawn = false;
    this.describe();
    figures.add(this);
    resizes.observe(this.canvas);
    watcher?.observe(this.node);
    pending.push(this);
    if (!working) {
      working = true;
      whenIdle(drawPending);
    }
  }

  describe() {
    this.spec = this.make();
    const {title, caption, source} = this.spec;
    this.title.replaceChildren(...written(title));
    this.caption.replaceChildren(...written(caption),
      source ? element("span", {class: "source"}, ` Source: ${source}.`) : "");
  }

  draw() {
    if (this.isDrawn) return;
    this.width = this.canvas.clientWidth || 640;
    this.isDrawn = true;
    const svg = drawn(this.spec, {width: this.width, dark: isDark()});
    svg.setAttribute("role", "img");
    svg.setAttribute("aria-label", `${this.title.textContent}. ${this.caption.textContent}`);
    this.canvas.replaceChildren(svg);
  }

  drawAgain() {
    const wasDrawn = this.isDrawn;
    this.isDrawn = false;
    if (wasDrawn && this.canvas.isConnected) this.draw();
  }

  /// Draws the figure again after a change of what is shown.
  update() {
    this.describe();
    this.drawAgain();
    if (this.body.open) this.fillTable();
  }

  resized(width) {
    if (this.isDrawn && Math.abs(width - this.width) > 8 && !matchMedia("print").matches) this.drawAgain();
  }

  name(extension) {
    return `${fileName(this.spec.file, this.spec.title)}.${extension}`;
  }

  saveSvg() {
    const svg = drawn(this.spec, {width: 680, dark: false, still: true});
    svg.insertBefore(element("title", {}, this.spec.title), svg.firstChild);
    svg.insertBefore(element("desc", {}, `${this.caption.textContent} ${this.spec.study}.`), svg.firstChild.nextSibling);
    save(this.name("svg"), '<?xml version="1.0" encoding="UTF-8"?>\n' + new XMLSerializer().serializeToString(svg),
      "image/svg+xml");
  }

  /// Every value that is drawn: of which series, where, how large, how uncertain.
  rows() {
    return this.spec.series.filter((one) => !one.guide).flatMap((one) =>
      one.rows.map((row) => [one.name, row.label || row.x, row.y, row.error ?? NaN, row.low ?? NaN, row.high ?? NaN]));
  }

  saveCsv() {
    const {x, y} = this.spec;
    save(this.name("csv"), csv(["series", x.label, y.label, "half width 68 %", "low", "high"], this.rows()),
      "text/csv");
  }

  fillTable() {
    if (!this.body.open) return;
    const {x, y, title} = this.spec;
    const rows = this.rows();
    const shown = rows.slice(0, longestTable).map(([series, at, value, error, low, high]) =>
      [series || "\u2013", typeof at === "number" ? number(at, 5) : at, withError(value, error),
       Number.isFinite(low) || Number.isFinite(high) ? `${number(low)} to ${number(high)}` : "\u2013"]);
    const table = dataTable(["series", x.label, y.label, "interval"], shown, title);
    const rest = rows.length - shown.length;
    this.body.replaceChildren(this.body.firstElementChild, table,
      ...(rest > 0 ? [element("p", {class: "small"}, `${rest} more rows are in the CSV.`)] : []));
  }
}

const ends = {inf: Infinity, "-inf": -Infinity};

function column(series, name) {
  return series[name]?.map((value) => value === null ? NaN : ends[value] ?? value);
}

/// A series with rows in the place of its columns.
function inRows(series) {
  const [y, error, low, high] = ["y", "error", "low", "high"].map((name) => column(series, name));
  return {...series, rows: column(series, "x").map((x, i) =>
    ({x, y: y[i], error: error?.[i], low: low?.[i], high: high?.[i], label: series.labels?.[i]}))};
}

/// A panel of the catalogue, drawn; of series with a sweep point those that `isShown`.
export function figure(panel, {file, about}, isShown) {
  const series = panel.series.map(inRows);
  return new Figure(() => ({...panel, file, study: `Of ${file}: ${about}`, series: series.filter((one) => one.point === undefined || isShown(one.point))}));
}
