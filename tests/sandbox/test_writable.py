"""Whether a file can be written is known beforehand, and asking leaves nothing behind."""

from __future__ import annotations

from pathlib import Path

import pytest

from sandbox.verbs.writable import folder_hindrance, hindrance

LONG = "x" * 300


def test_what_can_be_written_is_left_as_it_is(tmp_path: Path) -> None:
    file = tmp_path / "there.json"
    file.write_text("kept")
    assert [hindrance(one) for one in (file, tmp_path / "new.json", Path("/dev/null"))] == ["", "", ""]
    assert [folder_hindrance(one) for one in (tmp_path, tmp_path / "a" / "b", Path())] == ["", "", ""]
    assert file.read_text() == "kept"
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize(
    ("name", "why"),
    [
        (".", "it is a folder"),
        ("none/new.json", "its folder does not exist"),
        ("file/new.json", "Not a directory"),
        (LONG, "File name too long"),
    ],
)
def test_what_cannot_be_written_has_a_reason(tmp_path: Path, name: str, why: str) -> None:
    (tmp_path / "file").write_text("")
    assert hindrance(tmp_path / name) == why
    assert [file.name for file in tmp_path.iterdir()] == ["file"]


@pytest.mark.parametrize(
    ("name", "why"), [("file", "Not a directory"), ("file/a/b", "Not a directory"), (LONG, "File")]
)
def test_a_folder_that_cannot_be_had_has_a_reason(tmp_path: Path, name: str, why: str) -> None:
    (tmp_path / "file").write_text("")
    assert folder_hindrance(tmp_path / name).startswith(why)


def test_a_disk_that_takes_no_files_is_seen_whatever_its_rights_say() -> None:
    assert hindrance(Path("/proc/new.json"))
    assert folder_hindrance(Path("/proc"))
