from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

from vprbench.agents import build_encoder
from vprbench.checks.samples import flat_frame, textured_frame
from vprbench.errors import ConfigError, DataError, PhaseError
from vprbench.protocols import Encoder, Measured, Stepwise, Storable
from vprbench.types import Frame, LearningStep
from vprbench_encoders.hsd import HSD
from vprbench_encoders.stepwise import finished

# Few steps of a small encoder: enough to tell options apart.
QUICK: dict[str, Any] = {"size": 6, "steps": 6, "epochs": 10, "copies": 2}
FRAMES = [textured_frame(seed) for seed in range(200, 206)]


def fitted(**options: Any) -> HSD:  # noqa: ANN401
    encoder = HSD(**{**QUICK, **options})
    encoder.fit(FRAMES)
    return encoder


def signatures(encoder: HSD) -> np.ndarray:
    return encoder.encode(textured_frame(1)).signatures


@pytest.fixture(scope="module")
def usual() -> HSD:
    return fitted()


@pytest.mark.parametrize("protocol", [Encoder, Measured, Stepwise, Storable])
def test_it_is_an_encoder_that_learns_stepwise_and_can_be_stored_and_measured(protocol: type) -> None:
    assert isinstance(HSD(), protocol)


def test_a_signature_is_made_of_as_many_values_as_s2_picks_at_most(usual: HSD) -> None:
    active = (signatures(usual) > 0).sum(axis=1)
    assert active.max() <= 5
    assert active.min() >= 1
    assert ((signatures(fitted(signature="c1")) > 0).sum(axis=1) <= 10).all()


def test_contrast_and_brightness_do_not_change_a_signature(usual: HSD) -> None:
    frame = textured_frame(1)
    bright, dim = usual.encode(frame // 2 * 2), usual.encode(frame // 2 + 40)
    np.testing.assert_array_equal(bright.points, dim.points)
    np.testing.assert_allclose(bright.signatures, dim.signatures, atol=2e-2)


def test_a_frame_without_gradient_has_no_landmarks(usual: HSD) -> None:
    landmarks = usual.encode(flat_frame(80))
    assert landmarks.signatures.shape == (0, 9)
    assert landmarks.points.shape == (0, 2)


def test_the_same_seed_learns_the_same_dictionaries_and_another_seed_others(usual: HSD) -> None:
    same, other = fitted(), fitted(seed=1)
    for layer, (one, two) in enumerate(zip(same.layers, other.layers, strict=True)):
        np.testing.assert_array_equal(one.units, usual.layers[layer].units)
        assert np.abs(one.units - two.units).max() > 0.1


def test_units_have_unit_length(usual: HSD) -> None:
    for layer in usual.layers:
        np.testing.assert_allclose(np.linalg.norm(layer.units, axis=1), 1, rtol=1e-5)


def test_s2_codes_what_c1_has_beyond_its_mean(usual: HSD) -> None:
    first, second = usual.layers
    views = finished(usual._sampling.drawing(usual._views, FRAMES, np.random.default_rng(0)))
    np.testing.assert_allclose(second.mean, first.pooled(views.training).mean(axis=0), atol=1e-5)
    np.testing.assert_array_equal(first.mean, 0)
    np.testing.assert_array_equal(fitted(centred=False).layers[1].mean, 0)


@pytest.mark.parametrize(
    "options",
    [
        {"whitening": False},
        {"cutoff": 0.2},
        {"window": 40},
        {"jitter": 0},
        {"copies": 3},
        {"training_frames": 3},
        {"held_out": 0.5},
        {"picks": (6, 3)},
        {"homeostasis": "hap", "homeostasis_rate": 0.5},
        {"homeostasis": "none"},
        {"homeostasis_rate": 0.5},
        {"rule": "plain", "rate": 0.02},
        {"rate": 0.1},
        {"batch": 100},
        {"steps": 3},
        {"passes": 1},
        {"batch": 100, "steps": 20, "tolerance": 0.9},
        {"rectified": False},
        {"topology": False},
        {"epochs": 3},
        {"neighbourhood": 2.0},
        {"final_neighbourhood": 1.0},
        {"pool": 1},
        {"centred": False},
        {"equalised": True},
        {"signature": "c1"},
        {"map_size": 8},
        {"points": 10},
        {"radius": 40.0},
        {"focus_reduction": 2},
    ],
    ids=str,
)
def test_every_option_changes_the_signatures(usual: HSD, options: dict[str, Any]) -> None:
    changed, ordinary = signatures(fitted(**options)), signatures(usual)
    assert not np.array_equal(changed, ordinary)
    assert np.isfinite(changed).all()


def test_bins_matter_where_homeostasis_is_fast() -> None:
    coarse, fine = (fitted(bins=bins, homeostasis_rate=0.5) for bins in (4, 128))
    assert not np.array_equal(signatures(coarse), signatures(fine))


def test_reports_tell_training_from_held_out_and_atoms_from_units() -> None:
    encoder = fitted(steps=40, held_out=0.4, size=8)
    assert len(encoder.reports) == 2
    for report in encoder.reports:
        for rate in (*report.atoms, *report.units):
            assert 0 < rate < 1
        # A map of as many units as atoms blurs them.
        assert report.units.training < report.atoms.training
        assert 0 < report.entropy <= 1
        assert report.usage.shape == (64,)
        assert report.seconds > 0
    # Noise has nothing in common with other noise but its spectrum.
    assert encoder.reports[0].atoms.held_out < encoder.reports[0].atoms.training


def test_without_topology_atoms_and_units_are_one() -> None:
    for report in fitted(topology=False, held_out=0.4).reports:
        assert report.atoms == report.units


def test_without_held_out_frames_their_rate_is_unknown() -> None:
    assert np.isnan(fitted(held_out=0.0).reports[0].atoms.held_out)


def test_without_held_out_frames_there_are_no_measures_of_them() -> None:
    names = fitted(held_out=0.0).measures().keys()
    assert {"s1_rate", "s2_rate"} <= names
    assert not any("held_out" in name for name in names)


def test_measures_are_the_reports_layer_by_layer() -> None:
    encoder = fitted(held_out=0.5, map_size=8)
    measures = encoder.measures()
    for layer, report in zip(("s1", "s2"), encoder.reports, strict=True):
        assert (measures[f"{layer}_rate"], measures[f"{layer}_rate_held_out"]) == report.atoms
        assert (measures[f"{layer}_map_rate"], measures[f"{layer}_map_rate_held_out"]) == report.units
        assert measures[f"{layer}_usage_entropy"] == report.entropy
        assert measures[f"{layer}_seconds"] == report.seconds
    assert measures["signature_size"] == signatures(encoder).shape[1] == 16
    assert len(measures) == 2 * 6 + 1


def test_learning_tells_every_step_of_every_stage() -> None:
    encoder = HSD(**QUICK, batch=100, equalised=True)
    steps = list(encoder.learning(FRAMES))
    counts: dict[str, list[LearningStep]] = {}
    for step in steps:
        counts.setdefault(step.stage, []).append(step)
    # 6 frames of 25 points, twice each, a sixth of them held out... of so few, none.
    totals = {"local views": 6, "S1 dictionary": 6, "S1 map": 10, "S1 homeostasis": 6, "C1": 300}
    totals |= {"S2 dictionary": 6, "S2 map": 10, "S2 homeostasis": 6}
    assert list(counts) == list(totals)
    for stage, told in counts.items():
        assert {step.total for step in told} == {totals[stage]}
        assert told[-1].done == totals[stage]
        assert [step.done for step in told] == sorted(step.done for step in told)
        assert all(step.note.startswith("reconstruction rate 0.") for step in told if "dictionary" in stage)


def test_learning_step_by_step_is_fitting(usual: HSD) -> None:
    encoder = HSD(**QUICK)
    for _ in encoder.learning(FRAMES):
        with pytest.raises(PhaseError):
            encoder.encode(FRAMES[0])
    np.testing.assert_array_equal(signatures(encoder), signatures(usual))


def test_interrupted_learning_leaves_the_encoder_as_it_was() -> None:
    encoder = fitted()
    before = signatures(encoder)
    steps = encoder.learning(FRAMES[:2])
    assert any(step.stage == "S2 map" for step in steps)
    np.testing.assert_array_equal(signatures(encoder), before)
    list(steps)
    assert not np.array_equal(signatures(encoder), before)


class Counted(Sequence[Frame]):
    """Frames that count how often each is read."""

    def __init__(self) -> None:
        self.reads = [0] * 12

    def __len__(self) -> int:
        return len(self.reads)

    def __getitem__(self, index: Any) -> Any:  # noqa: ANN401
        self.reads[index] += 1
        return textured_frame(300 + index)


@pytest.mark.parametrize(("most", "reads"), [(1000, [1] * 12), (3, [1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])])
def test_each_frame_is_read_once_and_no_more_than_asked(most: int, reads: list[int]) -> None:
    frames = Counted()
    HSD(**QUICK, training_frames=most).fit(frames)
    assert frames.reads == reads


@pytest.mark.parametrize("frames", [[], [flat_frame(9)] * 3])
def test_frames_without_focus_points_teach_nothing(frames: list[Frame]) -> None:
    with pytest.raises(DataError, match="focus point"):
        HSD(**QUICK).fit(frames)


def test_an_encoder_that_has_learned_nothing_says_so() -> None:
    with pytest.raises(PhaseError, match="fit"):
        HSD().encode(textured_frame(1))
    with pytest.raises(PhaseError, match="fit"):
        HSD().measures()


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ({"size": 1}, "size"),
        ({"map_size": 1}, "map_size"),
        ({"size": 6, "map_size": 8, "topology": False}, "topology"),
        ({"focus_reduction": 0}, "focus_reduction"),
        ({"window": 27}, "window"),
        ({"window": 190}, "window"),
        ({"cutoff": 0.0}, "cutoff"),
        ({"pool": 0}, "pool"),
        ({"pool": 16}, "pool"),
        ({"picks": [0, 5]}, "picks"),
        ({"size": 3, "picks": [9, 5]}, "picks"),
        ({"jitter": -1}, "jitter"),
        ({"copies": 0}, "copies"),
        ({"training_frames": 0}, "training_frames"),
        ({"held_out": 1.0}, "held_out"),
        ({"steps": 0}, "steps"),
        ({"rate": 0.0}, "rate"),
        ({"tolerance": 1.0}, "tolerance"),
        ({"epochs": 0}, "epochs"),
        ({"neighbourhood": 0.1}, "neighbourhood"),
        ({"points": 0}, "points"),
        ({"homeostasis": "hep"}, "'heh'"),
        ({"signature": "c3"}, "'c2'"),
        ({"similarity": "cos"}, "cosine"),
        ({"size": "15"}, "size"),
        ({"szie": 15}, "'size'"),
    ],
    ids=str,
)
def test_impossible_options_are_refused_by_name(options: dict[str, Any], named: str) -> None:
    with pytest.raises(ConfigError, match=named):
        build_encoder({"name": "hsd", **options})
