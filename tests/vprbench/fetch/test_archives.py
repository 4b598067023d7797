from __future__ import annotations

from pathlib import Path, PurePosixPath

import pytest

from vprbench.catalogue import catalogue
from vprbench.errors import DataError
from vprbench.fetch.archives import data_sets, locations
from vprbench.fetch.plan import locate

BUCKET = "https://s3.eu-central-1.amazonaws.com/avg-kitti"


@pytest.mark.parametrize(
    ("path", "archives", "member"),
    [
        ("dataset/sequences/00/image_0/000113.png", ["data_odometry_gray"], None),
        ("sequences/10/image_2/000113.png", ["data_odometry_color"], "dataset/sequences/10/image_2/000113.png"),
        ("dataset/sequences/00/calib.txt", ["data_odometry_calib", "data_odometry_gray"], None),
        ("dataset/poses/10.txt", ["data_odometry_poses"], None),
        ("2011_10_03/calib_cam_to_cam.txt", ["raw_data/2011_10_03_calib"], None),
        (
            "2011_10_03/2011_10_03_drive_0027_sync/oxts/data/0000000007.txt",
            ["raw_data/2011_10_03_drive_0027/2011_10_03_drive_0027_sync"],
            None,
        ),
        ("2011_10_03/2011_09_30_drive_0027_sync/oxts/data/0000000007.txt", [], None),
        ("dataset/sequences/../image_0/000113.png", [], None),
        ("2011_10_03/2011_10_03_drive_0027_sync/oxts/data/../../0.txt", [], None),
    ],
)
def test_files_are_found_where_kitti_has_them(path: str, archives: list[str], member: str | None) -> None:
    found = locations(PurePosixPath(path))
    assert [place.url for place in found] == [f"{BUCKET}/{archive}.zip" for archive in archives]
    assert all(place.member == (member or path) for place in found)


def test_every_built_in_route_can_be_fetched(tmp_path: Path) -> None:
    known = catalogue()
    needs = [need for name in known.names() for need in known.entry(name).needs(tmp_path)]
    assert len(needs) > 10 and all(need.public for need in needs)
    files = {path for need in needs for path in need.files}
    assert set(locate(files, tmp_path)) == files


def test_what_is_published_nowhere_is_named(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"21a/calib\.txt: part of no data set that vprbench can fetch"):
        locate([tmp_path / "dataset/sequences/21a/calib.txt"], tmp_path)


def test_every_data_set_states_its_terms() -> None:
    for data_set in data_sets():
        assert data_set.home.startswith("https://")
        assert "CC BY-NC-SA 3.0" in data_set.licence and "Geiger" in data_set.citation
        assert all(archive.url.startswith("https://") for archive in data_set.archives)
