"""Verdicts on readings made by hand."""

from __future__ import annotations

import pytest

from vprbench.claims.reading import Reading
from vprbench.claims.rules import NOT_SUPPORTED, NOT_TESTABLE, SUPPORTED, Around, Beyond

NAN = float("nan")


def reading(low: float, high: float) -> Reading:
    return Reading((low + high) / 2, low, high, "here")


MORE = Beyond(kind="beyond", side="more")
LESS = Beyond(kind="beyond", side="less")
SLOWER = Beyond(kind="beyond", side="less", than=1)
FASTER = Beyond(kind="beyond", side="more", than=1)


@pytest.mark.parametrize(
    ("rule", "paper", "low", "high", "verdict", "note"),
    [
        (MORE, 10, 8, 12, SUPPORTED, ""),
        (MORE, 10, 12, 14, SUPPORTED, "more than the claimed size"),
        (MORE, 10, 1, 9, NOT_SUPPORTED, "direction only: less than the claimed size"),
        (MORE, 10, -1, 12, NOT_SUPPORTED, "no difference shown"),
        (MORE, 10, 0, 12, NOT_SUPPORTED, "no difference shown"),
        (MORE, 10, -5, -1, NOT_SUPPORTED, "the opposite is shown"),
        (MORE, None, 0.1, 0.2, SUPPORTED, ""),
        (MORE, None, -0.1, 0.2, NOT_SUPPORTED, "no difference shown"),
        (LESS, -9, -12, -8, SUPPORTED, ""),
        (LESS, -9, -8, -1, NOT_SUPPORTED, "direction only: less than the claimed size"),
        (LESS, None, 1, 2, NOT_SUPPORTED, "the opposite is shown"),
        (SLOWER, 0.5, 0.4, 0.6, SUPPORTED, ""),
        (SLOWER, 0.5, 0.2, 0.4, SUPPORTED, "more than the claimed size"),
        (SLOWER, 0.5, 0.6, 0.9, NOT_SUPPORTED, "direction only: less than the claimed size"),
        (SLOWER, 0.5, 0.4, 1.1, NOT_SUPPORTED, "no difference shown"),
        (FASTER, 2, 1.9, 2.1, SUPPORTED, ""),
        (FASTER, 2, 0.5, 0.9, NOT_SUPPORTED, "the opposite is shown"),
        (MORE, 10, NAN, NAN, NOT_TESTABLE, "too few data for an interval"),
    ],
)
def test_beyond(rule: Beyond, paper: float | None, low: float, high: float, verdict: str, note: str) -> None:
    assert rule.judge(reading(low, high), paper) == (verdict, note)


@pytest.mark.parametrize(
    ("paper", "margin", "low", "high", "verdict", "note"),
    [
        (0, 4, -1, 3, SUPPORTED, ""),
        (0, 4, 1, 3, SUPPORTED, ""),
        (0, 4, -1, 5, NOT_SUPPORTED, "the interval is wider than the margin of 4"),
        (0, 4, 1, 5, NOT_SUPPORTED, "a difference is shown"),
        (0, 4, -9, -1, NOT_SUPPORTED, "a difference is shown"),
        (85, 4, 82, 88, SUPPORTED, ""),
        (85, 4, 90, 95, NOT_SUPPORTED, "another value is shown"),
        (2916, 0, 2916, 2916, SUPPORTED, ""),
        (2916, 0, 729, 729, NOT_SUPPORTED, "another value is shown"),
        (15, 5, float("inf"), float("inf"), NOT_SUPPORTED, "another value is shown"),
        (0, 4, NAN, NAN, NOT_TESTABLE, "too few data for an interval"),
    ],
)
def test_around(paper: float, margin: float, low: float, high: float, verdict: str, note: str) -> None:
    assert Around(kind="around", margin=margin).judge(reading(low, high), paper) == (verdict, note)
