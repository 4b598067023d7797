"""The page about data says what the code does."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import vprbench.data_checks
from vprbench.entries.files import read_entries
from vprbench.proposals import propose, to_toml
from vprbench.recordings import open_recording

PAGE = (Path(__file__).parents[2] / "docs" / "data.md").read_text("utf-8")
(EXAMPLE,) = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)


def test_the_page_lists_every_check_with_its_severity() -> None:
    listed = {(severity, name) for name, severity in re.findall(r"^\| `([\w-]+)` \| (error|warning) \|", PAGE, re.M)}
    code = "".join(file.read_text("utf-8") for file in Path(vprbench.data_checks.__path__[0]).glob("*.py"))
    assert listed == set(re.findall(r'Finding\("(error|warning)", "([\w-]+)"', code))


def test_its_example_is_a_file_of_routes(tmp_path: Path) -> None:
    (tmp_path / "my.toml").write_text(EXAMPLE)
    assert list(read_entries(tmp_path / "my.toml")) == ["Revisit-00-3"]


@pytest.mark.kitti
def test_its_example_is_what_the_command_says(kitti_root: Path) -> None:
    recording = open_recording("00", kitti_root)
    assert EXAMPLE in to_toml(recording, propose(recording, ["same"]))
