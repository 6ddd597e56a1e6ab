// A derived table of the results file.

function decoded(value) {
  if (value === null) return NaN;
  if (value === "inf") return Infinity;
  return value === "-inf" ? -Infinity : value;
}

export class Table {
  constructor(stored) {
    this.group = stored.group;
    this.name = stored.name;
    this.notes = stored.notes;
    this.axes = new Map(stored.axes.map((axis) => [axis.name, axis]));
    this.quantities = new Map(stored.quantities.map((quantity) => [quantity.name, quantity]));
    for (const one of [...this.axes.values(), ...this.quantities.values()]) {
      const isText = one.values.some((value) => typeof value === "string" && !/^-?inf$/.test(value));
      if (!isText) one.values = one.values.map(decoded);
    }
    const point = /^point_(\d+)\/(.*)$/.exec(stored.name);
    this.point = point ? Number(point[1]) : null;
    this.path = (point ? point[2] : stored.name).split("/");
  }

  has(name) { return this.quantities.has(name); }
  axis(name) { return this.axes.get(name)?.values ?? []; }
  units(name) { return (this.quantities.get(name) ?? this.axes.get(name))?.units ?? "1"; }
  longName(name) { return (this.quantities.get(name) ?? this.axes.get(name))?.long_name ?? ""; }
  source(name) { return this.quantities.get(name)?.source ?? ""; }

  /// The values of a quantity, as they are stored.
  values(name) { return this.quantities.get(name)?.values ?? []; }
  /// One number.
  value(name, i = 0) { return this.values(name)[i] ?? NaN; }

  /// Values along the last axis, at one place of the first.
  row(name, i) {
    const quantity = this.quantities.get(name);
    if (!quantity) return [];
    if (quantity.axes.length < 2) return quantity.values;
    const length = this.axis(quantity.axes.at(-1)).length;
    return quantity.values.slice(i * length, (i + 1) * length);
  }
}

/// Several of up to `most`, spread evenly, the first and the last among them.
export function spread(list, most) {
  if (list.length <= most) return list;
  return Array.from({length: most}, (_, i) => list[Math.floor(i * (list.length - 1) / (most - 1))]);
}
