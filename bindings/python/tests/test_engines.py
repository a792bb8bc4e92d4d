"""A million rows through engines for many machines: the local answer, bit for bit."""

import os
import sys

import numpy as np
import pytest
from conftest import SECTIONS, skipped

import fingertip
from fingertip import Fingertip, Scene

pa = pytest.importorskip("pyarrow")

NAMES = ["fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm"]
ROWS, FILES = 1_000_000, 8


@pytest.fixture(scope="module")
def table():
    random = np.random.default_rng(1)
    columns = {"row": np.arange(ROWS), "file": np.repeat(np.arange(FILES), ROWS // FILES)}
    columns |= {name: random.normal(0, 0.3, ROWS) for name in NAMES[:2]}
    columns["fz_N"] = random.normal(-2, 0.4, ROWS)
    columns |= {name: random.normal(0, 2e-3, ROWS) for name in NAMES[3:]}
    return pa.table(columns)


@pytest.fixture(scope="module")
def scene():
    # A detector that remembers: the engines must keep recordings whole.
    return Scene.from_dict({**SECTIONS, "slip": {"detector": "drop", "noise_N": 0.01}})


@pytest.fixture(scope="module")
def local(table, scene):
    """File by file, without any engine."""
    found = []
    for file in range(FILES):
        part = table.slice(file * (ROWS // FILES), ROWS // FILES)
        touches = Fingertip(scene).sense_all([part[name].to_numpy() for name in NAMES], 1e-3)
        found.append(np.column_stack(list(touches.columns().values())))
    return np.concatenate(found)


def assert_same(result, local):
    result = result.sort_by("row")
    names = list(fingertip.Touches(0).columns())
    assert len(result) == ROWS
    for place, name in enumerate(names):
        assert np.array_equal(result[name].to_numpy(), local[:, place]), name


def test_polars(table, scene, local):
    pl = pytest.importorskip("polars")
    sense = fingertip.columns(scene, time_step=1e-3, group="file")
    frame = pl.DataFrame(table)
    schema = sense(frame.head(1)).schema
    result = frame.lazy().map_batches(sense, schema=schema).collect()
    assert_same(result.to_arrow(), local)


def test_dask(table, scene, local):
    try:
        import dask.dataframe as dd
    except ImportError:
        skipped("Dask is not installed: map_partitions is not tested")
    sense = fingertip.columns(scene, time_step=1e-3)
    frame = dd.from_pandas(table.to_pandas(), npartitions=FILES, sort=False)
    # A partition is a file.
    frame = frame.repartition(divisions=[*range(0, ROWS, ROWS // FILES), ROWS - 1])
    meta = sense(table.slice(0, 1)).to_pandas().iloc[:0]
    result = frame.map_partitions(sense, meta=meta).compute(scheduler="processes", num_workers=2)
    assert_same(pa.Table.from_pandas(result, preserve_index=False), local)


def test_ray(table, scene, local):
    if not os.environ.get("FINGERTIP_ENGINES"):
        skipped("FINGERTIP_ENGINES is not set: Ray's map_batches is not tested")
    try:
        import ray
    except ImportError:
        skipped("Ray is not installed: map_batches is not tested")
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False, logging_level="ERROR")
    try:
        sense = fingertip.columns(scene, time_step=1e-3)
        parts = [table.slice(file * (ROWS // FILES), ROWS // FILES) for file in range(FILES)]
        # A block is a file, and a batch a block.
        data = ray.data.from_arrow(parts).map_batches(sense, batch_format="pyarrow", batch_size=None)
        assert_same(pa.concat_tables(ray.get(data.to_arrow_refs())), local)
    finally:
        ray.shutdown()


def test_pyspark(table, scene, local, tmp_path):
    if not os.environ.get("FINGERTIP_ENGINES"):
        skipped("FINGERTIP_ENGINES is not set: PySpark's mapInArrow is not tested")
    try:
        from pyspark.sql import SparkSession
    except ImportError:
        skipped("PySpark is not installed: mapInArrow is not tested")
    import pyarrow.parquet as pq

    for file in range(FILES):
        pq.write_table(table.slice(file * (ROWS // FILES), ROWS // FILES), tmp_path / f"{file}.parquet")
    os.environ["PYSPARK_PYTHON"] = sys.executable
    spark = (
        SparkSession.builder.master("local[2]")
        .config("spark.ui.enabled", "false")
        .config("spark.sql.execution.arrow.pyspark.enabled", "true")
        .config("spark.sql.files.openCostInBytes", "1g")
        .config("spark.driver.memory", "2g")
        .getOrCreate()
    )
    try:
        sense = fingertip.columns(scene, time_step=1e-3, group="file")

        def whole(batches):
            # Spark cuts a partition into batches: a file is sensed as one.
            yield from sense(pa.Table.from_batches(list(batches))).to_batches()

        frame = spark.read.parquet(*[str(tmp_path / f"{file}.parquet") for file in range(FILES)])
        touched = sense(table.slice(0, 1)).schema
        from pyspark.sql.pandas.types import from_arrow_schema

        types = [field.with_type(pa.int16()) if field.type == pa.uint8() else field for field in touched]
        schema = from_arrow_schema(pa.schema(types))

        def cast(batches):
            for batch in whole(batches):
                yield pa.RecordBatch.from_arrays(
                    [column.cast(field.type) for column, field in zip(batch.columns, types, strict=True)],
                    schema=pa.schema(types),
                )

        result = frame.mapInArrow(cast, schema).toArrow()
        assert_same(result, local)
    finally:
        spark.stop()
