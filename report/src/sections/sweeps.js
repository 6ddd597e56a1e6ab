// What depends on the swept value, or on a strength that goes up and down.
import {byPoint, dataTable, figure, number, pair, pointsOf, refusals, rowsOf, section, statement, withError, words} from "../section.js";
import {axisLabel, controlLabel} from "../format.js";

const branchDashes = [null, "6,3", "2,3"];

/// Branches are counted from 1.
function branchNumber(table, branch) {
  return branch - Math.min(...table.values("branch")) + 1;
}

function loopFigure(chapter, table) {
  const observable = table.notes.observable ?? table.path.at(-1);
  const control = table.notes.control;
  const branches = [...new Set(table.values("branch"))];
  const steps = table.axis("step");
  const errorName = table.has(`${observable}_error`) ? `${observable}_error` : "";
  return figure({
    file: chapter.run.file,
    title: `Hysteresis of ${words(observable)}`,
    caption: "Mean of the last taps of every step of the protocol, in the order of the steps; bars are standard errors over realizations. A branch " +
      "ends where the strength turns.",
    source: table.source(observable),
    x: {label: controlLabel(control, table.units(control))}, y: {label: axisLabel(observable, table.units(observable)), short: words(observable)},
    series: branches.map((branch, b) => {
      const places = steps.map((_, i) => i).filter((i) => table.value("branch", i) === branch ||
        (b > 0 && i + 1 < steps.length && table.value("branch", i + 1) === branch && table.value("branch", i) === branches[b - 1]));
      const up = table.value(control, places.at(-1)) > table.value(control, places[0]);
      return {name: `branch ${branchNumber(table, branch)}, ${up ? "upwards" : "downwards"}`, kind: b, mark: "dots+line",
              dash: branchDashes[b % 3],
              rows: places.map((i) => ({x: table.value(control, i), y: table.value(observable, i),
                                        error: errorName ? table.value(errorName, i) : NaN}))};
    }),
  });
}

function areas(table) {
  if (table.axis("loop").length === 0) return null;
  return dataTable(["branches", "over strengths", "area", "p", "verdict"], table.axis("loop").map((_, i) =>
    [`${branchNumber(table, table.value("earlier_branch", i))} and ${branchNumber(table, table.value("later_branch", i))}`,
     `${number(table.value("lowest_strength", i))} to ${number(table.value("highest_strength", i))}`,
     withError(table.value("area", i), table.value("area_error", i)), number(table.value("area_p_corrected", i), 2),
     table.value("area_verdict", i) || "\u2013"]), "Area between branches, later less earlier");
}

export function hysteresisSection(chapter) {
  const tables = chapter.tables.filter((table) => table.group === "analysis" && table.path[0] === "hysteresis");
  const made = tables.filter((table) => !table.notes.refused && table.axis("step").length > 0);
  const content = made.length === 0 ? null : byPoint(chapter, pointsOf(made), (point) =>
    made.filter((table) => table.point === point).flatMap((table) => [pair(loopFigure(chapter, table)), areas(table)].filter(Boolean)));
  return section(chapter, "hysteresis", "Hysteresis", "The same strength, reached from below and from above.", content,
    refusals(chapter, tables));
}

function isSweep(table) {
  return table.group === "analysis" && table.path[0] === "sweep";
}

function sweepFigure(chapter, table) {
  const x = table.notes.against, y = table.notes.observable;
  if (!table.axes.has(x) || !table.has(y)) return null;
  const found = table.value("maximum_p") < 0.05;
  const low = table.value("maximum_at_low"), high = table.value("maximum_at_high");
  const pooled = table.has(`${y}_pooled_error`);
  const errors = table.values(pooled ? `${y}_pooled_error` : `${y}_error`);
  const rules = found ? [{x: table.value("maximum_at")}, ...[low, high].filter(Number.isFinite).map((at) => ({x: at}))] : [];
  return figure({
    file: chapter.run.file,
    title: `${words(y)[0].toUpperCase()}${words(y).slice(1)} against ${controlLabel(x, "1")}`,
    caption: "One point a sweep point; bars are standard errors" +
      (pooled ? " by the variance pooled over points, since few realizations know their own badly." : ".") + (found ? ` The highest point of a parabola is at ` +
      `${number(table.value("maximum_at"), 3)}; dashed: it and the 95 % interval of the maximum's place.` : ""),
    source: table.source(y),
    x: {label: controlLabel(x, table.units(x))}, y: {label: axisLabel(y, table.units(y)), short: words(y)}, rules,
    series: [{name: "", mark: "dots+line", rows: rowsOf(table.axis(x), table.values(y), errors)}],
  });
}

function differences(table) {
  if (table.axis("pair").length === 0) return null;
  return dataTable(["from", "to", "difference", "p, corrected"], table.axis("pair").map((_, i) =>
    [number(table.value("from", i)), number(table.value("to", i)), withError(table.value("difference", i), table.value("difference_error", i)),
     number(table.value("difference_p_corrected", i), 2)]), "Differences between points");
}

export function sweepSection(chapter) {
  const tables = chapter.tables.filter(isSweep);
  const made = tables.filter((table) => !table.notes.refused);
  const content = made.flatMap((table) => {
    const one = sweepFigure(chapter, table);
    if (!one) return [];
    return [pair(one), statement("Maximum", table.notes.maximum),
            Number.isFinite(table.value("line_slope")) ? statement("Straight line", `slope ${withError(table.value("line_slope"),
              table.value("line_slope_error"))}; p of lying on it: ${number(table.value("line_p"), 2)}`) : null, differences(table)];
  }).filter(Boolean);
  return section(chapter, "sweep", "Sweep curves", "A quantity against what is swept.", content, refusals(chapter, tables));
}
