"""Tables are the numbers that the command writes, bit for bit, for every reader of tables."""

from __future__ import annotations

import csv
import io
import math
import pickle
import struct
from collections.abc import Callable

import numpy as np
import pandas as pd
import polars
import pyarrow as pa
import pytest

import phea
from phea._record import Answer
from phea.table import Table, unit_of

pytestmark = pytest.mark.filterwarnings("ignore::phea.ProjectWarning")

ANSWERS: dict[str, Callable[[], Answer]] = {
    "check": lambda: phea.example("ybitu/hose").check(),
    "size": lambda: phea.example("ybitu/hose").size(),
    "linearize": lambda: phea.example("rotary/vane").linearize(),
    "sweep": lambda: phea.example("ybitu/hose").linearize(sweep="line.length=0.5 m..2 m", points=3),
    "verify": lambda: phea.example("ybitu/hose").verify(),
    "design": lambda: phea.example("qft/servo").design(files=True),
    "simulate": lambda: phea.example("ybitu/hose").simulate(figures=False),
    "rotary simulate": lambda: phea.example("rotary/vane").simulate(figures=False),
    "bench": lambda: phea.example("ybitu/bench").bench(),
    "campaign": lambda: phea.example("benchmark/campaign").campaign(runs=3, files=False),
    "rotary campaign": lambda: phea.example("rotary/vane").campaign(runs=2, files=False),
}

# Later pandas reads every number exactly, and warns of the option.
EXACT = {"float_precision": "round_trip"} if int(pd.__version__.split(".")[0]) < 3 else {}

# Columns without a unit, in every table of every example.
WITHOUT_UNIT = {
    *["accepted", "allowed", "branch", "campaign", "check", "compliance", "equation", "feasible"],
    *["forbidden_from_gain", "forbidden_to_gain", "frequencies", "hose", "imaginary", "kind"],
    *["machine", "model", "modulus_margin", "name", "occurrences", "order", "parts_price"],
    *["passive_closed_loop", "passive_open_loop", "periods", "plants", "prefilter_order", "real"],
    *["reason", "reasons", "relative_degree", "round", "run", "setting_a_ratio"],
    *["setting_b_ratio", "settled", "specification", "stable_with_its_load", "stated_value"],
    *["status", "steps", "structure", "unit", "value"],
}


@pytest.fixture(scope="module", params=ANSWERS)
def tables(request: pytest.FixtureRequest) -> dict[str, Table]:
    """Tables of an answer; there is at least one."""
    found = ANSWERS[request.param]().tables
    assert found
    return found


def bits(values: object) -> bytes:
    """Bits of numbers, in which not a number equals itself."""
    return np.asarray(values, np.float64).tobytes()


def test_columns_are_the_cells_of_the_text(tables: dict[str, Table]) -> None:
    for table in tables.values():
        names, *rows = csv.reader(io.StringIO(table.csv.decode()), strict=True)
        assert list(table) == names and len(set(names)) == len(names)
        for index, name in enumerate(names):
            cells = [row[index] for row in rows]
            column = table[name]
            if isinstance(column, list):
                assert column == cells
                continue
            numbers = [float(cell) if cell else math.nan for cell in cells]
            assert bits(column) == b"".join(struct.pack("=d", number) for number in numbers), name


def test_pandas_reads_the_same_columns(tables: dict[str, Table]) -> None:
    for table in tables.values():
        types = {name: str if isinstance(table[name], list) else np.float64 for name in table}
        read = pd.read_csv(
            io.BytesIO(table.csv),
            **EXACT,
            dtype=types,
            keep_default_na=False,
            na_values={name: [""] for name in table if types[name] is np.float64},
        )
        frame = table.to_pandas()
        assert list(frame) == list(read) and len(frame) == len(read)
        for name in frame:
            if types[str(name)] is str:
                assert list(frame[name]) == list(read[name])
            else:
                assert bits(frame[name]) == bits(read[name]), name


def test_units_of_a_frame_are_the_ends_of_the_names(tables: dict[str, Table]) -> None:
    for table in tables.values():
        units = table.to_pandas().attrs["units"]
        assert list(units) == list(table)
        for name, unit in units.items():
            # a parameter of the project is a path, its unit that of the project
            is_parameter = "." in name and "_at_" not in name
            assert unit or name in WITHOUT_UNIT or is_parameter, name


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("time_s", "s"),
        ("force_n", "N"),
        ("torque_n_m", "N.m"),
        ("velocity_m_per_s", "m/s"),
        ("velocity_rad_per_s", "rad/s"),
        ("real_rad_per_s", "rad/s"),
        ("flow_gain_m3_per_s_v", "m3/(s.V)"),
        ("flow_pressure_coefficient_m3_per_s_pa", "m3/(s.Pa)"),
        ("flow_a_m3_per_s", "m3/s"),
        ("hydraulic_stiffness_n_per_m", "N/m"),
        ("hydraulic_stiffness_n_m_per_rad", "N.m/rad"),
        ("10 rad/s: impedance_closed_n_s_per_m", "N.s/m"),
        ("impedance_open_n_m_s_per_rad", "N.m.s/rad"),
        ("proportional_gain_v_per_n", "V/N"),
        ("proportional_gain_v_per_n_m", "V/(N.m)"),
        ("leak_flow_l_per_min", "L/min"),
        ("pressure_a_bar", "bar"),
        ("oil_temperature_degC", "degC"),
        ("event1_overshoot_percent", "%"),
        ("worst_margin_db", "dB"),
        ("phase_deg", "deg"),
        ("force_n_at_2.5_s", "N"),
        ("torque_n_m_at_0_s", "N.m"),
        ("energy_from_supply_j", "J"),
        ("power_at_rest_w", "W"),
        ("forbidden_from_gain", ""),
        ("passive_open_loop", ""),
        ("s", ""),
    ],
)
def test_unit_of_a_name(name: str, unit: str) -> None:
    assert unit_of(name) == unit


def test_arrow_carries_columns_and_units(tables: dict[str, Table]) -> None:
    for table in tables.values():
        sink = pa.BufferOutputStream()
        arrow = table.to_arrow()
        with pa.ipc.new_stream(sink, arrow.schema) as writer:
            writer.write_table(arrow)
        with pa.ipc.open_stream(sink.getvalue()) as reader:
            back = reader.read_all()
        assert back.schema.equals(arrow.schema, check_metadata=True)
        for name in table:
            assert back.schema.field(name).metadata == {b"unit": unit_of(name).encode()}
            column = back.column(name)
            if pa.types.is_string(column.type):
                assert column.to_pylist() == table[name]
            else:
                assert column.type == pa.float64()
                assert bits(column.to_numpy()) == bits(table[name]), name


def test_other_readers_take_the_stream(tables: dict[str, Table]) -> None:
    for table in tables.values():
        arrow = pa.table(table)
        assert arrow.column_names == list(table)
        frame = polars.DataFrame(table)
        assert frame.columns == list(table)
        for name in table:
            column = table[name]
            if isinstance(column, list):
                assert frame[name].to_list() == column == arrow.column(name).to_pylist()
            else:
                assert bits(frame[name].to_numpy()) == bits(column) == bits(arrow.column(name))


def test_a_table_is_a_value(tables: dict[str, Table]) -> None:
    for table in tables.values():
        again = pickle.loads(pickle.dumps(table))
        assert again == table and hash(again) == hash(table) and list(again) == list(table)
        assert again != Table(table.csv + b"0") and "\n" not in repr(table)
        for name in table:
            column = table[name]
            if isinstance(column, np.ndarray):
                assert column.dtype == np.float64 and column.flags.c_contiguous
                with pytest.raises(ValueError, match="read-only"):
                    column[:1] = 0.0


def test_the_frame_of_a_table_is_the_user_s_own() -> None:
    table = Table(b"time_s,force_n\n0,1\n1,2\n")
    frame = table.to_pandas()
    frame["force_n"] = frame["force_n"] * 1000
    frame.loc[0, "time_s"] = 5.0
    assert list(table.force_n) == [1.0, 2.0] and list(table.time_s) == [0.0, 1.0]


def test_cells() -> None:
    table = Table(b'name,gain,left_s\n"a, ""b""",1e-3,\n,inf,-0.0\n\xce\xa9,-inf,2\n')
    assert table.name == ['a, "b"', "", "Ω"]
    assert bits(table.gain) == bits([1e-3, math.inf, -math.inf])
    assert bits(table.left_s) == bits([math.nan, -0.0, 2.0])
    assert len(Table(b"time_s\n").time_s) == 0
    with pytest.raises(KeyError, match="did you mean 'gain'"):
        table["gains"]
    with pytest.raises(AttributeError, match="left_s"):
        table.left  # noqa: B018
