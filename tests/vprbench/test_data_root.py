from __future__ import annotations

from pathlib import Path

import platformdirs
import pytest

from vprbench.data_root import data_root
from vprbench.errors import DataError


def test_the_nearest_word_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    given, variable = tmp_path / "given", tmp_path / "variable"
    given.mkdir()
    variable.mkdir()
    monkeypatch.setenv("VPRBENCH_DATA", str(variable))
    assert data_root(given) == given
    assert data_root(str(given)) == given
    assert data_root() == variable
    monkeypatch.delenv("VPRBENCH_DATA")
    assert data_root() == platformdirs.user_data_path("vprbench")


def test_a_tilde_is_the_users_home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "kitti").mkdir()
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("USERPROFILE", str(tmp_path))
    assert data_root("~/kitti") == tmp_path / "kitti"


def test_a_named_folder_must_be_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(DataError, match=r"--data names .*nowhere, which is not a folder"):
        data_root(tmp_path / "nowhere")
    monkeypatch.setenv("VPRBENCH_DATA", str(tmp_path / "nowhere"))
    with pytest.raises(DataError, match=r"VPRBENCH_DATA names .*nowhere, which is not a folder"):
        data_root()


def test_a_root_that_is_to_be_made_need_not_be_there(tmp_path: Path) -> None:
    assert data_root(tmp_path / "nowhere", there=False) == tmp_path / "nowhere"
