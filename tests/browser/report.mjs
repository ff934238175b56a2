// Looks at pages of `cobra report` as a reader does: `node report.mjs CHROMIUM PAGE.html...`.
//
// What a browser must be told to see, and no test of the HTML's text can: that the picture is drawn and turns,
// that nothing is loaded or complained of, that the page fits a phone, paper and the dark.

import assert from "node:assert/strict";
import { chromium } from "playwright-core";
import { pathToFileURL } from "node:url";

const [executablePath, ...pages] = process.argv.slice(2);
assert(pages.length > 0, "usage: node report.mjs CHROMIUM PAGE.html...");

const quiet = [
  "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync",
];
// WebGL by the processor: a machine that tests has no graphics.
const drawing = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

/** Opens a page and gives it to `look`; fails where it complains or asks for anything. */
async function open(browser, path, options, look) {
  const context = await browser.newContext({ viewport: { width: 1100, height: 900 }, ...options });
  const page = await context.newPage();
  const complaints = [];
  const requests = [];
  page.on("console", (message) => {
    // Of the driver, about the pictures that this test takes.
    if (!message.text().includes("GPU stall due to ReadPixels")) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(String(error)));
  const address = pathToFileURL(path).href;
  page.on("request", (request) => {
    if (request.url() !== address && !request.url().startsWith("data:")) requests.push(request.url());
  });
  await page.goto(address);
  await look(page);
  assert.deepEqual(complaints, [], `${path} complains`);
  assert.deepEqual(requests, [], `${path} asks for more than itself`);
  await context.close();
}

const state = (page) => page.locator("#stage").getAttribute("data-state");

/** The picture, when the frames that were asked for are drawn. */
async function picture(page) {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  return page.locator("#canvas").screenshot();
}

async function changes(page, what, act) {
  const before = await picture(page);
  await act();
  assert(!before.equals(await picture(page)), `${what} does not change the picture`);
}

async function middle(page) {
  await page.locator("#canvas").scrollIntoViewIfNeeded();
  const { x, y, width, height } = await page.locator("#canvas").boundingBox();
  return { x: x + width / 2, y: y + height / 2 };
}

async function turns(page) {
  assert.equal(await state(page), "ready");
  const { x, y } = await middle(page);
  await changes(page, "dragging", async () => {
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 80, y + 30, { steps: 4 });
    await page.mouse.up();
  });
  for (const key of ["ArrowLeft", "ArrowUp", "+", "Home"]) {
    await changes(page, key, () => page.locator("#canvas").press(key));
  }
  await changes(page, "another axis for up", () => page.selectOption("#up", "y"));
  // Nothing moves by itself.
  const frames = () => page.locator("#stage").getAttribute("data-frames");
  await picture(page);
  const drawn = await frames();
  await page.waitForTimeout(150);
  assert.equal(await frames(), drawn, "frames are drawn although nothing changes");
}

async function views(page) {
  const measured = await page.locator('input[value="residual"]').isEnabled();
  assert.equal(await page.locator('input[value="coverage"]').isEnabled(), measured);
  if (measured) {
    for (const view of ["component", "coverage", "residual"]) {
      await changes(page, view, () => page.locator(`input[value="${view}"]`).check({ force: true }));
      const shown = page.locator("[data-legend]:visible");
      assert.deepEqual(await shown.evaluateAll((all) => all.map((one) => one.dataset.legend)), [view]);
    }
    await page.locator('input[value="residual"]').focus();
    await changes(page, "an arrow key among the views", () => page.keyboard.press("ArrowRight"));
  }
}

async function reads(page) {
  await page.click("#reset");
  const { x, y } = await middle(page);
  const said = page.locator("#readout");
  // Somewhere around the middle there is surface: an object may be hollow.
  for (let turn = 0; turn < 40 && !(await said.textContent()).includes("component"); turn += 1) {
    await page.mouse.move(x + 5 * turn * Math.cos(turn), y + 3 * turn * Math.sin(turn));
    await picture(page);
  }
  assert.match(await said.textContent(), /component \d+: σ̂|no component speaks/);
}

/** The page must not be wider than the screen; what is, scrolls in a box of its own. */
async function fits(page) {
  // Not what the page is told: a phone shows it smaller where it is too wide.
  const screen = page.viewportSize().width;
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  assert(wide <= screen, `the page is ${wide} pixels wide on a screen of ${screen}`);
}

/** Text on what lies behind it, as WCAG 2 has it. */
async function contrasts(page) {
  const worst = await page.evaluate(() => {
    const numbers = (colour) => colour.match(/[\d.]+/g).map(Number);
    const luminance = ([r, g, b]) => {
      const linear = [r, g, b].map((byte) => byte / 255).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
      return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
    };
    const behind = (element) => {
      for (let at = element; at; at = at.parentElement) {
        const colour = numbers(getComputedStyle(at).backgroundColor);
        if (colour.length === 3 || colour[3] === 1) return colour;
      }
      return [255, 255, 255];
    };
    let worst = { contrast: 21, text: "" };
    for (const element of document.querySelectorAll("body *")) {
      const own = [...element.childNodes].some((node) => node.nodeType === 3 && node.data.trim());
      // What cannot be chosen may be pale, and a script is no text.
      if (!own || !element.checkVisibility() || element.matches("script, input:disabled + span")) continue;
      const pair = [numbers(getComputedStyle(element).color), behind(element)].map(luminance).sort((a, b) => b - a);
      const contrast = (pair[0] + 0.05) / (pair[1] + 0.05);
      if (contrast < worst.contrast) worst = { contrast, text: element.textContent.trim().slice(0, 40) };
    }
    return worst;
  });
  assert(worst.contrast >= 4.5, `contrast ${worst.contrast.toFixed(2)}: ${worst.text}`);
}

async function fingers(page) {
  assert.equal(await state(page), "ready");
  const { x, y } = await middle(page);
  const session = await page.context().newCDPSession(page);
  const touch = (type, touchPoints) => session.send("Input.dispatchTouchEvent", { type, touchPoints });
  await changes(page, "one finger", async () => {
    await touch("touchStart", [{ x, y }]);
    for (let i = 1; i <= 4; i += 1) await touch("touchMove", [{ x: x + 15 * i, y }]);
    await touch("touchEnd", []);
  });
  await changes(page, "two fingers", async () => {
    const apart = (by) => [{ x: x - by, y, id: 0 }, { x: x + by, y, id: 1 }];
    await touch("touchStart", apart(20));
    for (let i = 1; i <= 4; i += 1) await touch("touchMove", apart(20 + 15 * i));
    await touch("touchEnd", []);
  });
}

async function paper(page) {
  await picture(page);
  await page.emulateMedia({ media: "print", colorScheme: "dark" });
  const background = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  assert.equal(background, "rgb(255, 255, 255)", "paper is not white");
  assert.equal(await page.locator("button:visible, .controls:visible").count(), 0, "buttons are printed");
  const pdf = await page.pdf({ format: "A4" });
  assert(pdf.subarray(0, 5).toString() === "%PDF-" && pdf.length > 30_000, `a PDF of ${pdf.length} bytes`);
}

const background = (page) => page.evaluate(() => getComputedStyle(document.body).backgroundColor);

const browser = await chromium.launch({ executablePath, args: [...quiet, ...drawing] });
const blind = await chromium.launch({ executablePath, args: [...quiet, "--disable-3d-apis"] });
let looked = 0;
for (const path of pages) {
  const look = async (name, act) => {
    try {
      await act();
    } catch (error) {
      error.message = `${path}: ${name}: ${error.message}`;
      throw error;
    }
    looked += 1;
  };
  const light = { colorScheme: "light" };
  await look("turning", () => open(browser, path, light, turns));
  await look("views", () => open(browser, path, light, views));
  await look("reading a place", () => open(browser, path, light, reads));
  await look("a phone", () => open(browser, path, {
    viewport: { width: 360, height: 740 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2,
  }, async (page) => {
    await fits(page);
    await fingers(page);
  }));
  await look("light and dark", async () => {
    const found = [];
    for (const colorScheme of ["light", "dark"]) {
      await open(browser, path, { colorScheme }, async (page) => {
        found.push(await background(page));
        await contrasts(page);
      });
    }
    assert.notEqual(found[0], found[1], "the dark is as light");
  });
  await look("paper", () => open(browser, path, light, paper));
  for (const [name, engine, options, expected] of [
    ["without WebGL", blind, {}, "no-webgl"],
    ["without scripts", browser, { javaScriptEnabled: false }, null],
  ]) {
    await look(name, () => open(engine, path, options, async (page) => {
      assert.equal(await state(page), expected);
      assert(await page.locator(".fallback").isVisible(), "nothing says why there is no picture");
      await fits(page);
    }));
  }
}
await browser.close();
await blind.close();
console.log(`${looked} looks at ${pages.length} pages`);
