// When beds order, and which sweep point orders them first.
import {dataTable, figure, gallery, number, refusals, section, statement, withError, words} from "../section.js";

function interval(low, high) {
  const end = (value) => Number.isFinite(value) ? number(value) : "no limit";
  return Number.isFinite(low) || Number.isFinite(high) ? ` (${end(low)} to ${end(high)})` : "";
}

function survival(chapter, made, observable) {
  const example = made.find((table) => table.path.at(-1) === observable);
  const one = figure(() => ({
    file: chapter.run.file,
    title: `Not yet ordered, by ${words(observable)}`,
    caption: `Share of the beds that are not yet ordered (${example.notes.rule}), by Kaplan & Meier's estimate; bars are 95 % intervals.`,
    source: example.source("survival"), x: {label: "taps t", type: "tap", short: "tap"},
    y: {label: "share not yet ordered", short: "share"},
    series: chapter.shownPoints().flatMap(({point, label, colour}) => {
      const table = made.find((each) => each.point === point && each.path.at(-1) === observable);
      return table ? [{name: label, colour, mark: "dots+steps", rows: table.axis("tap").map((tap, i) => ({
        x: tap, y: table.value("survival", i), low: table.value("survival_low_95", i), high: table.value("survival_high_95", i)}))}] : [];
    }),
  }));
  chapter.onShown(() => one.update());
  return one;
}

function times(chapter, tables) {
  return dataTable(["observable", "sweep point", "ordered", "half by tap (95 %)", "growth a decade of taps", "law of the times"],
    tables.map((table) => [words(table.path.at(-1)), chapter.pointLabel(table.point), (table.notes.verdict ?? "").replace(/;.*/, ""),
      number(table.value("median_time")) + interval(table.value("median_time_low_95"), table.value("median_time_high_95")),
      withError(table.value("growth_per_decade"), table.value("growth_per_decade_error")), table.notes.law ?? ""]), "Times to order");
}

export function orderingSection(chapter) {
  const tables = chapter.tables.filter((table) => table.group === "analysis" && table.path[0] === "ordering");
  const made = tables.filter((table) => !table.notes.refused);
  const points = made.filter((table) => table.point !== null), over = made.filter((table) => table.point === null);
  const observables = [...new Set(points.map((table) => table.path.at(-1)))];
  return section(chapter, "ordering", "Ordering", "When beds order. Beds that had not when their taps ended count as such, not as if they never would.",
    observables.length > 0 ? gallery(observables.map((observable) => survival(chapter, points, observable))) : null,
    over.flatMap((table) => [statement(`Orders first, by ${words(table.path.at(-1))}`, table.notes.orders_first),
                             statement("Ends highest", table.notes.largest_value),
                             statement("Are they the same", table.notes.verdict)]),
    points.length > 0 ? times(chapter, points) : null, refusals(chapter, tables));
}
