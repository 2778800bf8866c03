#!/bin/sh
# Builds the programs of both boards into firmware/target, and says how large they are.
#
# TWINTAC_CHIP names the chips as in the table of docs/guides/hardware.md (MS5837-30BA if it does not), TWINTAC_SCALE says how many counts a
# Pa is, for a CPS135B. Needs rustup; with picotool, which is not needed to build, also makes a file to drop on the Pico.
set -eu
cd "$(dirname "$0")"
out="${CARGO_TARGET_DIR:-target}"
# Takes a program's package, its target, and the sections that are in RAM.
build() {
    rustup target list --installed | grep -qx "$2" || rustup target add "$2"
    cargo build --release --locked -p "$1" --target "$2"
    if command -v size > /dev/null; then
        size -A "$out/$2/release/$1" | awk -v name="$1" -v ram="^[.]($3)$" '
            $1 ~ /^[.](vector_table|start_block|trap|rwtext|data|flash[.]appdesc|rodata|text)$/ { flash += $2 }
            $1 ~ ram { taken += $2 }
            END { print name ": " flash " bytes of flash, " taken " bytes of RAM besides the stack" }'
    fi
}
build twintac-pico2 thumbv8m.main-none-eabihf 'data|bss|uninit'
build twintac-esp32c3 riscv32imc-unknown-none-elf 'trap|rwtext|data|bss'
if command -v picotool > /dev/null; then
    picotool uf2 convert "$out/thumbv8m.main-none-eabihf/release/twintac-pico2" -t elf "$out/twintac-pico2.uf2"
fi
