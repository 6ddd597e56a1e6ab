// Colours that people with any colour vision tell apart: Okabe & Ito's for kinds, viridis for an order.

const kindsLight = ["#0072B2", "#D55E00", "#009E73", "#B0578D", "#B07800", "#3A93C4", "#555555", "#7A5195"];
const kindsDark = ["#56B4E9", "#F0803C", "#2CC295", "#E29AC4", "#E6B23C", "#9AD4F5", "#B8B8B8", "#B79BE0"];

const viridisStops = [[68, 1, 84], [72, 40, 120], [62, 74, 137], [49, 104, 142], [38, 130, 142], [31, 158, 137],
                      [53, 183, 121], [110, 206, 88], [181, 222, 43], [253, 231, 37]];

/// RGB, 0 to 255, of a place in 0 .. 1.
export function viridis(share) {
  const place = Math.min(Math.max(share, 0), 1) * (viridisStops.length - 1);
  const i = Math.min(Math.floor(place), viridisStops.length - 2);
  return viridisStops[i].map((from, k) => Math.round(from + (viridisStops[i + 1][k] - from) * (place - i)));
}

export function hex([r, g, b]) {
  return "#" + [r, g, b].map((value) => value.toString(16).padStart(2, "0")).join("");
}

/// Of one kind out of several, in their order.
export function kindColour(i, dark) {
  const kinds = dark ? kindsDark : kindsLight;
  return kinds[i % kinds.length];
}

/// Of the i-th of n that have an order: dark to light, away from the background.
export function orderColour(i, n, dark) {
  const share = n < 2 ? 0.5 : i / (n - 1);
  return hex(viridis(dark ? 0.28 + 0.68 * share : 0.02 + 0.78 * share));
}

export const markers = ["circle", "square", "triangle", "diamond", "star", "cross", "wye"];
