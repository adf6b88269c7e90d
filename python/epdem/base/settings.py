# SPDX-License-Identifier: GPL-2.0-or-later
"""What a user sets once for all runs: the file epdem/config.toml in $XDG_CONFIG_HOME or ~/.config."""

import os
import tomllib
from pathlib import Path

from ..errors import CaseError

DEFAULT_ENGINE = "liggghts"  # of every command and function that is given none
KNOWN = {"engine": ("liggghts",)}


def config_file() -> Path:
    """Where the user's configuration file is, if there is one."""
    return Path(os.environ.get("XDG_CONFIG_HOME") or Path.home() / ".config") / "epdem" / "config.toml"


def setting(table: str, key: str) -> str | None:
    """The text of `key` in [table]; None without it or without the file. Raises CaseError for a file that is wrong."""
    path = config_file()
    try:
        values = tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None
    except (OSError, ValueError, RecursionError) as error:
        raise CaseError(f"{path}: {error}; mend or remove it") from None
    for name, keys in values.items():
        if name not in KNOWN or not isinstance(keys, dict):
            raise CaseError(f"{path}: {name}: is not known; there is [{'], ['.join(KNOWN)}]")
        for word, value in keys.items():
            if word not in KNOWN[name]:
                raise CaseError(f"{path}: {name}.{word}: is not known; there is {', '.join(KNOWN[name])}")
            if not isinstance(value, str) or not value:
                raise CaseError(f"{path}: {name}.{word} = {value!r}, must be a text; write it in quotes")
    found: str | None = values.get(table, {}).get(key)
    return found
