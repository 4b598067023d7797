"""Routes proposed where a recording drives a road twice: found, measured, and read back as a catalogue file."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import cv2
import numpy as np
import pytest

from vprbench.catalogue import catalogue, load_route
from vprbench.cli import main
from vprbench.entries import KittiOdometryEntry
from vprbench.entries.files import read_entries
from vprbench.entries.folder import folder_drive
from vprbench.entries.images import OwnCamera
from vprbench.geodesy import wrap
from vprbench.proposals import Proposal, propose, to_toml
from vprbench.readers.motion import Motion
from vprbench.recordings import Recording, open_recording

# A ring road of 400 m.
RING = 400


def ring(laps: float, aside: float) -> Recording:
    """Laps at 1 m a frame and 10 m/s, each farther out than the one before."""
    frames = np.arange(int(laps * RING))
    angle, radius = frames * 2 * np.pi / RING, RING / (2 * np.pi) + aside * (frames // RING)
    positions = np.stack([radius * np.sin(angle), radius * np.cos(angle)], axis=1)
    return Recording("Ring", "kitti-odometry", "00", 0, Motion(positions, wrap(angle + np.pi / 2), frames / 10), {})


class Told(NamedTuple):
    """What a command said, and its exit code."""

    code: int
    out: str
    err: str


@pytest.fixture
def tell(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Callable[..., Told]:
    """Find revisits in this process."""

    def run(*words: str | Path) -> Told:
        monkeypatch.setattr(sys, "argv", ["vprbench", "data", "revisits", *map(str, words)])
        with pytest.raises(SystemExit) as ended:
            main()
        return Told(int(ended.value.code or 0), *capsys.readouterr())

    return run


Tell = Callable[..., Told]


def test_a_second_lap_is_proposed_with_its_figures() -> None:
    recording = ring(1.5, aside=2.0)
    (proposal,) = propose(recording, ["same", "reverse"])
    positions = recording.motion.positions
    assert (proposal.name, proposal.direction) == ("Revisit-Ring-1", "same")
    assert proposal.test[-1] == 599
    assert proposal.metres[0] == pytest.approx(len(proposal.learn) - 1, rel=1e-3)
    assert proposal.distance[0] == pytest.approx(2.0, abs=0.1)
    drives = positions[[*proposal.learn, *proposal.test]]
    for run in proposal.training:
        assert np.linalg.norm(positions[run][:, None] - drives, axis=2).min() > 10.0
    assert sum(map(len, proposal.training)) == 150


def test_a_catalogue_file_reads_back_as_it_was_proposed(tmp_path: Path) -> None:
    recording = ring(2.5, aside=1.0)
    proposals = propose(recording, ["same"])
    (tmp_path / "my.toml").write_text(to_toml(recording, proposals))
    entries = read_entries(tmp_path / "my.toml")
    assert list(entries) == [proposal.name for proposal in proposals] == ["Revisit-Ring-1", "Revisit-Ring-2"]
    for proposal in proposals:
        entry = entries[proposal.name]
        assert isinstance(entry, KittiOdometryEntry)
        runs = [entry.learn.frames, entry.test.frames, *(run.frames for run in entry.training)]
        assert runs == [proposal.learn, proposal.test, *proposal.training]


def test_no_revisit_is_an_empty_catalogue(tmp_path: Path) -> None:
    recording = ring(1.0, aside=0.0)
    assert propose(recording, ["same", "reverse"]) == []
    (tmp_path / "my.toml").write_text(to_toml(recording, []))
    assert read_entries(tmp_path / "my.toml") == {}


def own_ring(folder: Path) -> Path:
    """A drive of one's own, one and a half times round 120 m, 2 m and a second a frame."""
    (folder / "img").mkdir(parents=True)
    lines = ["file,time,east,north"]
    for frame in range(90):
        angle = frame * 2 * np.pi / 60
        image = np.random.default_rng(frame).integers(0, 256, (12, 40), np.uint8)
        assert cv2.imwrite(str(folder / "img" / f"{frame}.png"), image)
        lines.append(f"img/{frame}.png,{frame},{19.1 * np.sin(angle):.3f},{19.1 * np.cos(angle):.3f}")
    (folder / "frames.csv").write_text("\n".join(lines))
    return folder


def test_parts_of_ones_own_drive_become_a_route_that_loads(tmp_path: Path, tell: Tell) -> None:
    drive = own_ring(tmp_path / "my drive")
    done = tell(drive, "--field-of-view", "60")
    assert (done.code, done.err) == (0, "")
    (tmp_path / "my.toml").write_text(done.out)
    (name,) = read_entries(tmp_path / "my.toml")
    assert name == "Revisit-my-drive-1"
    route = load_route(name, routes=tmp_path / "my.toml")
    whole = folder_drive(drive).traverse(OwnCamera(field_of_view_deg=60.0).reduced, None)
    # The second lap begins up to 5 m, two frames, before the first one does.
    assert route.learn.indices.tolist() == list(range(30))
    assert route.test.indices.tolist() == list(range(58, 90))
    assert route.test.positions[-1] == pytest.approx(route.learn.positions[-1], abs=1e-3)
    assert np.array_equal(route.test.frames[2], whole.frames[60])
    assert route.test.name.startswith(f"{drive / 'frames.csv'}, frames 58-89")
    assert route.learn.camera.fx == pytest.approx(321 / np.tan(np.radians(30)))


def test_a_part_beyond_the_drive_is_told(tmp_path: Path) -> None:
    drive = own_ring(tmp_path / "drive")
    text = (
        '[routes.Far]\nreader = "folder"\nlearn = "drive:0-29"\ntest = "drive:60-90"\ncamera = { fx = 40, cx = 20 }\n'
    )
    (tmp_path / "my.toml").write_text(text)
    with pytest.raises(Exception, match=r"frames\.csv: 90 rows, too few for frame 90"):
        load_route("Far", routes=tmp_path / "my.toml")
    assert drive.is_dir()


def test_a_raw_drive_is_read_from_its_fixes(raw_tree: Path, tell: Tell) -> None:
    """Its road is driven twice; at three seconds a frame the pause between is long enough."""
    stamps = raw_tree / "2011_10_03/2011_10_03_drive_0027_sync/image_00/timestamps.txt"
    stamps.write_text("".join(f"2011-10-03 12:{55 + n // 20}:{n % 20 * 3:02d}.0\n" for n in range(30)))
    done = tell("2011_10_03_drive_0027", "--data", raw_tree, "--length", "10")
    assert 'learn = "2011_10_03_drive_0027:0-14"\ntest = "2011_10_03_drive_0027:15-29"' in done.out
    (raw_tree / "my.toml").write_text(done.out)
    route = load_route("Revisit-2011_10_03_drive_0027-1", raw_tree, raw_tree / "my.toml")
    assert len(route.test) == 15


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["nowhere"], "nowhere: no recording; name a KITTI sequence (00), a raw drive"),
        (["00", "--direction", "revers"], "did you mean 'reverse'?"),
        (["09"], "dataset/poses/09.txt: cannot be read (No such file or directory)"),
        (["2011_10_03_drive_0099"], "no fixes of a drive; its [synced+rectified data] belong there"),
    ],
)
def test_what_cannot_be_searched_is_told(tmp_path: Path, tell: Tell, words: list[str], said: str) -> None:
    done = tell(*words, "--data", tmp_path)
    assert said in done.err
    assert len(done.err.splitlines()) == 1
    assert done.code in (2, 3)


def share(entry: KittiOdometryEntry, proposal: Proposal) -> float:
    """The smaller share of an entry's learn and test frames that a proposal has."""
    drives = ((entry.learn.frames, proposal.learn), (entry.test.frames, proposal.test))
    return min(len(set(asked) & set(there)) / len(asked) for asked, there in drives)


@pytest.mark.kitti
@pytest.mark.parametrize("sequence", ["00", "05"])
def test_the_papers_routes_are_proposed(kitti_root: Path, sequence: str) -> None:
    proposals = propose(open_recording(sequence, kitti_root), ["same"])
    entries = [catalogue().entry(name) for name in ("KITTI-K0-1", "KITTI-K0-2", "KITTI-K5-1", "KITTI-K5-2")]
    for entry in entries:
        assert isinstance(entry, KittiOdometryEntry)
        if entry.learn.sequence == sequence:
            assert max(share(entry, proposal) for proposal in proposals) >= 0.9, str(entry.test)


@pytest.mark.kitti
@pytest.mark.parametrize("sequence", ["01", "03", "04", "10"])
def test_roads_that_are_driven_once_have_none(kitti_root: Path, sequence: str) -> None:
    assert propose(open_recording(sequence, kitti_root), ["same", "reverse"]) == []


@pytest.mark.kitti
def test_sequence_08_is_driven_back(kitti_root: Path) -> None:
    """As is well known of it; its poses come without times here."""
    proposals = propose(open_recording("08", kitti_root), ["same", "reverse"])
    assert [(proposal.name, proposal.direction) for proposal in proposals] == [
        ("Revisit-08-R1", "reverse"),
        ("Revisit-08-R2", "reverse"),
    ]
