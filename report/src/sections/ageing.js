// Two-time functions, as measured and scaled.
import {byPoint, dataTable, figure, number, ordered, gallery, pointsOf, refusals, section, statement, withError, words} from "../section.js";

function series(table, ys, make) {
  const waiting = table.axis("waiting_time");
  return waiting.map((age, k) => ({
    name: `t_W = ${age}`, colour: ordered(k, waiting.length), mark: "dots+line",
    rows: table.axis("lag").map((lag, j) => make(k, lag, j)).filter((row) => Number.isFinite(row.y)),
  })).filter((one) => one.rows.length > 0);
}

function measured(chapter, table, observable) {
  return figure({
    file: chapter.run.file,
    title: `Ageing of ${words(observable)}, as measured`,
    caption: "A(t, t_W) = \u27e8(X(t_W+t) \u2212 X(t_W))\u00b2\u27e9 over realizations against the lag t, one curve a waiting time " +
      "t_W; bars are 68 % intervals.",
    source: table.source("a") || "Philippe & Bideau 2001, eq. 5",
    x: {label: "lag t (taps)", type: "log", short: "lag"},
    y: {label: `A(t, t_W)${table.units("a") === "1" ? "" : ` (${table.units("a")})`}`, type: "log", short: "A"},
    series: series(table, "a", (k, lag, j) => ({x: lag, y: table.row("a", k)[j], low: table.row("a_low_68", k)[j],
                                                high: table.row("a_high_68", k)[j]})),
  });
}

function fluctuations(chapter, table, observable) {
  if (!table.has("v")) return null;
  return figure({
    file: chapter.run.file,
    title: `Ageing of ${words(observable)}: fluctuations`,
    caption: "V(t, t_W), the variance of X(t_W+t) \u2212 X(t_W) over realizations: A without the change that they share; bars are 68 % intervals.",
    source: table.source("v"),
    x: {label: "lag t (taps)", type: "log", short: "lag"},
    y: {label: `V(t, t_W)${table.units("v") === "1" ? "" : ` (${table.units("v")})`}`, type: "log", short: "V"},
    series: series(table, "v", (k, lag, j) => ({x: lag, y: table.row("v", k)[j], low: table.row("v_low_68", k)[j],
                                                high: table.row("v_high_68", k)[j]})),
  });
}

function covarianceRatio(chapter, table, observable) {
  const lines = series(table, "c", (k, lag, j) => ({x: lag, y: table.row("c", k)[j],
    error: table.row("c_error", k)[j] <= 1 ? table.row("c_error", k)[j] : NaN}));
  if (lines.length === 0) return null;
  return figure({
    file: chapter.run.file,
    title: `Covariance ratio of ${words(observable)}`,
    caption: "C(t, t_W): covariance over realizations of the values at t_W and t_W+t, over the variance at t_W alone: 1 at lag 0, above 1 " +
      "where realizations spread apart; bars are standard errors, left out above 1.",
    source: table.source("c"),
    x: {label: "lag t (taps)", type: "log", short: "lag"}, y: {label: "C(t, t_W)", short: "C"}, rules: [{y: 0}], series: lines,
  });
}

function distance(table) {
  const [after, before] = [table.value("collapse_relative"), table.value("unscaled_collapse_relative")];
  if (!Number.isFinite(after)) return "Curves whose fit sets no limits to the scales are missing.";
  return `The curves differ by ${number(after, 2)} of their values, as measured by ${number(before, 2)}.`;
}

function scaled(chapter, table, observable) {
  const lines = series(table, "scaled_a", (k, lag, j) => ({x: table.row("scaled_lag", k)[j], y: table.row("scaled_a", k)[j],
                                                           error: table.row("scaled_a_error", k)[j]}));
  if (lines.length === 0) return null;
  return figure({
    file: chapter.run.file,
    title: `Ageing of ${words(observable)}, scaled`,
    caption: "A/A\u221e against t/\u03c4, with the scales of fits that share one B; the curves fall on one where ageing is a change of scales alone. " +
      distance(table),
    source: "Philippe & Bideau 2001, eq. 6",
    x: {label: "t / \u03c4(t_W)", type: "log"}, y: {label: "A / A\u221e(t_W)"}, series: lines,
  });
}

function laws(table) {
  return dataTable(["waiting time (taps)", "A\u221e", "B", "\u03c4 (taps)", "misfit", "what the curve says"],
    table.axis("waiting_time").map((age, k) => [String(age), ...["a_inf", "b", "tau"].map((name) =>
      Number.isFinite(table.value(name, k)) ? withError(table.value(name, k), table.value(`${name}_error`, k)) : "\u2013"),
      number(table.value("misfit", k), 2), table.value("verdict", k)]),
    "A\u221e (1 \u2212 1/(1 + B ln(1 + t/\u03c4))), fitted to each waiting time");
}

export function ageingSection(chapter) {
  const tables = chapter.tables.filter((table) => table.group === "analysis" && table.path[0] === "ageing");
  const made = tables.filter((table) => !table.notes.refused);
  const content = made.length === 0 ? null : byPoint(chapter, pointsOf(made), (point) =>
    made.filter((table) => table.point === point).flatMap((table) => {
      const observable = table.path.at(-1);
      const figures = [measured(chapter, table, observable), fluctuations(chapter, table, observable), scaled(chapter, table, observable),
                       covarianceRatio(chapter, table, observable)].filter(Boolean);
      return [gallery(figures), statement("Change with age", table.notes.ageing_verdict),
              statement("Of the fluctuations", table.notes.fluctuation_verdict),
              statement("Collapse on eq. 6", table.notes.collapse_verdict),
              ...[["A", ""], ["V", "v_"]].flatMap(([name, prefix]) => [
                statement(`${name} as a function of t/t_W^mu`, table.notes[`${prefix}mu_verdict`]),
                statement(`${name} as a function of ln(t_W + t)/ln t_W`, table.notes[`${prefix}logarithmic_collapse_verdict`])]),
              laws(table)].filter(Boolean);
    }));
  return section(chapter, "ageing", "Ageing", "How much an observable changes in a lag t, counted from the waiting time t_W.",
    content, refusals(chapter, tables));
}
