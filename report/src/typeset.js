// Texts of the catalogue: symbols as "N_c" and "\u03a6_b" get their subscript, "t_W^\u03bc" its superscript too;
// everything else is text.
import {element} from "./dom.js";

// A single letter, an underscore, and one letter or digit; a superscript may follow.
const subscript = /(?<![\p{L}\p{N}_])(\p{L})_([\p{L}\p{N}\u221e])(?![\p{L}\p{N}_])(?:\^(\p{L})(?![\p{L}\p{N}_]))?/gu;

function pieces(text, lowered) {
  const found = [];
  let end = 0;
  for (const match of text.matchAll(subscript)) {
    found.push(text.slice(end, match.index) + match[1], ...lowered(match[2], match[3]));
    end = match.index + match[0].length;
  }
  return [...found, text.slice(end)];
}

/// Nodes for an element of SVG.
export function typeset(text) {
  let isLow = false;
  return pieces(text, (letter, power) => [{low: letter}, power ? `^${power}` : ""]).filter((piece) => piece !== "").map((piece) => {
    if (piece.low) {
      isLow = true;
      return element("tspan", {dy: "0.3em", "font-size": "75%"}, piece.low);
    }
    const raised = isLow ? element("tspan", {dy: "-0.225em"}, piece) : piece;
    isLow = false;
    return raised;
  });
}

/// Nodes for an element of HTML.
export function written(text) {
  return pieces(text, (letter, power) => [element("sub", {}, letter), ...(power ? [element("sup", {}, power)] : [])]);
}

export function cutTo(text, most) {
  return text.length > most ? `${text.slice(0, most - 1)}\u2026` : text;
}
