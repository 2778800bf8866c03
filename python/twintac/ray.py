"""Data sets on many machines: one Ray task for each shard, written to any path that fsspec
supports.

`make_shard` is the task by itself, for other schedulers. The module needs the packages ray and
fsspec; `pip install './python[ray]'` in a checkout installs them.
"""

import hashlib
import json
import os
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from uuid import uuid4

from twintac._error import Error
from twintac._progress import Progress, listener
from twintac._twintac import Dataset

__all__ = ["make_dataset", "make_shard"]

_PATHS = ("sensor", "protocol", "fast", "twin", "variation", "settings")
_CHUNK = 1 << 20


def make_dataset(
    folder: str | os.PathLike[str],
    n_shards: int,
    *,
    cpus: int = 1,
    storage_options: Mapping[str, Any] | None = None,
    progress: Progress = None,
    **options: Any,
) -> list[dict[str, Any]]:
    """Makes all shards of a data set as tasks of the connected Ray cluster, or of a local one.

    A task whose worker fails is repeated elsewhere. Complete shards are kept, so that the same call
    continues a data set that was interrupted. `twintac dataset --merge` then merges the shards of a
    folder into one file.

    Args:
        folder: destination of the shards: a folder that all machines see, or a URL such as
            `s3://bucket/presses`.
        n_shards: number of shards.
        cpus: cores of a task, and threads with which it computes presses.
        storage_options: options of fsspec for the URL.
        progress: display of the progress, see `twintac.Progress`.
        options: arguments of `twintac.Dataset`. Files are read where the tasks run.

    Returns:
        The manifests of the shards, in order.

    Raises:
        twintac.Error: for options that are out of range, and for a folder that holds another data
            set.
        ImportError: if a package is missing.
    """
    ray = _needed("ray")
    options = {name: _absolute(value) if name in _PATHS else value for name, value in options.items()}
    Dataset(**options)  # raises their errors here once, and not in every task
    task = ray.remote(make_shard).options(
        num_cpus=cpus, max_retries=-1, runtime_env={"env_vars": {"RAYON_NUM_THREADS": str(cpus)}}
    )
    tell = listener(progress) or (lambda *_: None)
    tell("shards", 0, n_shards, "")
    numbers = {
        task.remote(_absolute(folder), number, n_shards, storage_options=storage_options, **options): number
        for number in range(1, n_shards + 1)
    }
    manifests: dict[int, dict[str, Any]] = {}
    waiting = list(numbers)
    try:
        while waiting:
            done, waiting = ray.wait(waiting, timeout=1.0)
            for shard in done:
                manifests[numbers[shard]] = ray.get(shard)
                tell("shards", len(manifests), n_shards, "")
    finally:
        for shard in waiting:
            ray.cancel(shard)
    return [manifests[number] for number in sorted(manifests)]


def make_shard(
    folder: str,
    shard: int,
    of: int,
    *,
    storage_options: Mapping[str, Any] | None = None,
    **options: Any,
) -> dict[str, Any]:
    """Makes one shard in a folder or at a URL, unless it is complete there.

    The shard is first made on this machine. Each file is then written under a temporary name and
    renamed, the manifest last. So a shard with a manifest is complete, even with other writers.

    Args:
        folder: the folder or URL.
        shard: number of the shard, from 1.
        of: number of all shards.
        storage_options: options of fsspec for the URL.
        options: arguments of `twintac.Dataset`.

    Returns:
        The manifest of the shard.

    Raises:
        twintac.Error: for options that are out of range, and for a folder that holds another data
            set.
        ImportError: if a package is missing.
    """
    files, root = _needed("fsspec").core.url_to_fs(folder, **(storage_options or {}))
    dataset = Dataset(**options)
    files.makedirs(root, exist_ok=True)
    described = f"{root}/dataset.toml"
    if files.exists(described):
        _expect(folder, files.cat_file(described), dataset)
    parquet, manifest = (f"{root}/shard-{shard:06}-of-{of:06}{end}" for end in (".parquet", ".json"))
    if files.exists(manifest) and files.exists(parquet):
        kept: dict[str, Any] = json.loads(files.cat_file(manifest))
        if kept["parquet_sha256"] == _sha256(files, parquet):
            return kept
    with TemporaryDirectory() as desk:
        made = dataset.make(desk, shard, of, progress=False)
        if not files.exists(described):
            for name in ("sensor.toml", "dataset.toml"):
                _put(files, Path(desk, name), f"{root}/{name}")
        _expect(folder, files.cat_file(described), dataset)
        _put(files, Path(made["parquet"]), parquet)
        _put(files, Path(made["manifest_file"]), manifest)
        new: dict[str, Any] = json.loads(Path(made["manifest_file"]).read_bytes())
        return new


def _expect(folder: str, found: bytes, dataset: Dataset) -> None:
    if found.decode() != dataset.identity:
        problem = f"{folder} is a data set of other settings (see dataset.toml there): give another folder"
        raise Error(problem, folder, None, None)


def _put(files: Any, source: Path, target: str) -> None:
    """Writes a file under a temporary name and renames it."""
    above, name = target.rsplit("/", 1)
    temporary = f"{above}/.{uuid4().hex}-{name}"
    files.put_file(str(source), temporary)
    files.mv(temporary, target)


def _sha256(files: Any, path: str) -> str:
    digest = hashlib.sha256()
    with files.open(path, "rb") as file:
        while chunk := file.read(_CHUNK):
            digest.update(chunk)
    return digest.hexdigest()


def _absolute(path: Any) -> Any:
    """An absolute path, valid for tasks in other folders; URLs and other values are unchanged."""
    if isinstance(path, os.PathLike):
        path = os.fspath(path)
    return os.path.abspath(path) if isinstance(path, str) and "://" not in path else path


def _needed(package: str) -> Any:
    try:
        return import_module(package)
    except ImportError as error:
        message = f"twintac.ray needs {package}, which is not installed: pip install ray fsspec"
        raise ImportError(message) from error
