// Draws the page for the documents: `node web/tests/picture.mjs docs/browser.png`, after `cargo xtask web`.

import { existsSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

import { chromium } from "playwright-core";

import { page as file } from "./engines.mjs";

const executablePath = process.env.CHROMIUM ?? ["/usr/bin/chromium", "/usr/bin/chromium-browser"].find((path) => existsSync(path));
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
await page.goto(pathToFileURL(file).href);
const ready = () => window.twintac?.state.isThere && window.twintac.state.frame && document.getElementById("status").textContent === "Ready";
await page.waitForFunction(ready, undefined, { timeout: 120_000 });
await page.evaluate(() => window.twintac.press.aim({ x_mm: -3, y_mm: 2, depth_mm: 1.6 }));
await page.waitForFunction(ready, undefined, { timeout: 120_000 });
// Times are of the machine that draws. Without them, the same page gives the same picture.
await page.evaluate(() => {
  const rate = document.getElementById("rate");
  const nodes = rate.cloneNode();
  nodes.removeAttribute("id");
  nodes.textContent = /[\d,]+ nodes$/.exec(rate.textContent)[0];
  rate.after(nodes);
  rate.style.display = "none";
  return new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)));
});
await page.screenshot({ path: resolve(process.argv[2]), fullPage: true });
await browser.close();
