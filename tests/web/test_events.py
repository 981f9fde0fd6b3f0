"""What the page tells of events: of frames that it does not draw, too, and the last ten of them."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np

from engine import Events
from engine.events import BODY_EVENT, BROKEN_EVENT, HIT_EVENT, NOTHING, TOUCH_EVENT
from sandbox.frame import Frame
from tests.web.fake_session import make_frame, wait_until
from web.panels.events import LATEST, Tally, events_html, latest_lines
from web.publisher import Publisher


def begun(*steps: int) -> Events:
    """A pair that begins to touch in each of these steps: body1 is the step."""
    return NOTHING._replace(begin=np.array([(step, 0, 1, step, 1) for step in steps], TOUCH_EVENT))


def frame(step: int, events: Events = NOTHING, **changes: Any) -> Frame:
    return make_frame([], step=step, events=events, **changes)


def test_no_event_is_lost_on_the_way_to_the_page() -> None:
    drawn: list[Frame] = []
    go = threading.Event()

    def draw(shown: Frame) -> None:
        go.wait(10)
        drawn.append(shown)

    publisher = Publisher(draw)
    for step in range(50):
        publisher.put(frame(step, begun(step), events_lost=1))
    go.set()
    wait_until(lambda: drawn and drawn[-1].step == 49)
    assert len(drawn) < 10
    steps = [step for shown in drawn for step in shown.events.begin["step"]]
    assert steps == list(range(50))
    assert sum(shown.events_lost for shown in drawn) == 50
    count = len(drawn)
    publisher.again()
    wait_until(lambda: len(drawn) > count)
    assert not len(drawn[-1].events.begin), "told once"
    publisher.close()


def test_the_last_ten_and_the_counts() -> None:
    tally = Tally()
    tally.add(frame(3, begun(1, 2, 3)))
    tally.add(frame(15, begun(*range(4, 16)), events_lost=7))
    assert tally.counts["begin"] == 15
    assert list(tally.latest) == [f"{step}: begin {step} and 1" for step in range(15, 15 - LATEST, -1)]
    assert "15 begin; 7 more were lost" in events_html(tally)
    tally.add(frame(2))
    assert not tally.latest, "begun again"
    assert "nothing yet" in events_html(tally)
    tally.add(frame(4, begun(4)))
    tally.add(frame(4, scene="another"))
    assert tally.counts["begin"] == 0


def test_each_kind_is_told_in_the_order_of_its_step() -> None:
    hit = np.zeros(1, HIT_EVENT)
    hit["step"], hit["body2"], hit["speed"] = 6, 3, 2.5
    events = begun(6, 7)._replace(
        hit=hit,
        fell_asleep=np.array([(5, 2)], BODY_EVENT),
        woke=np.array([(8, 2)], BODY_EVENT),
        broken=np.array([(8, 4, 0, 2, 12.5, 0.25)], BROKEN_EVENT),
    )
    assert latest_lines(events, 10) == [
        "5: fell asleep 2",
        "6: begin 6 and 1",
        "6: hit 0 and 3 with 2.50 m/s",
        "7: begin 7 and 1",
        "8: woke 2",
        "8: broken joint 4 of 0 and 2: 12.5 N, 0.25 N m",
    ]
    assert latest_lines(events, 1) == ["8: broken joint 4 of 0 and 2: 12.5 N, 0.25 N m"]
