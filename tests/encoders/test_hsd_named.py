from __future__ import annotations

import pytest

from vprbench.agents import build_encoder
from vprbench.checks.samples import textured_frame
from vprbench_encoders.hsd import HSD

FRAMES = [textured_frame(200)]


@pytest.mark.parametrize(
    ("name", "size", "map_size", "values"),
    [
        ("hsd", 15, 15, 64),
        ("hsd-12", 12, 12, 36),
        ("hsd-15", 15, 15, 64),
        ("hsd-18", 18, 18, 81),
        ("hsd-21", 21, 21, 100),
        ("hsd-24", 24, 24, 144),
        ("hsd-30", 30, 30, 225),
        ("hsd-15-30", 15, 30, 225),
    ],
)
def test_each_configuration_of_the_paper_has_a_name(name: str, size: int, map_size: int, values: int) -> None:
    encoder = build_encoder({"name": name, "steps": 1, "epochs": 1}, seed=4)
    assert isinstance(encoder, HSD)
    assert (encoder.size, encoder.map_size or encoder.size, encoder.seed) == (size, map_size, 4)
    encoder.fit(FRAMES)
    assert len(encoder.layers[0].units) == len(encoder.layers[1].units) == map_size**2
    assert encoder.encode(textured_frame(1)).signatures.shape == (25, values)


def test_ours_is_the_code_of_one_layer_at_more_points() -> None:
    encoder = build_encoder({"name": "hsd-plus", "steps": 1, "epochs": 1}, seed=4)
    encoder.fit(FRAMES)
    signatures = encoder.encode(textured_frame(1)).signatures
    assert signatures.shape[0] > 25 and signatures.shape[1] == 225
    assert ((signatures > 0).sum(axis=1) <= 15).all()
