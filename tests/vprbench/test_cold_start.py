"""What a fresh interpreter imports, and that the environments are there whichever is imported first."""

from __future__ import annotations

import subprocess
import sys

import pytest

# Each takes longer to import than all that `--help` needs.
HEAVY = ("cv2", "gymnasium", "numba", "numpy", "pandas", "pyarrow", "pydantic", "scipy")


def fresh(code: str) -> str:
    """What the code prints in an interpreter of its own."""
    return subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout


def loaded_after(code: str) -> set[str]:
    return set(fresh(f"import atexit, sys; atexit.register(lambda: print(*sys.modules))\n{code}").split())


@pytest.mark.parametrize(
    "code", ["import vprbench", "sys.argv = ['vprbench', '--help']; from vprbench.cli import main; main()"]
)
def test_what_needs_no_arrays_imports_none(code: str) -> None:
    loaded = loaded_after(code)
    assert "vprbench" in loaded
    assert loaded.isdisjoint(HEAVY)


def test_the_process_that_holds_the_messages_of_a_sweep_imports_no_more_than_it_needs() -> None:
    assert loaded_after("import vprbench.message_queue").isdisjoint({*HEAVY, "vprbench.runner"})


def test_a_worker_of_a_sweep_does_without_the_libraries_of_tables() -> None:
    assert loaded_after("import vprbench.pool").isdisjoint({"pandas", "pyarrow"})


@pytest.mark.parametrize(
    "imports",
    [
        "import vprbench; import gymnasium",
        "import gymnasium; import vprbench",
        "import vprbench; from gymnasium.envs.registration import registry; import gymnasium",
    ],
)
def test_environments_are_registered_in_either_order_of_imports(imports: str) -> None:
    count = "print(sum(name.startswith('vprbench/') for name in gymnasium.registry))"
    both = "from vprbench.catalogue import catalogue; print(len(catalogue().names()) + 1)"
    registered, routes = fresh(f"{imports}; {count}; {both}").split()
    assert registered == routes


def test_an_import_that_fails_leaves_the_next_one_to_act(tmp_path_factory: pytest.TempPathFactory) -> None:
    folder = tmp_path_factory.mktemp("modules")
    (folder / "fragile.py").write_text("import pathlib; pathlib.Path(__file__).with_name('ready').read_text()")
    code = f"""
import pathlib, sys; sys.path.insert(0, {str(folder)!r})
from vprbench.after_import import after_import
after_import("fragile", lambda module: print("acted on", module.__name__))
try:
    import fragile
except FileNotFoundError:
    print("failed")
pathlib.Path({str(folder)!r}, "ready").touch()
import fragile
after_import("fragile", lambda module: print("at once"))
"""
    assert fresh(code).splitlines() == ["failed", "acted on fragile", "at once"]
