"""Agents from configuration data: what is built, and what is said where it cannot be."""

from __future__ import annotations

import json
import math
import re
from datetime import date
from importlib.metadata import version
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vprbench.agents import Config, build, build_encoder, is_seeded, label, normalise, validate
from vprbench.errors import ConfigError, PluginError

THIRD_PARTY = Path(__file__).parents[1] / "third_party"


@pytest.fixture(autouse=True)
def acme(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(THIRD_PARTY))


def made(config: Config, seed: int = 0) -> Any:  # noqa: ANN401
    return build(config, seed)


def test_a_localizer_takes_the_options_beside_its_name() -> None:
    agent = made({"localizer": "thumbnail", "shrink": 8})
    assert (type(agent).__name__, agent.shrink, agent.gain) == ("Thumbnail", 8, 1.0)


def test_a_bare_name_is_an_agent_without_options() -> None:
    assert type(build("thumbnail")).__name__ == "Thumbnail"


def test_an_encoder_is_a_name_or_a_table() -> None:
    by_name = made({"localizer": "nearest-view", "encoder": "mean-patch"})
    by_table = made({"localizer": "nearest-view", "floor": 0, "encoder": {"name": "mean-patch", "size": 2}})
    assert (by_name.encoder.size, by_table.encoder.size, by_table.floor) == (4, 2, 0.0)


def test_numbers_and_lists_take_the_annotated_types() -> None:
    encoder: Any = build_encoder({"name": "mean-patch", "grid": [3, 5], "darkness": 1})
    assert encoder.grid == (3, 5)
    assert isinstance(encoder.darkness, float)
    assert made({"localizer": "thumbnail", "gain": math.inf}).gain == math.inf


def test_partials_and_factory_functions_are_plugins_too() -> None:
    fine: Any = build_encoder("fine-patch")
    finer: Any = build_encoder({"name": "fine-patch", "size": 16})
    noisy: Any = build_encoder({"name": "noisy-patch", "size": 2}, seed=3)
    assert (fine.size, finer.size, noisy.size) == (8, 16, 2)


def test_the_seed_reaches_the_parts_that_take_one() -> None:
    grids = {build_encoder("noisy-patch", seed).grid for seed in range(20)}  # type: ignore[attr-defined]
    again: Any = build_encoder({"name": "noisy-patch", "seed": 5}, seed=6)
    assert len(grids) > 1
    assert again.grid == build_encoder("noisy-patch", 5).grid  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("config", "seeded"),
    [
        ("thumbnail", False),
        ({"localizer": "nearest-view", "encoder": "mean-patch"}, False),
        ({"localizer": "nearest-view", "encoder": "noisy-patch"}, True),
        ({"localizer": "nearest-view", "encoder": {"name": "noisy-patch", "seed": 1}}, False),
    ],
)
def test_whether_the_seed_matters(config: Config, seeded: bool) -> None:
    assert is_seeded(config) is seeded


PATCH = "of encoder 'mean-patch' (acme-vpr 1.2)"


@pytest.mark.parametrize(
    ("config", "message"),
    [
        ({"localizer": "thumbnial"}, "agent thumbnial: no localizer is called 'thumbnial': did you mean 'thumbnail'?"),
        (
            {"localizer": "thumbnail", "shrnk": 3},
            "agent thumbnail[shrnk=3]: shrnk is not an option of localizer 'thumbnail' (acme-vpr 1.2): "
            "did you mean 'shrink'? (allowed: gain, shrink)",
        ),
        (
            {"localizer": "nearest-view"},
            "agent nearest-view: encoder is missing: localizer 'nearest-view' (acme-vpr 1.2) needs one of ",
        ),
        (
            {"localizer": "nearest-view", "encoder": "maen-patch"},
            "agent nearest-view(maen-patch): no encoder is called 'maen-patch': did you mean 'mean-patch'?",
        ),
        ({"localizer": "thumbnail", "encoder": "mean-patch"}, "encoder is not an option of localizer 'thumbnail'"),
        (
            {"localizer": "nearest-view", "encoder": {"name": "mean-patch", "sise": 3}},
            "agent nearest-view(mean-patch[sise=3]): encoder.sise is not an option "
            "of encoder 'mean-patch' (acme-vpr 1.2): did you mean 'size'? (allowed: darkness, grid, metric, size)",
        ),
        (
            {"localizer": "nearest-view", "encoder": {"name": "mean-patch", "metric": "l3"}},
            f"encoder.metric = 'l3' {PATCH}: did you mean 'l2'? (allowed: l1, l2)",
        ),
        (
            {"localizer": "nearest-view", "encoder": {"name": "mean-patch", "size": "4"}},
            f"encoder.size = '4' {PATCH}: should be a valid integer",
        ),
        (
            {"localizer": "nearest-view", "encoder": {"name": "mean-patch", "size": True}},
            f"encoder.size = True {PATCH}: should be a valid integer",
        ),
        (
            {"localizer": "nearest-view", "encoder": {"name": "mean-patch", "grid": [1, 2.5]}},
            f"encoder.grid[1] = 2.5 {PATCH}: should be a valid integer",
        ),
        (
            {"localizer": "nearest-view", "encoder": {"name": "mean-patch", "size": 0}},
            "encoder 'mean-patch' (acme-vpr 1.2) refuses its options: ValueError: size must be at least 1, not 0",
        ),
        ({"encoder": "mean-patch"}, "names no localizer: give its name, or a table with the key 'localizer'"),
        ({"localizer": {"name": "thumbnail"}}, "names no localizer: give its name, or a table with the key"),
        ({"localizer": "nearest-view", "encoder": 3}, "3 names no encoder: give its name, or a table with"),
        ({"localizer": "thumbnail", "gain": date(2024, 1, 1)}, "gain is a date, which no configuration file can hold"),
    ],
)
def test_a_fault_names_the_key_and_what_is_allowed(config: Config, message: str) -> None:
    with pytest.raises(ConfigError, match=re.escape(message)) as caught:
        build(config)
    assert "\n" not in str(caught.value)


def test_validate_finds_a_fault_without_building() -> None:
    with pytest.raises(ConfigError, match="should be a valid number"):
        validate({"localizer": "thumbnail", "gain": "high"})
    validate({"localizer": "nearest-view", "encoder": {"name": "mean-patch", "size": 0}})


def test_a_broken_encoder_is_named_by_the_agent_that_needs_it() -> None:
    with pytest.raises(PluginError, match=r"encoder 'broken-patch' \(acme-vpr 1\.2\) does not load"):
        build({"localizer": "nearest-view", "encoder": "broken-patch"})


def test_what_an_encoder_says_of_its_options_is_passed_on() -> None:
    origin = f"vprbench {version('vprbench')}"
    message = f"encoder log-polar[size=60]: encoder 'log-polar' ({origin}): log-polar: size must be 1..54, not 60"
    with pytest.raises(ConfigError, match=re.escape(message)):
        build_encoder({"name": "log-polar", "size": 60})


def test_a_plugin_that_makes_something_else_is_told_what_it_lacks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    info = tmp_path / "odd-9.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: odd\nVersion: 9\n")
    (info / "entry_points.txt").write_text("[vprbench.encoders]\nodd = builtins:dict\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    with pytest.raises(PluginError, match=r"encoder 'odd' \(odd 9\) makes a dict without encode, fit, match"):
        build_encoder("odd")


@pytest.mark.parametrize(
    ("config", "text"),
    [
        ("cohog", "cohog"),
        ({"localizer": "max-pi", "encoder": "log-polar"}, "max-pi(log-polar)"),
        (
            {"encoder": {"size": 15, "name": "hsd", "map_size": 30}, "localizer": "max-pi"},
            "max-pi(hsd[map_size=30,size=15])",
        ),
        ({"localizer": "cohog", "entropy_threshold": 0.5}, "cohog[entropy_threshold=0.5]"),
        ({"localizer": "max-pi", "width": 10.0, "encoder": {"name": "hsd"}}, "max-pi[width=10](hsd)"),
        (
            {"localizer": "a", "b": [1, 2.5], "c": True, "d": None, "e": {"f": "g"}},
            "a[b=(1,2.5),c=true,d=none,e=(f=g)]",
        ),
    ],
)
def test_a_label_reads_well(config: Config, text: str) -> None:
    assert label(config) == text


def test_texts_that_suit_no_file_name_stay_apart() -> None:
    labels = {label({"localizer": "a", "path": path}) for path in ("x/y", "x:y", "x_y", "x y")}
    assert len(labels) == 4
    assert not re.search(r"[^\w()\[\]=,.+-]", "".join(labels))


values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=3), inner, max_size=3),
    max_leaves=6,
)
tables = st.dictionaries(st.text(max_size=4).filter(lambda key: key not in ("name", "encoder")), values, max_size=3)
parts = tables.map(lambda options: {**options, "name": "e"})
agents = st.tuples(tables, st.just("e") | parts).map(lambda pair: {**pair[0], "localizer": "l", "encoder": pair[1]})


@given(agents)
def test_the_canonical_form_is_json_and_stays_itself(config: dict[str, Any]) -> None:
    canonical = normalise(config)
    assert json.loads(json.dumps(canonical)) == canonical
    assert normalise(canonical) == canonical
    assert list(canonical) == sorted(canonical)
    assert label(canonical) == label(config)


@given(agents)
def test_the_canonical_form_does_not_depend_on_how_it_was_written(config: dict[str, Any]) -> None:
    assert json.dumps(normalise(dict(reversed(config.items())))) == json.dumps(normalise(config))


def test_equal_numbers_are_one_configuration() -> None:
    as_float = {"localizer": "a", "b": 10.0, "encoder": "e"}
    as_int = {"localizer": "a", "b": 10, "encoder": {"name": "e"}}
    assert json.dumps(normalise(as_float)) == json.dumps(normalise(as_int))
