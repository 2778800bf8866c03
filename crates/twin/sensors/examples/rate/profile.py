"""Counts the instructions of a step by function:
`python3 crates/twin/sensors/examples/rate/profile.py` writes docs/benchmarks/sensors-profile.md.

Valgrind's callgrind counts every instruction. The program's line tables (`addr2line`) assign the
instructions of inlined functions.
"""

import collections
import os
import re
import subprocess
import tempfile

COMMAND = "python3 crates/twin/sensors/examples/rate/profile.py"
BODIES = {"ball": "ball", "box": "box", "random-mesh": "closed surface"}
N_STEPS, N_SENSORS = 2, 1024
LEAST_PERCENT = 1.0
TABLES = ["twintac-fast", "twintac-sensors", "twintac-random", "digitac"]


def build():
    tables = [f'profile.release.package.{name}.debug="line-tables-only"' for name in TABLES]
    command = ["cargo", "build", "--release", "--package", "twintac-sensors", "--example", "rate"]
    for table in tables:
        command += ["--config", table]
    subprocess.run(command, check=True)
    return os.path.join(os.environ.get("CARGO_TARGET_DIR", "target"), "release/examples/rate")


def counts(program, body):
    """Instructions at each address of the program, and in each function of libraries."""
    own, others = collections.Counter(), collections.Counter()
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "out")
        valgrind = ["valgrind", "--tool=callgrind", "--dump-instr=yes", "--compress-strings=no", "--compress-pos=no"]
        valgrind += ["--toggle-collect=*Scene*step*", f"--callgrind-out-file={out}"]
        subprocess.run([*valgrind, program, "--steps", body, str(N_STEPS)], check=True, stderr=subprocess.DEVNULL)
        is_own, function, is_call = False, "", False
        for line in open(out):
            if line.startswith("ob="):
                is_own = line[3:].strip().endswith(os.path.basename(program))
            elif line.startswith("fn="):
                function = line[3:].strip()
            elif line.startswith("calls="):
                is_call = True
            elif line.startswith("0x"):
                if not is_call:
                    address, *_, count = line.split()
                    if is_own:
                        own[int(address, 16)] += int(count)
                    else:
                        others[function.split("'")[0]] += int(count)
                is_call = False
    return own, others


def functions(program, own):
    """Instructions by the innermost function of this project, and its file."""
    asked = "\n".join(hex(address) for address in own)
    command = ["addr2line", "-a", "-i", "-f", "-C", "-e", program]
    lines = subprocess.run(command, input=asked, capture_output=True, text=True, check=True).stdout.splitlines()
    found, address = collections.Counter(), 0
    chains = collections.defaultdict(list)
    for line in lines:
        if line.startswith("0x"):
            address = int(line, 16)
        else:
            chains[address].append(line)
    for address, count in own.items():
        chain = chains[address]
        pairs = list(zip(chain[::2], chain[1::2]))
        ours = [pair for pair in pairs if "crates/" in pair[1] and "registry/" not in pair[1] and "stdarch" not in pair[1]]
        name, place = (ours or pairs or [("?", "?")])[0]
        name = re.sub(r"<.*", "", re.sub(r"^.*::(?=\w)", "", re.sub(r"<[^<>]*>|::h[0-9a-f]{16}$", "", name)))
        file = re.sub(r"^.*/?crates/", "crates/", place.split(":")[0]) if ours else "others"
        found[(name or "?", file)] += count
    return found


def main():
    program = build()
    text = "# What a step of the sensors consists of\n\n"
    text += f"Made by `{COMMAND}` (simulated data): instructions a reading, with a twin's relaxation and the whole sensor variation, by the innermost of our "
    text += "functions that they belong to, counted by Valgrind's callgrind on one thread. Functions of less than "
    text += f"{LEAST_PERCENT:.0f} % are summed up.\n"
    for body, words in BODIES.items():
        own, others = counts(program, body)
        found = functions(program, own)
        found.update({(name, "libraries"): count for name, count in others.items()})
        n_readings, total = N_STEPS * N_SENSORS, sum(found.values())
        text += f"\n## {words.capitalize()}\n\n{total / n_readings:,.0f} instructions a reading.\n\n"
        text += "| function | file | instructions a reading | % |\n|---|---|---:|---:|\n"
        rest = total
        for (name, file), count in found.most_common():
            percent = 100 * count / total
            if percent < LEAST_PERCENT:
                break
            rest -= count
            text += f"| `{name}` | {file} | {count / n_readings:,.0f} | {percent:.1f} |\n"
        text += f"| all others | | {rest / n_readings:,.0f} | {100 * rest / total:.1f} |\n"
    with open("docs/benchmarks/sensors-profile.md", "w") as page:
        page.write(text)


if __name__ == "__main__":
    main()
