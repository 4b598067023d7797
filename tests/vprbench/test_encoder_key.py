"""Keys of fits: unlike wherever something decides what is learned, alike wherever nothing does."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from vprbench import encoder_key as module
from vprbench.agents import Config, build_encoder
from vprbench.encoder_key import encoder_key, training_checksum
from vprbench.plugins import find
from vprbench.route import Route, Traverse

THIRD_PARTY = Path(__file__).parents[1] / "third_party"

PLUGIN = """
from acme_vpr.mean_patch import MeanPatch
from mine import shades

class Mine(MeanPatch):
    pass
"""


@pytest.fixture(autouse=True)
def mine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The package of a plug-in that stands on the third party's."""
    (tmp_path / "mine-1.dist-info").mkdir()
    (tmp_path / "mine-1.dist-info" / "METADATA").write_text("Name: mine\nVersion: 1\n")
    (tmp_path / "mine-1.dist-info" / "entry_points.txt").write_text("[vprbench.encoders]\nmine = mine.patch:Mine\n")
    package = tmp_path / "mine"
    package.mkdir()
    (package / "__init__.py").touch()
    (package / "patch.py").write_text(PLUGIN)
    (package / "shades.py").write_text("GREY = 128\n")
    monkeypatch.syspath_prepend(str(THIRD_PARTY))
    monkeypatch.syspath_prepend(str(tmp_path))
    return package


def key(route: Route, config: Config = "typical", seed: int = 0, training: Sequence[Traverse] | None = None) -> str:
    module._source_hash.cache_clear()
    drives = route.training if training is None else training
    return encoder_key(config, seed, build_encoder(config, seed), drives)


def test_what_decides_what_is_learned_changes_the_key(toy_route: Route, monkeypatch: pytest.MonkeyPatch) -> None:
    (drive,) = toy_route.training
    keys = [
        key(toy_route),
        key(toy_route, {"name": "typical", "size": 5}),
        key(toy_route, seed=1),
        key(toy_route, {"name": "typical", "seed": 1}),
        key(toy_route, training=[replace(drive, checksum="another")]),
        key(toy_route, training=[drive, drive]),
        key(toy_route, training=[]),
    ]
    with monkeypatch.context() as patch:
        patch.setattr(module, "versions", lambda: {"libraries": "numpy=9.0"})
        keys.append(key(toy_route))
    with monkeypatch.context() as patch:
        patch.setattr("llvmlite.binding.get_host_cpu_name", lambda: "z80")
        keys.append(key(toy_route))
    assert len(set(keys)) == len(keys)


def test_what_does_not_decide_leaves_it(toy_route: Route) -> None:
    assert key(toy_route) == key(toy_route, {"name": "typical"})
    sized = {"name": "typical", "size": 5}
    assert key(toy_route, sized) == key(toy_route, {"size": 5.0, "name": "typical"})
    seeded = {"name": "typical", "seed": 3}
    assert key(toy_route, seeded, 0) == key(toy_route, seeded, 1)
    assert key(replace(toy_route, name="b", learn=toy_route.test)) == key(toy_route)


def test_code_of_the_plugin_and_of_what_it_stands_on_counts(
    toy_route: Route, mine: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    keys = [key(toy_route, "mine")]
    (mine / "shades.py").write_text("GREY = 127\n")
    keys.append(key(toy_route, "mine"))
    (mine / "shades.py").rename(mine / "tones.py")
    keys.append(key(toy_route, "mine"))
    assert module._packages(find("encoder", "mine"), build_encoder("mine")) == {"mine", "acme_vpr"}
    sources = module._sources
    for package in ("vprbench.readers", "vprbench.street"):
        with monkeypatch.context() as patch:
            patch.setattr(module, "_sources", lambda name, but=package: () if name == but else sources(name))
            keys.append(key(toy_route, "mine"))
    assert len(set(keys)) == len(keys)


def test_a_key_reads_well_and_suits_a_file(toy_route: Route) -> None:
    assert key(toy_route).startswith("typical-s0-")
    assert key(toy_route, "mine").startswith("mine-")
    grid = {"name": "mean-patch", "grid": [10**60, 10**60]}
    assert len(encoder_key(grid, 0, build_encoder("mean-patch"), ())) < 150


def test_the_training_checksum_is_that_of_its_drives(toy_route: Route) -> None:
    (drive,) = toy_route.training
    sums = {training_checksum(drives) for drives in ([], [drive], [drive, drive], [replace(drive, checksum="x")])}
    assert len(sums) == 4
    assert all(len(value) == 16 for value in sums)
