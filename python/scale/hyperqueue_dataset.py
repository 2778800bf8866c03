"""A data set as tasks of HyperQueue on this machine, with HyperQueue's Python package; the program
`hq` is not needed.

    python python/scale/hyperqueue_dataset.py presses 64 --presses 10000 --fast

The arguments are the folder, the number of shards, and options of `twintac dataset`. A failed task
is not repeated in the same run; the same command again makes the missing shards.
"""

import os
import sys
from pathlib import Path

from hyperqueue import Job, LocalCluster
from hyperqueue.cluster import WorkerConfig

N_WORKERS = 2


def main(folder: str, n_shards: int, options: list[str]) -> int:
    """Makes all shards. Returns the number of failed ones."""
    twintac = str(Path(sys.executable).with_name("twintac"))
    logs = Path(folder).absolute().with_name(f"{Path(folder).name}.logs")
    logs.mkdir(parents=True, exist_ok=True)
    job = Job(max_fails=None, name="twintac")
    for number in range(1, n_shards + 1):
        words = [twintac, "dataset", *options, "--out", os.path.abspath(folder), "--shard", f"{number}/{n_shards}", "--threads", "1"]
        job.program(words, stdout=str(logs / f"{number}.out"), stderr=str(logs / f"{number}.err"))
    with LocalCluster() as cluster:
        for _ in range(N_WORKERS):
            cluster.start_worker(WorkerConfig(cores=1))
        client = cluster.client()
        submitted = client.submit(job)
        client.wait_for_jobs([submitted], raise_on_error=False)
        return len(client.get_failed_tasks(submitted))


if __name__ == "__main__":
    n_failed = main(sys.argv[1], int(sys.argv[2]), sys.argv[3:])
    if n_failed:
        sys.exit(f"{n_failed} shards failed; the same command makes them")
