"""Positions in file names, as VPR-datasets-downloader writes them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from vprbench.catalogue import catalogue, load_route
from vprbench.errors import ConfigError, DataError
from vprbench.readers.utm_names import UtmImages
from vprbench.route import Route
from vprbench.runner import run
from vprbench.sweep import Cell, Job

Writer = Callable[..., None]

ENTRY = """[routes.city]
reader = "utm"
learn = "images/test/database"
test = "images/test/queries"
camera = { field_of_view_deg = 60.0 }
"""


def name(east: float, north: float, time: str = "", heading: str = "", zone: str = "17", letter: str = "T") -> str:
    """As the downloader's own `get_dst_image_name` composes it."""
    return f"@{east:010.2f}@{north:010.2f}@{zone}@{letter}@040.44000@-080.00000@pano@00@{heading}@@@@{time}@@.jpg"


@pytest.fixture
def routes(tmp_path: Path, draw_view: Writer) -> Path:
    """A street of 12 database frames due east, 10 m apart, and queries beside frames 1, 4, 7 and one far away.

    The database's names are in another order than its timestamps.
    """
    images = tmp_path / "images" / "test"
    for step in range(12):
        east = 584_000 + 10 * step if step != 3 else 584_030.5
        draw_view(images / "database" / name(east, 4_477_000 - step % 2, f"201903{step + 1:02d}", "090"), step)
    for time, (east, step) in enumerate([(584_012, 1), (584_041, 4), (584_070, 7), (584_400, 40)]):
        draw_view(images / "queries" / name(east, 4_477_000, f"2020_{time}", "100"), step)
    (tmp_path / "my.toml").write_text(ENTRY)
    return tmp_path / "my.toml"


def load(routes: Path, more: str = "") -> Route:
    routes.write_text(ENTRY + more)
    return load_route("city", routes=routes)


def test_names_say_where_frames_are(routes: Path) -> None:
    route = load(routes)
    assert route.unit == "m"
    assert route.learn.positions[:4] == pytest.approx(np.array([[0, 0], [10, -1], [20, 0], [30.5, -1]]))
    assert route.test.positions[:, 0] == pytest.approx(np.array([12.0, 41, 70, 400]))
    assert route.learn.heading_source == "measured"
    assert np.degrees(route.test.headings) == pytest.approx([100] * 4)


def test_a_learn_frame_within_25_m_is_right(routes: Path) -> None:
    visit = load(routes).visit
    assert visit.rule == "learn frames within 25 m of the query; 1 of 4 queries have none"
    assert [np.flatnonzero(row).tolist() for row in visit.answers] == [
        [0, 1, 2, 3],
        [2, 3, 4, 5, 6],
        [5, 6, 7, 8, 9],
        [],
    ]
    assert load(routes, "tolerance = 3\n").visit.answers.sum(axis=1).tolist() == [1, 1, 1, 0]


def test_a_row_says_the_rule(routes: Path) -> None:
    (outcome,) = run(Job("city", "CoHOG", 0, "cohog", (Cell("city", "CoHOG", 5.0, 0),)), routes_file=routes)
    assert outcome.row["error"] == ""
    assert outcome.row["tolerance_rule"] == "learn frames within 25 m of the query; 1 of 4 queries have none"
    assert (outcome.row["unit"], outcome.row["heading_source"], outcome.row["places"]) == ("m", "measured", 12)
    assert outcome.trace is not None
    assert outcome.trace.correct.tolist() == [True, True, True, False]
    # The nearest frames lie 2 m and a metre aside, a metre, and a metre aside.
    assert outcome.trace.error_m[:3] == pytest.approx([np.hypot(2, 1), 1, 1])


def test_order_is_by_timestamp_note_or_name(tmp_path: Path, draw_view: Writer) -> None:
    for number, (time, note) in enumerate([("2021", "b"), ("2019", "c"), ("2020", "a")]):
        draw_view(tmp_path / name(10 * number, 0, time).replace("@.jpg", f"{note}@.jpg"), number)
    found = {order: UtmImages(tmp_path, order).utm[:, 0].tolist() for order in ("timestamp", "note", "name")}
    assert found == {"timestamp": [10, 20, 0], "note": [20, 0, 10], "name": [0, 10, 20]}


def test_names_may_end_after_the_position(tmp_path: Path, draw_view: Writer) -> None:
    for number in range(2):
        draw_view(tmp_path / f"@{number}@7.5@.png", number)
    images = UtmImages(tmp_path, "name")
    assert images.utm.tolist() == [[0, 7.5], [1, 7.5]]
    assert not images.has_headings


def test_headings_are_measured_derived_or_absent_as_the_route_says(routes: Path) -> None:
    derived = load(routes, 'headings = "derived"\n').learn
    assert derived.heading_source == "derived"
    assert np.degrees(derived.headings) == pytest.approx([90] * 12, abs=12)
    absent = load(routes, 'headings = "absent"\n').learn
    assert np.isnan(absent.headings).all()
    one = next((routes.parent / "images" / "test" / "queries").iterdir())
    one.rename(one.with_name(one.name.replace("@100@", "@@")))
    assert load(routes).test.heading_source == "absent"
    with pytest.raises(DataError, match=r"heading is '', not a finite number"):
        load(routes, 'headings = "measured"\n')


@pytest.mark.parametrize(
    ("bad", "fault"),
    [
        ("frame1.jpg", r"frame1\.jpg: its name does not say where it was taken; names are @easting@northing@zone@"),
        ("@1@.jpg", "its name does not say where"),
        ("x" + name(0, 0, "1"), "its name does not say where"),
        (name(0, 0, "1").replace("@pano", "@pano@more"), "its name does not say where"),
        (name(0, 0), r'no timestamp in its name to order it by; set order = "name"'),
        (name(0, 0, "1").replace("0000000.00@", "east@", 1), "easting is 'east', not a finite number"),
        (name(0, 0, "1", zone="18"), "in UTM zone 1[78] north, where others lie in 1[78] north; split"),
        (name(0, 0, "1", letter="M"), "in UTM zone 17 (north|south), where others lie in 17 (north|south); split"),
    ],
)
def test_a_name_that_does_not_fit_is_met_by_its_file(routes: Path, draw_view: Writer, bad: str, fault: str) -> None:
    draw_view(routes.parent / "images" / "test" / "database" / bad, 1)
    with pytest.raises(DataError, match=fault) as error:
        load(routes)
    assert "database" in str(error.value)
    assert "\n" not in str(error.value)


def test_neighbouring_bands_of_a_hemisphere_are_one_plane(routes: Path, draw_view: Writer) -> None:
    draw_view(routes.parent / "images" / "test" / "database" / name(584_200, 4_477_000, "2022", "0", letter="U"), 1)
    assert len(load(routes).learn) == 13


def test_a_missing_folder_and_a_bad_order_are_refused(routes: Path) -> None:
    routes.write_text(ENTRY.replace("queries", "gone"))
    with pytest.raises(DataError, match=r"city needs .*gone, a file that is not there.*VPR-datasets-downloader"):
        load_route("city", routes=routes)
    routes.write_text(ENTRY + 'order = "time"\n')
    with pytest.raises(ConfigError, match=r"city\.order: 'time': did you mean 'timestamp'\?"):
        catalogue(routes)
