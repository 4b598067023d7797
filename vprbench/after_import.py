"""What is done once a module has been imported, be that before or after, without importing it."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec
from types import ModuleType

__all__ = ["after_import"]


def after_import(name: str, act: Callable[[ModuleType], None]) -> None:
    """Act on a module at once if it has been imported, else as soon as it is."""
    if name in sys.modules:
        act(sys.modules[name])
    else:
        sys.meta_path.insert(0, _Watch(name, act))


@dataclass(frozen=True)
class _Watch(MetaPathFinder):
    """Leaves it to the others to find modules, and acts on one of them when its code has run."""

    name: str
    act: Callable[[ModuleType], None]

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """The module's own spec, its loader made to act; None for every other module."""
        if fullname != self.name:
            return None
        others = [finder for finder in sys.meta_path if finder is not self]
        spec = next(filter(None, (finder.find_spec(fullname, path, target) for finder in others)), None)
        if spec is None or spec.loader is None:
            return spec
        run = spec.loader.exec_module

        def run_and_act(module: ModuleType) -> None:
            run(module)
            self.act(module)

        spec.loader.exec_module = run_and_act  # type: ignore[method-assign]
        return spec
