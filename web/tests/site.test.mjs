// The first page of the documentation, with a gel that starts at a click.

import assert from "node:assert/strict";
import { existsSync, statSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";

import { chromium } from "playwright-core";

import { root } from "./engines.mjs";

const executablePath = process.env.CHROMIUM ?? ["/usr/bin/chromium", "/usr/bin/chromium-browser"].find((path) => existsSync(path));
const index = join(root, "target/site/index.html");

let browser;
before(async () => {
  browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
});
after(() => browser?.close());

test("a picture is there at once, and the gel after a click", async () => {
  const page = await (await browser.newContext({ viewport: { width: 1300, height: 900 } })).newPage();
  const [loaded, faults] = [new Set(), []];
  page.on("request", (request) => (request.url().startsWith("file:") ? loaded.add(request.url()) : /^(blob|data):/.test(request.url()) || faults.push(request.url())));
  page.on("pageerror", (error) => faults.push(String(error)));
  await page.goto(pathToFileURL(index).href);
  await page.waitForLoadState("networkidle");
  const bytes = [...loaded].map((url) => statSync(fileURLToPath(url.replace(/[?#].*/, ""))).size).reduce((sum, size) => sum + size, 0);
  console.log(`before the click: ${loaded.size} files, ${(bytes / 1e6).toFixed(2)} MB without compression`);
  assert.ok(bytes < 1e6 && ![...loaded].some((url) => url.endsWith("twintac.html")), `${bytes} bytes: ${[...loaded].join("\n")}`);

  await page.getByRole("button", { name: "Press it here" }).click();
  const frame = await (await page.waitForSelector("iframe[title='A gel to press']")).contentFrame();
  await frame.waitForFunction(() => window.twintac?.state.isThere && window.twintac.state.frame, undefined, { timeout: 120_000 });
  await frame.evaluate(() => window.twintac.press.aim({ depth_mm: 1 }));
  await frame.waitForFunction(() => window.twintac.state.frame.force_n[2] < -0.1, undefined, { timeout: 120_000 });
  assert.deepEqual(faults, []);
  if (process.env.PICTURE) await page.screenshot({ path: process.env.PICTURE });
});
