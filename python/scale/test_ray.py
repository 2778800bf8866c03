"""Tests that a data set by a Ray cluster of two nodes, one of which is killed, has the same bytes
as one by a single process.
"""

from pathlib import Path
from typing import Any

import pytest

from twintac import Dataset
from twintac.ray import make_dataset

ray = pytest.importorskip("ray")

N_SHARDS = 16  # many are missing when a node is killed
OPTIONS: dict[str, Any] = {"n_presses": 1600, "fast": True}


def test_a_node_that_is_killed_costs_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from ray.cluster_utils import Cluster

    cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 0})
    nodes = [cluster.add_node(num_cpus=1) for _ in range(2)]
    ray.init(address=cluster.address)
    killed: list[int] = []

    def kill_one(work: str, done: int, total: int, state: str) -> None:
        if done >= 3 and not killed:
            cluster.remove_node(nodes[1], allow_graceful=False)  # SIGKILL to all of its processes
            assert not nodes[1].any_processes_alive() and nodes[0].any_processes_alive()
            killed.append(done)

    try:
        manifests = make_dataset(tmp_path / "by-ray", N_SHARDS, progress=kill_one, **OPTIONS)
    finally:
        ray.shutdown()
        cluster.shutdown()
    assert killed and killed[0] < N_SHARDS - 2, "a node was killed in the middle"
    assert [manifest["shard"] for manifest in manifests] == list(range(1, N_SHARDS + 1))
    merged = Dataset.merge(tmp_path / "by-ray")
    whole = Dataset(**OPTIONS).make(tmp_path / "whole")
    assert Path(merged["merged"]).read_bytes() == Path(whole["parquet"]).read_bytes()
    with capsys.disabled():
        print(f"\nRay: killed after {killed[0]} of {N_SHARDS} shards; merged {whole['parquet_sha256']}")
