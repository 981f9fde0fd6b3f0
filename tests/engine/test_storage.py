"""Rows that come and go, against a plain list of what lives."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from engine.storage import SMALLEST_CAPACITY, Storage

ROW = np.dtype([("serial", np.int64), ("value", np.float64)])
OTHER = np.dtype([("more", np.float32)])


class AgainstAList(RuleBasedStateMachine):
    """Adds, removes, saves and loads; `living` is [(serial, row, value)] in the order of creation."""

    def __init__(self) -> None:
        super().__init__()
        self.storage = Storage({"main": ROW, "other": OTHER})
        self.living: list[tuple[int, int, float]] = []
        self.gone: list[tuple[int, int]] = []
        self.made = 0
        self.saves: list[tuple[dict, list, int]] = []

    @rule(value=st.floats(-10, 10), count=st.integers(1, 9))
    def add(self, value: float, count: int) -> None:
        for _ in range(count):
            row = self.storage.add()
            tables = self.storage.tables
            assert tables["main"]["value"][row] == 0.0, "a row starts empty"
            assert tables["other"]["more"][row] == 0.0
            assert row not in [used for _, used, _ in self.living]
            tables["main"]["value"][row] = value
            tables["other"]["more"][row] = 2.0
            self.living.append((self.made, row, value))
            self.made += 1

    @precondition(lambda self: self.living)
    @rule(data=st.data())
    def remove(self, data: st.DataObject) -> None:
        serial, row, _ = self.living.pop(data.draw(st.integers(0, len(self.living) - 1)))
        self.storage.remove(row)
        self.gone.append((row, serial))

    @rule()
    def save(self) -> None:
        self.saves.append((self.storage.save(), list(self.living)))

    @precondition(lambda self: self.saves)
    @rule(data=st.data())
    def load(self, data: st.DataObject) -> None:
        saved, living = self.saves[data.draw(st.integers(0, len(self.saves) - 1))]
        back = {serial for serial, _, _ in living}
        self.gone = [(row, serial) for row, serial in self.gone if serial not in back]
        self.gone += [(row, serial) for serial, row, _ in self.living if serial not in back]
        self.storage.load(saved)
        self.living = list(living)

    @invariant()
    def same_as_the_list(self) -> None:
        storage = self.storage
        assert storage.count == len(self.living)
        assert storage.order.tolist() == [row for _, row, _ in self.living]
        assert storage.tables["main"]["serial"][storage.order].tolist() == [serial for serial, _, _ in self.living]
        assert storage.tables["main"]["value"][storage.order].tolist() == [value for _, _, value in self.living]
        assert storage.next_serial >= self.made, "a serial is never given twice"
        for serial, row, _ in self.living:
            assert storage.holds(row, serial)
            assert storage.find(serial) == row
        for row, serial in self.gone:
            assert not storage.holds(row, serial)
            assert storage.find(serial) == -1
        if storage.dense:
            assert storage.order.tolist() == list(range(storage.count))


AgainstAList.TestCase.settings = settings(max_examples=60, stateful_step_count=20, deadline=None)
TestAgainstAList = AgainstAList.TestCase


def test_fresh_storage_is_dense_until_something_goes() -> None:
    storage = Storage({"main": ROW})
    rows = [storage.add() for _ in range(3 * SMALLEST_CAPACITY)]
    assert rows == list(range(3 * SMALLEST_CAPACITY))
    assert storage.dense
    storage.remove(5)
    assert not storage.dense
    assert storage.add() == 5, "the lowest free row is used first"
    assert not storage.dense, "row 5 now holds what was made last"


def test_find_knows_no_negative_serial() -> None:
    storage = Storage({"main": ROW})
    storage.remove(storage.add())
    assert storage.find(-1) == -1


def test_load_copies() -> None:
    storage = Storage({"main": ROW})
    storage.add()
    saved = storage.save()
    storage.load(saved)
    storage.tables["main"]["value"][0] = 5.0
    assert saved["main"]["value"][0] == 0.0


def test_what_was_made_after_a_save_stays_gone() -> None:
    storage = Storage({"main": ROW})
    storage.add()
    saved = storage.save()
    late = storage.add()
    serial = int(storage.tables["main"]["serial"][late])
    storage.load(saved)
    assert not storage.holds(late, serial)
    again = storage.add()
    assert int(storage.tables["main"]["serial"][again]) > serial
    assert not storage.holds(again, serial)


@pytest.mark.parametrize("count", [SMALLEST_CAPACITY, SMALLEST_CAPACITY + 1, 200])
def test_growth_keeps_rows(count: int) -> None:
    storage = Storage({"main": ROW, "other": OTHER})
    for k in range(count):
        row = storage.add()
        storage.tables["main"]["value"][row] = k
    assert storage.tables["main"]["value"][:count].tolist() == list(range(count))
    assert (storage.tables["main"]["serial"][count:] == -1).all()
    assert len(storage.tables["main"]) == len(storage.tables["other"])
