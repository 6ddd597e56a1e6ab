// The section of the run: its scene, program, machine and progress.
import {section} from "./blocks.js";
import {dataTable, element} from "./dom.js";
import {count, duration, number, words} from "./format.js";

/// A value of a scene in words: {"polar": {"max_step": 0.1}} as "polar (max step 0.1)".
function inWords(value) {
  if (typeof value === "number") return number(value, 6);
  if (value === null || typeof value !== "object") return words(String(value));
  if (Array.isArray(value)) return value.map(inWords).join("; ");
  return Object.entries(value).filter(([, member]) => !Array.isArray(member) || member.length > 0).map(([key, member]) => {
    if (member === null || typeof member !== "object" || Array.isArray(member)) return `${words(key)} ${inWords(member)}`;
    return Object.keys(member).length === 0 ? words(key) : `${words(key)} (${inWords(member)})`;
  }).join(", ");
}

function isOn(part, value) {
  if (value === undefined || value === null) return false;
  if (part === "snapshots") return value.taps !== undefined;
  if (typeof value !== "object") return true;
  return Object.values(value).some((member) => !Array.isArray(member) || member.length > 0);
}

const parts = ["container", "start", "protocol", "engine", "relax", "observe", "snapshots", "motion", "sweep", "until", "fits",
               "analyse", "structure"];

const longest = 500;  // characters of a part in words

/// The scene with the word "swept" in place of every value that the sweep replaces.
function withSwept(scene) {
  const marked = structuredClone(scene);
  const {zip, ...axes} = scene.sweep ?? {};
  for (const pointer of [axes, ...[zip ?? []].flat()].flatMap((axis) => Object.keys(axis))) {
    const keys = pointer.split("/").slice(1).map((key) => key.replaceAll("~1", "/").replaceAll("~0", "~"));
    const holder = keys.slice(0, -1).reduce((value, key) => value?.[key], marked);
    if (holder !== null && typeof holder === "object") holder[keys.at(-1)] = "swept";
  }
  return marked;
}

function effects(stored) {
  const scene = withSwept(stored);
  const on = parts.filter((part) => isOn(part, scene[part]));
  const off = parts.filter((part) => !on.includes(part) && !(["engine", "relax"].includes(part)));
  if (on.length === 0) return null;
  const rows = on.map((part) => {
    const text = inWords(scene[part]);
    return [words(part), text.length > longest ? `${text.slice(0, longest)}\u2026 (whole below)` : text];
  });
  if (off.length > 0) rows.push(["not asked for", off.map(words).join(", ")]);
  return element("div", {}, element("h4", {}, "The scene"), definitions(rows, "effects"));
}

function definitions(rows, kind) {
  return element("dl", {class: kind}, rows.filter(([, value]) => value).map(([term, value]) =>
    element("div", {}, element("dt", {}, term), element("dd", {}, value))));
}

function range(values) {
  const low = Math.min(...values), high = Math.max(...values);
  return low === high ? count(low) : `${count(low)} to ${count(high)}`;
}

export function runSection(chapter) {
  const {run} = chapter;
  const first = run.processes[0] ?? {};
  const tally = run.realizations;
  const states = [[tally.done, "done"], [tally.unfinished, "unfinished"], [tally.failed, "failed"], [tally.missing, "missing"]]
    .filter(([n]) => n > 0).map(([n, word]) => `${count(n)} ${word}`).join(", ");
  const stateText = {complete: "complete", interrupted: "interrupted: the run is not finished", running: "running"}[run.state];
  const facts = definitions([
    ["state", run.shard.count > 1 ? `${stateText}; share ${run.shard.index} of ${run.shard.count}` : stateText],
    ["bed", run.points[0]?.bed ?? ""],
    ["taps", range(run.points.map((point) => point.taps))],
    ["sweep points", count(run.n_points)],
    ["realizations", `${count(run.realizations_a_point)} per sweep point: ${states}`],
    // Work of different engines does not add up.
    ["cost", `${run.unit ? `${count(tally.units)} ${run.unit}, ` : ""}${duration(tally.seconds)} of one core`],
    ["seed", run.points[0]?.seed ?? ""],
    ["version", first.version ? `jostle ${first.version}, revision ${first.git_revision}` : ""],
    ["digest", run.digest ? element("code", {class: "digest"}, run.digest) : "not known: the run is not finished"],
  ], "facts");
  const failures = run.failures.length === 0 ? null : element("div", {class: "failures"},
    element("h4", {}, "Realizations that failed"),
    dataTable(["sweep point", "realization", "seed", "reason"], run.failures.map((one) =>
      [chapter.pointLabel(one.point), String(one.realization), one.seed, one.reason]), "Failed realizations"));
  const points = run.points.length < 2 ? null : element("details", {},
    element("summary", {}, "Sweep points"),
    dataTable(["sweep point", "spheres", "taps", "done", "failed", run.unit || "work", "core time"], run.points.map((point) =>
      [chapter.pointLabel(point.number), count(point.spheres), count(point.taps), count(point.realizations.done),
       count(point.realizations.failed), `${count(point.realizations.units)}${run.unit ? "" : ` ${point.unit}`}`, duration(point.realizations.seconds)]), "Sweep points"));
  const processes = element("details", {}, element("summary", {}, "Processes that worked on the file"),
    dataTable(["started", "host", "processor", "threads", "version", "command"], run.processes.map((one) =>
      [one.started, one.host, `${one.cpu} (${one.instruction_set})`, one.threads, `${one.version} (${one.git_revision})`,
       one.command_line]), "Processes"));
  const scene = element("details", {}, element("summary", {}, "The scene, with every default"),
    element("pre", {tabindex: 0}, JSON.stringify(run.scene, null, 2)));
  return section(chapter, "run", "The run", null, facts, effects(run.scene), failures, points, processes, scene);
}

/// The list of what the page leaves out.
export function leftOut(chapter) {
  if (chapter.run.left_out.length === 0) return null;
  return element("aside", {class: "left-out"}, element("strong", {}, "Thinned for this page: "),
    `${chapter.run.left_out.join("; ")}. The results file has everything.`);
}
