"""Kernels called by their address do what they do when called by name."""

from __future__ import annotations

import numba
import numpy as np
import pytest

from engine.calling import address_of, call
from engine.jit import kernel

pytestmark = pytest.mark.skipif(bool(numba.config.DISABLE_JIT), reason="without compilation there are no addresses")


@kernel
def weigh(values, more, factor):
    """A number from an array, from a table that may be missing, and from a number."""
    total = factor * values.sum()
    if more is not None:
        total += more[0].x
    return total


@kernel
def spread(values, *others):
    """Takes any number of arrays, changes the first."""
    for k in range(len(values)):
        for other in others:
            values[k] += other[k]


@kernel
def check(limit, value):
    """Raises an error."""
    if value > limit:
        raise ValueError("too much")
    return True


@kernel
def weighed(address, values, arguments):
    return call(address, 0.0, (values[1:], *arguments))


@kernel
def spread_twice(address, arguments):
    for _ in range(2):
        call(address, None, arguments)


@kernel
def checked(address, arguments):
    return call(address, False, arguments)


TABLE = np.zeros(1, np.dtype([("x", np.float32), ("y", np.int64)]))


def test_arrays_numbers_and_what_is_missing() -> None:
    values = np.arange(4.0)
    TABLE["x"] = 0.25
    for arguments, expected in (((None, 2.0), 12.0), ((TABLE, 3.0), 18.25)):
        address = address_of(weigh, 0.0, (values, *arguments))
        assert weighed(address, values, arguments) == weigh(values[1:], *arguments) == expected


def test_any_number_of_arguments() -> None:
    values, others = np.zeros(3), (np.ones(3), np.arange(3.0))
    spread(values, *others)
    spread_twice(address_of(spread, None, (values, *others)), (values, *others))
    assert values.tolist() == [3.0, 6.0, 9.0]


def test_errors_come_through() -> None:
    address = address_of(check, True, (1, 2))
    assert checked(address, (5, 4)) is True
    with pytest.raises(ValueError, match="too much"):
        checked(address, (5, 6))


def test_a_kernel_that_returns_something_else_is_refused() -> None:
    with pytest.raises(TypeError, match=r"^check returns bool, not int64$"):
        address_of(check, 0, (1, 2))


def test_types_tell_compiled_code_apart() -> None:
    halves = np.ones(3, np.float32)
    address = address_of(weigh, 0.0, (np.ones(3), None, 1.0))
    other = address_of(weigh, 0.0, (halves, None, 1.0))
    strided = address_of(weigh, 0.0, (np.ones(6)[::2], None, 1.0))
    assert len({address, other, strided}) == 3
    assert address == address_of(weigh, 0.0, (np.zeros(7), None, 2.0))
