// Sections of blocks, which the program describes (study/drawing/page/sections/): what each kind looks like.
import {chooser, dataTable, element} from "./dom.js";
import {packingPanel} from "./packing/panel.js";
import {written} from "./typeset.js";

/// A section of a chapter.
export function section(chapter, id, title, intro, ...content) {
  return element("section", {id: `${chapter.id}-${id}`, "data-section": id},
    element("h3", {}, title), intro ? element("p", {class: "intro"}, written(intro)) : null, ...content.flat().filter(Boolean));
}

/// A text, one whose beginning is set off, or one with symbols. Texts of a file are shown as they are, to be copied.
function cell(content) {
  if (typeof content === "string") return content;
  if ("print" in content) return element("span", {}, written(content.print));
  return element("span", {}, element("b", {}, content.strong), content.text);
}

function heading(content) {
  return element("span", {}, written(content));
}

/// Several lines, each a paragraph of its own.
function lines(text) {
  return text.split("\n").flatMap((line, i) => i === 0 ? [line] : [element("br"), line]);
}

/// Blocks that are shown for one sweep point at a time, with a menu.
function byPoint({points}, chapter) {
  const make = (i) => shownBlocks(points[i].blocks, chapter);
  if (points.length === 1) return element("div", {class: "by-point"}, make(0));
  const content = element("div", {}, make(0));
  return element("div", {class: "by-point"}, chooser("Sweep point", points.map(({label}, i) => [i, label]), 0,
    (i) => content.replaceChildren(...make(Number(i)))), content);
}

const kinds = {
  // Side by side where there is room; one that is alone is larger.
  figures({figures}, chapter) {
    const drawn = figures.flatMap((i) => chapter.figures(i));
    return element("div", {class: drawn.length === 1 ? "pair single" : "pair"}, drawn.map((one) => one.node));
  },
  table: ({caption, head, rows}) => dataTable(head.map(heading), rows.map((row) => row.map(cell)), caption),
  statement: ({label, text}) =>
    element("p", {class: "statement"}, label ? element("strong", {}, ...written(label), ": ") : null, lines(text)),
  small: ({text}) => element("p", {class: "small"}, written(text)),
  details: ({summary, open, blocks}, chapter) =>
    element("details", {open}, element("summary", {}, written(summary)), shownBlocks(blocks, chapter)),
  subsection: ({title, blocks}, chapter) =>
    element("div", {class: "subsection"}, element("h4", {}, written(title)), shownBlocks(blocks, chapter)),
  definitions: ({class: kind, rows}) => element("dl", {class: kind}, rows.map(([term, text]) =>
    element("div", {}, element("dt", {}, term), element("dd", {}, written(text))))),
  refusals: ({texts}) => element("ul", {class: "refusals"}, texts.map((text) => element("li", {}, text))),
  points: byPoint,
  packing: (_, chapter) => packingPanel(chapter),
};

export function shownBlocks(blocks, chapter) {
  return blocks.map((block) => kinds[block.kind](block, chapter));
}

export function shownSection({id, title, intro, blocks}, chapter) {
  return section(chapter, id, title, intro, shownBlocks(blocks, chapter));
}
