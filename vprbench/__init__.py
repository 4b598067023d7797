"""A Gymnasium-style environment and benchmark suite for visual place recognition.

Importing it registers one environment for each route of the catalogue, for example `vprbench/KITTI-K5-1-v0`, and
`vprbench/Route-v0`, which takes any route as its argument `route`.
"""

import tomllib
from importlib import resources
from types import ModuleType

from vprbench.after_import import after_import

__all__: list[str] = []


def _register(gymnasium: ModuleType) -> None:
    """Register the environments; a second import, as a reload makes, changes nothing."""
    table = tomllib.loads((resources.files(__name__) / "data" / "routes.toml").read_text(encoding="utf-8"))
    names = {f"vprbench/{name}-v0": {"route": name} for name in table["routes"]}
    for name, options in {"vprbench/Route-v0": {}, **names}.items():
        if name not in gymnasium.registry:
            gymnasium.register(name, "vprbench.env:RouteEnv", kwargs=options)


# Most commands do without Gymnasium, which takes several times as long to import as all that they need to say --help.
after_import("gymnasium", _register)
