"""Makes the studies of recorded sensors again: accuracy, uncertainty, adaptation and localization,
in docs/benchmarks/cross-validation and docs/results.

    cargo build --release --bin twintac
    python docs/studies.py [--data ../shared/data] [--out runs/studies] [NAME...]

Runs are in the folder `--out`; what is complete there is not computed again. A study is written
when all of it is there. With names, only those studies are made. All of them take about forty minutes
on two cores.
"""

import argparse
import json
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parent.parent
RESULTS = ROOT / "docs/results"
CROSS_VALIDATION = ROOT / "docs/benchmarks/cross-validation"

MEMORY_ALONE = '[train]\nvariants = ["pressure+memory"]\n'
DEMO = "[simulate]\nedges_per_height = 6.0\nedges_per_contact_radius = 5.0\n" + MEMORY_ALONE + "epochs = 120\n"  # as crates/app/run/src/demo.rs
ARRAY = '[split]\ntraining_places = 20\nblock_mm = 3.0\n[train]\nvariants = ["pressure+memory"]\n'


@dataclass(frozen=True)
class Recorded:
    """Recordings of a sensor, and the settings of its twin (TOML)."""

    sensor: str
    files: str
    settings: str = ""


RUNS = {
    "gel-d": Recorded("strip4-gel-d", "strip4/gelD_*.csv"),
    "gel-a": Recorded("strip4-gel-a", "strip4/gelA_*.csv"),
    "gel-b": Recorded("strip4-gel-b", "strip4/gelB_*.csv"),
    "gel-a-memory": Recorded("strip4-gel-a", "strip4/gelA_*.csv", MEMORY_ALONE),
    "gel-b-memory": Recorded("strip4-gel-b", "strip4/gelB_*.csv", MEMORY_ALONE),
    "ds10": Recorded("array8-ds10", "array8/DS10*.csv", ARRAY),
    "ds20": Recorded("array8-ds20", "array8/DS20*.csv", ARRAY),
}


class Studies:
    """The runs and the commands that the studies are made with."""

    def __init__(self, program: Path, data: Path, out: Path) -> None:
        self.program, self.data, self.out = program, data, out

    def twintac(self, *arguments: object) -> str:
        """The standard output of a command; how long it takes goes to standard error."""
        words = [str(argument) for argument in arguments]
        begin = time.monotonic()
        print("twintac", *words, file=sys.stderr, flush=True)
        done = subprocess.run([self.program, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        if done.returncode != 0:
            sys.exit(f"error: the command above ended with {done.returncode}:\n{done.stderr}")
        print(f"    {time.monotonic() - begin:.0f} s", file=sys.stderr, flush=True)
        return done.stdout

    def run(self, name: str, settings: str | None = None) -> Path:
        """The folder of a run: the stages of `reproduce` on the recordings of its sensor."""
        recorded, folder = RUNS[name.removesuffix("-tip")], self.out / name
        toml = self.settings(name, recorded.settings if settings is None else settings)
        sensor = ROOT / f"sensors/{recorded.sensor}.toml"
        self.twintac("reproduce", "--sensor", sensor, "--recordings", self.data / recorded.files, "--settings", toml, "--out", folder)
        return folder

    def demo(self) -> Path:
        """The folder of a run on the presses and with the settings of the demo."""
        folder, toml = self.out / "demo", self.settings("demo", DEMO)
        sensor, protocol = ROOT / "sensors/phystac.toml", ROOT / "protocols/demo.toml"
        self.twintac("record", "--at-once", "--lab", "default", "--sensor", sensor, "--protocol", protocol, "--settings", toml, "--out", folder)
        self.twintac("simulate", "--run", folder)
        return folder

    def settings(self, name: str, text: str) -> Path:
        """A file of settings."""
        self.out.mkdir(parents=True, exist_ok=True)
        path = self.out / f"{name}.toml"
        path.write_text(text)
        return path

    def cross_validate(self, run: Path, *arguments: object) -> str:
        return self.twintac("cross-validate", "--run", run, *arguments, "--json")


def one_seed(studies: Studies) -> None:
    """Errors of each sensor's twin on held-out locations, as `reproduce` and `demo` report them."""
    demo = studies.out / "one-seed-demo"
    studies.twintac("demo", "--out", demo)
    found: dict[str, Any] = {"command": "python docs/studies.py one-seed"}
    for name, run in (("gel_d", studies.run("gel-d")), ("gel_a", studies.run("gel-a")), ("gel_b", studies.run("gel-b")), ("demo", demo)):
        metrics = json.loads((run / "metrics.json").read_text())
        baselines = metrics["baselines"]
        found[name] = {
            "sensor": metrics["sensor"],
            "provenance": metrics["provenance"],
            "variant": metrics["variant"],
            "held_out_presses": metrics["held_out_presses"],
            "twin": metrics["twin"]["nearest_in_contact_percent"],
            "parametric_baseline": baselines["kernel"]["nearest_in_contact_percent"],
            "polynomial": baselines["polynomial"]["nearest_in_contact_percent"],
            "repeatability": metrics["repeatability"] and metrics["repeatability"]["nearest_in_contact_percent"],
        }
    keep(RESULTS / "accuracy.json", json.dumps(found))


def cross_validation(studies: Studies) -> None:
    """Errors on held-out locations, presses, files and taxels, without each step of the twin."""
    for name, run in (("strip4-gel-d", "gel-d"), ("strip4-gel-a", "gel-a-memory"), ("strip4-gel-b", "gel-b-memory")):
        folder = studies.run(run)
        found = studies.cross_validate(folder, "--held-out", "place,press,file,taxel", "--ablation")
        keep(CROSS_VALIDATION / f"{name}.json", found)
        shutil.copy(folder / "cross_validation/errors.png", CROSS_VALIDATION / f"{name}.png")
    folder = studies.run("ds10")
    keep(CROSS_VALIDATION / "array8-ds10.json", studies.cross_validate(folder, "--held-out", "place"))
    shutil.copy(folder / "cross_validation/errors.png", CROSS_VALIDATION / "array8-ds10.png")


def certainty(studies: Studies) -> None:
    """Coverage of the intervals, and detection of out-of-distribution contacts.

    The tip radius of gel D is that of one division of its presses: fitting it for each takes long.
    """
    demo = studies.demo()
    keep(RESULTS / "certainty/demo-place.json", studies.cross_validate(demo, "--held-out", "place", "--seeds", 3, "--intervals"))
    keep(RESULTS / "certainty/demo-apart.json", studies.cross_validate(demo, "--held-out", "depth,region,indenter", "--seeds", 2))
    twin = json.loads((studies.run("gel-d") / "model/twin.json").read_text())
    tip = studies.run("gel-d-tip", f"[bench]\ntip_radii_mm = [{twin['bench']['tip_radius_mm']['value']}]\n{MEMORY_ALONE}")
    keep(RESULTS / "certainty/gel-d-place.json", studies.cross_validate(tip, "--held-out", "place", "--seeds", 5, "--intervals"))
    keep(RESULTS / "certainty/gel-d-apart.json", studies.cross_validate(tip, "--held-out", "depth,region", "--seeds", 2))


def locate(studies: Studies) -> None:
    """Where and how deep the strips are pressed."""
    found: dict[str, Any] = {
        "what": "Errors of location and depth, by trained twins, frame by frame, on presses that the twin was not trained on (unseen) "
        "and on those that it was trained on (trained_on). real.",
        "command": "python docs/studies.py locate",
    }
    for name in ("gel-d", "gel-a", "gel-b"):
        run = studies.run(name)
        recordings = run / "recordings/presses.parquet"
        errors = studies.twintac("locate", "--model", run / "training/held-out", "--recordings", recordings, "--errors")
        found[name.replace("-", "_")] = json.loads(errors)
    keep(RESULTS / "locate.json", json.dumps(found))


def adaptation(studies: Studies) -> None:
    """Errors of a twin that was adapted to another gel with a few presses."""
    found: dict[str, Any] = {
        "what": "Error of one gel's twin, adapted to another gel with few presses, on that gel's held-out presses, beside a twin that was "
        "trained on all of that gel's training presses. Five choices of presses each, seeds 1 to 5.",
        "provenance": "real",
        "command": "python docs/studies.py adaptation",
        "curves": [],
    }
    pairs = (("gel-d", "gel-a"), ("gel-d", "gel-b"), ("gel-a", "gel-d"), ("gel-b", "gel-d"), ("ds10", "ds20"), ("ds20", "ds10"))
    for source, target in pairs:
        model, run, out = studies.run(source) / "model", studies.run(target), studies.out / f"{source}-to-{target}"
        curve = json.loads(studies.twintac("adapt", "--model", model, "--run", run, "--curve", "1,2,5,10,20", "--out", out, "--json"))
        found["curves"].append({
            "learned_from": RUNS[source].sensor,
            "sensor": curve["sensor"],
            "evaluated_presses": curve["evaluated_presses"],
            "training_presses": curve["training_presses"],
            "as_learned_nearest_in_contact_percent": curve["as_learned"]["nearest_in_contact_percent"],
            "trained_on_all_nearest_in_contact_percent": curve["trained_on_all"]["nearest_in_contact_percent"],
            "points": [
                {
                    "presses": point["presses"],
                    "nearest_in_contact_percent": point["nearest_in_contact"]["mean_percent"],
                    "standard_deviation_percent": point["nearest_in_contact"]["deviation_percent"],
                    "over_trained_on_all": point["over_trained_on_all"],
                    "seeds_percent": [figures["nearest_in_contact_percent"] for figures in point["seeds"]],
                }
                for point in curve["points"]
            ],
        })
        shutil.copy(out / "curve.svg", RESULTS / f"adaptation/{source}-to-{target}.svg")
    keep(RESULTS / "adaptation.json", json.dumps(found))


STUDIES: dict[str, Callable[[Studies], None]] = {
    "one-seed": one_seed,
    "cross-validation": cross_validation,
    "locate": locate,
    "certainty": certainty,
    "adaptation": adaptation,
}


def keep(path: Path, text: str) -> None:
    """Writes figures as JSON, with four digits: more would differ from machine to machine."""
    partial = path.with_suffix(".partial")
    partial.write_text(json.dumps(rounded(json.loads(text)), indent=1, ensure_ascii=False) + "\n")
    partial.rename(path)
    print(f"    wrote {path.relative_to(ROOT)}", file=sys.stderr, flush=True)


def rounded(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: rounded(own) for name, own in value.items()}
    if isinstance(value, list):
        return [rounded(own) for own in value]
    return float(f"{value:.4g}") if isinstance(value, float) else value


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("names", nargs="*", metavar="NAME", help=f"studies to make [default: all]: {', '.join(STUDIES)}")
    arguments.add_argument("--data", type=Path, default=ROOT.parent / "shared/data", help="folder of the recordings, with strip4 and array8 in it")
    arguments.add_argument("--out", type=Path, default=ROOT / "runs/studies", help="folder of the runs")
    arguments.add_argument("--twintac", type=Path, default=ROOT / "target/release/twintac", help="the program")
    given = arguments.parse_args()
    unknown = set(given.names) - set(STUDIES)
    if unknown:
        arguments.error(f"there is no study {', '.join(sorted(unknown))}; there are {', '.join(STUDIES)}")
    if not given.data.is_dir():
        arguments.error(f"the recordings are not in {given.data}; name their folder with --data")
    studies = Studies(given.twintac, given.data, given.out)
    for name in given.names or STUDIES:
        STUDIES[name](studies)


if __name__ == "__main__":
    main()
