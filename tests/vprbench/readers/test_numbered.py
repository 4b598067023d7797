from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from vprbench.errors import DataError
from vprbench.readers.crop import Crop
from vprbench.readers.images import read_grey
from vprbench.readers.numbered import NumberedImages
from vprbench.route import Camera, Traverse

Writer = Callable[..., None]


def half(width: int) -> Camera:
    return Camera(300.0, width / 2)


def load(images: NumberedImages) -> Traverse:
    return images.traverse(half)


@pytest.fixture
def folder(tmp_path: Path, draw_noise: Writer) -> Path:
    """Frames 2, 3, 8, 9, 10 and 11, named so that their names' order is another."""
    for number, name in enumerate(("a_2.png", "0003.png", "Image8.png", "x9.PNG", "10.jpg", "s1_11.jpeg")):
        draw_noise(tmp_path / "summer" / name, number)
    (tmp_path / "summer" / "notes.txt").write_text("12")
    return tmp_path / "summer"


def test_numbers_are_positions(folder: Path) -> None:
    drive = load(NumberedImages(folder))
    assert drive.indices.tolist() == [2, 3, 8, 9, 10, 11]
    assert drive.positions.tolist() == [[0, number] for number in (2, 3, 8, 9, 10, 11)]
    assert drive.length == 9
    assert drive.heading_source == "absent"
    assert np.isnan(drive.headings).all()
    assert np.array_equal(drive.frames[3], load(NumberedImages(folder, 9, 10)).frames[0])
    assert drive.name == str(folder)


def test_a_run_and_a_step_choose_by_number(folder: Path) -> None:
    images = NumberedImages(folder, 3, 10, every=2)
    assert load(images).indices.tolist() == [8, 10]
    assert images.name == f"{folder}:3-10, every 2"
    assert images.need().frames == (4, 6, 8, 10)
    assert images.need().missing == (4, 6)


def test_a_folder_without_a_run_needs_what_it_has(folder: Path) -> None:
    assert NumberedImages(folder).need().complete
    gone = NumberedImages(folder.parent / "winter").need()
    assert not gone.complete
    assert "winter" in str(gone)


@pytest.mark.parametrize(
    ("name", "fault"),
    [
        ("cover.png", r"cover\.png: no number in its name"),
        ("b0002.png", r"b0002\.png: frame 2, as is a_2\.png; keep one"),
    ],
)
def test_a_name_that_says_no_frame_is_refused(folder: Path, name: str, fault: str, draw_noise: Writer) -> None:
    draw_noise(folder / name, 1)
    with pytest.raises(DataError, match=fault):
        load(NumberedImages(folder))


def test_an_empty_folder_and_a_single_frame_are_no_drive(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    with pytest.raises(DataError, match=r"empty: no PNG or JPEG image in it"):
        load(NumberedImages(tmp_path / "empty"))
    with pytest.raises(DataError, match=r"summer:2-3, every 2: 1 frames, and a drive has at least two"):
        load(NumberedImages(folder, 2, 3, every=2))
    with pytest.raises(DataError, match=r"gone: cannot be read \(No such file"):
        load(NumberedImages(tmp_path / "gone"))


def test_sizes_may_differ_where_that_is_said(folder: Path, draw_noise: Writer) -> None:
    draw_noise(folder / "12.png", 1, size=(60, 40))
    with pytest.raises(DataError, match=r"12\.png: 60x40 pixels where the drive's other frames have 124x38"):
        load(NumberedImages(folder)).frames[6]
    assert load(NumberedImages(folder, one_size=False)).frames[6].shape == (188, 642)


def test_a_crop_is_a_band_of_the_image(tmp_path: Path, draw_noise: Writer) -> None:
    for number in range(2):
        draw_noise(tmp_path / f"{number}.png", number, size=(642, 400))
    image = read_grey(tmp_path / "0.png")
    bands = {Crop(): image[106:294], Crop(top=5): image[5:193], Crop(top=9, rows=188): image[9:197]}
    for crop, band in bands.items():
        drive = load(NumberedImages(tmp_path, crop=crop))
        assert np.array_equal(drive.frames[0], band)
        assert drive.checksum != load(NumberedImages(tmp_path)).checksum
    with pytest.raises(DataError, match=r"1\.png: 642x400 pixels hold no band of 188 rows from row 213 on; change"):
        load(NumberedImages(tmp_path, crop=Crop(top=213))).frames[1]


def test_a_flat_image_has_no_middle_band(tmp_path: Path, draw_noise: Writer) -> None:
    for number in range(2):
        draw_noise(tmp_path / f"{number}.png", number, size=(642, 180))
    with pytest.raises(DataError, match=r"0\.png: 642x180 pixels hold no band of 188 rows in the middle"):
        load(NumberedImages(tmp_path, crop=Crop())).frames[0]
