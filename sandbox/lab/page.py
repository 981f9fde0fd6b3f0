"""A page of the documents that a command writes a part of: what stands between two marks, and nothing else."""

from __future__ import annotations

from pathlib import Path


class PageError(Exception):
    """The page cannot be written; the message is one line for the user."""


def marks(name: str) -> tuple[str, str]:
    """The lines before and after the part."""
    return f"<!-- {name} -->", f"<!-- end of {name} -->"


def check_page(file: Path, name: str) -> None:
    """PageError unless the page is new, in a folder that is there, or has the marks, once and in order."""
    _parts(file, name)


def write_section(file: Path, name: str, text: str) -> None:
    """Writes the part; makes the page if there is none."""
    before, after = _parts(file, name)
    begin, end = marks(name)
    try:
        file.write_text(f"{before}{begin}\n\n{text.strip()}\n\n{end}{after}", encoding="utf-8")
    except OSError as error:
        raise PageError(f"{file}: cannot be written: {error.strerror}") from None


def _parts(file: Path, name: str) -> tuple[str, str]:
    """What stands before the part, and what after it."""
    if not file.parent.is_dir():
        raise PageError(f"{file}: its folder does not exist")
    if not file.exists():
        return "", "\n"
    try:
        page = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise PageError(f"{file}: cannot be read: {getattr(error, 'strerror', None) or 'not text'}") from None
    begin, end = marks(name)
    before, found, rest = page.partition(begin)
    _, closed, after = rest.partition(end)
    if not (found and closed):
        raise PageError(f"{file}: must have the lines {begin} and {end}, between which the tables go")
    return before, after
