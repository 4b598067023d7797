"""One thing that is wrong with data, or odd about them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

__all__ = ["Finding", "Severity"]

Severity = Literal["error", "warning"]


@dataclass(frozen=True)
class Finding:
    """What a check found.

    Attributes:
        severity: "error" where the data cannot be used as they are, "warning" where somebody should look.
        check: the check's name, "duplicate-frames" for example.
        where: the drive, with its frames where it is some of them.
        what: what was found, in one line.
        remedy: what to do about it.
    """

    severity: Severity
    check: str
    where: str
    what: str
    remedy: str

    def __str__(self) -> str:
        return f"{self.check}: {self.where}: {self.what}; {self.remedy}"
