"""A web server on this machine that answers range requests, and archives in KITTI's shape for it to serve."""

from __future__ import annotations

import re
import sys
import zipfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread
from typing import NamedTuple

import pytest

from vprbench.cli import main
from vprbench.route import Route
from vprbench.street.kitti_tree import draw_kitti

ROUTE = '[routes.Toy]\nreader = "kitti-odometry"\nlearn = "00:3-11"\ntest = "00:30-37"\ntraining = ["00:15-20"]\n'


class Handler(BaseHTTPRequestHandler):
    """Answers a GET with the bytes that its Range names; a fault of the server's may answer in its place."""

    protocol_version = "HTTP/1.1"
    server: Server

    def do_GET(self) -> None:
        """Answer, or let the fault do it."""
        first, last = map(int, re.findall(r"\d+", self.headers["Range"]))
        self.server.log.append((self.path, first, last + 1))
        if self.server.fault is None or not self.server.fault(self, first, last + 1):
            self.part(first, last + 1)

    def part(self, start: int, stop: int, sent: int | None = None, headers: Mapping[str, str] = {}) -> None:
        """Send a part of the file; of its bytes only the first `sent`, before the connection is closed."""
        path = self.server.folder / self.path.lstrip("/")
        if not path.is_file():
            self.send_error(404)
            return
        size = path.stat().st_size
        if start >= size:
            self.send_error(416)
            return
        stop = min(stop, size)
        self.send_response(206)
        usual = {"Content-Range": f"bytes {start}-{stop - 1}/{size}", "Content-Length": str(stop - start)}
        for key, value in {**usual, "ETag": '"1"', **headers}.items():
            self.send_header(key, value)
        self.end_headers()
        with path.open("rb") as file:
            file.seek(start)
            self.wfile.write(file.read(stop - start if sent is None else sent))
        self.close_connection = sent is not None

    def log_message(self, format: str, *args: object) -> None:
        """Say nothing."""


Fault = Callable[[Handler, int, int], bool]


class Server(ThreadingHTTPServer):
    """The server, its log of (path, start, stop), and what goes wrong at it."""

    daemon_threads = True

    def __init__(self, folder: Path) -> None:
        super().__init__(("127.0.0.1", 0), Handler)
        self.folder, self.log = folder, list[tuple[str, int, int]]()
        self.fault: Fault | None = None

    def handle_error(self, request: object, client_address: object) -> None:
        """Say nothing of a client that has hung up."""

    def url(self, path: str = "") -> str:
        """The address of a file."""
        return f"http://127.0.0.1:{self.server_address[1]}/{path}"


@pytest.fixture
def server(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Server]:
    """A running server of the folder `served`."""
    monkeypatch.setenv("NO_PROXY", "127.0.0.1")
    (tmp_path / "served").mkdir()
    with Server(tmp_path / "served") as running:
        thread = Thread(target=running.serve_forever, args=(0.01,))
        thread.start()
        yield running
        running.shutdown()
        thread.join()


@dataclass(frozen=True)
class World:
    """A data set on a server, a route through it, and where it is to go.

    Attributes:
        server: that serves its archives.
        tree: the data set, unpacked.
        root: the empty data root.
        routes: the route file.
        wanted: the files that the route needs.
    """

    server: Server
    tree: Path
    root: Path
    routes: Path
    wanted: tuple[str, ...]

    def written(self) -> dict[str, bytes]:
        """Every file below the data root, by its path there."""
        files = (path for path in self.root.rglob("*") if not path.is_dir())
        return {path.relative_to(self.root).as_posix(): path.read_bytes() for path in files}

    def original(self, name: str) -> bytes:
        """What a file should hold."""
        return (self.tree / name).read_bytes()

    def sound(self) -> bool:
        """Whether every file that was written is whole, one that the route needs, and all of them below the root."""
        below = all(name in self.wanted and data == self.original(name) for name, data in self.written().items())
        return below and {path.name for path in self.root.parent.iterdir()} == {"served", "routes.toml", "root"}


def pack(archive: Path, tree: Path, names: list[str], hole: int = 0) -> None:
    """Zip files of a tree, the second half of them behind a hole that takes no room on the disk."""
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as zipped:
        for index, name in enumerate(names):
            if index == len(names) // 2:
                zipped.start_dir += hole
            zipped.write(tree / name, name)


@pytest.fixture(scope="session")
def tree(tmp_path_factory: pytest.TempPathFactory, toy_route: Route) -> Path:
    """A sequence of 41 small frames in the layout of KITTI's odometry benchmark."""
    root = tmp_path_factory.mktemp("tree")
    draw_kitti(root, "00", {range(41): toy_route.learn}, size=(124, 38))
    return root


@pytest.fixture
def world(tmp_path: Path, server: Server, tree: Path) -> World:
    """The sequence in archives as KITTI publishes them, the images' larger than 4 GiB."""
    names = sorted(path.relative_to(tree).as_posix() for path in tree.rglob("*.*"))
    texts = [name for name in names if name.endswith(("calib.txt", "times.txt"))]
    images = [name for name in names if name.endswith(".png")]
    pack(server.folder / "data_odometry_gray.zip", tree, images, hole=5 << 30)
    pack(server.folder / "data_odometry_calib.zip", tree, texts)
    pack(server.folder / "data_odometry_poses.zip", tree, ["dataset/poses/00.txt"])
    (tmp_path / "routes.toml").write_text(ROUTE)
    (tmp_path / "root").mkdir()
    frames = (*range(3, 12), *range(15, 21), *range(30, 38))
    wanted = [f"dataset/sequences/00/image_0/{i:06d}.png" for i in frames]
    everything = (*wanted, *texts, "dataset/poses/00.txt")
    return World(server, tree, tmp_path / "root", tmp_path / "routes.toml", everything)


class Told(NamedTuple):
    """What a command said, and its exit code."""

    code: int
    out: str
    err: str

    @property
    def fault(self) -> str:
        """The fault of which it told in one line; empty where there is none."""
        (line,) = self.err.splitlines() or [""]
        assert self.code == 3 or not line
        return line


@dataclass
class Tell:
    """Runs `vprbench`; its waits are noted in place of being waited.

    Attributes:
        world: whose data root and route file every command gets.
        waits: seconds.
    """

    world: World
    capsys: pytest.CaptureFixture[str]
    monkeypatch: pytest.MonkeyPatch
    waits: list[float]

    def __call__(self, *words: str) -> Told:
        """Run a command."""
        files = ["--data", str(self.world.root), "--routes", str(self.world.routes)]
        self.monkeypatch.setattr(sys, "argv", ["vprbench", *words, *files])
        with pytest.raises(SystemExit) as ended:
            main()
        return Told(int(ended.value.code or 0), *self.capsys.readouterr())

    def fetch(self, *sources: str) -> Told:
        """Fetch the route, from the world's server unless told otherwise."""
        options = [word for source in sources or [self.world.server.url()] for word in ("--source", source)]
        return self("fetch", "Toy", "--accept-licence", *options)


@pytest.fixture
def tell(world: World, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Tell:
    """The command line, pointed at the world."""
    waits: list[float] = []
    monkeypatch.setattr("vprbench.fetch.http_file.sleep", waits.append)
    return Tell(world, capsys, monkeypatch, waits)
