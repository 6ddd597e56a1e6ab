// The search box and the button of the menu. The index is loaded when the box is used first, as a script, so that
// the search also works in files opened without a server.
"use strict";

const root = document.currentScript.dataset.root;
const box = document.getElementById("site-search");
const results = document.getElementById("site-results");
const page = document.getElementById("site-page");
const mostResults = 30;

let loading = null;
function loadIndex() {
  loading ??= new Promise((resolve, reject) => {
    const script = document.createElement("script");
    script.src = `${root}/search-index.js`;
    script.onload = () => resolve(window.searchIndex);
    script.onerror = reject;
    document.head.append(script);
  });
  return loading;
}

/// Returns the sections in which words begin with all words of the query, best first: a word in a heading counts more
/// than in the text.
function find(index, query) {
  const words = query.split(/\s+/).filter(Boolean).map((word) => word.replace(/[.*+?^${}()|[\]\\]/g, "\\$&"))
    .map((word) => new RegExp(`(?<![\\p{L}\\d])${word}`, "giu"));
  const found = [];
  for (const [title, heading, link, text] of words.length ? index : []) {
    const count = (part, word) => part.match(word)?.length ?? 0;
    let score = 0;
    for (const word of words) {
      const best = (count(heading, word) ? 4 : 0) + (count(title, word) ? 2 : 0) + Math.min(count(text, word), 3) / 2;
      if (best === 0) {
        score = 0;
        break;
      }
      score += best;
    }
    if (score > 0) found.push({title, heading, link, text, score, words});
  }
  return found.sort((a, b) => b.score - a.score);
}

/// Returns the text around the first word that is found, as nodes with the words marked.
function excerpt({text, words}) {
  const places = words.map((word) => text.search(word)).filter((n) => n >= 0);
  const begin = places.length ? Math.max(0, Math.min(...places) - 60) : 0;
  const part = (begin ? "... " : "") + text.slice(begin, begin + 200) + (begin + 200 < text.length ? " ..." : "");
  return part.split(new RegExp(`(${words.map((word) => word.source).join("|")})`, "iu")).map((piece, n) => {
    if (n % 2 === 0) return piece;
    const mark = document.createElement("mark");
    mark.textContent = piece;
    return mark;
  });
}

function show(found, query) {
  const list = document.createElement("ol");
  for (const one of found.slice(0, mostResults)) {
    const item = document.createElement("li");
    const link = document.createElement("a");
    link.href = `${root}/${one.link}`;
    link.textContent = one.heading === one.title ? one.title : `${one.title}: ${one.heading}`;
    link.addEventListener("click", () => {
      box.value = "";
      results.hidden = true;
      page.hidden = false;
    });
    const text = document.createElement("p");
    text.append(...excerpt(one));
    item.append(link, text);
    list.append(item);
  }
  const summary = document.createElement("p");
  const shown = found.length > mostResults ? `, the first ${mostResults} are shown` : "";
  summary.textContent = `${found.length} section${found.length === 1 ? "" : "s"} with "${query}"${shown}`;
  results.replaceChildren(summary, list);
}

async function search() {
  const query = box.value.trim();
  results.hidden = !query;
  page.hidden = Boolean(query);
  if (query) show(find(await loadIndex(), query), query);
}

box.addEventListener("input", search);
box.form.addEventListener("submit", (event) => event.preventDefault());
document.addEventListener("keydown", (event) => {
  if (event.key === "/" && event.target === document.body) {
    event.preventDefault();
    box.focus();
  } else if (event.key === "Escape" && event.target === box) {
    box.value = "";
    search();
  }
});

const button = document.getElementById("site-menu-button");
button.addEventListener("click", () => {
  const open = document.body.classList.toggle("menu-open");
  button.setAttribute("aria-expanded", String(open));
});
