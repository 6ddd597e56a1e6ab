// Elements are made of nodes and text alone: nothing of a results file is ever read as markup.

const svgNames = new Set(["svg", "g", "path", "rect", "line", "circle", "text", "tspan", "title", "desc"]);

export function element(name, attributes = {}, ...children) {
  const node = svgNames.has(name)
    ? document.createElementNS("http://www.w3.org/2000/svg", name)
    : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (key.startsWith("on")) node.addEventListener(key.slice(2), value);
    else node.setAttribute(key, value === true ? "" : value);
  }
  node.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return node;
}

const longestCell = 24;  // characters of a cell that a narrow screen has room for

/// A table of rows of texts (or nodes) under a head; the first column names the row. On a narrow screen a table with
/// sentences shows one row below another, each value with its head.
export function dataTable(head, rows, caption) {
  const textOf = (cell) => typeof cell === "string" ? cell : cell.textContent;
  const isWide = head.length > 4 || rows.some((row) => row.some((cell) => textOf(cell).length > longestCell));
  return element("div", {class: isWide ? "scroll stacks" : "scroll", tabindex: 0, role: "region", "aria-label": caption ?? "Table"},
    element("table", {},
      caption ? element("caption", {}, caption) : null,
      element("thead", {}, element("tr", {}, head.map((text) => element("th", {scope: "col"}, text)))),
      element("tbody", {}, rows.map((row) => element("tr", {}, row.map((cell, i) =>
        element(i === 0 ? "th" : "td", {...(i === 0 ? {scope: "row"} : {}), "data-head": textOf(head[i] ?? "")}, cell)))))));
}

/// Hands a file to whoever looks at the page.
export function save(name, content, type) {
  const blob = content instanceof Blob ? content : new Blob([content], {type});
  const url = URL.createObjectURL(blob);
  const link = element("a", {href: url, download: name});
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

export function chooser(label, options, chosen, onChange) {
  const select = element("select", {onchange: () => onChange(select.value)},
    options.map(([value, text]) => element("option", {value, selected: String(value) === String(chosen)}, text)));
  return element("label", {class: "chooser"}, element("span", {}, label), select);
}
