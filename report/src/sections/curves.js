// Series of the taps: compaction, spread, what the engine records.
import {figure, gallery, section, rowsOf, words} from "../section.js";
import {axisLabel} from "../format.js";

/// Logarithmic for a protocol of one strength, which relaxes; even where the strength changes on the way.
function tapAxisOf(chapter) {
  return {label: "taps t", type: chapter.changesStrength ? "linear" : "tap", short: "tap"};
}

const zeroText = "Tap 0 is the starting packing.";

/// A figure of one column at the sweep points that are switched on.
function columnFigure(chapter, name, spec) {
  const example = chapter.column(name);
  const made = figure(() => ({
    file: chapter.run.file,
    x: tapAxisOf(chapter),
    y: {label: axisLabel(name, example.units), short: words(name)},
    ...spec(example),
    series: chapter.shownCurves().map(({curve, label, colour}) => {
      const column = curve.columns.find((one) => one.name === name);
      return {name: label, colour, rows: column ? spec(example).rows(curve, column) : []};
    }),
  }));
  chapter.onShown(() => made.update());
  return made;
}

function bars(chapter) {
  return chapter.run.realizations_a_point > 1 ? "the band is the standard error of the mean over realizations"
    : "of one realization, without an error";
}

function sentence(text) {
  return text ? text[0].toUpperCase() + text.slice(1) : "";
}

function meanFigure(chapter, name, title) {
  return columnFigure(chapter, name, (column) => ({
    title: title ?? sentence(words(name)),
    caption: `${sentence(column.long_name || words(name))}, against the number of taps; ${bars(chapter)}. ` +
      zeroText,
    source: column.source === "jostle" ? "" : column.source,
    rows: (curve, own) => rowsOf(curve.taps, own.mean, own.error),
  }));
}

function namesOf(chapter, wanted) {
  const names = [];
  for (const curve of chapter.run.curves) {
    for (const column of curve.columns) {
      if (wanted(column) && !names.includes(column.name) && column.mean.some(Number.isFinite)) names.push(column.name);
    }
  }
  return names;
}

export function compactionSection(chapter) {
  const names = namesOf(chapter, (column) => column.kind === "observable");
  return section(chapter, "compaction", "Compaction",
    "How the bed changes from tap to tap, as means over realizations.", gallery(names.map((name) => meanFigure(chapter, name))));
}

export function spreadSection(chapter) {
  if (chapter.run.realizations_a_point < 2) return null;
  const names = namesOf(chapter, (column) => column.kind === "observable" && column.sigma.some((value) => value > 0));
  const figures = names.map((name) => columnFigure(chapter, name, (column) => ({
    title: `Spread of ${words(name)}`,
    caption: `Standard deviation of ${words(name)} over realizations at each tap (population deviation, 1/M). It tells how ` +
      "far single packings lie apart; the error of the mean is \u03c3/\u221a(M\u22121).",
    source: "Rosato et al. 2010",
    y: {label: `\u03c3 of ${words(name)}${column.units === "1" ? "" : ` (${column.units})`}`, zero: true, short: "\u03c3"},
    rows: (curve, own) => rowsOf(curve.taps, own.sigma),
  })));
  return section(chapter, "spread", "Spread over realizations", null, gallery(figures));
}

const energies = /energy|ledger|overlap|contacts|seconds|rest|spin/;

export function engineSection(chapter) {
  const isGrains = chapter.run.points.some((point) => point.unit !== "trials");
  const names = namesOf(chapter, (column) => column.kind === "engine" && !["count", "share"].includes(column.shown) &&
    column.mean.some((value) => value !== 0 && Number.isFinite(value)));
  if (names.length === 0) return null;
  const figures = names.map((name) => meanFigure(chapter, name));
  const title = isGrains ? "Grains: energies and contacts" : "Relaxation";
  const intro = isGrains
    ? "What the integration of the grains recorded of each tap. Energies are in m g d a sphere."
    : "What the relaxation after each tap took.";
  return section(chapter, isGrains && names.some((name) => energies.test(name)) ? "grains" : "relaxation", title, intro,
    gallery(figures));
}

/// Means of what snapshots keep.
export function snapshotSection(chapter) {
  const kept = chapter.run.snapshots;
  const withCoordination = kept.filter((one) => one.coordination.some(Number.isFinite));
  const coordination = withCoordination.length === 0 ? null : figure(() => ({
    file: chapter.run.file,
    title: "Coordination of the kept packings",
    caption: "Mean number of centres within the contact cut of a centre, all spheres, at the taps of the snapshots; " +
      "bars are standard errors over realizations.",
    x: tapAxisOf(chapter), y: {label: "mean coordination N_c", short: "N_c"},
    series: chapter.shownPoints().filter(({point}) => withCoordination.some((one) => one.point === point))
      .map(({point, label, colour}) => {
        const one = withCoordination.find((each) => each.point === point);
        return {name: label, colour, mark: "dots+line", rows: rowsOf(one.taps, one.coordination, one.coordination_error)};
      }),
  }));
  if (coordination) chapter.onShown(() => coordination.update());
  return coordination;
}
