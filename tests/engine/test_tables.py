"""The state tables: what holds for every one of them."""

from __future__ import annotations

import numba
import numpy as np
import pytest

from engine import tables
from engine.solvers.soft_step import tables as soft
from engine.tables import REALS, empty

DTYPES = {
    "body": tables.BODY,
    "shape": tables.SHAPE,
    "hull": tables.HULL,
    "contact record": tables.CONTACT_RECORD,
    "joint record": tables.JOINT_RECORD,
    **{
        f"{make.__name__}, {precision}": make(precision)
        for precision in REALS
        for make in (tables.motion_dtype, tables.placement_dtype, tables.arbiter_dtype, tables.contact_dtype,
                     tables.joint_dtype, tables.step_dtype, soft.mover_dtype, soft.constraint_dtype,
                     soft.friction_dtype, soft.belt_dtype, soft.rolling_dtype, soft.restitution_dtype)
    },
}  # fmt: skip

pytestmark = pytest.mark.kernel


@pytest.mark.parametrize("name", DTYPES)
def test_fields_are_no_attributes_of_arrays(name: str) -> None:
    # without compilation a row gives its fields by attribute: one named `size` or `flags` would be the array's own
    assert not set(DTYPES[name].names or ()) & set(dir(np.recarray))


@pytest.mark.parametrize("name", DTYPES)
def test_tables_have_no_padding(name: str) -> None:
    # whose bytes would differ between equal states
    dtype = DTYPES[name]
    assert dtype.itemsize == sum(dtype[field].itemsize for field in dtype.names or ())


@pytest.mark.parametrize("precision", REALS)
def test_a_motion_is_eight_numbers(precision: str) -> None:
    for dtype in (tables.motion_dtype(precision), soft.mover_dtype(precision)):
        assert [dtype[name] for name in dtype.names or ()] == [REALS[precision]] * 8


def test_empty_tables_are_zeros_that_both_modes_can_read() -> None:
    table = empty(3, tables.BODY)
    assert not table.view(np.uint8).any()
    assert isinstance(table, np.recarray) == bool(numba.config.DISABLE_JIT)
    if numba.config.DISABLE_JIT:
        assert table[0].x == 0.0
