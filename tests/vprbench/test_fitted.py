"""Encoders from the store: fitted once, equal to the bit, whatever becomes of the files."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from vprbench.agents import build_encoder
from vprbench.cache_root import cache_root
from vprbench.encoder_key import encoder_key
from vprbench.encoder_store import EncoderStore
from vprbench.errors import ConfigError
from vprbench.fitted import FittedEncoder, fitted_agent, fitted_encoder
from vprbench.observation import observe
from vprbench.route import Route

THIRD_PARTY = Path(__file__).parents[1] / "third_party"

# Holds the lock of a key until it is told to end, or is killed.
HOLDER = """
import sys
from pathlib import Path
from vprbench.encoder_store import EncoderStore
from vprbench.reporting import silent

with EncoderStore(Path(sys.argv[1])).alone(sys.argv[2], silent):
    print("held", flush=True)
    sys.stdin.read()
"""


@pytest.fixture(autouse=True)
def log(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where the third party's encoder says whenever it learns."""
    monkeypatch.syspath_prepend(str(THIRD_PARTY))
    monkeypatch.setenv("ACME_FITS", str(tmp_path / "fits"))
    (tmp_path / "fits").touch()
    return tmp_path / "fits"


@pytest.fixture
def store(tmp_path: Path) -> EncoderStore:
    return EncoderStore(tmp_path / "store")


def fits(log: Path) -> int:
    return len(log.read_text().split())


def fitted(route: Route, store: EncoderStore | None, **options: Any) -> FittedEncoder:  # noqa: ANN401
    return fitted_encoder("typical", 0, route.training, store, **options)


def key(route: Route) -> str:
    return encoder_key("typical", 0, build_encoder("typical"), route.training)


def same(one: FittedEncoder, other: FittedEncoder, route: Route) -> bool:
    frame = observe(route.learn, 3)["frame"]
    a, b = one.encoder.encode(frame), other.encoder.encode(frame)
    return np.array_equal(a.signatures, b.signatures) and np.array_equal(a.points, b.points)


def test_a_second_fit_is_restored_and_equal_to_the_bit(toy_route: Route, store: EncoderStore, log: Path) -> None:
    fresh, kept, restored = (fitted(toy_route, where) for where in (None, store, store))
    assert [one.restored for one in (fresh, kept, restored)] == [False, False, True]
    assert [one.remark for one in (fresh, kept)] == ["", ""]
    assert restored.remark == "encoder typical-s0 restored: it learned this before"
    assert fits(log) == 2
    assert same(fresh, kept, toy_route)
    assert same(fresh, restored, toy_route)
    assert not same(fresh, FittedEncoder(build_encoder("typical")), toy_route)


def test_it_is_fitted_again_where_that_is_asked_for(toy_route: Route, store: EncoderStore, log: Path) -> None:
    assert [fitted(toy_route, store, again=True).restored for _ in range(2)] == [False, False]
    assert fits(log) == 2
    assert fitted(toy_route, store).restored


def test_one_that_cannot_be_saved_is_fitted_each_time(toy_route: Route, store: EncoderStore) -> None:
    for _ in range(2):
        assert not fitted_encoder("mean-patch", 0, toy_route.training, store).restored
    assert not store.folder.exists()


@pytest.mark.parametrize("content", [b"", b"junk", None])
def test_a_damaged_file_is_replaced(toy_route: Route, store: EncoderStore, log: Path, content: bytes | None) -> None:
    fresh = fitted(toy_route, store)
    path = store.path(key(toy_route))
    path.write_bytes(path.read_bytes()[:-40] if content is None else content)
    again = fitted(toy_route, store)
    assert again.remark.startswith("encoder learned again, since the stored one is damaged: ")
    assert same(again, fresh, toy_route)
    assert fitted(toy_route, store).restored
    assert fits(log) == 2


def test_a_store_that_cannot_be_written_is_told_and_no_fault(toy_route: Route, tmp_path: Path, log: Path) -> None:
    (tmp_path / "file").touch()
    store = EncoderStore(tmp_path / "file" / "encoders")
    told = [fitted(toy_route, store).remark for _ in range(2)]
    assert told[0] == told[1] == f"encoder not stored: {store.folder} cannot be written (Not a directory)"
    assert fits(log) == 2


def test_an_encoder_that_fails_to_save_is_used_all_the_same(
    toy_route: Route, store: EncoderStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    def save(self: object, path: Path) -> None:
        path.write_bytes(b"half of it")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(type(build_encoder("typical")), "save", save)
    done = fitted(toy_route, store)
    assert done.remark.startswith("encoder not stored: ")
    assert "No space left" in done.remark
    assert done.encoder.encode(observe(toy_route.learn, 0)["frame"]).signatures.any()
    assert [path.name for path in store.folder.iterdir()] == [f".{key(toy_route)}.lock"]


@pytest.fixture
def holder(toy_route: Route, store: EncoderStore) -> Iterator[subprocess.Popen[str]]:
    """A process that is learning what is about to be asked for."""
    command = [sys.executable, "-c", HOLDER, str(store.folder), key(toy_route)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "held\n"
        yield process
        process.kill()


def test_a_dead_worker_holds_nobody_up(
    toy_route: Route, store: EncoderStore, log: Path, holder: subprocess.Popen[str]
) -> None:
    said: list[str] = []

    def report(stage: str, done: int, total: int, note: str = "") -> None:
        said.append(note)
        if "waiting" in note:
            assert fits(log) == 0
            os.kill(holder.pid, signal.SIGKILL)

    started = time.monotonic()
    assert not fitted(toy_route, store, report=report).restored
    assert said[0] == "another process learns the same: waiting for it"
    assert time.monotonic() - started < 30


def test_who_waited_takes_what_the_other_learned(
    toy_route: Route, store: EncoderStore, log: Path, holder: subprocess.Popen[str], tmp_path: Path
) -> None:
    learned = fitted(toy_route, EncoderStore(tmp_path / "elsewhere"))

    def report(stage: str, done: int, total: int, note: str = "") -> None:
        store.keep(learned.encoder, key(toy_route))  # type: ignore[arg-type]
        assert holder.stdin is not None
        holder.stdin.close()

    assert fitted(toy_route, store, report=report).restored
    assert fits(log) == 1


def test_an_agent_looks_through_the_fitted_encoder(toy_route: Route, store: EncoderStore, log: Path) -> None:
    said: list[tuple[str, str]] = []

    def report(stage: str, done: int, total: int, note: str = "") -> None:
        said.append((stage, note))

    config = {"localizer": "nearest-view", "encoder": "typical"}
    agent: Any = fitted_agent(config, 0, toy_route.training, store, report)
    assert same(FittedEncoder(agent.encoder), fitted(toy_route, None), toy_route)
    assert said[0] == ("fit", "")
    assert said[-2][0] == "fit"
    assert said[-2][1].startswith("brightness 10/10, mean 0.")
    assert said[-1] == ("fitted", "")
    fitted_agent({**config, "floor": 0.2}, 0, toy_route.training, store, report)
    assert said[-1] == ("fitted", "encoder typical-s0 restored: it learned this before")
    assert fits(log) == 2


def test_a_refused_option_is_told_before_anything_is_learned(toy_route: Route, log: Path) -> None:
    config = {"localizer": "max-pi", "vigilance": 2.0, "encoder": "typical"}
    with pytest.raises(ConfigError, match="vigilance"):
        fitted_agent(config, 0, toy_route.training)
    assert fits(log) == 0


def test_a_localizer_of_its_own_needs_no_encoder(toy_route: Route, store: EncoderStore) -> None:
    assert fitted_agent("thumbnail", 0, toy_route.training, store).recruiting == "step"
    assert not store.folder.exists()


def test_where_things_are_kept(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    assert cache_root() is None
    assert cache_root("none") is None
    assert EncoderStore.under(None) is None
    assert cache_root(tmp_path) == tmp_path
    monkeypatch.setenv("VPRBENCH_CACHE", str(tmp_path / "named"))
    assert EncoderStore.under(None) == EncoderStore(tmp_path / "named" / "encoders")
    monkeypatch.delenv("VPRBENCH_CACHE")
    found = cache_root()
    assert found is not None
    assert "vprbench" in found.parts
