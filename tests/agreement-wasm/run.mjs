// Runs the comparison in node: `node run.mjs MODULE.wasm`.

import { readFileSync } from "node:fs";

const { instance } = await WebAssembly.instantiate(readFileSync(process.argv[2]));
const { memory, agrees, report_start, report_length } = instance.exports;
const agreed = agrees();
// Only now, because memory that grows leaves its old buffer behind.
const report = new Uint8Array(memory.buffer, report_start(), report_length());
process.stdout.write(new TextDecoder().decode(report));
process.exitCode = agreed === 1 ? 0 : 1;
