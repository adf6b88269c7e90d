# SPDX-License-Identifier: GPL-2.0-or-later
"""Errors by exit code. Every message names place, value, limit and next step."""


class EpdemError(Exception):
    """Base of all errors that a user can mend."""

    exit_code = 2


class CaseError(EpdemError, ValueError):
    """A case file, an option or a parameter is wrong (exit code 2); nothing was written."""


class Stopped(BaseException):
    """Ctrl-C, a batch system or a closed terminal ended the run (exit code 130); not an error that anything catches."""


class EngineError(EpdemError):
    """An engine is missing, died or hung (exit code 3); its files are kept."""

    exit_code = 3
