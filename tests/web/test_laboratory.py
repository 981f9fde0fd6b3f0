"""The page's laboratory: a measurement in the background, its diagram, and settings that go to the live scene."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from engine import SOLVERS
from sandbox.commands import Reset, Set, SetAll
from sandbox.lab.accuracy import Outcome, Row, Series, over
from sandbox.lab.experiments import EXPERIMENTS
from sandbox.lab.side_by_side import SideBySide
from sandbox.session import Session
from tests.web.browser import look, open_page
from tests.web.fake_session import BODY, FakeSession, make_frame, pyramid, wait_until
from tests.web.raw_client import RawClient, raw_client
from tests.web.test_panels import prop
from web import App
from web.hit import pieces_at
from web.overlays.ghosts import Ghosts, outlines
from web.panels import laboratory
from web.panels.laboratory import BUSY, IDLE, can_be_live, choices_of, settings_of
from web.stage import Stage

APPLY = "Give this setting to the scene"
SOFT = {"dt": 1 / 60, "substeps": 8, "iterations": 2, "stiffness": "fixed"}
TALK = {"dt": 1 / 60, "iterations": 50}


def row(error: float, cost: float, settings: dict, solver: str = "soft_step", precision: str = "single") -> Row:
    return Row("ballistic", solver, settings, precision, "height [m]", error, cost, 0.1, 5, f"{solver}, x", "1", None)


ROWS = [
    row(0.3, 3.0, TALK, "sequential_impulses"),
    row(0.1, 2.0, SOFT),
    row(0.01, 1.0, {**SOFT, "dt": 1 / 240}),
    row(0.01, 1.0, SOFT, precision="double"),
    row(0.01, 1.0, {"dt": 1 / 60, "substeps": 4}, "pyb2d3"),
]


def test_a_live_scene_is_offered_what_it_can_have_the_best_first() -> None:
    assert [can_be_live(row) for row in ROWS] == [True, True, False, False, False]
    assert list(choices_of(ROWS)) == [
        "soft_step, 8 substeps, 2 iterations, fixed stiffness: 1.0e-01, 2 ms",
        "sequential_impulses, 50 iterations: 3.0e-01, 3 ms",
    ]


def test_a_setting_is_the_solver_and_its_numbers() -> None:
    soft = {"solver": "soft_step", "substeps": 8, "iterations": 2, "stiffness": "fixed"}
    assert settings_of(ROWS[1]) == soft
    assert settings_of(ROWS[0]) == {"solver": "sequential_impulses", "iterations": 50}


class Measuring:
    """Stands in for the sweep: it waits for a word."""

    def __init__(self) -> None:
        self.calls: list[str] = []
        self.go_on = threading.Event()
        self.stopped = False
        self.error: Exception | None = None

    def __call__(self, scene: str, stop: threading.Event, tell: Any) -> Outcome:
        self.calls.append(scene)
        while not self.go_on.wait(0.05):
            tell(3, 12, "measuring")
            if stop.is_set():
                self.stopped = True
                return Outcome()
        if self.error is not None:
            raise self.error
        return Outcome(rows=ROWS, refused={("ballistic", "direct"): "it has no <wings>"})


@pytest.fixture
def measuring(monkeypatch: pytest.MonkeyPatch) -> Measuring:
    found = Measuring()
    monkeypatch.setattr(laboratory, "measured", found)
    return found


@pytest.fixture
def page(measuring: Measuring) -> Iterator[tuple[FakeSession, RawClient]]:
    session = FakeSession(pyramid(2))
    app = App(session, port=0)  # type: ignore[arg-type]
    with raw_client(app.url) as client:
        yield session, client
    app.close()
    session.close()


Page = tuple[FakeSession, RawClient]


def sees(client: RawClient, text: str) -> None:
    wait_until(lambda: (client.read(), text in str(client.messages))[1], what=text)


def test_measuring_shows_progress_then_the_diagram_and_a_choice_goes_to_the_scene(
    page: Page, measuring: Measuring
) -> None:
    session, client = page
    client.set(IDLE, True)
    sees(client, "measuring: 3 of 12 settings")
    measuring.go_on.set()
    sees(client, "it has no &lt;wings&gt;")
    assert measuring.calls == ["ballistic"]
    assert "<svg" in str(client.messages)
    sees(client, "50 iterations")
    assert len(prop(client, "setting", "options")) == 2
    client.set("setting", list(choices_of(ROWS))[1])
    client.set(APPLY, True)
    session.wait_for(SetAll)
    assert session.of(SetAll) == [SetAll({"solver": "sequential_impulses", "iterations": 50})]
    assert session.of(Set) == []


def test_a_second_press_stops_it(page: Page, measuring: Measuring) -> None:
    _, client = page
    client.set(IDLE, True)
    wait_until(lambda: (client.read(), prop(client, IDLE, "label") == BUSY)[1])
    client.set(IDLE, True)
    wait_until(lambda: measuring.stopped)


def test_closing_the_page_stops_it(measuring: Measuring) -> None:
    session = FakeSession(pyramid(2))
    app = App(session, port=0)  # type: ignore[arg-type]
    with raw_client(app.url) as client:
        client.set(IDLE, True)
        wait_until(lambda: measuring.calls)
    app.close()
    session.close()
    wait_until(lambda: measuring.stopped)


def test_what_goes_wrong_is_told_and_the_page_goes_on(page: Page, measuring: Measuring) -> None:
    _, client = page
    measuring.error = RuntimeError("no worker\nto be had")
    measuring.go_on.set()
    client.set(IDLE, True)
    sees(client, "Not measured")
    wait_until(lambda: (client.read(), prop(client, IDLE, "label") == IDLE)[1])


def test_another_scene_has_other_measures(page: Page) -> None:
    _, client = page
    client.set("known scene", "stack")
    names = [measure.name for measure in EXPERIMENTS["stack"].measures]
    wait_until(lambda: (client.read(), list(prop(client, "measure", "options")) == names)[1])


# --- solvers side by side ---------------------------------------------------------------------------------------------

SHAPES: list[BODY] = [
    ("dynamic", "box", 2.0, 1.0, 1.0, 2.0, 0.7),
    ("dynamic", "circle", 0.8, 0.0, -3.0, 1.0, 0.3),
    ("dynamic", "capsule", 1.0, 0.4, 5.0, 1.0, 1.0),
    ("dynamic", "polygon", 0.2, 0.0, -7.0, 2.0, 0.5),
]


@pytest.mark.parametrize("body", SHAPES, ids=lambda body: body[1])
def test_an_outline_is_where_a_shape_ends(body: BODY) -> None:
    frame = make_frame([body])
    segments = outlines(frame)
    middle = np.array(body[4:6])
    ends = segments.reshape(-1, 2) - middle
    rim = ends[np.linalg.norm(ends, axis=1) > 1e-9] + middle  # but for the centre that a circle's radius starts from
    for point in rim:
        inside, outside = middle + 0.97 * (point - middle), middle + 1.03 * (point - middle)
        assert pieces_at(frame, *inside)[0]
        assert not pieces_at(frame, *outside)[0]
    np.testing.assert_allclose(segments[:-1, 1], segments[1:, 0])  # each edge begins where the one before ends
    np.testing.assert_allclose(segments[-1, 1], segments[0, 0])


def test_what_is_static_has_no_ghost() -> None:
    assert outlines(make_frame([("static", *SHAPES[0][1:])])).shape == (0, 2, 2)  # type: ignore[list-item]
    assert len(outlines(make_frame([("static", *SHAPES[0][1:]), SHAPES[1]]))) > 20  # type: ignore[list-item]


class FakeScene:
    """Hands out nodes that keep what was assigned to them."""

    def __getattr__(self, _: str) -> Any:
        return lambda *_, **__: SimpleNamespace(visible=True, points=None)


def test_a_solver_that_is_no_longer_compared_vanishes() -> None:
    ghosts, stage = Ghosts(FakeScene(), {"a": (1, 2, 3), "b": (4, 5, 6)}), Stage(0.0, 5.0, 20.0)  # type: ignore[arg-type]
    frame = make_frame(SHAPES[:1])
    ghosts.draw({"a": frame}, stage)
    assert ghosts._lines["a"].points.shape == (4, 2, 3)
    assert ghosts._lines["b"].points is None
    ghosts.draw({}, stage)
    assert ghosts._lines["a"].points.shape == (0, 2, 3)


# --- in a browser, with a living scene --------------------------------------------------------------------------------


@pytest.mark.browser
def test_the_whole_laboratory(chromium: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Measures one scene in another process while the live one goes on, takes a point, and lets solvers race."""
    few = Series("soft_step, substeps", "soft_step", over("substeps", (1, 2, 8)))
    monkeypatch.setattr(laboratory, "all_series", lambda solvers: (few,))
    session = Session("The Talk/Pyramid")
    app = App(session, port=0)
    session.start()
    try:
        with open_page(app.url, 1400, 850) as page:
            _measure(page, session)
            _compare(page, session, tmp_path)
            assert page.complaints == []  # type: ignore[attr-defined]
    finally:
        session.close()
        app.close()


def _measure(page: Any, session: Session) -> None:
    """The tab, its button, the diagram, and the first of the points that it offers."""
    page.get_by_text("Laboratory", exact=True).click()
    page.get_by_role("button", name=IDLE).click()
    page.get_by_role("button", name=BUSY).wait_for()
    before = session.frame.step
    page.get_by_role("button", name=APPLY).wait_for(timeout=90_000)
    assert session.frame.step > before + 10  # the live scene went on
    svg = page.locator("svg.chart")
    assert svg.locator(".ring").count() > 0
    assert svg.locator("title").count() == 3
    best = page.locator("input").evaluate_all("all => all.map(one => one.value).filter(v => v.includes(' ms'))")
    chosen = best[0]
    page.get_by_role("button", name=APPLY).click()
    solver, setting = chosen.partition(": ")[0].split(", ")[:2]
    wait_until(lambda: session.frame.settings.solver == solver)
    number, name = setting.split()
    wait_until(lambda: getattr(session.frame.settings, name) == int(number))


def _compare(page: Any, session: Session, tmp_path: Path) -> None:
    page.get_by_text("Status", exact=True).click()
    page.get_by_text("Compare solvers", exact=True).click()
    steps = session.frame.step
    for solver in ("soft_step", "sequential_impulses"):
        label = page.get_by_text(solver.replace("_", " "), exact=True)
        label.locator("xpath=ancestor::div[contains(@class, 'Flex-root')][1]").locator("input").click()
    wait_until(lambda: session.frame.step < steps, 60.0)  # it began again
    page.wait_for_timeout(2500)
    picture = look(page, tmp_path / "ghosts.png")[:, :1000].astype(int)
    for colour in ((110, 158, 199), (214, 181, 116)):
        assert (np.abs(picture - colour).sum(axis=2) < 24).sum() > 150


def test_every_solver_has_a_switch(page: Page) -> None:
    session, client = page
    for name in SOLVERS:
        client.control(name.replace("_", " "))
    client.set("soft step", True)
    session.wait_for(Reset)


def test_a_comparison_that_cannot_keep_up_puts_its_switch_off_and_says_so(
    page: Page, monkeypatch: pytest.MonkeyPatch
) -> None:
    session, client = page
    client.set("soft step", True)
    session.wait_for(Reset)
    (others,) = (viewer for viewer in session._viewers if isinstance(viewer, SideBySide))
    with others._lock:
        wait_until(lambda: (session.publish(), others.ended)[1])
    sees(client, "could not keep up")
    wait_until(lambda: (client.read(), prop(client, "soft step", "value") is False)[1])
    client.set("soft step", True)
    session.wait_for(Reset, 2)
    assert not others.ended
