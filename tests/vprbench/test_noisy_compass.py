"""A compass that errs: by how much, the same for everybody, on the test drive alone, and told in the checksum."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from vprbench.catalogue import load_route
from vprbench.errors import ConfigError
from vprbench.provenance import data_checksum
from vprbench.route import Route

STREET = '[routes.here]\nreader = "street"\nenvironment = "narrow"\nlength = 2000.0\n'


def street(folder: Path, *keys: str) -> Route:
    path = folder / "my.toml"
    path.write_text(STREET + "\n".join(keys))
    return load_route("here", routes=path)


def errors(noisy: Route, true: Route) -> np.ndarray:
    """Degrees that each heading of the test drive is off, -180..180."""
    return np.degrees(np.angle(np.exp(1j * (noisy.test.headings - true.test.headings))))


@pytest.mark.parametrize("sd", [1.0, 20.0])
def test_the_error_is_normal_white_and_of_the_stated_size(tmp_path: Path, sd: float) -> None:
    wrong = errors(street(tmp_path, f"heading_noise_deg = {sd}"), street(tmp_path))
    # 1600 frames: the standard error of the sd is 1/sqrt(2 * 1600) = 1.8 % of it, that of the others 2.5 %.
    assert len(wrong) > 1500
    assert wrong.std() == pytest.approx(sd, rel=0.08)
    assert abs(wrong.mean()) < 0.1 * sd
    assert abs(np.corrcoef(wrong[1:], wrong[:-1])[0, 1]) < 0.1
    assert np.mean(np.abs(wrong) < sd) == pytest.approx(0.683, abs=0.05)


def test_only_the_headings_of_the_test_drive_err(tmp_path: Path) -> None:
    true, noisy = street(tmp_path), street(tmp_path, "heading_noise_deg = 20")
    assert_array_equal(noisy.learn.headings, true.learn.headings)
    assert noisy.learn.checksum == true.learn.checksum
    assert [drive.checksum for drive in noisy.training] == [drive.checksum for drive in true.training]
    assert_array_equal(noisy.test.positions, true.test.positions)
    assert_array_equal(noisy.test.frames[7], true.test.frames[7])
    assert np.abs(noisy.test.headings).max() <= np.pi
    assert "20 degrees" in noisy.test.name


def test_the_seed_and_the_size_decide_the_errors_and_the_checksum(tmp_path: Path) -> None:
    noise = "heading_noise_deg = 5"
    first, again = street(tmp_path, noise), street(tmp_path, noise)
    other, larger = street(tmp_path, noise, "heading_noise_seed = 1"), street(tmp_path, "heading_noise_deg = 10")
    true = street(tmp_path)
    assert_array_equal(first.test.headings, again.test.headings)
    assert errors(larger, true) == pytest.approx(2 * errors(first, true), abs=1e-9)
    assert abs(np.corrcoef(errors(first, true), errors(other, true))[0, 1]) < 0.1
    checksums = [data_checksum(route) for route in (first, again, other, larger, true)]
    assert checksums[0] == checksums[1]
    assert len(set(checksums)) == 4


def test_without_noise_nothing_changes(tmp_path: Path) -> None:
    explicit, true = street(tmp_path, "heading_noise_deg = 0", "heading_noise_seed = 3"), street(tmp_path)
    assert_array_equal(explicit.test.headings, true.test.headings)
    assert data_checksum(explicit) == data_checksum(true)


@pytest.mark.parametrize(
    ("key", "said"),
    [
        ("heading_noise_deg = -1", "heading_noise_deg: "),
        ("heading_noise_deg = inf", "heading_noise_deg: "),
        ("heading_noise = 5", "did you mean 'heading_noise_deg'"),
    ],
)
def test_a_wrong_key_or_value_is_told(tmp_path: Path, key: str, said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        street(tmp_path, key)


def test_recorded_drives_err_alike(odometry_tree: Path) -> None:
    path = odometry_tree / "my.toml"
    entry = '[routes.here]\nreader = "kitti-odometry"\nlearn = "00:0-14"\ntest = "00:15-29"\n'
    path.write_text(entry)
    true = load_route("here", odometry_tree, path)
    path.write_text(entry + "heading_noise_deg = 5\n")
    noisy = load_route("here", odometry_tree, path)
    assert 1.0 < errors(noisy, true).std() < 10.0
    assert data_checksum(noisy) != data_checksum(true)
