"""Every Python block of the environment's page runs as it stands, and says what the page says it does."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[1] / "docs" / "environment.md"


def test_the_agent_that_looks_beats_the_one_that_guesses(capsys: pytest.CaptureFixture[str]) -> None:
    right = []
    for block in re.findall(r"```python\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL):
        exec(compile(block, PAGE.name, "exec"), {})
        said = re.search(r"(\d+) of the test frames", capsys.readouterr().out)
        assert said is not None
        right.append(int(said[1]))
    guessed, looked = right
    assert looked > 3 * guessed
