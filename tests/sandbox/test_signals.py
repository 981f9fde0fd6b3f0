"""Ctrl-C and a polite kill set an event; a second one interrupts."""

from __future__ import annotations

import signal
import threading

import pytest

from sandbox.signals import interruptible, stop_requested


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_first_signal_asks_and_second_interrupts(number: signal.Signals) -> None:
    before = signal.getsignal(number)
    with stop_requested() as stop:
        assert not stop.requested
        signal.raise_signal(number)
        assert stop.requested
        stop.wait()
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(number)
    assert signal.getsignal(number) == before


def test_waits_until_asked() -> None:
    with stop_requested() as stop:
        late = threading.Timer(0.05, lambda: signal.raise_signal(signal.SIGTERM))
        late.start()
        stop.wait()
        assert stop.requested
        late.join()


def test_handlers_come_back_after_an_error() -> None:
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(RuntimeError), stop_requested():
        raise RuntimeError("made up")
    assert signal.getsignal(signal.SIGINT) == before


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_what_has_nothing_to_finish_is_interrupted_at_once(number: int) -> None:
    before = signal.getsignal(signal.SIGTERM)
    with pytest.raises(KeyboardInterrupt), interruptible():
        signal.raise_signal(number)
    assert signal.getsignal(signal.SIGTERM) == before
