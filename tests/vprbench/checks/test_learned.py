"""Every check of what an encoder may offer fails for a wrong one that no other check catches."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from vprbench.agents import build_encoder
from vprbench.checks import DoesNotApply, encoder_checks
from vprbench.protocols import Drawn, Encoder, Measured, Stepwise, Storable
from vprbench.types import Frame, LearningStep

THIRD_PARTY = Path(__file__).parents[2] / "third_party"


@pytest.fixture(autouse=True)
def acme(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(THIRD_PARTY))


def good() -> Any:  # noqa: ANN401 - a third party's class, which no import here can name
    return build_encoder("typical")


def wrong(**changed: object) -> Callable[[], Encoder]:
    """Encoders as good ones are, but for some methods."""

    def make() -> Encoder:
        made = good()
        made.__class__ = type("Wrong", (type(made),), changed)
        return made

    return make


def parent(encoder: object) -> Any:  # noqa: ANN401
    """The class of the good ones."""
    return type(encoder).__mro__[1]


def learns_too_little(self: Any, frames: Sequence[Frame]) -> Iterator[LearningStep]:  # noqa: ANN401
    yield from parent(self).learning(self, frames[:4])


def fits_everything(self: Any, frames: Sequence[Frame]) -> None:  # noqa: ANN401
    list(parent(self).learning(self, frames))


def overshoots(self: Any, frames: Sequence[Frame]) -> Iterator[LearningStep]:  # noqa: ANN401
    for step in parent(self).learning(self, frames):
        yield step._replace(done=step.done + 1)


def saves_beside(self: Any, path: Path) -> None:  # noqa: ANN401
    parent(self).save(self, path.with_suffix(".backup"))
    parent(self).save(self, path)


@classmethod  # type: ignore[misc]
def forgets_a_bit(cls: Any, path: Path) -> Any:  # noqa: ANN401
    loaded = cls.__mro__[1].load(path)
    loaded.weights[0] = np.nextafter(loaded.weights[0], np.float32(0))
    return loaded


@classmethod  # type: ignore[misc]
def forgets_how_to_match(cls: Any, path: Path) -> Any:  # noqa: ANN401
    loaded = cls.__mro__[1].load(path)
    loaded.metric = "l2"
    return loaded


@classmethod  # type: ignore[misc]
def forgets_the_time(cls: Any, path: Path) -> Any:  # noqa: ANN401
    loaded = cls.__mro__[1].load(path)
    loaded.seconds = 0.0
    return loaded


WRONG = [
    ("learning-does-what-fit-does", wrong(learning=learns_too_little, fit=fits_everything)),
    ("learning-does-what-fit-does", wrong(learning=overshoots)),
    ("comes-back-from-its-file", wrong(save=saves_beside)),
    ("comes-back-from-its-file", wrong(load=forgets_a_bit)),
    ("comes-back-from-its-file", wrong(load=forgets_how_to_match)),
    ("comes-back-from-its-file", wrong(load=forgets_the_time)),
    ("measures-are-numbers", wrong(measures=lambda self: {"rate": float("inf")})),
    ("measures-are-numbers", wrong(measures=lambda self: {"rate": "high"})),
    ("figures-are-drawn", wrong(figures=lambda self: {"map": None})),
]


def outcomes(factory: Callable[[], Encoder]) -> dict[str, str]:
    """What came of each check: ok, failed or skipped. See test_matching.py for faster ways to match."""
    found = {}
    for check in encoder_checks(factory):
        if "match-pairs" in check.name or check.name.startswith("matches-"):
            continue
        try:
            check.run()
            found[check.name] = "ok"
        except DoesNotApply:
            found[check.name] = "skipped"
        except Exception:
            found[check.name] = "failed"
    return found


def test_one_that_offers_everything_passes_every_check() -> None:
    assert all(isinstance(good(), protocol) for protocol in (Stepwise, Storable, Measured, Drawn))
    assert set(outcomes(good).values()) == {"ok"}


def test_one_that_offers_nothing_skips_them() -> None:
    skipped = {name for name, outcome in outcomes(lambda: build_encoder("mean-patch")).items() if outcome != "ok"}
    assert skipped == {name for name, _ in WRONG}


@pytest.mark.parametrize(("name", "factory"), WRONG)
def test_a_wrong_one_fails_its_check_and_no_other(name: str, factory: Callable[[], Encoder]) -> None:
    assert {check for check, outcome in outcomes(factory).items() if outcome != "ok"} == {name}
