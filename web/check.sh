#!/bin/sh
# Makes the page and tests it: types, the engine beside the library, the engine in WebAssembly beside the native one, the page in a browser.
# Says what is skipped where a tool is missing.
set -eu
cd "$(dirname "$0")"
skipped=""

# With the dependencies as the tests of the workspace have them: they are compiled once.
cargo build --release --locked --workspace --bin twintac --example answer

if ! command -v node >/dev/null || ! command -v npm >/dev/null; then
    echo "skipped: page and WebAssembly, as Node.js and npm are missing"
    exit 0
fi
if ! [ -e "$(rustc --print target-libdir --target wasm32-unknown-unknown)" ] && ! [ -d /usr/lib/rustlib/src/rust/library ]; then
    echo "skipped: page and WebAssembly, as the standard library for WebAssembly is missing (web/README.md)"
    exit 0
fi
[ -d node_modules ] || npm ci --no-audit --no-fund
npx tsc --noEmit

(cd .. && cargo xtask web)
gzip -9 -c ../target/wasm32-unknown-unknown/web/twintac_web.wasm | wc -c | awk '{ print "module with gzip: " $1 / 1e6 " MB"; exit $1 > 1e6 }'

node --test tests/engine.test.mjs tests/package.test.mjs

if [ -x "${CHROMIUM:-/usr/bin/chromium}" ]; then
    node --test --test-concurrency=1 tests/page.test.mjs tests/view.test.mjs
    python=${TWINTAC_PYTHON:-python3}
    if "$python" -c "import mkdocs, twintac" 2>/dev/null; then
        (cd .. && NO_MKDOCS_2_WARNING=1 "$python" -m mkdocs build --strict --quiet) # target/site, now with the page
        node --test tests/site.test.mjs
    else
        skipped="$skipped the first page of the documentation (pip install './python[docs]', or name a Python in TWINTAC_PYTHON)"
    fi
else
    skipped="$skipped the page in a browser (apt install chromium, or name one in CHROMIUM)"
fi
[ -z "$skipped" ] || echo "skipped:$skipped"
