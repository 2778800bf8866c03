"""Tests of recordings through Arrow."""

from pathlib import Path

import numpy as np
import pytest
from conftest import DATA

from twintac import Recording

RECORDING = Recording.import_csv(DATA / "import.toml", DATA / "presses.csv")


def test_an_arrow_table_is_the_parquet_file(tmp_path: Path) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    RECORDING.save(tmp_path / "presses.parquet")
    table, expected = pyarrow.table(RECORDING), parquet.read_table(tmp_path / "presses.parquet")
    assert table.column_names == expected.column_names
    for name in expected.column_names:
        assert table[name].to_pylist() == expected[name].to_pylist(), name
    assert table.schema.metadata[b"twintac.provenance"] == b"emulated"
    assert pyarrow.types.is_string(table["press"].type) and pyarrow.types.is_boolean(table["t0_valid"].type)


def test_polars_and_pandas_take_a_recording_as_it_is() -> None:
    polars, pandas = pytest.importorskip("polars"), pytest.importorskip("pandas")
    frames = polars.DataFrame(RECORDING)
    assert frames.equals(RECORDING.to_polars())
    columns = RECORDING.columns()
    assert frames.columns == list(columns)
    for name, values in columns.items():
        assert np.array_equal(frames[name].to_numpy(), values), name
    if hasattr(pandas.DataFrame, "from_arrow"):
        pandas.testing.assert_frame_equal(pandas.DataFrame.from_arrow(RECORDING), RECORDING.to_pandas(), check_dtype=False)


def test_a_stream_outlives_its_recording() -> None:
    pyarrow = pytest.importorskip("pyarrow")
    recording = Recording.import_csv(DATA / "import.toml", DATA / "presses.csv")
    n_frames = len(recording.columns()["time_s"])
    stream = recording.__arrow_c_stream__()
    del recording
    del stream  # which was not consumed
    table = pyarrow.table(Recording.import_csv(DATA / "import.toml", DATA / "presses.csv"))
    assert table.num_rows == n_frames


def test_a_missing_reading_is_missing(tmp_path: Path) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    RECORDING.save(tmp_path / "presses.parquet")
    table = parquet.read_table(tmp_path / "presses.parquet")
    for name, value in (("t0_kpa", None), ("t0_valid", False)):
        index, values = table.column_names.index(name), table[name].to_pylist()
        values[5] = value
        table = table.set_column(index, table.schema.field(index), pyarrow.array(values, table.schema.field(index).type))
    parquet.write_table(table, tmp_path / "missing.parquet")
    recording = Recording.load(tmp_path / "missing.parquet")
    missing = np.isnan(recording.columns()["t0_kpa"])
    assert missing.sum() == 1 and missing[5]
    assert pyarrow.table(recording)["t0_kpa"].null_count == 1
