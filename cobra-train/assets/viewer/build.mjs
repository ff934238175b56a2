// Makes viewer.min.js, which the command embeds, or another file: `node build.mjs [FILE]`. Same sources, same
// bytes.

import { build } from "esbuild";
import { readFileSync, writeFileSync } from "node:fs";

const result = await build({
  entryPoints: ["viewer.js"],
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2020",
  // Its text stands above all, in full: the comments that a bundler keeps name the licence only.
  legalComments: "none",
  write: false,
});
const { version } = JSON.parse(readFileSync("node_modules/three/package.json", "utf8"));
const licence = readFileSync("node_modules/three/LICENSE", "utf8").trim();
const notice = `/*!\nContains three.js ${version}, https://threejs.org\n\n${licence}\n*/\n`;
const script = result.outputFiles[0].text;
// It becomes the content of an element of a page, which this would end.
if (/<\/script|<!--/i.test(script)) throw new Error("the script would end its element");
writeFileSync(process.argv[2] ?? "viewer.min.js", notice + script);
