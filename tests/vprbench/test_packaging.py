"""The distribution itself: what it registers, that it is typed, and that what it ships conforms."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from vprbench.checks import run_checks
from vprbench.options import parameters
from vprbench.plugins import GROUPS, Kind, find, plugins

ROOT = Path(__file__).parents[2]
PYPROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
PACKAGES = [ROOT / package for package in PYPROJECT["tool"]["hatch"]["build"]["targets"]["wheel"]["packages"]]


def shipped(kind: Kind) -> list[str]:
    return sorted(PYPROJECT["project"]["entry-points"][GROUPS[kind]])


@pytest.mark.parametrize("kind", ["encoder", "localizer"])
def test_the_registry_agrees_with_pyproject(kind: Kind) -> None:
    registered = {name: plugin.value for name, plugin in plugins(kind).items() if plugin.distribution == "vprbench"}
    assert registered == PYPROJECT["project"]["entry-points"][GROUPS[kind]], "run pip install -e . again"


@pytest.mark.parametrize("name", shipped("encoder"))
def test_every_encoder_shipped_conforms(name: str) -> None:
    # A dictionary learns in fewer steps here: the checks ask whether it keeps the protocol, not how good it is.
    options = {"steps": 10} if "steps" in parameters(find("encoder", name).load()) else {}
    assert [result for result in run_checks("encoder", {"name": name, **options}) if result.fault] == []


def encoder_of(localizer: str) -> str | None:
    """The quickest encoder for a localizer that looks through one."""
    return "log-polar-6" if "encoder" in parameters(find("localizer", localizer).load()) else None


@pytest.mark.parametrize("name", shipped("localizer"))
def test_every_localizer_shipped_conforms(name: str) -> None:
    assert [result for result in run_checks("localizer", name, encoder=encoder_of(name)) if result.fault] == []


@pytest.mark.parametrize("package", PACKAGES, ids=lambda package: package.name)
def test_every_package_is_typed(package: Path) -> None:
    assert (package / "py.typed").is_file()
