from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from vprbench.checks.samples import textured_frame
from vprbench.errors import DataError, PhaseError
from vprbench_encoders.hsd import HSD
from vprbench_encoders.hsd_store import FORMAT


def fitted(**options: Any) -> HSD:  # noqa: ANN401
    encoder = HSD(**{"size": 6, "map_size": 8, "steps": 5, "epochs": 5, "seed": 3, "points": 12, **options})
    encoder.fit([textured_frame(seed) for seed in (200, 201, 202)])
    return encoder


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("hsd") / "dictionary.npz"
    fitted().save(path)
    return path


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"signature": "c1", "picks": (8, 5)},
        {"equalised": True},
        {"equalised": True, "homeostasis": "hap"},
        {"rectified": False, "similarity": "cosine", "sigmas": (1.5, 3.0)},
        {"held_out": 0.5},
    ],
    ids=str,
)
def test_what_was_saved_encodes_bit_by_bit_as_before(options: dict[str, Any], tmp_path: Path) -> None:
    before = fitted(**options)
    before.save(tmp_path / "d.npz")
    after = HSD.load(tmp_path / "d.npz")
    for option in fields(HSD):
        if option.name != "layers":
            # As text, since an unknown rate is NaN, which equals nothing.
            assert str(getattr(after, option.name)) == str(getattr(before, option.name))
    one, other = (encoder.encode(textured_frame(1)) for encoder in (before, after))
    np.testing.assert_array_equal(one.signatures, other.signatures)
    np.testing.assert_array_equal(one.points, other.points)
    np.testing.assert_array_equal(
        before.match(one.signatures, one.signatures), after.match(one.signatures, one.signatures)
    )


def test_saving_again_gives_equal_bytes(saved: Path, tmp_path: Path) -> None:
    HSD.load(saved).save(tmp_path / "again.npz")
    assert (tmp_path / "again.npz").read_bytes() == saved.read_bytes()


def test_a_file_holds_no_pickle_and_says_what_it_is(saved: Path) -> None:
    with np.load(saved, allow_pickle=False) as archive:
        header = json.loads(str(archive["header"]))
        assert all(archive[name].dtype != object for name in archive)
    assert header["format"] == FORMAT
    assert header["options"]["map_size"] == 8


def test_any_damaged_byte_of_the_arrays_is_noticed(saved: Path, tmp_path: Path) -> None:
    whole = saved.read_bytes()
    path = tmp_path / "damaged.npz"
    for place in np.linspace(200, len(whole) - 2000, 12).astype(int):
        path.write_bytes(whole[:place] + bytes([whole[place] ^ 0xFF]) + whole[place + 1 :])
        with pytest.raises(DataError, match=r"damaged\.npz"):
            HSD.load(path)


@pytest.mark.parametrize("share", [0.0, 0.3, 0.99])
def test_a_file_that_was_cut_off_is_refused(saved: Path, tmp_path: Path, share: float) -> None:
    path = tmp_path / "cut.npz"
    path.write_bytes(saved.read_bytes()[: int(share * saved.stat().st_size)])
    with pytest.raises(DataError, match=r"cut\.npz"):
        HSD.load(path)


def rewritten(
    saved: Path, path: Path, arrays: Mapping[str, np.ndarray], header: Mapping[str, Any] | None = None
) -> Path:
    """The saved file with some of its contents replaced."""
    with np.load(saved) as archive:
        contents = dict(archive)
    contents["header"] = np.array(json.dumps({**json.loads(str(contents["header"])), **(header or {})}))
    np.savez(path, **{**contents, **arrays})
    return path


@pytest.mark.parametrize(
    "header",
    [
        {"format": "vprbench HSD dictionaries, version 1"},
        {"options": {"size": 6, "colour": 1}},
        {"options": {"size": 1}},
        {"options": {"size": 6}},
        {"options": {"size": 6, "map_size": 8, "signature": "c1"}},
        {"reports": [{}]},
    ],
    ids=str,
)
def test_a_file_of_another_version_is_refused(saved: Path, tmp_path: Path, header: dict[str, Any]) -> None:
    with pytest.raises(DataError, match=r"other\.npz"):
        HSD.load(rewritten(saved, tmp_path / "other.npz", {}, header))


@pytest.mark.parametrize(
    "arrays",
    [
        {"s1_units": np.zeros((64, 5), np.float32)},
        {"s1_gain": np.ones(3, np.float32)},
        {"s2_mean": np.full(16, np.nan, np.float32)},
        {"s2_mean": np.zeros(16)},
        {"s1_tables": np.zeros((3, 4), np.float32)},
        {"s1_usage": np.zeros(3, np.float32)},
        {"s2_usage": np.full(64, 1.5, np.float32)},
        {"s2_units": np.zeros((64, 577), np.float32), "s2_mean": np.zeros(577, np.float32)},
        {"header": np.array("{")},
    ],
    ids=lambda arrays: next(iter(arrays)),
)
def test_arrays_that_do_not_fit_together_are_refused(
    saved: Path, tmp_path: Path, arrays: dict[str, np.ndarray]
) -> None:
    with pytest.raises(DataError, match=r"odd\.npz"):
        HSD.load(rewritten(saved, tmp_path / "odd.npz", arrays))


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 no zip", b"\x93NUMPY", b"text"])
def test_a_foreign_file_is_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "foreign.npz"
    path.write_bytes(content)
    with pytest.raises(DataError, match=r"foreign\.npz"):
        HSD.load(path)


def test_a_lone_array_is_refused(tmp_path: Path) -> None:
    with (tmp_path / "lone.npz").open("wb") as file:
        np.save(file, np.zeros(3))
    with pytest.raises(DataError, match=r"lone\.npz"):
        HSD.load(tmp_path / "lone.npz")


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"absent\.npz.*No such file"):
        HSD.load(tmp_path / "absent.npz")


def test_where_nothing_can_be_written_the_place_is_named(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="nowhere"):
        fitted().save(tmp_path / "nowhere" / "d.npz")


def test_nothing_learned_is_nothing_to_save(tmp_path: Path) -> None:
    with pytest.raises(PhaseError, match="fit"):
        HSD().save(tmp_path / "d.npz")
    assert not list(tmp_path.iterdir())
