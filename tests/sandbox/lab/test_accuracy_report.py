"""What a sweep's reports say: the Pareto front, tables, diagrams as SVG and PNG, and the page that needs no network."""

from __future__ import annotations

import math
import re
from collections import Counter
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from engine import SOLVERS
from sandbox.lab.accuracy import Outcome, Row, cheapest, front
from sandbox.lab.accuracy.chart import as_svg
from sandbox.lab.accuracy.groups import LEAST, by_measure
from sandbox.lab.accuracy.html import as_html
from sandbox.lab.accuracy.pareto import milliseconds, solves
from sandbox.lab.accuracy.picture import draw, labels
from sandbox.lab.accuracy.report import as_markdown, as_text
from sandbox.lab.accuracy.style import BACKDROP, GRID, LINES, TEXT, colour_of, kind_of
from web import theme

SETTINGS = {"dt": 1 / 60, "substeps": 4, "iterations": 1, "stiffness": "follows"}


def made(error: float, cost_ms: float, label: str = "4", solver: str = "soft_step", count: int | None = 10) -> Row:
    """A point of the experiment `ballistic`, whose scale is 7.2 m."""
    settings = {**SETTINGS, "substeps": int(label)}
    series = f"{solver}, substeps"
    return Row("ballistic", solver, settings, "single", "height [m]", error, cost_ms, 0.1, count, series, label, 0.3)


ROWS = [
    made(0.5, 1.0, "1"),
    made(0.05, 2.0, "2"),
    made(0.06, 3.0, "4"),
    made(0.0, 4.0, "8"),
    made(math.inf, 0.5, "16"),
    made(0.01, 2.5, "1", "sequential_impulses"),
    made(0.02, 0.9, "2", "pyb2d3", None),
]


@pytest.fixture
def outcome() -> Outcome:
    """With something of everything."""
    refused = {("bounce", "direct"): "it has no <restitution>"}
    return Outcome(ROWS, refused, Counter({("stack", 1): 7}), ["pile: it & more"], 3, 12.0)


errors = st.one_of(st.floats(1e-9, 10.0), st.just(math.inf), st.just(0.0))
counts = st.one_of(st.none(), st.integers(0, 50))
many = st.lists(st.builds(made, errors, st.floats(0.1, 100.0), count=counts), max_size=12)


@given(many, st.sampled_from([milliseconds, solves]))
def test_nothing_beats_the_front_and_the_front_beats_the_rest(rows: list[Row], price) -> None:
    known = [row for row in rows if math.isfinite(row.error) and price(row) is not None]

    def beats(one: Row, other: Row) -> bool:
        pair, against = (price(one), one.error), (price(other), other.error)
        return pair != against and pair[0] <= against[0] and pair[1] <= against[1]

    found = front(rows, price)
    assert not any(beats(other, one) for one in found for other in known)
    pairs = {(price(one), one.error) for one in found}
    for row in known:
        assert (price(row), row.error) in pairs or any(beats(one, row) for one in found)


def test_the_cheapest_is_within_its_part_of_the_scale() -> None:
    own = ROWS[:5]
    scale = 7.2
    assert own[0].relative == pytest.approx(0.5 / scale)
    assert cheapest(own, 0.1) is own[0]
    assert cheapest(own, 0.01) is own[1]
    assert cheapest(own, 1e-5) is own[3]
    assert cheapest(own[:3], 1e-5) is None


# --- tables -----------------------------------------------------------------------------------------------------------


def test_text_tells_cheapest_what_is_not_applicable_and_what_was_left_out(outcome: Outcome) -> None:
    text = as_text(outcome)
    assert "height [m]" in text  # and not taken for an instruction to rich
    assert "2 substeps" in text
    assert "not applicable: sequential_impulses has no substeps" in text
    assert "not applicable: bounce with direct: it has no <restitution>" in text
    assert "left out for want of time: 7 finer settings of stack" in text
    assert "failed: pile: it & more" in text


def test_the_cheapest_of_ours_stand_beside_those_of_peers(outcome: Outcome) -> None:
    lines = [line for line in as_markdown(outcome).splitlines() if line.startswith("| ballistic<br>")]
    assert "soft_step<br>1 substeps<br>1 ms" in lines[0]
    assert "pyb2d3" not in lines[0]
    assert "height [m], peers" in lines[1]
    assert "pyb2d3" in lines[1]


def test_markdown_shows_pictures_and_each_solvers_best(outcome: Outcome) -> None:
    page = as_markdown(outcome)
    assert "](accuracy/ballistic.svg)" in page
    assert "| soft_step | 8 substeps | 0.0e+00 | 3.0e-01 | 4 | 10 |" in page
    assert "| pyb2d3 | 2 substeps | 2.0e-02 | 3.0e-01 | 0.9 | |" in page.replace("|  |", "| |")


# --- diagrams ---------------------------------------------------------------------------------------------------------


def test_svg_is_whole_and_marks_the_front_with_titles() -> None:
    tree = ElementTree.fromstring(as_svg(ROWS))
    space = "{http://www.w3.org/2000/svg}"
    rings = [one for one in tree.iter(f"{space}circle") if one.get("class") == "ring"]
    titles = [one.text or "" for one in tree.iter(f"{space}title")]
    drawn = [row for row in ROWS if math.isfinite(row.error)]
    assert len(rings) == len(front(drawn)) + 1  # and the one in the legend
    assert len(titles) == len(drawn)
    assert (
        "soft_step: 2 substeps\nerror 5.0e-02 (6.9e-03 of the scale)\npredicted 3.0e-01\n"
        "2 ms, from least to greatest 0.1\n10 constraints solved"
    ) in titles
    assert any(one.get("class") == "floor" for one in tree.iter(f"{space}path"))
    labelled = {one.text for one in tree.iter(f"{space}text") if one.get("class") == "label"}
    assert {"1", "2", "8"} <= labelled


@given(many)
def test_any_rows_can_be_drawn(rows: list[Row]) -> None:
    tree = ElementTree.fromstring(as_svg(rows))
    for one in tree.iter("{http://www.w3.org/2000/svg}circle"):
        x = float(one.get("cx", "0"))
        assert math.isfinite(x)
        assert 0 <= x <= 900


class _Reader(HTMLParser):
    """Whether each element is closed, and what it asks of elsewhere."""

    EMPTY = ("meta", "input", "br")

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.asked: list[str] = []

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.asked += [value or "" for name, value in attributes if name in ("src", "href", "srcset", "data")]
        if tag not in self.EMPTY:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_startendtag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        pass


def test_html_is_whole_and_asks_no_network(outcome: Outcome) -> None:
    page = as_html(outcome)
    reader = _Reader()
    reader.feed(page)
    assert reader.open == []
    assert all(one.startswith("#") for one in reader.asked)
    assert not re.search(r"url\(|@import|fetch\(|https?://", page)
    assert "prefers-color-scheme:dark" in page
    assert "it has no &lt;restitution&gt;" in page
    assert "pile: it &amp; more" in page


def test_picture_is_drawn(tmp_path: Path) -> None:
    draw(ROWS, tmp_path / "picture.png")
    with Image.open(tmp_path / "picture.png") as picture:
        assert picture.width > 400
        colours = {colour for _, colour in picture.convert("RGB").getcolors(1 << 24)}  # type: ignore[misc, union-attr]
    for solver in ("soft_step", "sequential_impulses"):
        assert tuple(bytes.fromhex(colour_of(solver, SOLVERS)[1:])) in colours


def test_labels_do_not_lie_on_each_other() -> None:
    row = made(0.1, 2.0, "1")
    near, far, none = replace(row, error=0.1001, label="2"), replace(row, error=0.2, label="4"), replace(row, error=0.0)
    assert [label for _, label in labels([row, near, far])] == ["1", "4"]
    assert labels([none])[0][0] == (2.0, LEAST)


def test_colours_are_the_pages_and_stay_with_their_solvers() -> None:
    assert "#{:02x}{:02x}{:02x}".format(*theme.BACKDROP) == BACKDROP
    assert theme.PLOT_LINES == LINES
    assert (TEXT, GRID) == (theme.PLOT_TEXT, theme.PLOT_GRID)
    assert colour_of("soft_step", ["soft_step"]) == colour_of("soft_step", ["pymunk", "soft_step"])
    both = ["pyb2d3", "pymunk"]
    assert len({colour_of(name, [*SOLVERS, *both]) for name in (*SOLVERS, *both)}) == len(SOLVERS) + 2


@pytest.mark.parametrize(
    ("series", "kind"),
    [
        ("soft_step, substeps", ""),
        ("soft_step, steps in 1/60 s", "steps"),
        ("soft_step, iterations in 4 substeps", "iterations"),
        ("soft_step, substeps, stiffness fixed", "fixed"),
        ("soft_step, substeps, double precision", "double"),
    ],
)
def test_markers_say_what_is_varied(series: str, kind: str) -> None:
    assert kind_of(series) == kind


def test_rows_are_grouped_by_measure() -> None:
    (group,) = by_measure(ROWS)
    assert group.title == "ballistic: a ball thrown upwards; height after 2 s [m]"
    assert group.against == "7.2 m, the height it rises"
