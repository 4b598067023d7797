"""What each module exports: all that its names call public."""

from __future__ import annotations

import ast
import importlib
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
WHEEL = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["hatch"]["build"]["targets"]["wheel"]
PACKAGES = [ROOT / package for package in WHEEL["packages"]]
MODULES = [file for package in PACKAGES for file in sorted(package.rglob("*.py")) if file.name != "__main__.py"]


def module_name(file: Path) -> str:
    """The name by which a file of one of the packages is imported."""
    package = next(package for package in PACKAGES if file.is_relative_to(package))
    return ".".join(file.relative_to(package.parent).with_suffix("").parts).removesuffix(".__init__")


def public_names(tree: ast.Module) -> set[str]:
    """Classes and functions of a module that carry no underscore."""
    defined = {node.name for node in tree.body if isinstance(node, ast.ClassDef | ast.FunctionDef)}
    return {name for name in defined if not name.startswith("_")}


@pytest.mark.parametrize("file", MODULES, ids=module_name)
def test_all_is_complete(file: Path) -> None:
    module = importlib.import_module(module_name(file))
    exported = getattr(module, "__all__", None)
    public = public_names(ast.parse(file.read_text()))
    if exported is None:
        assert not public, f"{module.__name__} defines {sorted(public)} and no __all__"
        return
    assert [name for name in exported if not hasattr(module, name)] == []
    assert public <= set(exported), f"missing in __all__: {sorted(public - set(exported))}"
