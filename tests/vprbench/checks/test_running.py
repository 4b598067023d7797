"""The two ways to run checks: one decorator in a third party's tests, and a plug-in's name."""

from __future__ import annotations

from pathlib import Path

import pytest

from vprbench.agents import build_encoder
from vprbench.checks import CheckFailed, encoder_checks, parametrize_with_checks, run_checks
from vprbench.errors import ConfigError, PluginError, VprbenchError
from vprbench.plugins import plugins

pytest_plugins = ["pytester"]

THIRD_PARTY = Path(__file__).parents[2] / "third_party"

THEIR_TESTS = """
from acme_vpr.mean_patch import MeanPatch
from acme_vpr.thumbnail import Thumbnail
from vprbench.checks import Check, parametrize_with_checks

class Dim(MeanPatch):
    def match(self, queries, memory):
        return super().match(queries, memory) / 2

@parametrize_with_checks(encoder=MeanPatch)
def test_mean_patch_conforms(check: Check) -> None:
    check.run()

@parametrize_with_checks(encoder=Dim)
def test_dim_conforms(check: Check) -> None:
    check.run()

@parametrize_with_checks(localizer=Thumbnail)
def test_thumbnail_conforms(check: Check) -> None:
    check.run()
"""


@pytest.fixture(autouse=True)
def acme(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(THIRD_PARTY))


def test_one_decorator_makes_a_test_of_each_check(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(THIRD_PARTY))
    pytester.makepyfile(THEIR_TESTS)
    result = pytester.runpytest_subprocess("-p", "no:cacheprovider", "-v", "-rs")
    # The patches have nothing of what is optional, nor has the thumbnail: no encoder, describe, store or locate.
    result.assert_outcomes(passed=21 + 20 + 17, failed=1, skipped=8 + 8 + 5)
    result.stdout.fnmatch_lines(
        [
            "*test_dim_conforms?match-of-equals-is-1? FAILED*",
            "*test_thumbnail_conforms?learn-agrees-with-compare? SKIPPED*",
            "*CheckFailed: a signature matches itself with 1; *",
            "SKIPPED * it has no describe and compare, which are optional",
        ]
    )


def test_the_decorator_takes_one_factory() -> None:
    with pytest.raises(TypeError, match="either encoder= or localizer="):
        parametrize_with_checks()


@pytest.mark.parametrize(
    ("kind", "name", "encoder"),
    [
        ("encoder", "mean-patch", None),
        ("encoder", {"name": "mean-patch", "size": 2}, None),
        ("encoder", "typical", None),
        ("localizer", "thumbnail", None),
        ("localizer", "nearest-view", "fine-patch"),
        ("localizer", "nearest-view", "typical"),
    ],
)
def test_the_third_party_conforms(kind: str, name: str, encoder: str | None) -> None:
    results = run_checks(kind, name, encoder)  # type: ignore[arg-type]
    assert len({result.name for result in results}) == len(results) > 15
    assert [result for result in results if result.fault] == []
    inapplicable = {result.name for result in results if result.inapplicable}
    assert len(inapplicable) == {"thumbnail": 5, "nearest-view": 2, "typical": 4}.get(str(name), 8)


def test_a_localizer_gets_the_first_encoder_that_loads(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[object] = []
    theirs = {name: plugin for name, plugin in plugins("encoder").items() if plugin.distribution == "acme-vpr"}
    monkeypatch.setattr("vprbench.checks.running.plugins", lambda kind: theirs)
    monkeypatch.setattr("vprbench.checks.running.validate", asked.append)
    monkeypatch.setattr("vprbench.checks.running.localizer_checks", lambda factory: iter(()))
    run_checks("localizer", "nearest-view")
    # Before it in the list come "broken-patch", which does not import, and "constant", which is no factory.
    assert asked == [{"localizer": "nearest-view", "encoder": "fine-patch"}]


def test_what_a_plugin_raises_is_told_in_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    info = tmp_path / "rude-9.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: rude\nVersion: 9\n")
    (info / "entry_points.txt").write_text("[vprbench.encoders]\nrude = rude_checked_vpr:Rude\n")
    (tmp_path / "rude_checked_vpr.py").write_text(
        "from acme_vpr.mean_patch import MeanPatch\n"
        "class Rude(MeanPatch):\n"
        "    def match(self, queries, memory):\n"
        "        raise IndexError('over\\nthere')\n"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    faults = {result.name: result.fault for result in run_checks("encoder", "rude")}
    assert faults["match-of-equals-is-1"] == "raised IndexError: over there"
    assert faults["encodes-repeatably"] is None


def test_faults_of_the_question_are_raised_at_once() -> None:
    with pytest.raises(ConfigError, match="no encoder is called 'mean-pach'"):
        run_checks("encoder", "mean-pach")
    with pytest.raises(PluginError, match="broken-patch"):
        run_checks("encoder", "broken-patch")
    with pytest.raises(ConfigError, match="encoder is not an option of localizer 'thumbnail'"):
        run_checks("localizer", "thumbnail", "mean-patch")


def test_a_failed_check_is_an_assertion_and_one_of_our_errors() -> None:
    assert issubclass(CheckFailed, AssertionError)
    assert issubclass(CheckFailed, VprbenchError)


def test_the_names_of_checks_are_known_before_anything_is_built() -> None:
    def never() -> None:
        raise AssertionError("built too early")

    names = [check.name for check in encoder_checks(never)]  # type: ignore[arg-type]
    assert names == [check.name for check in encoder_checks(lambda: build_encoder("mean-patch"))]
