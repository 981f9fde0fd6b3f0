"""The command, called in this process."""

from __future__ import annotations

import logging
from pathlib import Path

import pytest

from sandbox import cli
from tests.sandbox.commandline import Result, Tumble


@pytest.fixture
def tumble(capsys: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture) -> Tumble:
    """Runs a command line: its exit code, standard output, standard error."""
    caplog.set_level(logging.CRITICAL)

    def run(*arguments: object) -> Result:
        capsys.readouterr()
        try:
            code = cli.main([str(argument) for argument in arguments])
        except SystemExit as exit_:  # argparse
            code = int(exit_.code or 0)
        out, err = capsys.readouterr()
        assert "Traceback" not in out + err
        return code, out, err

    return run


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A recording of 20 steps."""
    file = tmp_path_factory.mktemp("recorded") / "teeter.rrd"
    assert cli.main(["record", "Teeter", "-o", str(file), "--steps", "20"]) == 0
    return file


@pytest.fixture(scope="module")
def blocks(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """The bytes of a recording of 40 steps in several blocks."""
    file = tmp_path_factory.mktemp("blocks") / "teeter.rrd"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("recordings.mailbox.BLOCK_BYTES", 20_000)
        assert cli.main(["record", "Teeter", "-o", str(file), "--steps", "40"]) == 0
    return file.read_bytes()
