#!/usr/bin/env bash
# What CI runs on the hardware: makes the boards of all variants, and has KiCad check them. Where KiCad 9 cannot be had, it says so and still makes the rest.
# `hardware/check.sh --install` installs KiCad, where it can be had, and ends.
set -euo pipefail
cd "$(dirname "$0")/.."

has_kicad() { command -v kicad-cli >/dev/null && [ "$(kicad-cli --version | cut -d. -f1)" = 9 ]; }

# Debian has KiCad 9 in its backports. Their archive is that of this machine's own sources, under another suite.
install_kicad() {
  [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null || return 1
  local codename uri list=/etc/apt/sources.list.d/twintac-backports.list
  codename=$(. /etc/os-release && [ "${ID:-}" = debian ] && echo "${VERSION_CODENAME:-}")
  [ -n "$codename" ] || return 1
  if ! apt-cache policy | grep -q "n=$codename-backports"; then
    uri=$(cat /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources 2>/dev/null |
      awk '$1 == "URIs:" { print $2 } $1 == "deb" { for (i = 2; i <= NF; i++) if ($i ~ /:\/\//) { print $i; break } }' |
      grep '/debian/*$' | head -1)
    [ -n "$uri" ] || return 1
    echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $uri $codename-backports main" >"$list"
    apt-get update -qq || { rm -f "$list"; return 1; }
  fi
  DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends -t "$codename-backports" kicad >/dev/null
}

if ! has_kicad; then
  install_kicad || true
fi
if [ "${1:-}" = --install ]; then
  exit 0
fi
if ! has_kicad; then
  echo "skipped: KiCad's checks and fabrication files (KiCad 9 cannot be installed here)"
fi
# As `cargo xtask hardware` does, but with the dependencies as the tests of the workspace have them: they are compiled once.
cargo build --release --quiet --workspace --bin twintac-hardware
"${CARGO_TARGET_DIR:-target}/release/twintac-hardware" --root . --release "$@"
