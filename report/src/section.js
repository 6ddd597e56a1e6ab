// Headings, the words of notes, and what several sections need.
import {element, chooser, dataTable} from "./dom.js";
import {figure} from "./figure.js";
import {number, withError, words} from "./format.js";
import {orderColour, kindColour} from "./colours.js";

/// A section of a chapter; null where nothing stands in it.
export function section(chapter, id, title, intro, ...content) {
  const there = content.flat().filter(Boolean);
  if (there.length === 0) return null;
  return element("section", {id: `${chapter.id}-${id}`, "data-section": id},
    element("h3", {}, title), intro ? element("p", {class: "intro"}, intro) : null, ...there);
}

/// Two side by side where there is room; one that is alone is larger.
export function pair(...figures) {
  const there = figures.filter(Boolean);
  return element("div", {class: there.length === 1 ? "pair single" : "pair"}, there.map((one) => one.node));
}

/// Many, of one size.
export function gallery(figures) {
  return figures.length === 1 ? pair(...figures) : element("div", {class: "pair"}, figures.map((one) => one.node));
}

/// What was found, in words; several lines each stand alone.
export function statement(label, text) {
  if (!text) return null;
  return element("p", {class: "statement"}, label ? element("strong", {}, `${label}: `) : null,
    ...text.split("\n").flatMap((line, i) => i === 0 ? [line] : [element("br"), line]));
}

/// Verdicts begin with what they say; it is set off.
export function verdict(text) {
  const found = /^(reached|not reached|cannot decide|found|met|not met|agrees|maximum)\b/i.exec(text ?? "");
  if (!found) return text || "\u2013";
  return element("span", {}, element("b", {}, found[0]), text.slice(found[0].length));
}

/// What is drawn for one sweep point at a time, with a menu of those that there are.
export function byPoint(chapter, points, make) {
  const box = element("div", {class: "by-point"});
  if (points.length === 1) {
    box.append(...make(points[0]));
    return box;
  }
  const content = element("div");
  const show = (point) => content.replaceChildren(...make(point));
  box.append(chooser("Sweep point", points.map((point) => [point, chapter.pointLabel(point)]), points[0],
    (value) => show(Number(value))), content);
  show(points[0]);
  return box;
}

/// The points of some tables, ascending.
export function pointsOf(tables) {
  return [...new Set(tables.map((table) => table.point))].sort((a, b) => a - b);
}

/// Which of the ones with an order.
export function ordered(i, n) {
  return (dark) => n <= 4 ? kindColour(i, dark) : orderColour(i, n, dark);
}

export function rowsOf(xs, ys, errors, extra = () => ({})) {
  return xs.map((x, i) => ({x, y: ys[i], error: errors?.[i], ...extra(i)}));
}

/// A refused analysis says why.
export function refusals(chapter, tables) {
  const refused = tables.filter((table) => table.notes.refused);
  if (refused.length === 0) return null;
  return element("ul", {class: "refusals"}, refused.map((table) =>
    element("li", {}, `${chapter.titleOf(table)}: not possible: ${table.notes.refused}`)));
}

/// Numbers of a table that stand alone, or one a tap, with their errors.
export function scalarTable(table, names, caption) {
  const shown = names.filter((name) => table.has(name));
  if (shown.length === 0) return null;
  const taps = table.axis("tap");
  return dataTable(["tap", ...shown.map((name) => words(name))], taps.map((tap, i) => [String(tap), ...shown.map((name) => {
    const value = table.value(name, i);
    return typeof value === "string" ? value : withError(value, table.value(`${name}_error`, i));
  })]), caption);
}

export {element, chooser, dataTable, figure, number, withError, words};
