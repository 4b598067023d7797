"""Studies as data: the paper's are whole, and what is wrong with a file is told."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from vprbench.catalogue import catalogue
from vprbench.claims import load_claims
from vprbench.errors import ConfigError
from vprbench.plugins import plugins
from vprbench.studies import FitStudy, SweepStudy, choose_studies, load_studies, road_for
from vprbench.sweep import builtin_sweeps, load_sweep

STUDIES = load_studies()
SWEEPS = [study for study in STUDIES if isinstance(study, SweepStudy)]
ON_ONE_ROAD = [study for study in STUDIES if not isinstance(study, SweepStudy)]
LEAST = '[[studies]]\nname = "a"\ntitle = "?"\nkind = "sweep"\nsweep = "streets"\n'


def test_every_figure_and_table_of_the_paper_has_its_study() -> None:
    shown = " ".join(study.paper for study in STUDIES)
    for what in ("AUC_HSD", "reconstruction", "freq", "result_global", "result_env", "Table cost", "placeField"):
        assert what in shown


def test_every_result_that_a_claim_needs_is_measured() -> None:
    made = {"fit" if study.kind == "fit" else study.name for study in STUDIES}
    assert {claim.study for claim in load_claims().claims} <= made | {"routes"}


@pytest.mark.parametrize("study", SWEEPS, ids=lambda study: study.name)
def test_figures_ask_for_what_their_sweep_measures(study: SweepStudy) -> None:
    assert study.sweep == study.name, "claims look for the table under the study's name"
    _, sweep = load_sweep(study.sweep)
    for figure in study.figures:
        assert set(figure.routes) <= set(sweep.routes), figure.stem
        assert set(figure.names) <= set(figure.routes), figure.stem
        assert set(figure.agents) | set(figure.paper) <= set(sweep.agents), figure.stem


def test_no_route_of_our_own_questions_is_left_undrawn() -> None:
    for study in SWEEPS:
        if study.name in ("robustness", "sampling", "heading"):
            assert {route for figure in study.figures for route in figure.routes} == set(
                load_sweep(study.sweep)[1].routes
            )


def test_no_two_figures_overwrite_each_other() -> None:
    stems = [figure.stem for study in SWEEPS for figure in study.figures] + [study.name for study in ON_ONE_ROAD]
    assert len(set(stems)) == len(stems)


def test_no_sweep_is_forgotten() -> None:
    # Those that are left are for starting, and for how hsd-plus was found.
    assert set(builtin_sweeps()) - {study.sweep for study in SWEEPS} == {"k0-2", "paper", "streets", "tuning"}


def test_what_needs_one_road_can_do_without_data(tmp_path: Path) -> None:
    for study in ON_ONE_ROAD:
        assert set(study.routes) <= set(catalogue().names())
        road, lacking = road_for(study, tmp_path)
        assert road == "Street-Wide"
        assert list(lacking) == ["KITTI-K5-1", "KITTI-K0-2"]


def test_the_table_of_cost_has_all_seven_configurations_with_five_seeds() -> None:
    (study,) = (study for study in STUDIES if isinstance(study, FitStudy))
    assert "Table cost" in study.paper
    assert set(study.encoders) == {name for name in plugins("encoder") if re.fullmatch(r"hsd-[\d-]+", name)}
    assert (len(study.encoders), len(study.seeds)) == (7, 5)


def test_chosen_studies_keep_their_order_and_a_misspelt_one_is_told() -> None:
    assert [study.name for study in choose_studies(STUDIES, ("global", "reconstruction"))] == [
        "reconstruction",
        "global",
    ]
    assert choose_studies(STUDIES, ()) == STUDIES
    with pytest.raises(ConfigError, match="no study is called 'globel': did you mean 'global'"):
        choose_studies(STUDIES, ("globel",))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "studies: field required"),
        ("[[studies", "Expected"),
        (LEAST.replace("sweep =", "sweeep ="), "studies.0.sweep.sweep: field required"),
        (LEAST + 'colour = "red"', "studies.0.sweep.colour: extra inputs"),
        (LEAST.replace('"sweep"', '"sweeps"'), "studies.0: input tag 'sweeps'"),
        (LEAST.replace('"a"', '"a/b"'), "studies.0.sweep.name: string should match"),
        (LEAST + LEAST, "two studies are called 'a'"),
    ],
)
def test_what_is_wrong_with_a_file_is_told(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "own.toml"
    path.write_text(text)
    with pytest.raises(ConfigError, match=re.escape(said)) as fault:
        load_studies(path)
    assert str(path) in str(fault.value)
