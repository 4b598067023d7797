"""Encoders and agents ready to use: fitted on a route's training drives, or restored where that was done before."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from vprbench.agents import Config, build, build_encoder, normalise
from vprbench.encoder_key import encoder_key, encoder_name
from vprbench.encoder_store import EncoderStore
from vprbench.fitting import TrainingFrames, fit
from vprbench.observation import Drive
from vprbench.plugins import one_line
from vprbench.protocols import Encoder, Localizer, Storable
from vprbench.reporting import Report, silent
from vprbench.route import Traverse

__all__ = ["FittedEncoder", "fitted_agent", "fitted_encoder"]


class FittedEncoder(NamedTuple):
    """An encoder that has learned.

    Attributes:
        encoder: ready to encode.
        restored: whether it was learned before and comes from the store.
        remark: what to tell of that or of the store, in a line; empty where there is nothing to tell.
    """

    encoder: Encoder
    restored: bool = False
    remark: str = ""


def fitted_agent(
    config: Config,
    seed: int,
    training: Sequence[Traverse],
    store: EncoderStore | None = None,
    report: Report = silent,
) -> Localizer:
    """The agent that a configuration describes: its encoder fitted first, then its localizer.

    Args:
        config: of the agent.
        seed: see `vprbench.agents.build`.
        training: drives off the route.
        store: where fitted encoders are kept; None for nowhere.
        report: gets the stage "fit" step by step, and then "fitted" with a remark if there is one.
    """
    # An option that is refused must not come to light only after minutes of learning.
    build(config, seed)
    report("fit", 0, 1)
    table = normalise(config)
    encoder = None
    if "encoder" in table:
        encoder, _, remark = fitted_encoder(table["encoder"], seed, training, store, report)
        report("fitted", 1, 1, remark)
    localizer = build(config, seed, encoder)
    localizer.fit([Drive(drive) for drive in training])
    return localizer


def fitted_encoder(
    config: Config,
    seed: int,
    training: Sequence[Traverse],
    store: EncoderStore | None = None,
    report: Report = silent,
    *,
    again: bool = False,
) -> FittedEncoder:
    """The encoder that a configuration describes, from the store if it can be, else fitted and kept there.

    Arguments are those of `fitted_agent`; with `again` it is fitted in any case.
    """
    encoder = build_encoder(config, seed)
    frames = TrainingFrames([Drive(drive) for drive in training])
    if store is None or not isinstance(encoder, Storable):
        fit(encoder, frames, report)
        return FittedEncoder(encoder)
    key = encoder_key(config, seed, encoder, training)
    with store.alone(key, report) as fault:
        found, damage = (None, "") if again else _restored(store, type(encoder), key)
        if found is not None:
            return FittedEncoder(found, True, f"encoder {encoder_name(config, seed)} restored: it learned this before")
        fit(encoder, frames, report)
        fault = fault or _kept(store, encoder, key)
        return FittedEncoder(encoder, False, ", ".join(filter(None, (damage, fault))))


def _restored(store: EncoderStore, kind: type[Storable], key: str) -> tuple[Storable | None, str]:
    """The stored encoder, if any; or why it is to be learned again."""
    try:
        return store.restore(kind, key), ""
    except Exception as error:
        return None, f"encoder learned again, since the stored one is damaged: {one_line(error)}"


def _kept(store: EncoderStore, encoder: Storable, key: str) -> str:
    """Keep an encoder; why that failed, if it did."""
    try:
        store.keep(encoder, key)
    except Exception as error:
        return f"encoder not stored: {store.folder}: {one_line(error)}"
    return ""
