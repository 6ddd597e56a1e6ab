// Accuracy against time, target precision, and tables that have no section of their own.
import {dataTable, element, figure, number, pair, section, statement, withError, words} from "../section.js";
import {parts} from "./structure.js";

function front(chapter, table) {
  const names = table.axis("setting");
  const rows = names.map((name, i) => ({label: name, x: table.value("tap_seconds", i),
    y: Math.abs(table.value("bias", i)) + (table.value("bias_error", i) || 0), best: table.value("pareto", i) === 1}))
    .filter((row) => row.x > 0 && row.y > 0);
  if (rows.length === 0) return null;
  const best = rows.filter((row) => row.best).sort((a, b) => a.x - b.x);
  const observable = table.notes.observable ?? table.path.at(-1);
  return figure({
    file: chapter.run.file, title: `Accuracy of ${words(observable)} against time`,
    caption: `|bias| plus its standard error of each setting, against ${table.notes.reference ?? "the most complete"}, and the core time of a late tap. ` +
      "Joined: settings that no other beats in both.",
    x: {label: "core time of a tap (s)", type: "log", short: "time"}, y: {label: "|bias| + error", type: "log"},
    height: 420,
    series: [
      {name: "no other is better and faster", mark: "dots+line", kind: 0, labels: true, rows: best},
      {name: "others", mark: "dots", kind: 1, hollow: true, rows: rows.filter((row) => !row.best)},
    ],
  });
}

function costTable(table) {
  return dataTable(["setting", "part", "bias", "core time of a tap (s)", "core hours of the scene", "best"], table.axis("setting").map((name, i) =>
    [name, table.value("part", i) || "\u2013", withError(table.value("bias", i), table.value("bias_error", i)), number(table.value("tap_seconds", i), 3),
     number(table.value("core_hours", i), 3), table.value("pareto", i) === 1 ? "yes" : ""]), `Settings, ${words(table.notes.observable ?? "")}`);
}

export function costSection(chapter) {
  const tables = chapter.tables.filter((table) => table.group === "analysis" && table.path[0] === "cost");
  return section(chapter, "cost", "Accuracy against time",
    "What settings of the relaxation cost, and what they leave undone.", tables.flatMap((table) =>
      [pair(front(chapter, table)), element("details", {}, element("summary", {}, `All settings, ${words(table.path.at(-1))}`), costTable(table))]));
}

export function precisionSection(chapter) {
  const tables = chapter.tables.filter((table) => table.name === "target_precision");
  return section(chapter, "precision", "Target precision", null, tables.map((table) => statement("Targets", table.notes.verdict)),
    tables.map((table) => dataTable(["observable", "sweep point", "spread", "largest over the taps", "asked for"], table.axis("target").map((_, i) =>
      [words(table.value("observable", i)), chapter.pointLabel(table.value("point", i)), words(table.value("spread", i)),
       number(table.value("value", i)), number(table.value("at_most", i))]), "Targets")));
}

const drawn = {
  fits: () => true,
  analysis: (table) => ["steady", "spectrum", "ageing", "hysteresis", "cost", "sweep", "target_precision", "ordering", "motion", "volumes",
                        "memory"].includes(table.path[0]),
  structure: (table) => table.path[0] in parts,
};

/// Of a later version, or another program.
export function otherSection(chapter) {
  const others = chapter.tables.filter((table) => !drawn[table.group]?.(table));
  return section(chapter, "others", "Other tables", null, others.map((table) => element("details", {},
    element("summary", {}, `${table.group}/${table.name}`),
    dataTable(["quantity", "values"], [...table.quantities.keys()].map((name) =>
      [words(name), table.values(name).slice(0, 50).map((value) => typeof value === "string" ? value : number(value)).join(", ")]), table.name))));
}
