"""Tables of Arrow, shared with its libraries."""

import copy
import gc
import pickle

import fingertip
import numpy as np
import pytest
from fingertip import Fingertip, Table

pa = pytest.importorskip("pyarrow")
pl = pytest.importorskip("polars")

NAMES = ["fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm"]


def address(array):
    return array.__array_interface__["data"][0]


@pytest.fixture
def rows(wrenches):
    return np.asfortranarray(wrenches)


@pytest.fixture
def table(rows):
    return pa.table({name: rows[:, place] for place, name in enumerate(NAMES)})


def test_columns_go_out_and_come_in_without_a_copy(rows):
    ours = Table({name: rows[:, place] for place, name in enumerate(NAMES)})
    there = pa.table(ours)
    assert [there[name].chunk(0).buffers()[1].address for name in NAMES] == [address(c) for c in rows.T]
    frame = pl.DataFrame(ours)
    assert [address(frame[name].to_numpy(allow_copy=False)) for name in NAMES] == [address(c) for c in rows.T]
    for theirs in (there, frame, there.to_batches()[0]):
        back = Table.from_arrow(theirs)
        assert [address(back.column(name)) for name in NAMES] == [address(column) for column in rows.T]
        assert not back.column("fx_N").flags.writeable


def test_memory_lives_as_long_as_it_is_used():
    column = Table.from_arrow(pa.table({"a": np.arange(1000.0)})).column("a")
    there = pa.table(Table({"a": np.arange(1000.0)}))
    gc.collect()
    np.full(100_000, 7.0)
    assert np.array_equal(column, np.arange(1000.0)) and there["a"].to_pylist() == list(range(1000))


@pytest.mark.parametrize("kind", ["table", "batch", "polars", "pandas", "ours"])
def test_contacts_of_any_table_are_those_of_the_columns(scene, rows, table, kind):
    given = {
        "table": lambda: table,
        "batch": lambda: table.to_batches()[0],
        "polars": lambda: pl.DataFrame(table),
        "pandas": lambda: pytest.importorskip("pandas") and table.to_pandas(),
        "ours": lambda: Table.from_arrow(table),
    }[kind]()
    out = fingertip.columns(scene, time_step=1e-3)(given)
    assert type(out) is type(given)
    local = Fingertip(scene).sense_all(rows, 1e-3)
    back = Table.from_arrow(out)
    assert back.names == NAMES + list(local.columns())
    for name, column in local.columns().items():
        assert np.array_equal(back.column(name), column), name


def test_pieces_are_sensed_in_a_row_and_groups_apart():
    sections = {"surface": {"shape": "sphere", "radius_m": 0.013}, "slip": {"detector": "drop", "noise_N": 0.01}}
    scene = fingertip.Scene.from_dict(sections)
    x = np.concatenate([np.linspace(0, 1.0, 300), np.linspace(0.9, 0.5, 30)])
    columns = {"t_s": np.arange(330) * 1e-3, "fx_N": x, "fy_N": 0 * x, "fz_N": 0 * x - 2}
    columns |= {"tx_Nm": 0 * x, "ty_Nm": x * 0.013, "tz_Nm": 0 * x, "file": ["a"] * 300 + ["b"] * 30}
    whole = pa.table(columns)
    pieces = pa.Table.from_batches(whole.to_batches(max_chunksize=300))
    assert len(pieces.to_batches()) == 2
    slips = lambda table, **how: np.array(fingertip.columns(scene, **how)(table)["slip"])  # noqa: E731
    assert np.array_equal(slips(whole), slips(pieces)) and (slips(whole)[300:] == 3).any()
    # In another file nothing is known of the first.
    assert np.array_equal(slips(whole, group="file"), slips(pieces, group="file"))
    assert np.array_equal(slips(whole, group="file")[300:], slips(whole.slice(300)))
    assert not (slips(whole, group="file")[300:303] == 3).any()


def test_units_and_sensors_are_those_of_the_names(scene):
    table = pa.table({
        "left_fx_mN": [0.0], "left_fy_mN": [0.0], "left_fz_mN": [-1000.0],
        "left_tx_Nmm": [1.0], "left_ty_Nmm": [0.0], "left_tz_Nmm": [0.0],
    })  # fmt: skip
    there = fingertip.columns(scene, sensor="left", time_step=1e-3)(table)
    here = Fingertip(scene).sense([0, 0, -1.0, 1e-3, 0, 0], 1e-3)
    assert [there[name][0].as_py() for name in ("x_m", "y_m", "z_m")] == pytest.approx(here.point.tolist(), rel=1e-14)
    with pytest.raises(fingertip.RecordingError, match="right"):
        fingertip.columns(scene, sensor="right", time_step=1e-3)(table)
    with pytest.raises(fingertip.FingertipError, match="has no column of time; add one"):
        fingertip.columns(scene)(table)
    with pytest.raises(fingertip.FingertipError, match="is no table of Arrow"):
        fingertip.columns(scene)([1, 2])


def test_gauges_of_a_table_are_wrenches_too():
    seen = fingertip.simulate([{"do": "press", "at": {"from_top": 0.3, "azimuth": 0.0}, "force": 3, "duration": 0.2}])
    scene = seen.scene()
    table = pa.table({f"v{gauge + 1}_V": seen.gauges[:, gauge].copy() for gauge in range(6)})
    out = fingertip.columns(scene, time_step=1e-3)(table)
    local = Fingertip(scene).sense_all(seen.gauges, 1e-3)
    assert np.array_equal(np.array(out["x_m"]), local.point[:, 0])


def test_single_precision_columns_are_read_where_they_lie(scene, rows):
    single = rows.astype(np.float32)
    table = Table({name: np.ascontiguousarray(single[:, place]) for place, name in enumerate(NAMES)})
    out = fingertip.columns(scene, time_step=1e-3, dtype=np.float32)(table)
    assert out.column("x_m").dtype == np.float32
    assert np.array_equal(out.column("x_m"), Fingertip(scene, np.float32).sense_all(single, 1e-3).point[:, 0])


def test_missing_numbers_are_no_contacts_and_no_rows_are_none(scene, table):
    holes = table.set_column(0, "fx_N", pa.array([None, *table["fx_N"].to_pylist()[1:]], pa.float64()))
    out = fingertip.columns(scene, time_step=1e-3)(holes)
    assert out["normal_N"][0].as_py() == 0.0
    for empty in (table.slice(0, 0), pa.Table.from_batches([], table.schema), pl.DataFrame(table.slice(0, 0))):
        nothing = fingertip.columns(scene, time_step=1e-3)(empty)
        assert len(nothing) == 0 and len(pa.table(nothing).schema) == 16


def test_the_function_pickles(scene, table):
    sense = fingertip.columns(scene, time_step=1e-3)
    one, other = Table.from_arrow(pickle.loads(pickle.dumps(sense))(table)), Table.from_arrow(sense(table))
    assert all(np.array_equal(one.column(name), other.column(name), equal_nan=True) for name in other.names)


def test_polars_maps_batches_of_a_lazy_frame(scene, table):
    sense = fingertip.columns(scene, time_step=1e-3)
    schema = pl.DataFrame(sense(table.slice(0, 1))).schema
    lazy = pl.DataFrame(table).lazy().map_batches(sense, schema=schema).collect()
    here = pl.DataFrame(sense(table))
    assert lazy.columns == here.columns and lazy.equals(here)


def test_duckdb_takes_and_gives_columns(scene, table):
    duckdb = pytest.importorskip("duckdb")
    sense = fingertip.columns(scene, time_step=1e-3)
    rows = table  # noqa: F841
    touched = sense(duckdb.sql("select * from rows"))  # noqa: F841
    found = duckdb.sql("select count(*) from touched where normal_N > 0").fetchall()[0][0]
    assert found == np.count_nonzero(np.array(sense(table)["normal_N"]) > 0)


def test_tables_pickle_by_their_columns(table):
    for one in (Table.from_arrow(table), Table({"x": np.arange(3.0), "n": np.zeros(3, np.uint8), "who": ["a", "b", "c"]}), Table.from_arrow(table).with_no_rows(Table({"y": np.zeros(1)}))):
        back = pickle.loads(pickle.dumps(one))
        assert back.names == one.names and len(back) == len(one)
        ours, theirs = (pa.table(every).to_pydict() for every in (one, back))
        assert all(np.array_equal(ours[n], theirs[n], equal_nan=n not in ("who",)) for n in one.names)
        assert copy.deepcopy(one) is one
    pieces = Table.joined([Table({"x": np.arange(3.0)}), Table({"x": np.arange(2.0)})], Table.from_arrow(table))
    assert pa.table(pickle.loads(pickle.dumps(pieces))).equals(pa.table(pieces)) and len(pieces.batches()) == 2
    gaps = Table.from_arrow(pa.table({"x": [1.0, None]}))
    with pytest.raises(fingertip.FingertipError, match="places without a value"):
        pickle.dumps(gaps)
