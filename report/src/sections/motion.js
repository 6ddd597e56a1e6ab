// How far spheres move while the bed is tapped.
import {byPoint, figure, gallery, number, ordered, pointsOf, refusals, section, statement} from "../section.js";

/// A curve of every waiting time against the lag, of the quantity's rows at `place` of a third axis.
function byAge(table, name, {low, high, error, length = 1, place = 0}) {
  const ages = table.axis("waiting_time"), lags = table.axis("lag");
  return ages.map((age, k) => {
    const at = (quantity, j) => quantity ? table.value(quantity, (k * lags.length + j) * length + place) : NaN;
    return {name: `t_W = ${age}`, colour: ordered(k, ages.length), mark: "dots+line",
            rows: lags.map((lag, j) => ({x: lag, y: at(name, j), error: at(error, j), low: at(low, j), high: at(high, j)}))
              .filter((row) => Number.isFinite(row.y))};
  }).filter((one) => one.rows.length > 0);
}

const lagAxis = {label: "lag t (taps)", type: "log", short: "lag"};

function squares(chapter, table, name, title, what) {
  return figure({
    file: chapter.run.file, title,
    caption: `${what} in a lag t from the waiting time t_W on, mean over spheres and realizations; bars are standard errors.`,
    source: table.source(name), x: lagAxis, y: {label: `mean square (${table.units(name)})`, type: "log", short: "MSD"},
    series: byAge(table, name, {error: `${name}_error`}),
  });
}

/// Where the susceptibility is greatest, of the overlap lengths.
function greatestLength(table, name) {
  const n = table.axis("overlap_length").length;
  let best = -1;
  table.values(name).forEach((value, i) => { if (Number.isFinite(value) && !(value <= table.value(name, best))) best = i; });
  return best < 0 ? 0 : best % n;
}

function susceptibility(chapter, table) {
  const name = "lateral_chi_4", lengths = table.axis("overlap_length"), place = greatestLength(table, name);
  return figure({
    file: chapter.run.file, title: "Spheres that move together",
    caption: `\u03c7\u2084, the variance over realizations of the share of spheres that moved sideways by less than ${number(lengths[place])} d, ` +
      "times their number, at the overlap length where it is greatest; bars are 68 % intervals, left out where few spheres have moved.",
    source: table.source(name), x: lagAxis, y: {label: "\u03c7\u2084", short: "\u03c7\u2084"},
    series: byAge(table, name, {low: `${name}_low_68`, high: `${name}_high_68`, length: lengths.length, place}),
  });
}

/// At the longest lag that every waiting time has.
function byHeight(chapter, table) {
  const name = "msd_lateral", ages = table.axis("waiting_time"), lags = table.axis("lag"), n = table.axis("layer").length;
  const place = (k, j, l) => (k * lags.length + j) * n + l;
  const longest = lags.findLastIndex((_, j) => ages.every((__, k) => Number.isFinite(table.value(name, place(k, j, 0)))));
  if (longest < 0) return null;
  return figure({
    file: chapter.run.file, title: "Lateral motion by height",
    caption: `Mean square of the lateral displacement in ${lags[longest]} taps, of layers of as many spheres each, against their ` +
      "mean height; bars are standard errors.",
    source: table.source(name), x: {label: "height (diameter)"},
    y: {label: `mean square (${table.units(name)})`, short: "MSD", type: "log"},
    series: ages.map((age, k) => ({name: `t_W = ${age}`, colour: ordered(k, ages.length), mark: "dots+line",
      rows: table.axis("layer").map((_, l) => ({x: table.value("height", place(k, longest, l)), y: table.value(name, place(k, longest, l)),
                                                error: table.value(`${name}_error`, place(k, longest, l))}))})),
  });
}

export function motionSection(chapter) {
  const tables = chapter.tables.filter((table) => table.group === "analysis" && table.path[0] === "motion");
  const made = tables.filter((table) => !table.notes.refused);
  const content = made.length === 0 ? null : byPoint(chapter, pointsOf(made), (point) => {
    const [displacement, overlap, layers] = ["displacement", "overlap", "layers"].map((name) =>
      made.find((table) => table.point === point && table.path[1] === name));
    const figures = [
      displacement && squares(chapter, displacement, "msd_lateral", "Lateral motion", "Square of the lateral displacement"),
      displacement && squares(chapter, displacement, "msd_z_about_mean", "Vertical motion about the settling",
                              "Square of the vertical displacement less its mean over the bed,"),
      layers && byHeight(chapter, layers), overlap && susceptibility(chapter, overlap)].filter(Boolean);
    return [gallery(figures), statement("With age", displacement?.notes.age),
            statement("Through periodic sides", displacement?.notes.unwrapping)].filter(Boolean);
  });
  return section(chapter, "motion", "Motion", "How far spheres move in a lag t, counted from the waiting time t_W.", content,
    refusals(chapter, tables));
}
