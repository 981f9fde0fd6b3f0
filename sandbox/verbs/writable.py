"""Whether a file can be written, found out before minutes of measuring are lost; nothing is made by asking."""

from __future__ import annotations

import stat
import tempfile
from pathlib import Path


def hindrance(file: Path) -> str:
    """Why the file cannot be written; "" if it can."""
    try:
        return _of_what_is_there(file)
    except FileNotFoundError:
        pass
    except OSError as error:
        return error.strerror or str(error)
    return "its folder does not exist" if not file.parent.is_dir() else _of_a_new_one_in(file.parent)


def folder_hindrance(folder: Path) -> str:
    """Why there can be no such folder, or nothing be written into it; "" if all is well."""
    try:
        there = next(one for one in (folder, *folder.absolute().parents) if one.exists() or one.is_symlink())
    except OSError as error:  # such as a name that is too long
        return error.strerror or str(error)
    return _of_a_new_one_in(there) if there.is_dir() else "Not a directory"


def _of_what_is_there(file: Path) -> str:
    mode = file.stat().st_mode
    if stat.S_ISDIR(mode):
        return "it is a folder"
    if stat.S_ISREG(mode):
        file.open("ab").close()
    return ""


def _of_a_new_one_in(folder: Path) -> str:
    """Tried with a file that has no name: what rights say is not always what the disk does."""
    try:
        with tempfile.TemporaryFile(dir=folder):
            return ""
    except OSError as error:
        return error.strerror or str(error)
