"""docs/plugins.md, followed word for word: its files are written, registered, checked and built."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest

from vprbench.agents import build, validate
from vprbench.checks import run_checks
from vprbench.errors import ConfigError

pytest_plugins = ["pytester"]

GUIDE = (Path(__file__).parents[2] / "docs" / "plugins.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", GUIDE, re.MULTILINE | re.DOTALL)


@pytest.fixture(autouse=True)
def my_vpr(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The distribution of the guide, as if installed."""
    for block in [*blocks("python"), *blocks("toml")]:
        if named := re.match(r"# (\S+\.(?:py|toml))\n", block):
            file = tmp_path / named[1]
            file.parent.mkdir(exist_ok=True)
            file.write_text(block, encoding="utf-8")
    (tmp_path / "my_vpr" / "__init__.py").touch()
    project = tomllib.loads(blocks("toml")[0])["project"]
    info = tmp_path / "my_vpr-0.1.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n")
    groups = project["entry-points"].items()
    lines = [f"[{group}]\n" + "".join(f"{k} = {v}\n" for k, v in offered.items()) for group, offered in groups]
    (info / "entry_points.txt").write_text("\n".join(lines))
    monkeypatch.syspath_prepend(str(tmp_path))
    return tmp_path


def agents() -> dict[str, Any]:
    table: dict[str, Any] = tomllib.loads(blocks("toml")[1])["agents"]
    return table


def test_the_tree_of_the_guide_is_what_its_blocks_write(my_vpr: Path) -> None:
    drawn = re.findall(r"[├└]── (\w+\.\w+)", blocks("text")[0])
    assert sorted(drawn) == sorted(path.name for path in my_vpr.rglob("*.*") if "dist-info" not in str(path))


def test_the_project_of_the_guide_builds_beside_results(my_vpr: Path) -> None:
    pytest.importorskip("setuptools", minversion="61", reason="setuptools builds the guide's project")
    (my_vpr / "runs").mkdir()
    (my_vpr / "built").mkdir()
    build = [sys.executable, "-c", "import setuptools; setuptools.setup()", "egg_info", "--egg-base", "built"]
    built = subprocess.run(build, cwd=my_vpr, capture_output=True, text=True)
    assert built.returncode == 0, built.stderr
    info = my_vpr / "built" / "my_vpr.egg-info"
    assert (info / "top_level.txt").read_text() == "my_vpr\n"
    offered = (info / "entry_points.txt").read_text()
    assert "corners = my_vpr.corners:Corners" in offered
    assert "tiny-image = my_vpr.tiny_image:TinyImage" in offered


@pytest.mark.parametrize(
    ("kind", "name", "encoder"),
    [("encoder", "corners", None), ("localizer", "tiny-image", None), ("localizer", "max-pi", "corners")],
)
def test_the_plugins_of_the_guide_conform(kind: str, name: str, encoder: str | None) -> None:
    assert [result for result in run_checks(kind, name, encoder) if result.fault] == []  # type: ignore[arg-type]


def test_the_tests_of_the_guide_pass(my_vpr: Path, pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(my_vpr))
    result = pytester.runpytest_subprocess("-p", "no:cacheprovider", str(my_vpr / "test_my_vpr.py"))
    assert result.ret == 0
    assert result.parseoutcomes()["passed"] > 30


def test_the_agents_of_the_guide_are_valid() -> None:
    for config in agents().values():
        validate(config)


def test_the_fault_of_the_guide_is_what_is_said() -> None:
    with pytest.raises(ConfigError) as caught:
        build({"localizer": "max-pi", "encoder": {"name": "corners", "pionts": 50}})
    assert str(caught.value) in GUIDE


def test_the_last_lines_of_the_guide_build_an_agent() -> None:
    names: dict[str, Any] = {}
    exec(blocks("python")[-1], names)
    assert names["agent"].encoder.points == 50
