"""The whole way: from a route's name to a data root from which the route is read."""

from __future__ import annotations

import os
import re
import shutil
import signal
import zipfile
from pathlib import Path
from time import sleep
from typing import TYPE_CHECKING

import numpy as np
import pytest

from vprbench.catalogue import load_route

if TYPE_CHECKING:
    from tests.vprbench.fetch.conftest import Handler, Tell, World

GREY, CALIB, POSES = (f"data_odometry_{name}.zip" for name in ("gray", "calib", "poses"))


def test_a_route_is_fetched_listed_and_read(world: World, tell: Tell) -> None:
    assert (world.server.folder / GREY).stat().st_size > 5 << 30
    assert re.search(r"Toy .* 0 of 23", tell("list", "routes").out)
    done = tell.fetch()
    assert done.code == 0, done.err
    assert set(world.written()) == set(world.wanted)
    assert world.sound()
    assert re.search(r"Toy .* 23 frames", tell("list", "routes").out)
    route = load_route("Toy", world.root, world.routes)
    whole = load_route("Toy", world.tree, world.routes)
    assert (route.learn.checksum, route.test.checksum) == (whole.learn.checksum, whole.test.checksum)
    assert np.array_equal(route.test.frames[7], whole.test.frames[7])


def test_neighbours_come_together(world: World, tell: Tell) -> None:
    done = tell.fetch()
    # For each archive one request for its size and one for its directory, which brings all of a small one; then one for
    # the frames on either side of the hole.
    assert [path for path, _, _ in world.server.log] == [
        f"/{name}" for name in (GREY,) * 2 + (POSES,) * 2 + (CALIB,) * 2 + (GREY,) * 2
    ]
    asked = sum(stop - start for _, start, stop in world.server.log)
    assert asked < 400_000
    assert f"{asked / 1e6:.1f} MB were read in 8 requests" in done.out


def test_without_the_licence_nothing_is_asked(world: World, tell: Tell) -> None:
    done = tell("fetch", "Toy", "--source", world.server.url())
    assert done.code == 2
    assert "CC BY-NC-SA 3.0" in done.err
    assert "Geiger" in done.err and "CVPR 2012" in done.err
    assert "data_odometry_gray.zip (22 GB" in done.err
    assert done.err.splitlines()[-1].startswith("vprbench: nothing was fetched")
    assert "--accept-licence" in done.err
    assert world.server.log == [] and world.written() == {}


def test_a_dry_run_reads_directories_only(world: World, tell: Tell) -> None:
    done = tell("fetch", "Toy", "--dry-run", "--source", world.server.url())
    assert done.code == 0
    size = sum(len(world.original(name)) for name in world.wanted if name.endswith(".png"))
    assert f"{GREY}: 0 of 23 files are there, 23 to fetch ({size / 1e6:.1f} MB)" in done.out
    assert len(world.server.log) == 6
    assert not any(world.root.iterdir())


def test_what_is_there_is_left_alone_and_what_differs_is_replaced(world: World, tell: Tell) -> None:
    tell.fetch()
    kept, gone, cut, changed = (world.root / name for name in world.wanted[:4])
    gone.unlink()
    cut.write_bytes(cut.read_bytes()[:-5])
    changed.write_bytes(changed.read_bytes()[:-1] + b"?")
    before, asked = kept.stat().st_mtime_ns, len(world.server.log)
    done = tell.fetch()
    assert f"{GREY}: 20 of 23 files are there, 3 to fetch" in done.out
    assert "2 of them in place of files that differ from the archive's" in done.out
    assert set(world.written()) == set(world.wanted) and world.sound()
    assert kept.stat().st_mtime_ns == before
    assert len(world.server.log) == asked + 7
    assert "0 files (0.0 MB) were written" in tell.fetch().out


def test_an_interrupted_fetch_goes_on(world: World, tell: Tell) -> None:
    def interrupt(handler: Handler, start: int, stop: int) -> bool:
        if len(handler.server.log) == 8:
            os.kill(os.getpid(), signal.SIGINT)
            sleep(0.2)  # the answer must not overtake the signal
        return False

    world.server.fault = interrupt
    done = tell.fetch()
    assert done.code == 130
    assert done.err == "interrupted: what was fetched is kept, and the same command goes on from there\n"
    # The first stretch holds the frames before the hole: 3-11 and 15-19 of 0-40.
    assert sorted(world.written()) == sorted(world.wanted[:14])
    assert world.sound()
    world.server.fault = None
    assert f"{GREY}: 14 of 23 files are there" in tell.fetch().out
    assert set(world.written()) == set(world.wanted) and world.sound()


def test_what_a_killed_fetch_left_is_cleared_away(world: World, tell: Tell) -> None:
    folder = world.root / "dataset" / "sequences" / "00" / "image_0"
    folder.mkdir(parents=True)
    for name in (".000003.png.77.tmp", ".000004.png.tmp", ".000002.png.77.tmp", ".mine.png.1.tmp"):
        (folder / name).write_bytes(b"half")
    assert tell.fetch().code == 0
    assert [path.name for path in sorted(folder.glob(".*"))] == [
        ".000002.png.77.tmp",
        ".000004.png.tmp",
        ".mine.png.1.tmp",
    ]


def test_local_archives_are_taken_by_name(world: World, tell: Tell, tmp_path: Path) -> None:
    folder = world.server.folder
    shutil.move(folder / POSES, folder / "p.zip")
    assert tell.fetch(str(folder / GREY), f"data_odometry_poses={folder / 'p.zip'}", f"{folder}").code == 0
    assert world.server.log == []
    assert set(world.written()) == set(world.wanted) and world.sound()


def test_the_root_may_be_the_dataset_folder_or_not_be_there_yet(world: World, tell: Tell) -> None:
    (world.root / "dataset" / "sequences").mkdir(parents=True)
    tell.world = type(world)(world.server, world.tree, world.root / "dataset", world.routes, world.wanted)
    assert tell.fetch().code == 0
    assert set(world.written()) == set(world.wanted)
    tell.world = type(world)(world.server, world.tree, world.root / "new" / "place", world.routes, world.wanted)
    assert tell.fetch().code == 0
    assert set(tell.world.written()) == set(world.wanted)


def test_a_sweep_stands_for_its_routes(tell: Tell) -> None:
    done = tell("fetch", "paper")
    assert done.code == 2
    assert all(name in done.err for name in (GREY, CALIB, POSES))
    assert "color" not in done.err
    assert "nothing to fetch" in tell("fetch", "streets").out
    assert "no route or sweep 'papre': did you mean 'paper'?" in tell("fetch", "papre").err


def test_drives_of_ones_own_are_not_fetched(tell: Tell) -> None:
    tell.world.routes.write_text(
        '[routes.Toy]\nreader = "folder"\nlearn = "a"\ntest = "b"\ncamera = { field_of_view_deg = 82.0 }\n'
    )
    assert re.search(r"Toy needs .*frames\.csv, which is no public data set", tell.fetch().fault)


def test_a_frame_that_the_archive_lacks_is_named(world: World, tell: Tell) -> None:
    world.routes.write_text(world.routes.read_text().replace("00:30-37", "00:38-42"))
    fault = tell.fetch().fault
    assert f"{GREY}: has no dataset/sequences/00/image_0/000041.png and 1 more" in fault
    assert world.written() == {}


def test_raw_drives_come_with_their_fixes(raw_tree: Path, world: World, tell: Tell) -> None:
    drive = "2011_10_03/2011_10_03_drive_0027_sync"
    for archive, pattern in (
        ("2011_10_03_drive_0027_sync", f"{drive}/**/*.*"),
        ("2011_10_03_calib", "2011_10_03/*.txt"),
    ):
        with zipfile.ZipFile(world.server.folder / f"{archive}.zip", "w") as zipped:
            for path in raw_tree.glob(pattern):
                zipped.write(path, path.relative_to(raw_tree).as_posix())
    world.routes.write_text('[routes.Toy]\nreader = "kitti-raw"\nlearn = "00:2-9"\ntest = "00:17-24"\n')
    done = tell.fetch()
    assert done.code == 0, done.err
    assert len(world.written()) == 2 * 16 + 2
    route = load_route("Toy", world.root, world.routes)
    assert route.test.checksum == load_route("Toy", raw_tree, world.routes).test.checksum


@pytest.mark.parametrize(
    ("source", "fault"),
    [
        ("ftp://host/data_odometry_gray.zip", "begins with https:// or http://"),
        ("http://[host/data_odometry_gray.zip", "begins with https:// or http://"),
        ("https:///data_odometry_gray.zip", "begins with https:// or http://"),
        ("/nowhere/data_odometry_gray.zip", "there is no such file or folder"),
        ("https://host/odometry.zip", "which archive is it? Write --source NAME=https://host/odometry.zip"),
        ("data_grey=https://host/x.zip", "no archive 'data_grey' is needed: did you mean 'data_odometry_gray'?"),
    ],
)
def test_a_source_that_fits_nothing_is_refused(tell: Tell, source: str, fault: str) -> None:
    done = tell.fetch(source)
    assert done.code == 2
    assert f"--source {source}: " in done.err and fault in done.err
