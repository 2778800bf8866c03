// The package for npm, installed from its archive: its own example presses the gel, and its types hold.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";

import { root, wasmFile } from "./engines.mjs";

test("the package is installed and presses the gel", () => {
  const made = join(root, "target/web/package");
  execFileSync("node", [join(root, "web/package.mjs"), wasmFile, made]);
  const folder = mkdtempSync(join(tmpdir(), "twintac-"));
  try {
    execFileSync("npm", ["install", "--silent", "--offline", "--no-audit", "--no-fund", join(made, "twintac-0.1.0.tgz")], { cwd: folder });
    const [, example] = readFileSync(join(made, "README.md"), "utf8").match(/```js\n(.*?)```/s);
    writeFileSync(join(folder, "example.mjs"), example);
    const lines = execFileSync("node", ["example.mjs"], { cwd: folder }).toString();
    assert.match(lines, /^1 -0\.\d+ \[/m, lines);
    writeFileSync(join(folder, "example.mts"), `${example}\nconst wrong: number = (await engine.open("", "")).name;\n`);
    const tsc = join(root, "web/node_modules/typescript/bin/tsc");
    const types = ["--noEmit", "--strict", "--module", "nodenext", "--target", "es2022", "--lib", "es2022,dom", "example.mts"];
    const found = (() => {
      try {
        return execFileSync("node", [tsc, ...types], { cwd: folder }).toString();
      } catch (error) {
        return error.stdout.toString();
      }
    })();
    // The line that is wrong, and no other.
    assert.match(found, /Type 'string' is not assignable to type 'number'/);
    assert.equal(found.trim().split("\n").length, 1, found);
  } finally {
    rmSync(folder, { recursive: true });
  }
});
