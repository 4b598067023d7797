"""Every check of the data of one route, in the order in which one would want to know."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from vprbench.catalogue import catalogue
from vprbench.data_checks.finding import Finding
from vprbench.data_checks.motion import motion_findings
from vprbench.data_checks.overlap import Overlap, overlap, overlap_findings, training_findings
from vprbench.data_checks.pictures import duplicate_findings, look, shared_findings
from vprbench.entries import KittiOdometryEntry, RouteEntry, StreetEntry
from vprbench.errors import DataError
from vprbench.reporting import Report, silent
from vprbench.route import Route, Traverse

__all__ = ["RouteCheck", "check_route"]


@dataclass(frozen=True)
class RouteCheck:
    """What the checks of a route came to.

    Attributes:
        name: the route's.
        findings: errors and warnings, in the order of the checks.
        route: its drives; None where they cannot be loaded.
        overlap: how the test drive lies beside the learn drive; None there too.
    """

    name: str
    findings: tuple[Finding, ...]
    route: Route | None = field(default=None, repr=False)
    overlap: Overlap | None = field(default=None, repr=False)

    @property
    def errors(self) -> int:
        """How many findings are errors."""
        return sum(finding.severity == "error" for finding in self.findings)


def check_route(
    name: str, data: Path | None = None, routes_file: Path | None = None, report: Report = silent
) -> RouteCheck:
    """Check the data of a route, every frame included.

    Args:
        name: the route's.
        data: the data root, None for the default.
        routes_file: a TOML with the user's own routes.
        report: is told how many frames of each drive are read.

    Raises:
        ConfigError: there is no route of that name, or the file of routes is wrong.
    """
    known = catalogue(routes_file)
    there = known.availability(name, data)
    if there.wanting:
        lacking = (Finding("error", "files", name, str(need), there.hint or need.remedy) for need in there.wanting)
        return RouteCheck(name, tuple(lacking))
    try:
        route = known.load(name, data)
    except DataError as error:
        return RouteCheck(name, (Finding("error", "loading", name, str(error), "mend that, and check again"),))
    beside = overlap(route)
    found = tuple(_findings(route, beside, _in_its_plane(route, known.entry(name)), report))
    return RouteCheck(name, found, route, beside)


def _findings(route: Route, beside: Overlap, training: list[Traverse], report: Report) -> Iterator[Finding]:
    """The findings of a route that loads; `training` are its training drives in the route's plane."""
    drives = (route.learn, route.test, *route.training)
    for drive in drives:
        yield from motion_findings(drive)
    seen = [look(drive, report) for drive in drives]
    for pictures in seen:
        yield from pictures.findings()
    yield from shared_findings(seen)
    plane = (route.learn, route.test, *training)
    yield from duplicate_findings([pictures for pictures in seen if any(pictures.drive is drive for drive in plane)])
    yield from overlap_findings(route.test, beside)
    yield from training_findings(route, training)


def _in_its_plane(route: Route, entry: RouteEntry) -> list[Traverse]:
    """The training drives whose positions have the route's origin: each sequence and each drawn street has its own."""
    if isinstance(entry, StreetEntry):
        return []
    if not isinstance(entry, KittiOdometryEntry):
        return list(route.training)
    runs = zip(route.training, entry.training, strict=True)
    return [drive for drive, run in runs if run.sequence == entry.learn.sequence]
