"""The registry, seen through a third party's distribution."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from vprbench.errors import ConfigError, PluginError
from vprbench.plugins import find, missing, plugins

THIRD_PARTY = Path(__file__).parents[1] / "third_party"


@pytest.fixture(autouse=True)
def acme(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(THIRD_PARTY))


def offer(folder: Path, distribution: str, encoders: str) -> None:
    info = folder / f"{distribution}-9.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {distribution}\nVersion: 9\n")
    (info / "entry_points.txt").write_text(f"[vprbench.encoders]\n{encoders}\n")


def test_a_third_party_distribution_is_found_and_named() -> None:
    plugin = plugins("encoder")["mean-patch"]
    assert (plugin.distribution, plugin.version, plugin.kind) == ("acme-vpr", "1.2", "encoder")
    assert str(plugin) == "encoder 'mean-patch' (acme-vpr 1.2)"
    assert getattr(plugin.load(), "__name__", "") == "MeanPatch"
    assert "thumbnail" in plugins("localizer")
    assert "thumbnail" not in plugins("encoder")


def test_our_own_plugins_enter_by_the_same_door() -> None:
    assert plugins("encoder")["log-polar"].distribution == "vprbench"
    assert {"cohog", "max-pi"} <= plugins("localizer").keys()


def test_the_list_is_sorted_by_name() -> None:
    assert list(plugins("encoder")) == sorted(plugins("encoder"))


def test_listing_imports_no_plugin() -> None:
    program = (
        "import sys; from vprbench.plugins import plugins; "
        "names = plugins('encoder').keys() | plugins('localizer').keys(); "
        "assert {'mean-patch', 'broken-patch', 'log-polar'} <= names, names; "
        "imported = {m.partition('.')[0] for m in sys.modules}; "
        "assert not imported & {'acme_vpr', 'vprbench_encoders', 'vprbench_localizers'}"
    )
    path = {"PYTHONPATH": str(THIRD_PARTY)}
    subprocess.run([sys.executable, "-c", program], check=True, env=path)


def test_a_broken_plugin_is_reported_by_name_and_takes_no_other_down() -> None:
    with pytest.raises(PluginError) as caught:
        find("encoder", "broken-patch").load()
    assert str(caught.value) == (
        "encoder 'broken-patch' (acme-vpr 1.2) does not load from acme_vpr.broken:Broken: "
        "ModuleNotFoundError: No module named 'acme_missing_dependency'"
    )
    assert find("encoder", "broken-patch").fault() == str(caught.value)
    assert find("encoder", "mean-patch").fault() is None


def test_a_plugin_that_exits_at_import_is_a_broken_plugin(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    offer(tmp_path, "rude", "rude = rude_vpr:Rude")
    (tmp_path / "rude_vpr.py").write_text("import sys\nsys.exit('bye')\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    with pytest.raises(PluginError, match=r"'rude' \(rude 9\) does not load .*SystemExit: bye"):
        find("encoder", "rude").load()


@pytest.mark.parametrize("value", ["not a reference", "acme_vpr.mean_patch:Absent"])
def test_a_reference_that_leads_nowhere_is_a_broken_plugin(
    value: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    offer(tmp_path, "astray", f"astray = {value}")
    monkeypatch.syspath_prepend(str(tmp_path))
    with pytest.raises(PluginError, match=r"'astray' \(astray 9\) does not load"):
        find("encoder", "astray").load()


def test_an_entry_point_that_is_nothing_to_call_is_refused() -> None:
    with pytest.raises(PluginError, match="acme_vpr:ANSWER is of type int, not a class or function"):
        find("encoder", "constant").load()


def test_a_name_offered_twice_names_both_distributions(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    offer(tmp_path, "rival-vpr", "mean-patch = rival_vpr:Rival")
    monkeypatch.syspath_prepend(str(tmp_path))
    with pytest.raises(PluginError, match=r"acme-vpr 1\.2, rival-vpr 9: uninstall all but one"):
        find("encoder", "mean-patch").load()
    assert find("encoder", "fine-patch").fault() is None


def test_a_misspelt_name_is_answered_with_the_nearest() -> None:
    with pytest.raises(ConfigError, match="no encoder is called 'mean-pach': did you mean 'mean-patch'"):
        find("encoder", "mean-pach")


def test_missing_names_what_a_protocol_asks_for() -> None:
    class HalfEncoder:
        def encode(self) -> None:
            """Not all there."""

    assert missing("encoder", HalfEncoder()) == ["fit", "match"]
    assert missing("localizer", object()) == ["clear", "fit", "learn", "recruiting", "respond"]
