// A kept packing, decoded, and how it may be coloured.
import {hex, viridis} from "../colours.js";
import {number} from "../format.js";

function bytesOf(text) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

/// centres: Float32Array [n, 3], diameters.
export function centresOf(stored) {
  const bytes = bytesOf(stored.position), view = new DataView(bytes.buffer);
  const n = Math.floor(bytes.length / 6), centres = new Float32Array(3 * n);
  for (let i = 0; i < 3 * n; ++i) {
    const low = stored.lower[i % 3], high = stored.upper[i % 3];
    centres[i] = low + (high - low) * view.getUint16(2 * i, true) / 65535;
  }
  return centres;
}

/// Float32Array [n], diameters: of a mixture as stored, else 1/2.
export function radiiOf(stored) {
  const n = stored.spheres, radii = new Float32Array(n).fill(0.5);
  if (!stored.radius) return radii;
  const view = new DataView(bytesOf(stored.radius).buffer);
  for (let i = 0; i < n; ++i) radii[i] = stored.greatest_radius * view.getUint16(2 * i, true) / 65535;
  return radii;
}

/// Kinds of a mixture: colours of Okabe and Ito, which people with any colour vision can distinguish.
const kindColours = [[86, 180, 233], [213, 94, 0], [0, 158, 115], [240, 228, 66], [0, 114, 178], [204, 121, 167], [230, 159, 0]];
const kindColour = (kind) => kindColours[kind % kindColours.length];

const structures = ["disordered", "fcc", "hcp"];
const structureColours = [[150, 156, 164], [0, 114, 178], [213, 94, 0]];

/// The quantities that can colour spheres: values, their range, and the name of a value.
export const colourings = {
  kind: {label: "kind", title: "kind of sphere", names: (packing) => packing.kinds, colour: kindColour, values: (packing) => bytesOf(packing.kind ?? "")},
  radius: {label: "diameter", title: "diameter of the sphere", values: (packing) => radiiOf(packing).map((radius) => 2 * radius),
           range: (packing) => [2 * packing.least_radius, 2 * packing.greatest_radius]},
  coordination: {label: "coordination", title: (packing) => packing.radius ? "centres within 1.05 times the sum of the two radii" : "centres within 1.05 diameters",
                 whole: true, values: (packing) => bytesOf(packing.coordination ?? ""),
                 range: () => [0, 12]},
  structure: {label: "crystalline order", title: "local order by common-neighbour analysis", names: () => structures,
              colour: (value) => structureColours[value] ?? structureColours[0],
              values: (packing) => bytesOf(packing.structure ?? "")},
  q6: {label: "bond order q\u2086", title: "q\u2086 of the 12 nearest neighbours",
       values: (packing) => Float32Array.from(bytesOf(packing.q6 ?? ""), (value) => value / 255), range: () => [0.25, 0.6]},
  local_fraction: {label: "local packing fraction", title: "sphere volume over the volume of its Voronoi cell",
                   values: (packing) => Float32Array.from(bytesOf(packing.local_fraction ?? ""), (value) => value / 255), range: () => [0.4, 0.75]},
  force: {label: "force", title: "sum of the normal forces on a sphere, m g", openEnded: true,
          values: (packing) => Float32Array.from(bytesOf(packing.force ?? ""), (value) => value / 255 * packing.greatest_force),
          range: (packing) => [0, mostForces(packing)]},
  height: {label: "height", title: "height of the centre, diameters", values: (packing, centres) => centres.filter((_, i) => i % 3 === 2),
           range: (packing) => [0, packing.upper[2]]},
};

/// The force that 19 of 20 spheres do not exceed: few spheres bear far more, and would leave all others one colour.
function mostForces(packing) {
  const bytes = bytesOf(packing.force).sort();
  return Math.max(bytes[Math.floor(0.95 * (bytes.length - 1))], 1) / 255 * packing.greatest_force;
}

export function possible(packing) {
  return Object.keys(colourings).filter((name) => name === "height" || packing[name]);
}

/// The title of a colouring of this packing in the key.
export function titleOf(name, packing) {
  const {title} = colourings[name];
  return typeof title === "function" ? title(packing) : title;
}

/// Uint8Array [n, 4].
export function coloursOf(name, packing, values) {
  const one = colourings[name], colours = new Uint8Array(4 * values.length);
  const [low, high] = one.range?.(packing) ?? [0, 1];
  for (let i = 0; i < values.length; ++i) {
    const rgb = one.colour ? one.colour(values[i]) : viridis(high > low ? (values[i] - low) / (high - low) : 0.5);
    colours.set([...rgb, 255], 4 * i);
  }
  return colours;
}

/// The key: names with colours, or a bar.
export function keyOf(name, packing) {
  const one = colourings[name];
  if (one.names) return {names: one.names(packing).map((text, i) => [text, hex(one.colour(i))])};
  const [low, high] = one.range(packing);
  const stops = Array.from({length: 11}, (_, i) => hex(viridis(i / 10)));
  return {bar: `linear-gradient(to right, ${stops.join(",")})`, low: number(low, 3),
          high: one.openEnded ? `${number(high, 3)} and more` : number(high, 3)};
}

/// How many spheres have which value, for those who do not see the picture.
export function tally(name, packing, values, isShown) {
  const one = colourings[name], counts = new Map();
  let total = 0;
  const [low, high] = one.range?.(packing) ?? [0, 1];
  const width = (high - low) / 10, names = one.names?.(packing);
  values.forEach((value, i) => {
    if (!isShown[i]) return;
    ++total;
    const bin = names ? names[value] ?? "?" : one.whole ? value : width > 0 ? Math.min(Math.max(Math.floor((value - low) / width), 0), 9) : 0;
    counts.set(bin, (counts.get(bin) ?? 0) + 1);
  });
  const label = (bin) => typeof bin === "string" ? bin : one.whole ? String(bin)
    : one.openEnded && bin === 9 ? `${number(low + bin * width, 3)} and more`
    : `${number(low + bin * width, 3)} to ${number(low + (bin + 1) * width, 3)}`;
  return {total, rows: [...counts].sort(([a], [b]) => a < b ? -1 : 1).map(([bin, n]) => [label(bin), String(n), `${(100 * n / total).toFixed(1)} %`])};
}

/// The edges of what holds the spheres, as pairs of points.
export function frameOf(kind, upper) {
  const [x, y, z] = upper, points = [];
  if (kind === "cylinder") {
    const at = (k, height) => [x / 2 + x / 2 * Math.cos(k * Math.PI / 24), y / 2 + y / 2 * Math.sin(k * Math.PI / 24), height];
    for (let k = 0; k < 48; ++k) for (const height of [0, z]) points.push(...at(k, height), ...at(k + 1, height));
    for (let k = 0; k < 48; k += 12) points.push(...at(k, 0), ...at(k, z));
    return new Float32Array(points);
  }
  for (const height of [0, z]) points.push(0, 0, height, x, 0, height, x, 0, height, x, y, height, x, y, height, 0, y, height, 0, y, height, 0, 0, height);
  for (const [a, b] of [[0, 0], [x, 0], [0, y], [x, y]]) points.push(a, b, 0, a, b, z);
  return new Float32Array(points);
}
