// Makes page.html: page.template.html with the script and the styles put into it, and the script's
// SHA-256 in its content security policy, so that a browser runs this script and no other. Also
// licences.txt, of the packages that are in it.
import {createHash} from "node:crypto";
import {existsSync, readFileSync, readdirSync, writeFileSync} from "node:fs";
import {fileURLToPath} from "node:url";
import {build} from "esbuild";

const folder = fileURLToPath(new URL(".", import.meta.url));

async function bundled(entry) {
  const result = await build({
    entryPoints: [folder + entry],
    absWorkingDir: folder,
    bundle: true,
    minify: true,
    charset: "ascii",
    format: "iife",
    target: "es2020",
    legalComments: "none",
    metafile: true,
    write: false,
  });
  const packages = Object.values(result.metafile.outputs).flatMap((output) => Object.entries(output.inputs))
    .filter(([, {bytesInOutput}]) => bytesInOutput > 0)
    .map(([path]) => /^node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(path)?.[1]).filter(Boolean);
  // esbuild leaves regular expressions as they are.
  const text = result.outputFiles[0].text.trimEnd()
    .replace(/[^\x00-\x7f]/g, (one) => `\\u${one.charCodeAt(0).toString(16).padStart(4, "0")}`);
  return {text, packages: [...new Set(packages)].sort()};
}

/// Every licence once, with the packages and holders it is of.
function licences(packages) {
  const byText = new Map();
  for (const name of packages) {
    const home = `${folder}node_modules/${name}/`;
    const about = JSON.parse(readFileSync(`${home}package.json`, "utf8"));
    const file = readdirSync(home).find((one) => /^licen[cs]e/i.test(one));
    if (!file || !existsSync(home + file)) throw new Error(`${name} has no licence`);
    const lines = readFileSync(home + file, "utf8").replaceAll("\r", "").trim().split("\n").map((line) => line.trimEnd());
    const holders = lines.filter((line) => /^copyright (\(c\)|\d)/i.test(line.trim()));
    const text = lines.filter((line) => !/^copyright (\(c\)|\d)/i.test(line.trim())).join("\n").replace(/\n{3,}/g, "\n\n").trim();
    const known = byText.get(text) ?? [];
    known.push(`${name} ${about.version} (${about.license})${holders.length > 0 ? `: ${holders.join("; ")}` : ""}`);
    byText.set(text, known);
  }
  return [...byText].map(([text, of]) => `${of.join("\n")}\n\n${text}`).join(`\n\n${"-".repeat(78)}\n\n`) + "\n";
}

const script = await bundled("src/main.js");
const style = await bundled("src/style.css");
const ofPackages = licences([...new Set([...script.packages, ...style.packages])]);
const hash = createHash("sha256").update(script.text).digest("base64");
const parts = {"@SCRIPT@": script.text, "@STYLE@": style.text, "@SCRIPT_SHA256@": hash,
               "@LICENCES@": ofPackages.replaceAll("--", "- -").trimEnd()};
const page = readFileSync(`${folder}page.template.html`, "utf8")
  .replace(/@(SCRIPT|STYLE|SCRIPT_SHA256|LICENCES)@/g, (mark) => parts[mark]);

const foreign = /[^\x00-\x7f]/.exec(page);
if (foreign) throw new Error(`page.html must be ASCII, and has ${page.slice(foreign.index - 30, foreign.index + 30)}`);
for (const [text, times] of [["@TITLE@", 1], ["@DATA@", 1], [')JOSTLE"', 0]]) {
  if (page.split(text).length - 1 !== times) throw new Error(`${text} does not stand ${times} times in page.html`);
}
if (/<\/script|<!--/i.test(script.text) || /<\/style/i.test(style.text)) throw new Error("a bundle ends its own element");
writeFileSync(`${folder}licences.txt`, ofPackages);
writeFileSync(`${folder}page.html`, page);
console.log(`report/page.html: ${(page.length / 1024).toFixed(0)} kB`);
