// A kept packing to turn, slice and colour.
import {chooser, dataTable, element, save} from "../dom.js";
import {count, fileName, number, plural} from "../format.js";
import {centresOf, colourings, coloursOf, frameOf, keyOf, possible, radiiOf, tally, titleOf} from "./packing.js";
import {View} from "./view.js";
import {isDark, onTheme} from "../theme.js";

class PackingPanel {
  constructor(chapter) {
    this.chapter = chapter;
    this.packings = chapter.run.packings;
    this.point = this.packings[0].point;
    this.realization = this.packings[0].realization;
    this.index = this.taps().length - 1;
    this.colouring = this.wanted = possible(this.packings[0])[0];
    this.slices = {z: [0, 1], x: [0, 1], y: [0, 1]};
    this.canvas = element("canvas", {class: "packing", tabindex: 0, role: "img"});
    this.status = element("p", {class: "packing-status", "aria-live": "polite"});
    this.key = element("div", {class: "key"});
    this.controls = element("div", {class: "controls"});
    this.table = element("details", {class: "values", ontoggle: () => this.fillTable()}, element("summary", {}, "Values as a table"));
    this.node = element("div", {class: "packing-panel"},
      element("div", {class: "stage"}, this.canvas, this.key, this.status), this.controls, this.table);
    this.buildControls();
    this.listen();
    new IntersectionObserver((entries, watcher) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      watcher.disconnect();
      this.start();
    }, {rootMargin: "200px"}).observe(this.canvas);
    onTheme(() => { if (this.view) this.paint(); });
    addEventListener("beforeprint", () => this.view ? this.view.draw() : this.start());
  }

  series() {
    return this.packings.filter((one) => one.point === this.point && one.realization === this.realization);
  }
  /// The quantities that can colour any packing. A packing without the chosen one shows its first.
  choices() {
    return Object.keys(colourings).filter((name) => this.packings.some((one) => possible(one).includes(name)));
  }
  taps() { return this.series().map((one) => one.tap); }
  packing() { return this.series()[this.index]; }

  start() {
    if (this.centres) return;
    try {
      this.view = new View(this.canvas);
    } catch (error) {
      this.canvas.replaceWith(element("p", {class: "statement"}, `The packing cannot be drawn: ${error.message}. The table below says what is in it.`));
      this.view = null;
    }
    new ResizeObserver(() => this.view?.draw()).observe(this.canvas);
    this.choose();
  }

  /// Menus of what there is; the slider over taps.
  buildControls() {
    const points = [...new Set(this.packings.map((one) => one.point))];
    const realizations = [...new Set(this.packings.filter((one) => one.point === this.point).map((one) => one.realization))];
    if (!realizations.includes(this.realization)) this.realization = realizations[0];
    const taps = this.taps();
    this.index = Math.min(this.index, taps.length - 1);
    this.tapText = element("output", {});
    const slider = element("input", {type: "range", min: 0, max: taps.length - 1, value: this.index, step: 1, class: "tap-slider",
                                     oninput: () => { this.index = Number(slider.value); this.choose(); }});
    this.slider = slider;
    this.controls.replaceChildren(
      points.length > 1 ? chooser("Sweep point", points.map((point) => [point, this.chapter.pointLabel(point)]), this.point, (value) => {
        this.point = Number(value);
        this.buildControls();
        this.choose();
      }) : "",
      realizations.length > 1 ? chooser("Realization", realizations.map((one) => [one, String(one)]), this.realization, (value) => {
        this.realization = Number(value);
        this.buildControls();
        this.choose();
      }) : "",
      taps.length > 1 ? element("label", {class: "chooser wide"}, element("span", {}, "Tap"), slider, this.tapText) : this.tapText,
      chooser("Colour by", this.choices().map((name) => [name, colourings[name].label]), this.wanted, (value) => {
        this.wanted = value;
        this.choose();
      }),
      this.slice("z", "height"), this.slice("x", "x"), this.slice("y", "y"),
      element("div", {class: "actions"},
        element("button", {type: "button", onclick: () => { this.slices = {z: [0, 1], x: [0, 1], y: [0, 1]}; this.view?.reset(); this.buildControls(); this.paint(); }}, "Reset view"),
        element("button", {type: "button", onclick: () => this.save()}, "Save PNG")));
  }

  /// Two sliders: from and to, as shares of the box.
  slice(axis, label) {
    const ends = [0, 1].map((end) => {
      const input = element("input", {type: "range", min: 0, max: 1, step: 0.005, value: this.slices[axis][end],
                                      "aria-label": `${label}: ${end === 0 ? "from" : "to"}`, "data-slice": `${axis}${end}`,
                                      oninput: () => { this.slices[axis][end] = Number(input.value); this.paint(); }});
      return input;
    });
    return element("div", {class: "chooser slice"}, element("span", {}, `Slice ${label}`), ...ends);
  }

  listen() {
    const pointers = new Map();
    let apart = 0;
    const distance = () => {
      const [a, b] = [...pointers.values()];
      return Math.hypot(a.x - b.x, a.y - b.y);
    };
    this.canvas.addEventListener("pointerdown", (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
      if (pointers.size === 2) apart = distance();
    });
    this.canvas.addEventListener("pointermove", (event) => {
      const last = pointers.get(event.pointerId);
      if (!last) return;
      pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
      if (pointers.size === 2) {
        this.view?.magnify(distance() / Math.max(apart, 1));
        apart = distance();
      } else {
        this.view?.turn((event.clientX - last.x) * 0.01, (event.clientY - last.y) * 0.01);
      }
    });
    for (const end of ["pointerup", "pointercancel"]) this.canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
    this.canvas.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && document.activeElement !== this.canvas) return;  // the page scrolls
      event.preventDefault();
      this.view?.magnify(Math.exp(-event.deltaY * 0.0015));
    }, {passive: false});
    const keys = {ArrowLeft: [-0.12, 0], ArrowRight: [0.12, 0], ArrowUp: [0, -0.12], ArrowDown: [0, 0.12]};
    this.canvas.addEventListener("keydown", (event) => {
      if (keys[event.key]) this.view?.turn(...keys[event.key]);
      else if (event.key === "+" || event.key === "=") this.view?.magnify(1.15);
      else if (event.key === "-") this.view?.magnify(1 / 1.15);
      else return;
      event.preventDefault();
    });
  }

  /// Another packing.
  choose() {
    const packing = this.packing();
    this.centres = centresOf(packing);
    this.radii = radiiOf(packing);
    this.tapText.textContent = `tap ${packing.tap}`;
    this.slider.setAttribute("aria-valuetext", `tap ${packing.tap}`);
    this.colouring = possible(packing).includes(this.wanted) ? this.wanted : possible(packing)[0];
    this.paint();
  }

  shownSpheres() {
    const {upper} = this.packing(), n = this.centres.length / 3, shown = new Uint8Array(n);
    const limits = ["x", "y", "z"].map((axis, k) => this.slices[axis].map((share) => share * upper[k]));
    for (let i = 0; i < n; ++i) {
      shown[i] = [0, 1, 2].every((k) => this.centres[3 * i + k] >= limits[k][0] - 1e-3 && this.centres[3 * i + k] <= limits[k][1] + 1e-3) ? 1 : 0;
    }
    return shown;
  }

  paint() {
    const packing = this.packing();
    const values = colourings[this.colouring].values(packing, this.centres);
    const colours = coloursOf(this.colouring, packing, values), shown = this.shownSpheres();
    const kept = [];
    shown.forEach((is, i) => { if (is) kept.push(i); });
    const centres = new Float32Array(3 * kept.length), tints = new Uint8Array(4 * kept.length);
    const radii = Float32Array.from(kept, (i) => this.radii[i]);
    kept.forEach((i, k) => {
      centres.set(this.centres.subarray(3 * i, 3 * i + 3), 3 * k);
      tints.set(colours.subarray(4 * i, 4 * i + 4), 4 * k);
    });
    const dark = isDark();
    if (this.view) {
      this.view.background = dark ? [0.082, 0.094, 0.11] : [1, 1, 1];
      this.view.ink = dark ? [0.5, 0.53, 0.57] : [0.45, 0.45, 0.45];
      const point = this.chapter.run.points.find((one) => one.number === packing.point);
      this.view.show({centres, radii, colours: tints, lines: frameOf(point?.container.kind, packing.upper), size: packing.upper});
    }
    this.describe(packing, kept.length);
    this.values = {packing, values, shown};
    this.fillTable();
  }

  describe(packing, n) {
    const colouring = colourings[this.colouring];
    const text = `${n < packing.spheres ? `${count(n)} of ` : ""}${plural(packing.spheres, "sphere")}; ${this.chapter.run.n_points > 1 ? `${this.chapter.pointLabel(packing.point)}, ` : ""}` +
      `realization ${packing.realization}, tap ${packing.tap}; ${number(packing.upper[2], 3)} diameters high`;
    this.status.textContent = text;
    this.canvas.setAttribute("aria-label", `Packing of ${text}, coloured by ${colouring.label}. Arrow keys turn it, plus and minus magnify it.`);
    const key = keyOf(this.colouring, packing);
    this.key.replaceChildren(element("span", {class: "key-title"}, titleOf(this.colouring, packing)),
      key.names ? element("span", {class: "swatches"}, key.names.map(([name, colour]) =>
        element("span", {}, element("i", {style: `background:${colour}`}), name)))
        : element("span", {class: "ramp"}, key.low, element("i", {style: `background:${key.bar}`}), key.high));
  }

  fillTable() {
    if (!this.table.open || !this.values) return;
    const {packing, values, shown} = this.values;
    const {rows} = tally(this.colouring, packing, values, shown);
    this.table.replaceChildren(this.table.firstElementChild, dataTable([colourings[this.colouring].label, "spheres", "share"], rows,
      "Spheres that are shown"));
  }

  async save() {
    if (!this.view) return;
    const packing = this.packing();
    save(`${fileName(this.chapter.run.file, `point-${packing.point}-realization-${packing.realization}-tap-${packing.tap}`)}.png`, await this.view.picture());
  }
}

export function packingPanel(chapter) {
  return new PackingPanel(chapter).node;
}
