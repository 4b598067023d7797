"""What the optional protocols ask of an encoder: to learn step by step, to be stored, measured and drawn."""

from __future__ import annotations

from importlib.util import find_spec
from math import isfinite
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TypeVar

import numpy as np

from vprbench.checks.check import DoesNotApply, Suite, expect
from vprbench.checks.encoder_subject import EncoderSubject, LazyFrames, same_landmarks
from vprbench.checks.samples import textured_frame
from vprbench.protocols import Drawn, Encoder, Measured, Stepwise, Storable
from vprbench.types import LearningStep

__all__ = ["learned_suite"]

Offered = TypeVar("Offered", bound=Encoder)

learned_suite = Suite[EncoderSubject]()


def _offered(encoder: Encoder, protocol: type[Offered], names: str) -> Offered:
    """The encoder, if it has what only some have."""
    if not isinstance(encoder, protocol):
        raise DoesNotApply(f"it has no {names}, which {'are' if ' ' in names else 'is'} optional")
    return encoder


@learned_suite.add
def _learning_does_what_fit_does(subject: EncoderSubject) -> None:
    encoder = _offered(subject.factory(), Stepwise, "learning")  # type: ignore[type-abstract]
    steps = list(encoder.learning(LazyFrames()))
    sound = all(isinstance(step, LearningStep) and 0 <= step.done <= step.total for step in steps)
    expect(sound, "learning gives LearningSteps, each with done in 0..total")
    same = same_landmarks(encoder.encode(textured_frame(1)), subject.landmarks[0])
    expect(same, "once learning is exhausted, the encoder is exactly as fit leaves it: let fit exhaust it")


@learned_suite.add
def _comes_back_from_its_file(subject: EncoderSubject) -> None:
    encoder = _offered(subject.encoder, Storable, "save and load")  # type: ignore[type-abstract]
    with TemporaryDirectory() as folder:
        path = Path(folder, "encoder.npz")
        encoder.save(path)
        expect(list(Path(folder).iterdir()) == [path], "save writes the file that is named, and no other")
        loaded = type(encoder).load(path)
    same = all(map(same_landmarks, (loaded.encode(textured_frame(seed)) for seed in (1, 2)), subject.landmarks))
    expect(same, "what load gives encodes to the bit as the encoder that was saved")
    same = np.array_equal(loaded.match(*subject.signatures), encoder.match(*subject.signatures))
    expect(same, "what load gives matches to the bit as the encoder that was saved")
    if isinstance(encoder, Measured) and isinstance(loaded, Measured):
        same = dict(loaded.measures()) == dict(encoder.measures())
        expect(same, "what load gives has the measures of the encoder that was saved")


@learned_suite.add
def _measures_are_numbers(subject: EncoderSubject) -> None:
    encoder = _offered(subject.encoder, Measured, "measures")  # type: ignore[type-abstract]
    for name, value in encoder.measures().items():
        number = isinstance(value, float | int) and isfinite(value)
        expect(number, f"measures are finite numbers, not {name} = {value!r}")


@learned_suite.add
def _figures_are_drawn(subject: EncoderSubject) -> None:
    encoder = _offered(subject.encoder, Drawn, "figures")  # type: ignore[type-abstract]
    if find_spec("matplotlib") is None:
        raise DoesNotApply("matplotlib is not installed: pip install 'vprbench[figures]'")
    from matplotlib.figure import Figure

    for stem, figure in encoder.figures().items():
        expect(isinstance(figure, Figure), f"figures are matplotlib Figures by file stem; {stem!r} is {figure!r}")
