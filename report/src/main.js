import {shownSection} from "./blocks.js";
import {element} from "./dom.js";
import {figure} from "./figure.js";
import * as format from "./format.js";
import {View} from "./packing/view.js";
import {leftOut, runSection} from "./run.js";
import {isDark, onTheme, startTheme, toggleTheme} from "./theme.js";

/// One results file.
class Chapter {
  constructor(run, index) {
    this.run = run;
    this.id = `file-${index}`;
    this.drawn = run.curve_points.map((one) => one.number);
    this.usual = run.curve_points.filter((one) => one.shown).map((one) => one.number);
    this.shown = new Set(this.usual);
    this.listeners = [];
  }

  pointLabel(number) {
    return this.run.points.find((point) => point.number === number)?.label || `point ${number}`;
  }
  /// A figure of the catalogue, by its place: one drawing for each of its panels.
  figures(place) {
    return this.run.figures[place].panels.map((panel) => {
      const drawn = figure(panel, this.run, (number) => this.shown.has(number));
      if (panel.series.some((series) => series.point !== undefined)) this.listeners.push(() => drawn.update());
      return drawn;
    });
  }

  /// The buttons that choose the sweep points of the curves.
  chips() {
    if (this.drawn.length < 2) return null;
    const boxes = this.drawn.map((point) => {
      const box = element("input", {type: "checkbox", checked: this.shown.has(point), onchange: () => this.change(point, box.checked)});
      const swatch = element("i", {class: "swatch"});
      const {colour: tints} = this.run.curve_points.find((one) => one.number === point);
      const colour = () => { swatch.style.background = isDark() ? tints.dark : tints.light; };
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
      element("button", {type: "button", onclick: () => all(this.usual)}, "some"));
  }
  change(point, on) {
    if (on) this.shown.add(point);
    else this.shown.delete(point);
    for (const listener of this.listeners) listener();
  }

  build() {
    const {run} = this;
    const sections = [run.summary ? shownSection(run.summary, this) : null, runSection(this), this.chips(), ...run.sections.map((one) => shownSection(one, this))].filter(Boolean);
    const description = run.scene.description;
    const article = element("article", {id: this.id, "aria-label": run.file},
      element("header", {class: "chapter"}, element("h2", {}, run.scene.name || run.file), element("p", {class: "file"}, run.file),
        description ? element("p", {class: "lead"}, Array.isArray(description) ? description.join(" ") : String(description)) : null),
      leftOut(this), sections);
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
      element("p", {class: "small"}, `${format.plural(data.files.length, "results file")}; made ${made.started} by jostle ${made.version} (${made.git_revision})`), button),
    element("div", {class: "columns"}, contents(articles), element("div", {class: "chapters"}, articles)));
  document.documentElement.dataset.ready = "yes";
}

globalThis.jostle = {format, View};  // for tests
build();
