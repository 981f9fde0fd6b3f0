"""Threads that run at the same time; one that never ends fails a test instead of holding it up."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

LONG = 60.0  # a thread that has not come back by then never will [s]


def at_once(*work: Callable[[], Any]) -> list[Any]:
    """Runs functions in a thread each, all begun together, and gives what they return."""
    start = threading.Barrier(len(work))
    results: list[Any] = [None] * len(work)
    errors: list[BaseException] = []

    def run(place: int) -> None:
        start.wait()
        try:
            results[place] = work[place]()
        except BaseException as error:  # noqa: BLE001 - told by the thread that waits
            errors.append(error)

    threads = [threading.Thread(target=run, args=(place,), daemon=True) for place in range(len(work))]
    for thread in threads:
        thread.start()
    end = time.monotonic() + LONG
    for thread in threads:
        thread.join(max(0.0, end - time.monotonic()))
    if errors:
        raise errors[0]
    assert not any(thread.is_alive() for thread in threads), "a thread waits for ever"
    return results
