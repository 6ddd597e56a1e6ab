// Light and dark: the setting of the reader's system, until a button changes it.

const listeners = new Set();
let chosen = null;

export function isDark() {
  return chosen ? chosen === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
}

export function onTheme(listener) {
  listeners.add(listener);
}

function tell() {
  document.documentElement.dataset.theme = isDark() ? "dark" : "light";
  for (const listener of listeners) listener();
}

export function startTheme() {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { if (!chosen) tell(); });
  document.documentElement.dataset.theme = isDark() ? "dark" : "light";
}

export function toggleTheme() {
  chosen = isDark() ? "light" : "dark";
  tell();
}
