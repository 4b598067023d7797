from __future__ import annotations

import ntpath
import posixpath
from types import ModuleType

from hypothesis import example, given
from hypothesis import strategies as st

from vprbench.fetch.names import leads_out


def inside(paths: ModuleType, root: str, name: str) -> bool:
    """Whether a path module keeps a name below a root."""
    path = paths.normpath(paths.join(root, name))
    return bool(path == root or path.startswith(root + paths.sep))


@given(st.text("./\\:aC\0", max_size=12))
@example("a/../../b")
@example("C:..\\b")
def test_what_passes_stays_inside_on_every_system(name: str) -> None:
    if not leads_out(name):
        assert inside(posixpath, "/data/root", name)
        assert inside(ntpath, "D:\\data\\root", name)
        assert "\0" not in name


@given(st.lists(st.text("abz09_-.", min_size=1, max_size=6), min_size=1, max_size=4))
def test_plain_names_pass(parts: list[str]) -> None:
    assert leads_out("/".join(parts)) == (".." in parts)
