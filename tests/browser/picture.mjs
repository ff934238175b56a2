// Takes README's picture of a page: `node picture.mjs CHROMIUM PAGE.html OUT.png`.

import { chromium } from "playwright-core";
import { pathToFileURL } from "node:url";

const [executablePath, path, out] = process.argv.slice(2);
const browser = await chromium.launch({
  executablePath,
  args: ["--no-sandbox", "--disable-gpu", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
const context = await browser.newContext({ viewport: { width: 1000, height: 1270 }, colorScheme: "light" });
const page = await context.newPage();
await page.goto(pathToFileURL(path).href);
await page.waitForSelector('#stage[data-state="ready"]');
await page.waitForTimeout(300);
await page.screenshot({ path: out });
await browser.close();
