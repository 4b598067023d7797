"""Oxford RobotCar's layout: a drive due north, drawn with positions and headings that can be worked by hand."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest

from vprbench.catalogue import catalogue, load_route
from vprbench.errors import ConfigError, DataError
from vprbench.readers.images import read_grey
from vprbench.route import Route
from vprbench.runner import run
from vprbench.sweep import Cell, Job

Writer = Callable[..., None]

START, FRAME, FIX = 1_418_132_504_537_582, 62_500, 200_000  # microseconds: the first image, 16 and 5 a second
LATITUDE = 51.75
METRES = 111_258.0  # in a degree of latitude there, from the ellipsoid's radius in the meridian
FRAMES, SPEED = 24, 4.0  # so that frames are 0.25 m apart

ENTRY = """[routes.oxford]
reader = "robotcar"
learn = "2014-12-09"
test = "2015-02-03"
camera = { fx = 124.0, cx = 80.0 }
"""
INS = (
    "timestamp,ins_status,latitude,longitude,altitude,northing,easting,down,utm_zone,"
    "velocity_north,velocity_east,velocity_down,roll,pitch,yaw"
)


def fixes(start: int, late: float = 0.0, status: dict[int, str] | None = None) -> str:
    """Ten fixes from 0.1 s before the first image; the yaw turns from 350 to 8 degrees, 2 at each."""
    lines = [INS]
    for fix in range(10):
        seconds = (fix * FIX - 100_000) / 1e6
        latitude = LATITUDE + (late + SPEED * seconds) / METRES
        yaw = np.radians(350 + 2 * fix) if fix < 5 else np.radians(2 * fix - 10)
        good = (status or {}).get(fix, "INS_SOLUTION_GOOD")
        stamp = start + fix * FIX - 100_000
        lines.append(f"{stamp},{good},{latitude:.12f},-1.25,110,0,0,-110,30U,4,0,0,0,0,{yaw:.12f}")
    return "\n".join(lines) + "\n"


@pytest.fixture
def root(tmp_path: Path, draw_view: Writer) -> Path:
    """Two drives of 24 images, the second 0.1 m further on; the test of the end has no fixes."""
    for drive, start, late in (("2014-12-09", START, 0.0), ("2015-02-03", START + 10**12, 0.1)):
        stamps = [start + frame * FRAME for frame in range(FRAMES)]
        for frame, stamp in enumerate(stamps):
            draw_view(tmp_path / drive / "stereo" / "centre" / f"{stamp}.png", frame)
        (tmp_path / drive / "stereo.timestamps").write_text("".join(f"{stamp} 1\n" for stamp in stamps))
        (tmp_path / drive / "gps").mkdir()
        (tmp_path / drive / "gps" / "ins.csv").write_text(fixes(start, late))
    return tmp_path


def load(root: Path, more: str = "") -> Route:
    (root / "my.toml").write_text(ENTRY + more)
    return load_route("oxford", root, root / "my.toml")


def ins(root: Path) -> Path:
    return root / "2014-12-09" / "gps" / "ins.csv"


def test_positions_and_headings_lie_between_the_fixes(root: Path) -> None:
    learn = load(root).learn
    assert len(learn) == FRAMES
    assert learn.indices[:2].tolist() == [START, START + FRAME]
    assert learn.times == pytest.approx(np.arange(FRAMES) * 0.0625)
    assert learn.positions[:, 1] == pytest.approx(0.25 * np.arange(FRAMES), abs=1e-3)
    assert np.abs(learn.positions[:, 0]).max() < 1e-6
    # 10 degrees a second from 351 at the first image, through north.
    turned = (351 + 10 * 0.0625 * np.arange(FRAMES) + 180) % 360 - 180
    assert np.degrees(learn.headings) == pytest.approx(turned, abs=1e-6)
    assert learn.heading_source == "measured"
    assert learn.geodetic is not None
    assert learn.geodetic[4] == pytest.approx([LATITUDE + 1.0 / METRES, -1.25], abs=1e-9)


def test_a_row_from_end_to_end(root: Path) -> None:
    load(root, "every = 2\n")
    job = Job("oxford", "CoHOG", 0, "cohog", (Cell("oxford", "CoHOG", 1.0, 0),))
    (outcome,) = run(job, data=root, routes_file=root / "my.toml")
    assert outcome.row["error"] == ""
    assert (outcome.row["unit"], outcome.row["heading_source"]) == ("m", "measured")
    assert outcome.row["tolerance_rule"].startswith("d_NN")
    assert outcome.row["tolerance_mean_m"] == pytest.approx(0.1, abs=1e-3)
    assert (outcome.row["places"], outcome.row["accuracy"]) == (6, 1.0)


def test_frames_are_thinned_by_count_and_by_road(root: Path) -> None:
    assert load(root, "every = 5\n").learn.positions[:, 1] == pytest.approx([0, 1.25, 2.5, 3.75, 5], abs=1e-3)
    # Half a millimetre less than two frames, since rounding decides whether exactly two are enough.
    assert load(root, "spacing = 0.4995\n").learn.positions[:, 1] == pytest.approx(np.arange(0, 6, 0.5), abs=1e-3)
    both = load(root, "every = 3\nspacing = 1.0\n").learn
    assert both.positions[:, 1] == pytest.approx([0, 1.5, 3, 4.5], abs=1e-3)


def test_a_stretch_is_named_by_its_timestamps(root: Path) -> None:
    (root / "my.toml").write_text(ENTRY.replace("2014-12-09", f"2014-12-09:{START + 1}-{START + 3 * FRAME}"))
    learn = load_route("oxford", root, root / "my.toml").learn
    assert ((learn.indices - START) / FRAME).tolist() == [1, 2, 3]


def test_images_outside_the_good_fixes_are_left_out_and_counted(root: Path) -> None:
    bad = {fix: "INS_BAD_GPS_AGREEMENT" for fix in (0, 1, 3, 4, 5, 6, 7)}
    ins(root).write_text(fixes(START, status=bad))
    # Good fixes at 0.3 s, 1.5 and 1.7 s: between the first two lies more than a second. The images end at 1.4375 s.
    with pytest.raises(DataError, match=r"of 24 images asked for, 0 lie between two good fixes"):
        load(root)
    ins(root).write_text(fixes(START, status={fix: "INS_BAD" for fix in (0, 1, 4)}))
    learn = load(root).learn
    # The first good fix comes at 0.3 s, before the image at 0.3125.
    assert ((learn.indices - START) / FRAME).tolist() == list(range(5, FRAMES))
    assert learn.name == "RobotCar 2014-12-09, stereo/centre, 19 frames; 5 images left out, not between two good fixes"


def test_gps_alone_gives_derived_headings(root: Path) -> None:
    for drive in ("2014-12-09", "2015-02-03"):
        lines = (root / drive / "gps" / "ins.csv").read_text().splitlines()[1:]
        table = ["timestamp,num_satellites,latitude,longitude"]
        for line in lines:
            words = line.split(",")
            table.append(",".join([words[0], "9", words[2], words[3]]))
        (root / drive / "gps" / "gps.csv").write_text("\n".join(table))
    learn = load(root, 'fixes = "gps"\n').learn
    assert learn.heading_source == "derived"
    assert learn.headings == pytest.approx(np.zeros(FRAMES), abs=1e-6)
    with pytest.raises(DataError, match="too short a drive to see its direction; take a longer one"):
        load(root, 'fixes = "gps"\nevery = 12\n')


def test_mosaics_are_made_grey_by_the_pattern_of_their_camera(root: Path) -> None:
    colours = np.zeros((188, 642), np.uint8)
    colours[0::2, 0::2] = colours[1::2, 1::2] = 100  # green
    colours[0::2, 1::2], colours[1::2, 0::2] = 50, 200  # blue and red: g b / r g
    for path in (root / "2014-12-09" / "stereo" / "centre").iterdir():
        assert cv2.imwrite(str(path), colours)
    frame = load(root).learn.frames[0]
    assert np.abs(frame[2:-2, 2:-2].astype(int) - 124).max() <= 1
    untouched = load(root, "raw = false\n").learn
    assert np.array_equal(untouched.frames[0], read_grey(path))
    assert untouched.checksum != load(root).learn.checksum


def test_coloured_images_are_no_mosaics(root: Path, draw_noise: Writer) -> None:
    draw_noise(root / "2014-12-09" / "stereo" / "centre" / f"{START}.png", 0, size=(160, 48), channels=3)
    with pytest.raises(DataError, match=rf"{START}\.png: in colour, so no raw mosaic any more; set raw = false"):
        load(root)
    assert load(root, "raw = false\n").learn.frames[0].shape == (188, 642)


def test_what_is_missing_is_named(root: Path) -> None:
    (root / "2014-12-09" / "stereo" / "centre" / f"{START + 2 * FRAME}.png").unlink()
    with pytest.raises(
        DataError, match=r"frames 0-23 of RobotCar drive 2014-12-09: 23 of 24 .*missing 2\. Unpack ster"
    ):
        load(root)
    ins(root).unlink()
    with pytest.raises(DataError, match=r"oxford needs RobotCar drive 2014-12-09, a file that is not there"):
        load(root)


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("INS_SOLUTION_GOOD", "INS_BAD", r"ins\.csv: 0 of 10 fixes are INS_SOLUTION_GOOD"),
        ("latitude", "lattitude", r"ins\.csv, line 1: unknown column 'lattitude': did you mean 'latitude'\?"),
        ("latitude", "latitude_sigma", r"ins\.csv, line 1: no column 'latitude'"),
        (",51.75", ",151.75", r"ins\.csv, line \d+: latitude 151\.75\d* is not within 90 degrees"),
        (",-1.25", ",west", r"ins\.csv, line 2: longitude is 'west', not a finite number"),
        (f"{START + 300_000},", f"{START + 100_000},", r"ins\.csv, line 4: the time is not after the one before"),
        (f"{START + 300_000},", "1.4e15,", r"ins\.csv, line 4: timestamp is '1\.4e15', not whole microseconds"),
        (",30U", "", r"ins\.csv, line 2: 14 values for 15 columns"),
    ],
)
def test_bad_fixes_are_met_by_their_line(root: Path, old: str, new: str, fault: str) -> None:
    text = ins(root).read_text()
    assert old in text
    ins(root).write_text(text.replace(old, new))
    with pytest.raises(DataError, match=fault):
        load(root)


@pytest.mark.parametrize(
    ("line", "fault"),
    [("", "'' does not begin with"), ("x 1", "'x 1' does not begin with"), (f"{START} 1", "the time is not after")],
)
def test_a_bad_list_of_images_is_met_by_its_line(root: Path, line: str, fault: str) -> None:
    path = root / "2014-12-09" / "stereo.timestamps"
    lines = path.read_text().splitlines()
    path.write_text("\n".join([*lines[:4], line, *lines[4:]]))
    with pytest.raises(DataError, match=rf"stereo\.timestamps, line 5: {fault}"):
        load(root)


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ('"2015-02-03"', '"2015-02-03:9-3"', r"\.test: '2015-02-03:9-3' ends before it begins"),
        ('"2015-02-03"', '"a/b"', r"\.test: 'a/b' is neither \"drive\" nor \"drive:first-last\""),
        ("fx =", 'view = "stereo/center", fx =', r"\.camera\.view: unknown key"),
    ],
)
def test_a_bad_entry_is_met_by_its_key(root: Path, old: str, new: str, fault: str) -> None:
    (root / "my.toml").write_text(ENTRY.replace(old, new))
    with pytest.raises(ConfigError, match=r"my\.toml: routes\.oxford" + fault):
        catalogue(root / "my.toml")
