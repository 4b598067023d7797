"""What decides, to the bit, what an encoder learns: two fits of one key learn the same."""

from __future__ import annotations

import inspect
import json
import platform
from collections.abc import Iterator, Sequence
from functools import cache
from hashlib import sha256
from importlib.util import find_spec
from pathlib import Path

import llvmlite.binding as llvm  # type: ignore[import-untyped]

from vprbench.agents import Config, is_seeded, label, normalise
from vprbench.plugins import Factory, Plugin, find
from vprbench.protocols import Encoder
from vprbench.provenance import versions
from vprbench.route import Traverse

__all__ = ["encoder_key", "encoder_name", "training_checksum"]

# Counted up whenever a stored file means something else, or is written in another way.
_FORMAT = 1

# Reads or draws every frame that an encoder learns from.
_FRAMES = ("vprbench.readers", "vprbench.street")

# Characters of a name that any file system holds, with room for what follows it.
_NAME = 120


def encoder_key(config: Config, seed: int, encoder: Encoder, training: Sequence[Traverse]) -> str:
    """A name for what this encoder learns on these drives: readable, suits a file, and unlike that of any other fit.

    Args:
        config: of the encoder.
        seed: counts only where the encoder takes it.
        encoder: as made from `config`: says whose code learns.
        training: the drives, in their order.
    """
    plugin = find("encoder", normalise(config, "encoder")["name"])
    parts = {
        "format": _FORMAT,
        "plugin": [plugin.name, plugin.origin, plugin.value],
        "code": [_source_hash(name) for name in (*sorted(_packages(plugin, encoder)), *_FRAMES)],
        "config": normalise(config, "encoder"),
        "seed": seed if is_seeded(config, "encoder") else None,
        "training": [drive.checksum for drive in training],
        "libraries": versions()["libraries"],
        # Libraries choose their instructions, and so their rounding, by the processor.
        "processor": [platform.system(), platform.machine(), llvm.get_host_cpu_name()],
    }
    digest = sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()
    return f"{encoder_name(config, seed)[:_NAME]}-{digest[:20]}"


def encoder_name(config: Config, seed: int) -> str:
    """An encoder's label, with its seed where that matters: "hsd[size=12]-s0"; suits a file."""
    return label(config, "encoder") + (f"-s{seed}" if is_seeded(config, "encoder") else "")


def training_checksum(training: Sequence[Traverse]) -> str:
    """Short sha256 over the checksums of the training drives."""
    return sha256("".join(drive.checksum for drive in training).encode()).hexdigest()[:16]


def _packages(plugin: Plugin, encoder: Encoder) -> set[str]:
    """The top-level packages that an encoder's code lies in: its entry point's, and those of its class's ancestors."""
    factory: Factory = plugin.load()
    modules = [plugin.value.partition(":")[0], getattr(inspect.unwrap(factory), "__module__", "")]
    modules += [ancestor.__module__ for ancestor in type(encoder).__mro__]
    return {module.partition(".")[0] for module in modules} - {"", "builtins", "functools", "typing", "vprbench"}


@cache
def _source_hash(package: str) -> str:
    """Sha256 of the Python files of a package, or of the one file of a module."""
    digest = sha256()
    for root, file in sorted(_sources(package)):
        digest.update(f"{file.relative_to(root).as_posix()}\0".encode() + sha256(file.read_bytes()).digest())
    return digest.hexdigest()


def _sources(package: str) -> Iterator[tuple[Path, Path]]:
    """The Python files of a package, each with the folder that its name begins in."""
    spec = find_spec(package)
    for folder in map(Path, (spec and spec.submodule_search_locations) or ()):
        yield from ((folder, file) for file in folder.rglob("*.py"))
    if spec and not spec.submodule_search_locations and spec.origin and Path(spec.origin).is_file():
        yield Path(spec.origin).parent, Path(spec.origin)
