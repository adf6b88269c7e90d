# SPDX-License-Identifier: GPL-2.0-or-later
"""Case files for the tests of scenes, from TOML data."""

import json
from pathlib import Path


def value(x: object) -> str:
    """A TOML value."""
    if isinstance(x, dict):
        return "{ " + ", ".join(f"{k} = {value(v)}" for k, v in x.items()) + " }"
    if isinstance(x, list):
        return "[" + ", ".join(map(value, x)) + "]"
    return json.dumps(x)


def write_case(data: dict, folder: Path, name: str = "case.toml") -> Path:
    """The case file of `data`, in `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = [f"[{table}]\n" + "".join(f"{k} = {value(v)}\n" for k, v in keys.items()) for table, keys in data.items()]
    (folder / name).write_text("\n".join(lines))
    return folder / name
