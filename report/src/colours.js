// The colours of spheres: viridis, which people with any colour vision can read.

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
