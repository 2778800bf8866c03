// The WebAssembly engine finds what the native one finds, within 1 %.

import assert from "node:assert/strict";
import { test } from "node:test";

import { readFileSync } from "node:fs";

import { deviation, nativeAnswers, sensorText, surrogateFile, wasmEngine } from "./engines.mjs";

/** Down and aside; anew: down, and tilted, in steps of a hand. */
function requests(touch_mm) {
  const to = (x_mm, depth_mm, tilt_rad) => {
    const gel_from_indenter = {
      position_mm: [x_mm, 2, touch_mm - depth_mm],
      rotation: [Math.sin(tilt_rad / 2), 0, 0, Math.cos(tilt_rad / 2)],
    };
    return { do: "step", since_s: 0.02, gel_from_indenter };
  };
  const down = (x_mm) => [0.3, 0.6, 0.9, 1.2, 1.5].map((depth_mm) => to(x_mm, depth_mm, 0));
  const aside = [0.4, 0.8, 1.2, 1.6, 2].map((way_mm) => to(-4 + way_mm, 1.5, 0));
  const tilted = [0.03, 0.06, 0.09].map((tilt_rad) => to(-2, 1.5, tilt_rad));
  return [...down(-4), ...aside, { do: "rest" }, ...down(-2), ...tilted];
}

for (const indenter of ["sphere-25", "cube", "x", "ring", "triangle", "wedge", "cylinder"]) {
  test(`a press of ${indenter}`, async () => {
    const engine = await wasmEngine();
    await engine.open("phystac.toml", sensorText);
    const mesh = await engine.prepare(indenter, 2, 2000);
    const steps = requests(mesh.touch_mm);
    const [, prepared, ...answers] = nativeAnswers([
      { do: "open", file: "phystac.toml", text: sensorText },
      { do: "prepare", indenter, depth_mm: 2, max_nodes: 2000 },
      ...steps,
    ]);
    assert.equal(mesh.n_nodes, prepared.n_nodes);
    let worst = { readings: 0, force: 0 };
    const took_ms = [];
    for (const [index, step] of steps.entries()) {
      if (step.do === "rest") {
        await engine.rest();
        continue;
      }
      const found = await engine.step(step.gel_from_indenter, step.since_s);
      const off = deviation(found, answers[index]);
      worst = { readings: Math.max(worst.readings, off.readings), force: Math.max(worst.force, off.force) };
      took_ms.push(found.took_ms);
    }
    took_ms.sort((a, b) => a - b);
    console.log(`${indenter}: ${mesh.n_nodes} nodes, readings ${(100 * worst.readings).toFixed(4)} %, force ${(100 * worst.force).toFixed(4)} %, median ${took_ms[took_ms.length >> 1].toFixed(1)} ms`);
    assert.ok(worst.readings < 0.01 && worst.force < 0.01, JSON.stringify(worst));
  });
}

test("a surrogate with three shapes", async () => {
  const engine = await wasmEngine();
  const { indenters } = await engine.open("phystac.toml", sensorText);
  await engine.keep(surrogateFile, readFileSync(surrogateFile));
  const { touch_mm } = await engine.prepare("sphere-25", 2, 400);
  const body = (name, x_mm, depth_mm) => ({
    shape: indenters.find((indenter) => indenter.name === name).shape,
    gel_from_indenter: { position_mm: [x_mm, 1, touch_mm - depth_mm], rotation: [0, 0, 0, 1] },
  });
  const bodies = [body("sphere-25", -10, 1), body("ring", 0, 0.5), body("cube", 10, 0.3)];
  const expected = nativeAnswers(
    [
      { do: "open", file: "phystac.toml", text: sensorText },
      { do: "prepare", indenter: "sphere-25", depth_mm: 2, max_nodes: 400 },
      { do: "touch", surrogate: surrogateFile, bodies },
    ],
    [surrogateFile],
  ).at(-1);
  const found = await engine.touch(surrogateFile, bodies);
  const off = deviation(found, expected);
  assert.ok(off.readings < 1e-4 && off.force < 1e-4 && Math.abs(found.ood_score - expected.ood_score) < 1e-3, JSON.stringify(off));
  const took_ms = [];
  for (let frame = 0; frame < 60; frame++) took_ms.push((await engine.touch(surrogateFile, bodies)).took_ms);
  console.log(`readings ${(100 * off.readings).toFixed(5)} %, median ${took_ms.sort((a, b) => a - b)[30].toFixed(2)} ms`);
});

test("errors are those of the native engine", async () => {
  const engine = await wasmEngine();
  for (const [from, to] of [
    ["size_mm = [34.0, 18.0, 8.5]", "size_mm = [34.0, -18.0, 8.5]"],
    ["poissons_ratio = 0.495", "poissons_ratio = 0.7"],
    ['chip = "CPS135B"', "chip = CPS135B"],
  ]) {
    const text = sensorText.replace(from, to);
    assert.notEqual(text, sensorText);
    const [{ error }] = nativeAnswers([{ do: "open", file: "mine.toml", text }]);
    assert.match(error, /mine\.toml:\d+/);
    await assert.rejects(engine.open("mine.toml", text), { message: error });
  }
});
