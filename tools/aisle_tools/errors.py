"""Errors meant for the person at the console: one line, exit code 2."""

from __future__ import annotations


class UserError(Exception):
    """Something the caller can mend; the text says what and where."""
