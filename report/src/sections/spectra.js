// Power spectra of steady states, with their slopes.
import {dataTable, figure, gallery, refusals, rowsOf, section, statement, withError, words, number} from "../section.js";

/// The line of the slope, through the geometric mean of what it was fitted to.
function slopeLine(table) {
  const slope = table.value("slope");
  const band = /^([\d.e+-]+) to ([\d.e+-]+) per tap/.exec(table.notes.band ?? "");
  if (!band || !Number.isFinite(slope)) return [];
  const inside = table.axis("frequency").map((f, i) => [Math.log(f), Math.log(table.value("density", i))])
    .filter(([f, p]) => f >= Math.log(Number(band[1]) * 0.99) && f <= Math.log(Number(band[2]) * 1.01) && Number.isFinite(p));
  if (inside.length < 2) return [];
  const [f0, p0] = [0, 1].map((k) => inside.reduce((sum, one) => sum + one[k], 0) / inside.length);
  return [inside[0], inside.at(-1)].map(([f]) => ({x: Math.exp(f), y: Math.exp(p0 + slope * (f - f0))}));
}

export function spectraSection(chapter) {
  const tables = chapter.tables.filter((table) => table.group === "analysis" && table.path[0] === "spectrum");
  const made = tables.filter((table) => !table.notes.refused);
  const observables = [...new Set(made.map((table) => table.path.at(-1)))];
  const figures = observables.map((observable) => {
    const one = figure(() => {
      const shown = chapter.shownPoints().flatMap(({point, label, colour}) => {
        const table = made.find((each) => each.point === point && each.path.at(-1) === observable);
        if (!table) return [];
        const line = slopeLine(table);
        return [{name: label, colour, mark: "dots", rows: rowsOf(table.axis("frequency"), table.values("density"),
                                                                 table.values("density_error"))},
                ...(line.length > 0 ? [{name: "", colour, mark: "line", dash: "5,3", isGuide: true, rows: line}] : [])];
      });
      const example = made.find((table) => table.path.at(-1) === observable);
      return {
        file: chapter.run.file,
        title: `Spectrum of ${words(observable)}`,
        caption: `One-sided power spectral density of taps ${example.notes.taps} (${example.notes.window} window, ` +
          `${example.notes.detrending} removed, ${example.notes.segments}), averaged over realizations; bars are standard errors, dashed ` +
          "lines the log-log slopes.",
        source: example.source("density"),
        x: {label: "frequency (1/taps)", type: "log", short: "f"},
        y: {label: `power density (${example.units("density")})`, type: "log", short: "P"}, series: shown,
      };
    });
    chapter.onShown(() => one.update());
    return one;
  });
  const slopes = made.length === 0 ? null : dataTable(["observable", "sweep point", "slope", "of an AR(1) with this memory", "p", "verdict",
                                                       "drift"],
    made.map((table) => [words(table.path.at(-1)), chapter.pointLabel(table.point), withError(table.value("slope"), table.value("slope_error")),
      withError(table.value("ar1_slope"), table.value("ar1_slope_error")), number(table.value("ar1_slope_p"), 2), table.notes.verdict ?? "",
      table.notes.drift ?? ""]), "Log-log slopes in the band");
  return section(chapter, "spectra", "Spectra", "The frequencies in which an observable fluctuates. Memory alone gives a slope: compare it with that " +
    "of a process with the same autocorrelation time.", figures.length > 0 ? gallery(figures) : null, slopes, refusals(chapter, tables));
}

export {statement};
