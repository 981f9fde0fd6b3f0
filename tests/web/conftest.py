"""One live page over a session without physics, for all tests of a module: opening one takes a while."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.web.fake_session import FakeSession, pyramid
from web import App


@pytest.fixture(scope="module")
def served() -> Iterator[tuple[FakeSession, App]]:
    session = FakeSession(pyramid(4))
    app = App(session, port=0)  # type: ignore[arg-type]
    yield session, app
    app.close()
    session.close()
