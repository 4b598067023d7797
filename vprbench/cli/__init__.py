"""The command line: a thin edge that turns words into calls, and errors into one line and an exit code."""

from __future__ import annotations

import sys

__all__ = ["main"]


def main() -> None:
    """Run `vprbench`; a fault the user can mend is one line on stderr and a non-zero exit code."""
    from vprbench.cli.app import app
    from vprbench.errors import VprbenchError

    try:
        app()
    except VprbenchError as error:
        # Whatever a cause says, a fault is told in one line.
        sys.stderr.write(f"vprbench: {' '.join(str(error).splitlines())}\n")
        sys.exit(error.exit_code)
