"""Names in archives that would lead out of the folder where one is unpacked."""

from __future__ import annotations

import re

__all__ = ["leads_out"]

# From the root or from a drive, by way of a parent, or with what another system takes for a separator or an end.
_ESCAPING = re.compile(r"/|.:|(?:.*/)?\.\.(?:/|$)|.*[\\\x00]", re.DOTALL)


def leads_out(name: str) -> bool:
    """Whether a member's name, taken as a path below some folder, may lead out of it, on any system."""
    return _ESCAPING.match(name) is not None
