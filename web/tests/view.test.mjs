// The page as `twintac view` serves it: solved by the program, for those who have the token.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { existsSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { chromium } from "playwright-core";

import { deviation, nativeAnswers, page as file, root, sensorText } from "./engines.mjs";

const executablePath = process.env.CHROMIUM ?? ["/usr/bin/chromium", "/usr/bin/chromium-browser"].find((path) => existsSync(path));
const PATIENCE = { timeout: 120_000 };

let browser, program, url;
before(async () => {
  browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
  program = spawn(join(root, "target/release/twintac"), ["view", "--json", "--page", file], { stdio: ["ignore", "pipe", "inherit"] });
  const [printed] = await once(program.stdout, "data");
  url = JSON.parse(printed).url;
});
after(async () => {
  await browser?.close();
  program?.kill();
});

/** A page at rest. */
async function opened(fragment = "") {
  const page = await (await browser.newContext()).newPage();
  page.faults = [];
  page.on("pageerror", (error) => page.faults.push(String(error)));
  page.on("request", (request) => new URL(request.url()).host === new URL(url).host || /^(blob|data):/.test(request.url()) || page.faults.push(request.url()));
  await page.goto(url + fragment);
  await page.waitForFunction(() => window.twintac, undefined, PATIENCE);
  await there(page);
  return page;
}

async function there(page) {
  await page.waitForFunction(() => window.twintac.state.isThere && window.twintac.state.frame && document.getElementById("status").textContent === "Ready", undefined, PATIENCE);
}

test("what the page shows is what the program solves", async () => {
  const page = await opened();
  await page.evaluate(() => window.twintac.press.useNodes(2000));
  await page.evaluate(() => window.twintac.press.aim({ x_mm: 2, y_mm: 1, depth_mm: 1.2 }));
  await there(page);
  const { frame, n_nodes } = await page.evaluate(() => ({ ...window.twintac.state }));
  const begin = [
    { do: "open", file: "phystac.toml", text: sensorText },
    { do: "prepare", indenter: "sphere-25", depth_mm: 2.125, max_nodes: 2000 },
  ];
  const [, { touch_mm, n_nodes: expected_nodes }] = nativeAnswers(begin);
  assert.equal(n_nodes, expected_nodes);
  const steps = [0, 0.4, 0.8, 1.2].map((depth_mm) => ({ do: "step", since_s: 0.02, gel_from_indenter: { position_mm: [2, 1, touch_mm - depth_mm], rotation: [0, 0, 0, 1] } }));
  const off = deviation(frame, nativeAnswers([...begin, ...steps]).at(-1));
  console.log(`beside a press straight down: readings ${(100 * off.readings).toFixed(4)} %, force ${(100 * off.force).toFixed(4)} %`);
  assert.ok(off.readings < 0.01 && off.force < 0.01, JSON.stringify(off));
  assert.deepEqual(page.faults, []);
  await page.context().close();
});

test("two windows press gels of their own", async () => {
  const [a, b] = [await opened(), await opened()];
  for (const [page, depth_mm] of [[a, 0.3], [b, 1.5]]) {
    await page.evaluate((depth_mm) => window.twintac.press.aim({ depth_mm }), depth_mm);
  }
  await Promise.all([there(a), there(b)]);
  const depths = await Promise.all([a, b].map((page) => page.evaluate(() => window.twintac.state.frame.depth_mm)));
  assert.ok(Math.abs(depths[0] - 0.3) < 0.01 && Math.abs(depths[1] - 1.5) < 0.01, String(depths));
  await Promise.all([a, b].map((page) => page.context().close()));
});

test("a wrong token gets neither the page nor the engine, and a link has none", async () => {
  const wrong = url.replace(/token=.*/, "token=0");
  const page = await (await browser.newContext()).newPage();
  assert.equal((await page.goto(wrong)).status(), 403);
  // From another page, even with the token: a browser says where it comes from.
  await page.goto("data:text/html,another page");
  const reached = (address) => page.evaluate((address) => new Promise((resolve) => {
    const socket = new WebSocket(address);
    socket.onopen = () => resolve(true);
    socket.onerror = () => resolve(false);
  }), address);
  assert.equal(await reached(url.replace("http:", "ws:").replace("/?", "/engine?")), false);
  await page.context().close();

  const context = await browser.newContext({ permissions: ["clipboard-read", "clipboard-write"] });
  const own = await context.newPage();
  await own.goto(url);
  await own.waitForFunction(() => window.twintac, undefined, PATIENCE);
  await there(own);
  await own.click("#share");
  await own.waitForFunction(() => document.getElementById("kept").textContent !== "", undefined, PATIENCE);
  const link = await own.evaluate(() => navigator.clipboard.readText());
  assert.ok(link.includes("#") && !link.includes("token"), link);
  await context.close();
});

test("a sensor on the desk is shown beside its twin", async () => {
  const other = spawn(join(root, "target/release/twintac"), ["view", "--json", "--page", file, "--lab"], { stdio: ["ignore", "pipe", "inherit"] });
  try {
    const [printed] = await once(other.stdout, "data");
    const context = await browser.newContext({ viewport: { width: 1280, height: 900 } });
    const page = await context.newPage();
    await page.goto(JSON.parse(printed).url);
    await page.waitForFunction(() => window.twintac?.state.deskFrame?.pressure_kpa.some((kpa) => kpa > 0.5), undefined, PATIENCE);
    assert.equal(await page.textContent("#desk-provenance"), "emulated");
    assert.equal(await page.textContent("#provenance"), "simulated");
    assert.match(await page.textContent("#desk-status"), /^the lab: [\d,]+ frames$/);
    const found = await page.evaluate(() => {
      const { deskFrame, frame } = window.twintac.state;
      const read = (id) => [...document.querySelectorAll(`#${id}-bars .number`)].map((number) => parseFloat(number.textContent));
      return { desk: read("desk"), twin: read("twin"), off: read("off"), n: deskFrame.pressure_kpa.length, twin_kpa: frame.pressure_kpa };
    });
    assert.equal(found.n, 8);
    for (let taxel = 0; taxel < 8; taxel++) assert.ok(Math.abs(found.desk[taxel] - found.twin[taxel] - found.off[taxel]) < 0.02, JSON.stringify(found));
    await page.locator("#desk").screenshot({ path: join(root, "target/web/pictures/desk.png") });
    await page.click("#desk-zero");
    await page.click("#desk-stop");
    await page.waitForFunction(() => document.getElementById("desk").hidden, undefined, PATIENCE);
    await context.close();
  } finally {
    other.kill();
  }
});

test("when the program ends, the page says so", async () => {
  const page = await opened();
  program.kill("SIGINT");
  const [code] = await once(program, "exit");
  assert.equal(code, 0);
  await page.evaluate(() => window.twintac.press.aim({ depth_mm: 1.7 }));
  await page.waitForFunction(() => document.body.textContent.includes("`twintac view` has ended"), undefined, PATIENCE);
  await page.context().close();
});
