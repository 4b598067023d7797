from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from vprbench.errors import DataError
from vprbench.readers.folder import FolderDrive
from vprbench.route import Camera, Traverse

Writer = Callable[..., Path]

LOCAL = """file,time,east,north,heading_deg
img/0.png,0.0,0.0,0.0,90
img/1.png,0.5,4.0,0.0,90.5
img/2.png,1.0,8.0,0.0,-270
img/3.png,1.5,12.0,0.0,350
"""

GLOBAL = """time, latitude, longitude, file
0, 49.0, 8.4, img/0.png
1, 49.0001, 8.4, img/1.png
2, 49.0002, 8.4, img/2.png

3, 49.0003, 8.4, img/3.png
"""


def half(width: int) -> Camera:
    return Camera(300.0, width / 2)


def load(path: Path, origin: np.ndarray | None = None) -> Traverse:
    return FolderDrive(path).traverse(half, origin)


def test_a_drive_in_metres(own_drive: Writer) -> None:
    path = own_drive(LOCAL)
    drive = load(path)
    assert drive.positions.tolist() == [[0, 0], [4, 0], [8, 0], [12, 0]]
    assert np.degrees(drive.headings) == pytest.approx([90, 90.5, 90, -10])
    assert drive.times.tolist() == [0, 0.5, 1, 1.5]
    assert drive.camera == Camera(300.0, 100.0)
    assert drive.frames[3].shape == (188, 642)
    assert drive.name == str(path)
    assert drive.geodetic is None


def test_a_drive_on_the_globe_whose_course_is_its_heading(own_drive: Writer) -> None:
    drive = load(own_drive(GLOBAL), np.array([49.0, 8.4]))
    assert drive.positions == pytest.approx(np.outer(np.arange(4), [0.0, 11.12]), abs=0.01)
    assert drive.headings == pytest.approx(np.zeros(4), abs=1e-6)
    assert drive.geodetic is not None
    assert drive.name.endswith("(headings from its positions)")


def test_a_byte_order_mark_is_passed_over(own_drive: Writer) -> None:
    assert len(load(own_drive("\ufeff" + LOCAL))) == 4


def test_missing_images_are_found_by_listing(own_drive: Writer) -> None:
    drive = FolderDrive(own_drive(LOCAL))
    assert drive.need().complete
    (drive.path.parent / "img" / "2.png").unlink()
    assert drive.need().missing == (2,)


def test_a_missing_table_is_named(tmp_path: Path) -> None:
    need = FolderDrive(tmp_path / "frames.csv").need()
    assert not need.complete
    assert need.absent == (tmp_path / "frames.csv",)
    assert str(need) == f"{tmp_path / 'frames.csv'}, a file that is not there"


def swap(old: str, new: str, csv: str = LOCAL) -> str:
    assert old in csv
    return csv.replace(old, new)


@pytest.mark.parametrize(
    ("csv", "fault"),
    [
        ("", ": the file is empty"),
        (swap("heading_deg", "heading_dge"), ", line 1: unknown column 'heading_dge': did you mean 'heading_deg'?"),
        (swap("east", "time"), ", line 1: a column is named twice"),
        (swap(",", ";"), ", line 1: separated by semicolons"),
        (swap("east", "latitude"), ", line 1: .*either east and north or latitude and longitude"),
        (swap("latitude, longitude", "latitude, east", GLOBAL), ", line 1: "),
        ("time,east,north\n0,0,0\n1,1,0\n", ", line 1: no column 'file'"),
        (swap("4.0,0.0", "4,0,0.0"), ", line 3: 6 values for 5 columns; write decimals with a point"),
        (swap("4.0,0.0", '"4,0",0.0'), ", line 3: east is '4,0', not a finite number; write decimals with a point"),
        (swap("4.0,0.0", "4.0"), ", line 3: 4 values for 5 columns$"),
        (swap("8.0,0.0", "8.0,nan"), ", line 4: north is 'nan', not a finite number"),
        (swap("8.0,0.0", "8.0,"), ", line 4: north is '', not a finite number"),
        (swap("1.0,8.0", "0.5,8.0"), ", line 4: the time is not after the one before"),
        (swap("8.0,0.0", "8.0,900.0"), ", line 4: 1800 m/s since the frame before"),
        (swap("-270", "3e4"), ", line 4: heading_deg 30000 is not within 360 degrees"),
        ("\n".join(LOCAL.splitlines()[:2]), ": 1 frames, and a drive has at least two"),
        (swap("img/3.png", '"img/3.png'), r"line \d: unexpected end of data"),
        (swap("img/3.png", "img/2.png"), ", line 5: the image of another line too"),
    ],
)
def test_a_bad_table_is_met_by_its_line(own_drive: Writer, csv: str, fault: str) -> None:
    with pytest.raises(DataError, match=r"frames\.csv.*" + fault):
        load(own_drive(csv))


@pytest.mark.parametrize(
    ("csv", "fault"),
    [
        (swap("49.0003", "490.003", GLOBAL), ", line 6: latitude 490.003 is not within 90 degrees"),
        (swap("49.0003, 8.4", "0, 0", GLOBAL), ", line 6: .* m/s since the frame before"),
    ],
)
def test_a_bad_fix_is_met_by_its_line(own_drive: Writer, csv: str, fault: str) -> None:
    with pytest.raises(DataError, match=r"frames\.csv" + fault):
        load(own_drive(csv), np.array([49.0, 8.4]))


def test_a_drive_too_short_to_have_a_course_needs_headings(own_drive: Writer) -> None:
    standing = "file,time,east,north\nimg/0.png,0,0,0\nimg/1.png,1,0,0\n"
    with pytest.raises(DataError, match="too short a drive to see its direction; add a column heading_deg"):
        load(own_drive(standing))


def test_metres_and_degrees_do_not_mix(own_drive: Writer) -> None:
    with pytest.raises(DataError, match="give all drives of a route the same"):
        load(own_drive(LOCAL), np.array([49.0, 8.4]))
    with pytest.raises(DataError, match="give all drives of a route the same"):
        load(own_drive(GLOBAL))
