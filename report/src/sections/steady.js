// Steady states: value, fluctuation, memory, and whether they are steady at all.
import {byPoint, dataTable, element, figure, gallery, pointsOf, refusals, rowsOf, section, verdict, withError, words} from "../section.js";

function overview(chapter, tables) {
  return dataTable(["observable", "sweep point", "taps", "mean", "\u03c3 of single taps", "memory \u03c4 (taps)", "drift", "verdict"],
    tables.map((table) => [words(table.notes.observable ?? table.path.at(-1)), chapter.pointLabel(table.point), table.notes.taps,
      withError(table.value("value"), table.value("value_error")), withError(table.value("sigma"), table.value("sigma_error")),
      withError(table.value("autocorrelation_time"), table.value("autocorrelation_time_error")),
      withError(table.value("drift"), table.value("drift_error")), verdict(table.notes.verdict)]),
    "The last taps of every sweep point");
}

export function steadySection(chapter) {
  const tables = chapter.tables.filter((table) => table.group === "analysis" && table.path[0] === "steady");
  if (tables.length === 0) return null;
  const made = tables.filter((table) => !table.notes.refused);
  const curves = byPoint(chapter, pointsOf(made), (point) => {
    const figures = made.filter((table) => table.point === point).map((table) => figure({
      file: chapter.run.file,
      title: `Blocking of ${words(table.path.at(-1))}`,
      caption: `Standard error of the mean of taps ${table.notes.taps}, if blocks of so many taps were independent. It grows ` +
        `until they are; plateau: ${table.notes.plateau}.`,
      source: table.source("block_error"),
      x: {label: "block length (taps)", type: "log"}, y: {label: "error of the mean", type: "log"},
      series: [{name: "", mark: "dots+line", rows: rowsOf(table.axis("block_length"), table.values("block_error"),
                                                          table.values("block_error_error"))}],
    }));
    return [gallery(figures)];
  });
  return section(chapter, "steady", "Steady state",
    "Whether the last taps show a drift, and what they are worth. Values are value(standard error); few realizations make " +
    "errors rough.", made.length > 0 ? overview(chapter, made) : null,
    made.length > 0 ? element("details", {}, element("summary", {}, "Blocking curves"), curves) : null, refusals(chapter, tables));
}
