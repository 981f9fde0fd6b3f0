"""Rows that come and go, against a plain list of what lives."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from engine.storage import SMALLEST_CAPACITY, Column, Storage

ROW = np.dtype([("serial", np.int64), ("value", np.float64)])
OTHER = np.dtype([("more", np.float32)])
COLUMNS = {"tint": Column(np.dtype(np.float64), 2.0), "bits": Column(np.dtype(np.int64), 7)}
PLAIN = (2.0, 7)  # what a thing has of which nothing was said


class AgainstAList(RuleBasedStateMachine):
    """Adds, removes, saves and loads; `living` is [(serial, row, value)] in the order of creation.

    `traits` is what things have in columns: {serial: (tint, bits)}.
    """

    def __init__(self) -> None:
        super().__init__()
        self.storage = Storage({"main": ROW, "other": OTHER}, COLUMNS)
        self.traits: dict[int, tuple[float, int]] = {}
        self.living: list[tuple[int, int, float]] = []
        self.gone: list[tuple[int, int]] = []
        self.made = 0
        self.saves: list[tuple[dict, list, dict]] = []

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
            self.traits[self.made] = PLAIN
            self.made += 1

    @rule(count=st.integers(0, 40))
    def add_many(self, count: int) -> None:
        rows = self.storage.add_many(count)
        assert len(set(rows.tolist())) == count
        assert not self.storage.tables["main"]["value"][rows].any()
        for row in rows:
            self.living.append((self.made, int(row), 0.0))
            self.traits[self.made] = PLAIN
            self.made += 1

    @precondition(lambda self: self.living)
    @rule(data=st.data(), tint=st.sampled_from([2.0, -1.5, 0.0]), bits=st.sampled_from([7, 0, -3]))
    def put(self, data: st.DataObject, tint: float, bits: int) -> None:
        chosen = data.draw(st.lists(st.sampled_from(self.living), max_size=4, unique=True))
        self.storage.put("tint", np.array([row for _, row, _ in chosen], np.int64), tint)
        for serial, row, _ in chosen:
            self.storage.put("bits", row, bits)
            self.traits[serial] = (tint, bits)

    @rule(forget=st.booleans())
    def tidy(self, forget: bool) -> None:
        if forget:
            self.storage.drop_idle_columns()
            assert all(self.storage.departing(name) for name in self.storage.columns)
        else:
            self.storage.ensure("tint")

    @precondition(lambda self: self.living)
    @rule(data=st.data())
    def remove(self, data: st.DataObject) -> None:
        serial, row, _ = self.living.pop(data.draw(st.integers(0, len(self.living) - 1)))
        self.storage.remove(row)
        self.gone.append((row, serial))

    @rule()
    def save(self) -> None:
        saved = self.storage.save()
        assert {"tint", "bits"} & set(saved) == {name for name in COLUMNS if self.storage.departing(name)}
        self.saves.append((saved, list(self.living), dict(self.traits)))

    @precondition(lambda self: self.saves)
    @rule(data=st.data())
    def load(self, data: st.DataObject) -> None:
        saved, living, traits = self.saves[data.draw(st.integers(0, len(self.saves) - 1))]
        back = {serial for serial, _, _ in living}
        self.gone = [(row, serial) for row, serial in self.gone if serial not in back]
        self.gone += [(row, serial) for serial, row, _ in self.living if serial not in back]
        self.storage.load(saved)
        self.living = list(living)
        self.traits |= {serial: traits[serial] for serial in back}

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
            assert (storage.get("tint", row), storage.get("bits", row)) == self.traits[serial]
        for place, name in enumerate(COLUMNS):
            values = [self.traits[serial][place] for serial, _, _ in self.living]
            assert storage.departing(name) == sum(value != PLAIN[place] for value in values)
            if name in storage.columns:
                assert storage.columns[name][storage.order].tolist() == values
                assert len(storage.columns[name]) == len(storage.tables["main"])
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


def test_a_column_is_there_only_while_something_departs_from_the_default() -> None:
    storage = Storage({"main": ROW}, COLUMNS)
    rows = storage.add_many(5)
    storage.put("tint", rows, 2.0)
    assert storage.columns == {}
    storage.put("tint", rows[1:3], 0.5)
    assert list(storage.columns) == ["tint"]
    assert storage.departing("tint") == 2
    storage.remove(int(rows[1]))
    storage.put("tint", rows[2], 2.0)
    storage.drop_idle_columns()
    assert storage.columns == {}
    assert storage.get("tint", int(rows[0])) == 2.0
    assert type(storage.get("bits", 0)) is int


def test_a_reused_row_has_nothing_left_of_the_one_before() -> None:
    storage = Storage({"main": ROW}, COLUMNS)
    row = storage.add()
    storage.put("tint", row, 0.5)
    storage.add()
    storage.remove(row)
    assert storage.columns["tint"][row] == 2.0
    assert storage.add() == row
    assert storage.get("tint", row) == 2.0


def test_columns_grow_with_their_tables() -> None:
    storage = Storage({"main": ROW}, COLUMNS)
    storage.put("tint", storage.add(), 0.5)
    storage.add_many(10 * SMALLEST_CAPACITY)
    assert len(storage.columns["tint"]) == len(storage.tables["main"])
    assert storage.departing("tint") == 1
    assert (storage.columns["tint"][1:] == 2.0).all()


def test_loading_takes_away_columns_that_were_not_saved() -> None:
    storage = Storage({"main": ROW}, COLUMNS)
    row = storage.add()
    saved = storage.save()
    storage.put("tint", row, 0.5)
    storage.load(saved)
    assert storage.get("tint", row) == 2.0


def test_ten_thousand_at_once() -> None:
    storage = Storage({"main": ROW, "other": OTHER}, COLUMNS)
    rows = storage.add_many(10_000)
    assert storage.dense
    assert rows.tolist() == storage.tables["main"]["serial"][:10_000].tolist() == list(range(10_000))
