// Laws fitted to curves: over the data, beside the residuals, and in words.
import {byPoint, chooser, dataTable, element, figure, number, pair, pointsOf, refusals, rowsOf, section, statement, withError,
        words} from "../section.js";
import {axisLabel} from "../format.js";

const lawNames = {inverse_log: "inverse logarithm", inverse_log_height: "inverse logarithm, eq. 4",
                  two_exponentials: "two exponentials", kww: "stretched exponential"};
const dashes = [null, "7,4", "2,3", "9,3,2,3"];

export function lawName(table) {
  return lawNames[table.path.at(-1)] ?? words(table.path.at(-1));
}

function interval(table, j, level, prefix = "") {
  const low = table.row(`${prefix}interval_lower`, j)[level], high = table.row(`${prefix}interval_upper`, j)[level];
  if (!Number.isFinite(low) && !Number.isFinite(high)) return "no limit";
  if (!Number.isFinite(high)) return `above ${number(low)}`;
  if (!Number.isFinite(low)) return `below ${number(high)}`;
  return `${number(low)} to ${number(high)}`;
}

/// A value with half of its 68 % interval, as jostle fit prints it; alone where the interval is lopsided.
function estimate(table, j, prefix) {
  const value = table.value(`${prefix}value`, j);
  const low = table.row(`${prefix}interval_lower`, j)[0], high = table.row(`${prefix}interval_upper`, j)[0];
  const half = (high - low) / 2;
  if (!Number.isFinite(half) || half > 4 * Math.min(value - low, high - value)) return number(value);
  return withError(value, half);
}

function parameters(table, prefix = "", law = lawName(table)) {
  const names = table.axis(`${prefix}parameter`);
  return dataTable(["parameter", "estimate", "95 % interval", "what the data say of it"], names.map((name, j) => {
    const value = table.value(`${prefix}value`, j);
    return [name, Number.isFinite(value) ? estimate(table, j, prefix) : "not determined",
            interval(table, j, 1, prefix), table.value(`${prefix}statement`, j)];
  }), `Parameters of the ${law}`);
}

/// What was fitted where the least squares lie at a limit of the law.
function limiting(table) {
  return table.notes.limit ? [statement("Limit", table.notes.limit), parameters(table, "limit_", table.notes.limit_law)] : [];
}

/// The same curve in the parameters of the law that draws it too.
function restated(table) {
  const law = table.notes.restated_model;
  return law ? [statement("The same curve", table.notes.restated_law), parameters(table, "restated_", lawNames[law] ?? words(law))] : [];
}

/// Without those that draw the curve of another under another name.
function distinct(tables) {
  return tables.filter((table, i) => !tables.slice(0, i).some((other) => other.notes.restated_model === table.path.at(-1)));
}

/// In words, how many of its parameters a law's data determine.
function identified(table) {
  const names = table.axis("parameter");
  const known = names.filter((_, j) => Number.isFinite(table.value("value", j)) &&
    Number.isFinite(table.row("interval_lower", j)[1]) && Number.isFinite(table.row("interval_upper", j)[1]));
  if (known.length === names.length) return "All parameters are limited on both sides.";
  if (known.length === 0) return "No parameter is limited on both sides: the curve does not identify this law.";
  const others = names.filter((name) => !known.includes(name));
  return `${known.join(", ")} ${known.length === 1 ? "is" : "are"} limited on both sides; ${others.join(", ")} ` +
    `${others.length === 1 ? "is" : "are"} not.`;
}

function dataFigure(chapter, tables, observable) {
  const [first] = tables;
  const t = first.axis("t");
  return figure({
    file: chapter.run.file,
    title: `Fits of ${words(observable)}`,
    caption: `Mean over realizations (points; bars are standard errors pooled over taps) and the fitted laws, taps ` +
      `${first.notes.range?.replace(":", " to ") ?? ""}.`,
    source: tables.map((table) => table.notes.source).filter(Boolean).filter((text, i, all) => all.indexOf(text) === i).join("; "),
    x: {label: "taps t", type: "tap", short: "tap"}, y: {label: axisLabel(observable, ""), short: words(observable)},
    series: [
      {name: "data", ink: true, mark: "dots", symbol: "circle", rows: rowsOf(t, first.values("x"), first.values("x_error"))},
      ...tables.map((table, i) => ({name: lawName(table), kind: i, dash: dashes[i % dashes.length], width: 2,
                                    rows: rowsOf(table.axis("t"), table.values("fitted"))})),
    ],
  });
}

function residualFigure(chapter, tables, observable) {
  const scaled = tables[0].values("x_error").some((error) => error > 0);
  return figure({
    file: chapter.run.file,
    title: `Residuals of ${words(observable)}`,
    caption: scaled ? "Data less law, in standard errors of the mean. Neighbouring taps are not independent: what matters is a " +
      "trend, not the single point beyond one." : "Data less law.",
    x: {label: "taps t", type: "tap", short: "tap"},
    y: {label: scaled ? "(data \u2212 law) / error" : "data \u2212 law", short: "residual"},
    rules: [{y: 0}],
    series: tables.map((table, i) => ({
      name: lawName(table), kind: i, mark: "line", width: 1.4, dash: dashes[i % dashes.length],
      rows: table.axis("t").map((t, k) => ({x: t, y: (table.value("x", k) - table.value("fitted", k)) /
        (scaled ? table.value("x_error", k) : 1)})),
    })),
  });
}

function goodness(tables) {
  if (tables.length < 2) return null;
  return dataTable(["law", "formula", "reduced \u03c7\u00b2", "R\u00b2", "held-out error", "difference", "p", "points", "independent points"],
    tables.map((table) => [lawName(table), table.notes.law ?? "", number(table.value("reduced_chi2"), 3), number(table.value("r2"), 5),
      ...(table.has("held_out_error") ?
        [number(table.value("held_out_error"), 5), withError(table.value("held_out_difference"), table.value("held_out_difference_error")),
         number(table.value("held_out_p"), 2)] :
        ["\u2013", "\u2013", "\u2013"]),
      number(table.value("points"), 6), number(table.value("effective_points"), 3)]),
    "The laws compared. Held-out error: mean squared error of the prediction of a realization that the fit has not seen, in variances " +
    "of one realization; difference: from the leading law, with its standard error; p: of the hypothesis that the law is as close to " +
    "the mean curve as the leading law");
}

/// Which law is chosen, for each set of laws that were fitted together.
function choices(tables) {
  return [...new Set(tables.map((table) => table.notes.choice).filter(Boolean))].map((text) => statement("Choice", text));
}

export function fitsSection(chapter) {
  const tables = chapter.tables.filter((table) => table.group === "fits");
  if (tables.length === 0) return null;
  const made = tables.filter((table) => !table.notes.refused && table.has("fitted"));
  const content = byPoint(chapter, pointsOf(made), (point) => {
    const here = made.filter((table) => table.point === point);
    return [...new Set(here.map((table) => table.path[0]))].flatMap((observable) => {
      const laws = distinct(here.filter((table) => table.path[0] === observable));
      return [
        pair(dataFigure(chapter, laws, observable), residualFigure(chapter, laws, observable)),
        ...choices(laws), goodness(laws),
        ...laws.map((table) => element("details", {class: "law", open: laws.length === 1},
          element("summary", {}, element("b", {}, lawName(table)), ` \u2013 ${identified(table)}`),
          statement("", table.notes.law), ...limiting(table), parameters(table), ...restated(table), statement("Combinations", table.notes.combinations),
          statement("Remarks", table.notes.remarks))),
      ].filter(Boolean);
    });
  });
  return section(chapter, "fits", "Fitted laws",
    "Estimates are given as value(half of the 68 % interval); \u201cno limit\u201d means that the data allow any value beyond.", made.length > 0 ? content : null,
    refusals(chapter, tables));
}

export {chooser};
