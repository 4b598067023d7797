"""The sweeps that come with vprbench ask what their descriptions say."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import asdict
from math import inf
from pathlib import Path
from typing import Any

import pytest

from vprbench.catalogue import catalogue
from vprbench.entries import KittiOdometryEntry, StreetEntry
from vprbench.street.parameters import StreetParameters
from vprbench.sweep import Sweep, builtin_sweeps, parse_sweep

PLACE_CELLS = {
    "LPMP": {"localizer": "max-pi", "encoder": "log-polar"},
    "HSD-15-30": {"localizer": "max-pi", "encoder": "hsd-15-30"},
    "HSD-plus": {"localizer": "max-pi", "encoder": "hsd-plus"},
}


def entries(sweep: Sweep, path: Path) -> list[Any]:
    known = catalogue(path.parent / sweep.routes_file if sweep.routes_file else None)
    return [known.entry(name) for name in sweep.routes]


def asked(name: str) -> tuple[Sweep, list[Any]]:
    path = builtin_sweeps()[name]
    sweep = parse_sweep(path)
    return sweep, entries(sweep, path)


@pytest.mark.parametrize("name", builtin_sweeps())
def test_every_sweep_parses_and_its_routes_are_known(name: str) -> None:
    sweep, routes = asked(name)
    assert sweep.description.endswith(".")
    assert len(routes) == len(set(sweep.routes))


def test_every_routes_file_is_asked_for() -> None:
    folder = next(iter(builtin_sweeps().values())).parent
    named = {
        tomllib.loads(path.read_text())["routes_file"]
        for path in folder.glob("*.toml")
        if "routes_file" in path.read_text()
    }
    assert named == {str(path.relative_to(folder)) for path in folder.glob("routes/*.toml")}


@pytest.mark.parametrize("name", ["robustness", "sampling", "heading"])
def test_the_studies_compare_the_paper_s_methods(name: str) -> None:
    sweep, _ = asked(name)
    cohog = {} if name == "heading" else {"CoHOG": {"localizer": "cohog"}}
    compass = {agent: config for agent, config in sweep.agents.items() if not agent.endswith("-no-compass")}
    assert compass == PLACE_CELLS | cohog
    assert f"; {len(sweep.seeds)} seeds." in sweep.description


def test_robustness_changes_one_parameter_at_a_time() -> None:
    sweep, routes = asked("robustness")
    assert all(isinstance(entry, StreetEntry) for entry in routes)
    drawn = [asdict(entry.parameters) for entry in routes]
    default = drawn[sweep.routes.index("Robust-Default")]
    assert default == asdict(StreetParameters(length=default["length"]))
    words = {"lateral_offset": "Offset", "exposure": "Exposure", "occluders": "Occluders"}
    levels: dict[str, list[float]] = {key: [default[key]] for key in words}
    for name, parameters in zip(sweep.routes, drawn, strict=True):
        changed = [key for key, value in parameters.items() if value != default[key]]
        assert len(changed) == (name != "Robust-Default")
        for key in changed:
            levels[key].append(parameters[key])
            told = f"{'minus-' if parameters[key] < 0 else ''}{abs(parameters[key]):g}"
            assert name == f"Robust-{words[key]}-{told}"
    for low, high, key in [(0, 3, "lateral_offset"), (-2, 2.5, "exposure"), (0, 1, "occluders")]:
        assert len(levels[key]) == len(set(levels[key])) >= 4
        assert (min(levels[key]), max(levels[key])) == (low, high)


def test_sampling_goes_from_1_to_20_metres_on_a_real_and_a_drawn_road() -> None:
    sweep, routes = asked("sampling")
    assert sweep.sampling_distances == [1, 2, 3, 5, 10, 20]
    assert sweep.routes[0] == "KITTI-K0-2"
    assert [type(entry) for entry in routes] == [KittiOdometryEntry, StreetEntry]


def test_heading_spoils_nothing_but_the_compass() -> None:
    sweep, routes = asked("heading")
    noise = [entry.heading_noise_deg for entry in routes]
    assert noise == [0, 1, 2, 5, 10, 20] * 2
    assert {entry.heading_noise_seed for entry in routes} == {0}
    for road in (routes[:6], routes[6:]):
        assert len({_without_noise(entry) for entry in road}) == 1
    for name, sd in zip(sweep.routes, noise, strict=True):
        assert name.endswith(f"-noisy-{sd:g}") == (sd > 0)


def test_without_a_compass_the_heading_plays_no_part() -> None:
    sweep, _ = asked("heading")
    blind = {agent: config for agent, config in sweep.agents.items() if agent.endswith("-no-compass")}
    assert blind == {
        f"{agent}-no-compass": {**config, "azimuth_width_deg": inf} for agent, config in PLACE_CELLS.items()
    }


def _without_noise(entry: Any) -> str:  # noqa: ANN401 - of any reader
    dropped: Sequence[str] = ("heading_noise_deg", "split")
    return str(entry.model_dump(exclude=set(dropped)))
