"""What all tests share: no silent skips in CI, what the machine must have, and how hypothesis draws."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import settings

# A first call compiles for seconds: no deadline. In CI the examples are the same each time: a red run can be repeated.
settings.register_profile("here", deadline=None)
settings.register_profile("ci", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("ci" if os.environ.get("CI") else "here")

NO_SKIP = os.environ.get("TUMBLE_NO_SKIP") == "1"  # a skipped test fails the run: set by `make check`

_VULKAN_FOLDERS = ("/usr/share/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/etc/vulkan/icd.d")


@pytest.fixture(scope="session")
def chromium() -> Path:
    """The browser's path; skips without one."""
    from tests.web.browser import find_chromium  # here, so that other tests do without a browser's driver

    path = find_chromium()
    if path is None:
        pytest.skip("no Chromium: apt-get install chromium")
    return path


@pytest.fixture(scope="session")
def vulkan() -> list[Path]:
    """The Vulkan drivers' files; skips without one. Mesa's draws on the CPU."""
    named = os.environ.get("VK_DRIVER_FILES") or os.environ.get("VK_ICD_FILENAMES") or ""
    files = [Path(name) for name in named.split(os.pathsep) if name]
    drivers = [file for file in files if file.is_file()]
    if not named:
        drivers = [file for folder in _VULKAN_FOLDERS for file in sorted(Path(folder).glob("*.json"))]
    if not drivers:
        pytest.skip("no Vulkan driver: apt-get install mesa-vulkan-drivers")
    return drivers


@pytest.fixture(autouse=True)
def _needs(request: pytest.FixtureRequest) -> None:
    """A marked test need not ask for the fixture of the same thing; a wider fixture that uses the thing must."""
    for marker, fixture in (("browser", "chromium"), ("vulkan", "vulkan")):
        if request.node.get_closest_marker(marker) is not None:
            request.getfixturevalue(fixture)


def _skipped(config: pytest.Config) -> int:
    reporter = config.pluginmanager.get_plugin("terminalreporter")
    return len(reporter.stats.get("skipped", [])) if NO_SKIP and reporter is not None else 0


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish(session: pytest.Session) -> None:
    if _skipped(session.config):
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    if count := _skipped(config):
        terminalreporter.write_line(
            f"TUMBLE_NO_SKIP=1: {count} skipped, so this run fails. The reasons below say what is missing.", red=True
        )
