// What was measured inside the kept packings.
import {byPoint, dataTable, element, figure, gallery, number, ordered, pair, pointsOf, refusals, rowsOf, scalarTable, section, statement, withError,
        words} from "../section.js";
import {spread} from "../table.js";
import {snapshotSection} from "./curves.js";

const mostTaps = 6;

/// A curve of a part at several taps: what is drawn, over what, on which axes.
export const parts = {
  profile: {
    title: "Density profile",
    plots: [
      {y: "phi", x: "height", title: "Packing fraction by height", xLabel: "height z (diameters)", yLabel: "packing fraction \u03a6(z)"},
      {y: "phi_smoothed", x: "height", title: "Packing fraction by height, smoothed", xLabel: "height z (diameters)",
       yLabel: "packing fraction \u03a6(z), smoothed"},
    ],
    scalars: ["alpha", "phi_region", "eq7_phi_0", "eq7_alpha", "eq7_beta", "eq7_z_star", "eq7_status"],
  },
  sides: {
    title: "Across the bed",
    plots: [
      {y: "phi_xy", x: "x", title: "Packing fraction across the bed", xLabel: "x and y (diameters)", yLabel: "packing fraction \u03a6"},
      {y: "phi_wall", x: "wall_distance", title: "Packing fraction by distance from the walls", xLabel: "distance from the nearest wall (diameters)",
       yLabel: "packing fraction \u03a6"},
      {y: "phi_radial", x: "radius", title: "Packing fraction by distance from the axis", xLabel: "distance from the axis (diameters)",
       yLabel: "packing fraction \u03a6"},
    ],
    scalars: ["lateral", "lateral_change", "central", "central_change"],
  },
  layers: {
    title: "Layers",
    plots: [
      {y: "n", x: "height", title: "Centres by height, n(z)", xLabel: "height z (diameters)", yLabel: "fraction of centres in a bin", zero: true},
      {y: "share", x: "layer_height", title: "How sharp the layers are", xLabel: "height of the hcp layer (diameters)",
       yLabel: "share of the layer's centres in place", zero: true, mark: "dots+line"},
      {y: "filling", x: "layer_height", title: "How full the layers are", xLabel: "height of the hcp layer (diameters)",
       yLabel: "filling of the layer", zero: true, mark: "dots+line"},
    ],
    scalars: ["grown_layers"],
  },
  coordination: {
    title: "Coordination",
    plots: [
      {y: "neighbour_share", x: "neighbours", title: "Number of neighbours", xLabel: "neighbours within the cut", yLabel: "share of spheres",
       zero: true, mark: "dots+line"},
      {y: "n_c_of_cut", x: "cut", title: "Coordination by cut", xLabel: "cut (diameters)", yLabel: "mean coordination N_c"},
    ],
    scalars: ["n_c", "n_c_all", "normal_mean", "normal_width"],
  },
  pair_correlation: {
    title: "Pair correlation",
    plots: [{y: "g", x: "r", title: "Pair correlation g(r)", xLabel: "distance r (diameters)", yLabel: "g(r)", rule: 1, zero: true}],
    scalars: [],
  },
  order: {
    title: "Order",
    plots: [
      {y: "q6_at_height", x: "height", title: "Bond order by height", xLabel: "height z (diameters)", yLabel: "mean q\u2086"},
      {y: "fcc_at_height", x: "height", title: "Fcc surroundings by height", xLabel: "height z (diameters)", yLabel: "share of spheres", zero: true},
      {y: "hcp_at_height", x: "height", title: "Hcp surroundings by height", xLabel: "height z (diameters)", yLabel: "share of spheres", zero: true},
    ],
    trends: [["fcc", "hcp"], ["q6"]],
    scalars: ["fcc", "hcp", "disordered", "q4", "q6", "w6"],
  },
  voronoi: {
    title: "Voronoi cells",
    plots: [
      {y: "free_volume_density", x: "free_volume", title: "Free volumes", xLabel: "free volume (sphere volumes)", yLabel: "probability density",
       log: true, mark: "dots"},
      {y: "local_fraction_density", x: "local_fraction", title: "Local packing fractions", xLabel: "sphere volume / cell volume",
       yLabel: "probability density"},
      {y: "face_share", x: "faces", title: "Faces of the cells", xLabel: "faces", yLabel: "share of cells", zero: true, mark: "dots+line"},
    ],
    scalars: ["mean_faces", "mean_free_volume", "mean_local_fraction", "k", "k_gamma_k", "k_gamma_status"],
  },
  pores: {
    title: "Pores",
    plots: [
      {y: "rho_v", x: "xi", title: "Pores by volume", xLabel: "pore volume v = \u03be\u00b3 (sphere volumes)", yLabel: "\u03c1_v", log: true,
       mark: "dots", xOf: (xi) => xi ** 3},
      {y: "rho_xi", x: "xi", title: "Pores by radius", xLabel: "pore radius \u03be = r/R", yLabel: "\u03c1(\u03be)", zero: true},
      {y: "v_rho_v", x: "xi", title: "Pores by logarithm of volume", xLabel: "pore volume v = \u03be\u00b3 (sphere volumes)", yLabel: "v \u03c1_v", logX: true,
       xOf: (xi) => xi ** 3, zero: true},
    ],
    scalars: ["n_pores", "nu", "tetrahedral", "octahedral", "mean_touched", "tail_v0", "tail_status"],
  },
  void_probability: {
    title: "Void probability",
    plots: [{y: "p0", x: "sigma", title: "Void probability", xLabel: "radius of the random sphere (R)", yLabel: "P\u2080", log: true, beside: "p0_gotoh",
             besideName: "Gotoh, Percus-Yevick fluid"}],
    scalars: ["phi"],
  },
  holes: {title: "Bernal's holes", plots: [], scalars: ["unclassified"]},
  gaps: {
    title: "Gaps and contacts",
    plots: [
      {y: "z_of_gap", x: "gap", title: "Contacts by gap", xLabel: "gap that counts as a contact (diameters)", yLabel: "mean number of contacts",
       logX: true, mark: "dots+line"},
      {y: "rattlers_of_gap", x: "gap", title: "Rattlers by gap", xLabel: "gap that counts as a contact (diameters)", yLabel: "share of rattlers",
       logX: true, zero: true, mark: "dots+line"},
    ],
    trends: [["contacts", "backbone_contacts"], ["rattlers"]],
    scalars: ["contacts", "backbone_contacts", "rattlers", "gap_exponent"],
  },
  structure_factor: {
    title: "Structure factor",
    plots: [{y: "s", x: "k", title: "Structure factor S(k)", xLabel: "wave number k (1/diameters)", yLabel: "S(k)", log: true, mark: "dots+line"}],
    trends: [["s_0_of_line", "s_0_of_squares"]],
    scalars: ["s_0_of_line", "s_0_of_squares"],
  },
  clusters: {
    title: "Clusters of Voronoi cells",
    plots: [
      {y: "relative_variance", x: "cells", title: "Variance of clusters of cells", xLabel: "cells of a cluster",
       yLabel: "variance a cell over that of single cells", logX: true, log: true, mark: "dots+line"},
      {y: "chi", x: "cells", title: "Compactivity of clusters of cells", xLabel: "cells of a cluster", yLabel: "\u03c7 (sphere volumes)", logX: true,
       mark: "dots+line"},
    ],
    trends: [["mean_volume"]],
    scalars: ["mean_volume"],
  },
};

function tapPlaces(table) {
  return spread(table.axis("tap").map((_, i) => i), mostTaps);
}

function partFigure(chapter, table, plot) {
  if (!table.has(plot.y) || !table.axes.has(plot.x)) return null;
  const places = tapPlaces(table), taps = table.axis("tap");
  const xs = table.axis(plot.x).map((x) => plot.xOf ? plot.xOf(x) : x);
  const rowsAt = (name, i) => rowsOf(xs, table.row(name, i), table.row(`${name}_error`, i)).filter((row) => Number.isFinite(row.y) &&
    (!plot.log || row.y > 0));
  const lines = places.map((i, k) => ({
    name: `tap ${taps[i]}`, colour: ordered(k, places.length), mark: plot.mark ?? "line", rows: rowsAt(plot.y, i),
  })).filter((one) => one.rows.length > 0);
  if (lines.length === 0) return null;
  if (plot.beside && table.has(plot.beside)) {
    places.forEach((i, k) => lines.push({name: k === 0 ? plot.besideName : "", colour: ordered(k, places.length), dash: "4,3", width: 1.2, band: false,
                                         mark: "line", rows: rowsOf(xs, table.row(plot.beside, i)).filter((row) => row.y > 0)}));
  }
  const source = table.source(plot.y);
  return figure({
    file: chapter.run.file,
    title: plot.title,
    caption: `${sentence(table.longName(plot.y))}; means over realizations at some of the kept taps, with their standard errors.`,
    source: source === "jostle" ? "" : source,
    x: {label: plot.xLabel, type: plot.logX ? "log" : "linear"}, y: {label: plot.yLabel, type: plot.log ? "log" : "linear", zero: plot.zero},
    rules: plot.rule ? [{y: plot.rule}] : [], series: lines,
  });
}

function sentence(text) {
  return text ? text[0].toUpperCase() + text.slice(1) : "Values";
}

function holesContent(chapter, table) {
  const names = table.axis("hole"), places = tapPlaces(table), taps = table.axis("tap");
  const one = (quantity, title) => table.has(quantity) ? figure({
    file: chapter.run.file, title,
    caption: `${sentence(table.longName(quantity))}; means over realizations with standard errors, beside the published share.`,
    source: table.source(quantity) || "Philippe & Bideau 2001, table I",
    x: {label: "Bernal's canonical holes", type: "names", rotate: -22, names: names.map(words)},
    y: {label: "share", zero: true}, marginBottom: 84,
    series: [...places.map((i, k) => ({
      name: `tap ${taps[i]}`, colour: ordered(k, places.length), mark: "dots",
      rows: names.map((name, j) => ({x: j + (k - (places.length - 1) / 2) * 0.09, label: words(name), y: table.row(quantity, i)[j],
                                     error: table.row(`${quantity}_error`, i)[j]})),
    })), {name: "published", ink: true, mark: "dots", symbol: "star", hollow: true,
          rows: names.map((name, j) => ({x: j + 0.34, label: words(name), y: table.row(`${quantity}_published`, 0)[j]}))}],
  }) : null;
  return [pair(one("number_fraction", "Holes by number"), one("volume_fraction", "Holes by volume"))];
}

/// Numbers of a packing against the tap, where there are several taps.
function trends(chapter, table, names) {
  const taps = table.axis("tap");
  if (taps.length < 3) return [];
  const isCurve = (name) => table.has(name) && table.values(name).every((value) => typeof value === "number") &&
    table.values(name).some((value) => Number.isFinite(value) && value !== 0);
  return names.map((group) => group.filter(isCurve)).filter((group) => group.length > 0).slice(0, 2).map((group) => figure({
    file: chapter.run.file, title: `${sentence(group.map(words).join(" and "))} by tap`,
    caption: `${group.map((name) => sentence(table.longName(name))).join("; ")}; means over realizations with standard errors.`,
    source: table.source(group[0]) === "jostle" ? "" : table.source(group[0]),
    x: {label: "taps t", type: "tap", short: "tap"},
    y: {label: group.map(words).join(", ") + (table.units(group[0]) === "1" ? "" : ` (${table.units(group[0])})`)},
    series: group.map((name) => ({name: words(name), mark: "dots+line", rows: rowsOf(taps, table.values(name), table.values(`${name}_error`))})),
  }));
}

function partContent(chapter, table) {
  const part = parts[table.path[0]];
  const figures = part.plots.map((plot) => partFigure(chapter, table, plot)).filter(Boolean);
  const drawn = [...figures, ...trends(chapter, table, part.trends ?? part.scalars.map((name) => [name]))];
  const rows = [];
  if (table.path[0] === "holes") rows.push(...holesContent(chapter, table));
  if (drawn.length > 0) rows.push(gallery(drawn));
  const numbers = scalarTable(table, part.scalars, part.title);
  if (numbers) rows.push(element("details", {}, element("summary", {}, "Numbers by tap"), numbers));
  rows.push(element("p", {class: "small"}, table.notes.region ? `Counted ${table.notes.region}.` : ""));
  return rows;
}

/// n(z) of snapshots, where no structure was measured.
function heightFigure(chapter, point) {
  const kept = chapter.run.snapshots.find((one) => one.point === point);
  if (!kept || kept.heights.length === 0) return null;
  return figure({
    file: chapter.run.file, title: "Centres by height, n(z)",
    caption: `Fraction of all centres in a bin of height, ${number(kept.bin_width)} diameters, means over realizations, at some of the kept taps.`,
    source: "Rosato et al. 2010, fig. 6",
    x: {label: "height z (diameters)"}, y: {label: "fraction of centres in a bin", zero: true},
    series: kept.heights.map((one, k) => ({
      name: `tap ${one.tap}`, colour: ordered(k, kept.heights.length), mark: "line", width: 1.4,
      rows: rowsOf(one.n.map((_, i) => Number(((i + 0.5) * kept.bin_width).toPrecision(6))), one.n),
    })),
  });
}

export function structureSections(chapter) {
  const tables = chapter.tables.filter((table) => table.group === "structure" && parts[table.path[0]]);
  const made = tables.filter((table) => !table.notes.refused);
  const coordination = snapshotSection(chapter);
  const heights = pointsOf(chapter.run.snapshots.filter((one) => one.heights.length > 0));
  const hasLayers = made.some((table) => table.path[0] === "layers");
  const snapshots = section(chapter, "snapshots", "Kept packings",
    "Means over the packings that the run kept.", coordination ? pair(coordination) : null,
    heights.length > 0 && !hasLayers ? byPoint(chapter, heights, (point) => [pair(heightFigure(chapter, point))]) : null);
  const sections = Object.keys(parts).map((name) => {
    const own = tables.filter((table) => table.path[0] === name);
    const ownMade = own.filter((table) => !table.notes.refused);
    return section(chapter, name, parts[name].title, null,
      ownMade.length > 0 ? byPoint(chapter, pointsOf(ownMade), (point) => partContent(chapter, ownMade.find((table) => table.point === point)))
        : null, refusals(chapter, own));
  });
  return [snapshots, ...sections];
}

export {dataTable, number, statement, withError};
