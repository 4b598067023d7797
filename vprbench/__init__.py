"""A Gymnasium-style environment and benchmark suite for visual place recognition.

Importing it registers one environment for each route of the catalogue, for example `vprbench/KITTI-K5-1-v0`, and
`vprbench/Route-v0`, which takes any route as its argument `route`.
"""

from gymnasium import register, registry

from vprbench.catalogue import catalogue

__all__: list[str] = []


def _register() -> None:
    """Register the environments; a second import, as a reload makes, changes nothing."""
    entry = "vprbench.env:RouteEnv"
    names = {f"vprbench/{name}-v0": {"route": name} for name in catalogue().names()}
    for name, options in {"vprbench/Route-v0": {}, **names}.items():
        if name not in registry:
            register(name, entry, kwargs=options)


_register()
