"""`vprbench fetch`: the public data that routes need, out of their publishers' archives, into the data root."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, DownloadColumn, Progress, TextColumn, TimeRemainingColumn, TransferSpeedColumn

from vprbench.catalogue import catalogue
from vprbench.data_root import data_root
from vprbench.entries import RouteEntry
from vprbench.errors import ConfigError, DataError, nearest
from vprbench.fetch.addresses import Addresses
from vprbench.fetch.archives import Location
from vprbench.fetch.extraction import check_disk, extract, transfer
from vprbench.fetch.plan import ArchivePlan, locate, plan
from vprbench.fetch.shelf import Shelf
from vprbench.reporting import part_of
from vprbench.sweep import builtin_sweeps, load_sweep

__all__ = ["Fetching", "fetch_command"]


@dataclass(frozen=True)
class Fetching:
    """The options of `vprbench fetch`; the command's help says what each means."""

    names: Sequence[str]
    data: Path | None
    routes: Path | None
    accepted: bool
    dry_run: bool
    sources: Sequence[str]


def fetch_command(request: Fetching) -> int:
    """Fetch what is not there yet; exit code 130 where it was interrupted."""
    console, aside = Console(soft_wrap=True, highlight=False), Console(stderr=True, soft_wrap=True, highlight=False)
    root = data_root(request.data, there=False)
    sought = _sought(request, root)
    if not sought:
        console.print("nothing to fetch: these roads are drawn")
        return 0
    addresses = Addresses.parse(
        request.sources, sorted({place.archive for group in sought.values() for place in group})
    )
    if not (request.accepted or request.dry_run):
        _state_terms(sought, aside)
        raise ConfigError("nothing was fetched: if you accept the licence above, add --accept-licence")
    with Shelf(addresses) as shelf:
        try:
            plans = _planned(sought, shelf, console, aside)
            if not request.dry_run:
                _fetch(plans, root, aside)
                console.print(_done(plans, shelf, root), markup=False)
        except KeyboardInterrupt:
            aside.print("interrupted: what was fetched is kept, and the same command goes on from there")
            return 130
    return 0


def _sought(request: Fetching, root: Path) -> dict[Path, tuple[Location, ...]]:
    """Where every file that the routes need is published."""
    files: dict[Path, None] = {}
    for name, entry in _routes(request):
        for need in entry.needs(root):
            if not need.public:
                raise DataError(f"{name} needs {need.source}, which is no public data set: put it there yourself")
            files.update(dict.fromkeys(need.files))
    return locate(files, root)


def _routes(request: Fetching) -> Iterator[tuple[str, RouteEntry]]:
    """The routes that are named, and those of the sweeps that are."""
    known, sweeps = catalogue(request.routes), builtin_sweeps()
    for name in request.names:
        if name in known.entries:
            yield name, known.entry(name)
        elif name in sweeps or name.endswith(".toml"):
            yield from _routes_of_sweep(name, request)
        else:
            raise ConfigError(f"no route or sweep {name!r}: {nearest(name, [*known.entries, *sweeps])}")


def _routes_of_sweep(name: str, request: Fetching) -> Iterator[tuple[str, RouteEntry]]:
    question, sweep = load_sweep(name)
    own = request.routes or (question.parent / sweep.routes_file if sweep.routes_file else None)
    known = catalogue(own)
    for route in sweep.routes:
        yield route, known.entry(route)


def _state_terms(sought: Mapping[Path, tuple[Location, ...]], aside: Console) -> None:
    """Say what would be fetched from where, under what licence, and what to cite."""
    places = [group[0] for group in sought.values()]
    for data_set in dict.fromkeys(place.data_set for place in places):
        aside.print(f"{data_set.title}, {data_set.home}", markup=False)
        aside.print(f"  licence: {data_set.licence}", markup=False)
        aside.print(f"  cite: {data_set.citation}", markup=False)
        for url, size in dict.fromkeys((place.url, place.size) for place in places if place.data_set is data_set):
            aside.print(f"  from {url}" + (f" ({size}, of which parts are read)" if size else ""), markup=False)


def _planned(
    sought: Mapping[Path, tuple[Location, ...]], shelf: Shelf, console: Console, aside: Console
) -> list[ArchivePlan]:
    """What there is to be had from each archive, told in a line each."""
    with aside.status("read what the archives hold"):
        plans = plan(sought, shelf.contents)
    for each in plans:
        console.print(_told(each), markup=False)
    return plans


def _told(each: ArchivePlan) -> str:
    """What is there and what is not, of one archive."""
    wanted = len(each.there) + len(each.todo)
    text = f"{each.contents.source.name}: {len(each.there)} of {wanted} files are there"
    if each.todo:
        text += f", {len(each.todo)} to fetch ({each.bytes / 1e6:.1f} MB)"
    if each.differing:
        text += f", {len(each.differing)} of them in place of files that differ from the archive's"
    return text


def _fetch(plans: Sequence[ArchivePlan], root: Path, aside: Console) -> None:
    """Write everything while its bar moves."""
    check_disk(plans, root)
    with _bars(aside) as bars:
        total, before = transfer(plans), 0
        bar = bars.add_task("fetch", total=total)

        def report(stage: str, done: int, total: int, note: str = "") -> None:
            bars.update(bar, completed=done)

        for each in plans:
            extract(each, part_of(report, before, total))
            before += transfer([each])


def _done(plans: Sequence[ArchivePlan], shelf: Shelf, root: Path) -> str:
    files, size = sum(len(each.todo) for each in plans), sum(each.bytes for each in plans)
    text = f"{files} files ({size / 1e6:.1f} MB) were written to {root}"
    if shelf.requests:
        text += f"; {shelf.received / 1e6:.1f} MB were read in {shelf.requests} requests"
    return text


def _bars(console: Console) -> Progress:
    """One bar, for all bytes."""
    return Progress(
        TextColumn("{task.description}", markup=False),
        BarColumn(bar_width=28),
        DownloadColumn(),
        TransferSpeedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        console=console,
        disable=not console.is_terminal,
        transient=True,
    )
