import {element} from "./dom.js";
import {kindColour, orderColour} from "./colours.js";
import {plural} from "./format.js";
import {Table, spread} from "./table.js";
import {isDark, onTheme, startTheme, toggleTheme} from "./theme.js";
import {leftOut, runSection} from "./sections/run.js";
import {compactionSection, engineSection, spreadSection} from "./sections/curves.js";
import {fitsSection} from "./sections/fits.js";
import {steadySection} from "./sections/steady.js";
import {ageingSection} from "./sections/ageing.js";
import {motionSection} from "./sections/motion.js";
import {orderingSection} from "./sections/ordering.js";
import {spectraSection} from "./sections/spectra.js";
import {hysteresisSection, sweepSection} from "./sections/sweeps.js";
import {structureSections} from "./sections/structure.js";
import {costSection, otherSection, precisionSection} from "./sections/others.js";
import {packingSection} from "./sections/packing.js";
import {memorySection, volumesSection} from "./sections/volumes.js";

const mostShown = 8;  // sweep points that are switched on at first

/// Numbers of a curve: what is not there is not a number.
function numbers(list) {
  return list.map((value) => typeof value === "number" ? value : NaN);
}

/// One results file.
class Chapter {
  constructor(run, index) {
    this.run = run;
    this.id = `file-${index}`;
    this.tables = run.tables.map((table) => new Table(table));
    this.settings = this.tables.find((table) => table.path[0] === "cost" && table.axis("setting").length === run.n_points);
    for (const curve of run.curves) {
      for (const column of curve.columns) for (const key of ["mean", "error", "sigma"]) column[key] = numbers(column[key]);
    }
    for (const one of run.snapshots) for (const key of ["coordination", "coordination_error"]) one[key] = numbers(one[key]);
    const drawn = run.curves.map((curve) => curve.point);
    this.shown = new Set(spread(drawn, mostShown));
    this.drawn = drawn;
    this.listeners = [];
    const stages = run.scene.protocol;
    this.changesStrength = Array.isArray(stages) && (stages.length > 1 || stages.some((stage) => stage?.ramp));
  }

  /// What a sweep point is called: its swept values; of a study of cost its setting.
  pointLabel(number) {
    const settings = this.settings?.axis("setting");
    if (settings && number !== null) return settings[number];
    return this.run.points.find((point) => point.number === number)?.label || (number === null ? "all points" : `point ${number}`);
  }
  titleOf(table) {
    return `${table.path.join(" ").replaceAll("_", " ")}${table.point === null ? "" : `, ${this.pointLabel(table.point)}`}`;
  }
  column(name) {
    for (const curve of this.run.curves) {
      const found = curve.columns.find((column) => column.name === name);
      if (found) return found;
    }
    return null;
  }

  onShown(listener) { this.listeners.push(listener); }
  colourOf(point) {
    const i = this.drawn.indexOf(point), n = this.drawn.length;
    return (dark) => n <= 4 ? kindColour(i, dark) : orderColour(i, n, dark);
  }
  shownPoints() {
    return this.drawn.filter((point) => this.shown.has(point)).map((point) =>
      ({point, label: this.drawn.length > 1 ? this.pointLabel(point) : "", colour: this.colourOf(point)}));
  }
  shownCurves() {
    return this.shownPoints().map((one) => ({...one, curve: this.run.curves.find((curve) => curve.point === one.point)}));
  }

  /// Which sweep points the curves show.
  chips() {
    if (this.drawn.length < 2) return null;
    const boxes = this.drawn.map((point) => {
      const box = element("input", {type: "checkbox", checked: this.shown.has(point), onchange: () => this.change(point, box.checked)});
      const swatch = element("i", {class: "swatch"});
      const colour = () => { swatch.style.background = this.colourOf(point)(isDark()); };
      colour();
      onTheme(colour);
      return {point, box, node: element("label", {class: "chip"}, box, swatch, this.pointLabel(point))};
    });
    const all = (points) => {
      this.shown = new Set(points);
      for (const one of boxes) one.box.checked = this.shown.has(one.point);
      for (const listener of this.listeners) listener();
    };
    return element("fieldset", {class: "chips"}, element("legend", {}, "Sweep points in the curves"), boxes.map((one) => one.node),
      element("button", {type: "button", onclick: () => all(this.drawn)}, "all"),
      element("button", {type: "button", onclick: () => all(spread(this.drawn, mostShown))}, "some"));
  }
  change(point, on) {
    if (on) this.shown.add(point);
    else this.shown.delete(point);
    for (const listener of this.listeners) listener();
  }

  build() {
    const {run} = this;
    const sections = [runSection(this), this.chips(), compactionSection(this), spreadSection(this), packingSection(this), fitsSection(this),
                      steadySection(this), ageingSection(this), spectraSection(this), hysteresisSection(this), sweepSection(this),
                      orderingSection(this), motionSection(this), volumesSection(this), memorySection(this),
                      ...structureSections(this), engineSection(this), costSection(this), precisionSection(this), otherSection(this)].filter(Boolean);
    const description = run.scene.description;
    const article = element("article", {id: this.id, "aria-label": run.file},
      element("header", {class: "chapter"}, element("h2", {}, run.scene.name || run.file), element("p", {class: "file"}, run.file),
        description ? element("p", {class: "lead"}, Array.isArray(description) ? description.join(" ") : String(description)) : null),
      leftOut(this), sections);
    for (const node of article.querySelectorAll("figure.plot")) node.figure.of(`Of ${run.file}: ${run.about}`);
    return article;
  }
}

function contents(articles) {
  return element("nav", {class: "contents", "aria-label": "Contents"}, element("h2", {}, "Contents"),
    articles.map((article) => element("div", {},
      articles.length > 1 ? element("a", {class: "chapter-link", href: `#${article.id}`}, article.querySelector("h2").textContent) : null,
      element("ul", {}, [...article.querySelectorAll("section")].map((one) =>
        element("li", {}, element("a", {href: `#${one.id}`}, one.querySelector("h3").textContent)))))));
}

function build() {
  startTheme();
  const data = JSON.parse(document.getElementById("report-data").textContent);
  const articles = data.files.map((run, i) => new Chapter(run, i).build());
  const button = element("button", {type: "button", class: "theme", onclick: toggleTheme});
  const name = () => { button.textContent = isDark() ? "Light" : "Dark"; };
  name();
  onTheme(name);
  const made = data.made;
  document.getElementById("report").append(
    element("header", {class: "page"}, element("p", {class: "brand"}, "jostle report"),
      element("p", {class: "small"}, `${plural(data.files.length, "results file")}; made ${made.started} by jostle ${made.version} (${made.git_revision})`), button),
    element("div", {class: "columns"}, contents(articles), element("div", {class: "chapters"}, articles)));
  document.documentElement.dataset.ready = "yes";
}

build();
