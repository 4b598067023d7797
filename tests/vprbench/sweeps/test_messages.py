"""What the command line says: one line for each fault, and help that is enough."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest

Tell = Callable[..., Any]


@pytest.mark.parametrize(
    ("right", "wrong", "said"),
    [
        ("routes =", "rotues =", "did you mean 'routes'"),
        ("[2, 5]", "[2, -5]", "sampling_distances.1"),
        ("[2, 5]", "[2, inf]", "sampling_distances.1"),
        ("[2, 5]", "[2, 2.0000001]", "must differ"),
        ("[2, 5]", "[2, 5", "tiny.toml"),
        ('"Tiny-2"', '"Tinny"', "did you mean 'Tiny"),
        ('"mean-patch"', '"main-patch"', "did you mean 'mean-patch'"),
        ('"mean-patch"', '"mean-patch", flor = 1', "did you mean 'floor'"),
        ("patches =", "'../patches' =", "agents"),
    ],
)
def test_a_typo_is_told_in_one_line(here: Path, tell: Tell, right: str, wrong: str, said: str) -> None:
    question = (here / "tiny.toml").read_text()
    assert right in question
    (here / "tiny.toml").write_text(question.replace(right, wrong))
    done = tell("sweep", "tiny.toml")
    assert done.code == 2
    assert said in done.err
    assert len(done.err.splitlines()) == 1
    assert not (here / "runs").exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["sweep", "streats"], "did you mean 'streets'"),
        (["sweep", "streets", "--data", "nowhere"], "nowhere"),
        (["sweep", "streets", "--filter", "Wode"], "matches no cell"),
        (["run", "Street-Wied", "cohog"], "did you mean 'Street-Wide'"),
        (["run", "Street-Wide", "chog"], "did you mean 'cohog'"),
        (["list", "encodrs"], "did you mean 'encoders'"),
        (["check", "log-poler"], "did you mean 'log-polar'"),
        (["table", "nowhere.csv"], "nowhere.csv"),
        (["score", "nowhere.csv"], "nowhere.csv"),
    ],
)
def test_a_wrong_word_is_told_in_one_line(tell: Tell, words: Sequence[str], said: str) -> None:
    done = tell(*words)
    assert done.code not in (0, 1)
    assert said in done.err
    assert len(done.err.splitlines()) == 1


def test_a_folder_that_cannot_be_written_is_told_before_anything_runs(here: Path, tell: Tell) -> None:
    (here / "runs").write_text("a file in the way")
    done = tell("sweep", "tiny.toml")
    assert done.code == 3
    assert "--out" in done.err


def test_help_tells_every_command(tell: Tell) -> None:
    whole = tell("--help").out
    for command in ("sweep", "run", "table", "list", "score", "check"):
        assert command in whole
        assert "Example: vprbench " in " ".join(tell(command, "--help").out.split())


def test_the_lists_name_what_there_is(tell: Tell) -> None:
    everything = tell("list").out
    for name in ("Street-Wide", "KITTI-K5-1", "log-polar", "max-pi", "cohog", "streets", "k0-2", "acme-vpr"):
        assert name in everything
