"""Calling the command in this process, and what its refusals look like."""

from __future__ import annotations

import signal
import urllib.request
import webbrowser
from collections.abc import Callable
from typing import Any

import pytest

Result = tuple[int, str, str]  # exit code, standard output, standard error
Tumble = Callable[..., Result]

# that take a file, and would serve or open it
VERBS_OF_A_FILE = [["verify"], ["replay", "--no-open", "--port", "0"], ["replay", "--viewer", "rerun"]]


def one_line(result: Result) -> str:
    """The one line of a refusal."""
    code, out, err = result
    assert (code, out) == (2, ""), result
    assert err.startswith("tumble: ")
    assert err.count("\n") == 1
    assert err.endswith("\n")
    return err


def usage_error(result: Result) -> str:
    """The one line about wrong arguments."""
    code, out, err = result
    assert (code, out) == (2, ""), result
    assert err.startswith("tumble")
    (line,) = err.splitlines()
    return line


class Visit:
    """Stands in for the browser: looks at the page once, then ends the server as Ctrl-C would."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, number: signal.Signals = signal.SIGINT) -> None:
        self.url = self.page = ""
        self._number = number
        monkeypatch.setattr(webbrowser, "open", self)

    def __call__(self, url: str) -> bool:
        with urllib.request.urlopen(url, timeout=10) as answer:
            assert answer.status == 200
            self.page = answer.read().decode()
        self.url = url
        signal.raise_signal(self._number)
        return True


class StoppedAtOnce:
    """sandbox.signals.stop_requested, after a Ctrl-C."""

    requested = True

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def wait(self) -> None:
        pass
