// What fluctuations of steady states say of the compactivity, and whether the packing fraction alone is the state.
import {axisLabel, controlOf, controlSymbol} from "../format.js";
import {dataTable, figure, gallery, number, ordered, rowsOf, refusals, section, statement, withError, words} from "../section.js";

const estimators = [["inverse_x_fluctuations", "by fluctuations"], ["inverse_x_histograms", "by overlapping histograms"]];

function compactivity(chapter, table) {
  const volumes = table.values("volume");
  return figure({
    file: chapter.run.file, title: `Compactivity, by ${words(table.path.at(-1))}`,
    caption: "1/X less that of the first steady state, X the compactivity, against the mean volume of the states; bars are standard errors.",
    source: table.source("inverse_x_fluctuations"),
    x: {label: `volume a sphere (${table.units("volume")})`}, y: {label: `\u0394(1/X) (${table.units("inverse_x_fluctuations")})`}, rules: [{y: 0}],
    series: estimators.map(([name, label], i) => ({name: label, kind: i, mark: "dots+line", hollow: i > 0,
      rows: rowsOf(volumes, table.values(name), table.values(`${name}_error`)).filter((row) => Number.isFinite(row.y))})),
  });
}

function variances(chapter, table) {
  return figure({
    file: chapter.run.file, title: `Variance of the volume, by ${words(table.path.at(-1))}`,
    caption: "Variance of a bed's volume a sphere of each state, over taps and realizations, against its mean; bars are standard errors.",
    source: table.source("volume_variance"), x: {label: `volume a sphere (${table.units("volume")})`},
    y: {label: `variance (${table.units("volume_variance")})`, short: "variance"},
    series: [{name: "", mark: "dots+line", rows: rowsOf(table.values("volume"), table.values("volume_variance"),
                                                        table.values("volume_variance_error"))}],
  });
}

function steps(table) {
  if (table.axis("neighbours").length === 0) return null;
  const shown = ["step_fluctuations", "step_histograms", "step_difference", "bend"];
  return dataTable(["states", ...shown.map(words), "distance (deviations)", "overlap"], table.axis("neighbours").map((_, i) =>
    [`${number(table.value("from_state", i))} and ${number(table.value("to_state", i))}`,
     ...shown.map((name) => withError(table.value(name, i), table.value(`${name}_error`, i))),
     number(table.value("separation", i), 3), number(table.value("overlap", i), 2)]), "Steps of 1/X from state to state");
}

export function volumesSection(chapter) {
  const tables = chapter.tables.filter((table) => table.group === "analysis" && table.path[0] === "volumes");
  const content = tables.filter((table) => !table.notes.refused).flatMap((table) =>
    [gallery([compactivity(chapter, table), variances(chapter, table)]), statement("Do the estimators agree", table.notes.verdict),
     statement("Left out", table.notes.left_out), steps(table)].filter(Boolean));
  return section(chapter, "volumes", "Volumes of steady states", "What the fluctuations of the volume say of the compactivity, by two estimators.",
    content, refusals(chapter, tables));
}

function response(chapter, table) {
  const lags = table.axis("lag_window"), histories = table.axis("history");
  const name = table.notes.observable ?? table.path.at(-1), control = controlOf(table);
  return figure({
    file: chapter.run.file, title: `Memory of ${words(name)}`,
    caption: `Change of ${words(name)} since the switch to taps of one strength, mean over windows of lags, one curve a history; bars are ` +
      "standard errors. Histories that came to one value have one curve where it alone is the state.",
    source: table.source("response"), x: {label: "end of the window of lags (taps)", type: "log", short: "lag"},
    y: {label: `change of ${axisLabel(name, table.units("response"))}`, short: "change"}, rules: [{y: 0}],
    series: histories.map((_, k) => ({name: `${controlSymbol(control)} = ${number(table.value(control, k))} before`, colour: ordered(k, histories.length),
      mark: "dots+line", rows: lags.map((lag, j) => ({x: lag, y: table.value("response", k * lags.length + j),
                                                      error: table.value("response_error", k * lags.length + j)}))})),
  });
}

function differences(table) {
  const lags = table.axis("lag_window"), control = controlOf(table);
  return dataTable([`histories, by ${controlSymbol(control)} before`, ...lags.map((lag, j) => {
    const first = table.value("first_lag", j);
    return first === lag ? `lag ${lag}` : `lags ${first} to ${lag}`;
  })], table.axis("pair").map((_, i) => [
    `${number(table.value(`second_${control}`, i))} less ${number(table.value(`first_${control}`, i))}`,
    ...lags.map((__, j) => `${withError(table.value("difference", i * lags.length + j), table.value("difference_error", i * lags.length + j))}, ` +
      `p = ${number(table.value("difference_p_corrected", i * lags.length + j), 2)}`)]), "Differences between histories at equal value, p corrected");
}

export function memorySection(chapter) {
  const tables = chapter.tables.filter((table) => table.group === "analysis" && table.path[0] === "memory");
  const content = tables.filter((table) => !table.notes.refused).flatMap((table) =>
    [gallery([response(chapter, table)]), statement("Is it the state", table.notes.verdict), differences(table)]);
  return section(chapter, "memory", "Memory", "Whether what follows depends on how a value was reached.", content, refusals(chapter, tables));
}
