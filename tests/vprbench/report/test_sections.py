"""Sections one by one: what each tells where something is missing."""

from __future__ import annotations

from dataclasses import replace

import pandas as pd
from markupsafe import escape

from vprbench.report.gathering import read_material
from vprbench.report.material import Material
from vprbench.report.sections import SECTIONS
from vprbench.report.sections.appendices import appendices
from vprbench.report.sections.differences import differences
from vprbench.report.sections.failures import failures
from vprbench.report.sections.frames import frames
from vprbench.report.sections.maps import maps
from vprbench.report.sections.repeat import repeat
from vprbench.results import ResultTable


def material(results: ResultTable) -> Material:
    return read_material(results.csv)


def test_without_the_roads_there_are_maps_but_no_frames(results: ResultTable) -> None:
    (results.folder / "routes.toml").unlink()
    given = material(results)
    section = frames(given)
    assert not section.figures
    assert section.html.count("Left out:") == 2
    assert "Wee: no route of this name is known here." in section.html
    assert [drawing.stem for drawing in maps(given).figures] == ["map-Tiny", "map-Wee"]
    assert "first drive is not drawn" in maps(given).figures[0].caption


def test_frames_of_other_data_than_were_measured_are_not_shown(results: ResultTable) -> None:
    csv = results.folder / "test-Tiny" / "frames.csv"
    csv.write_text(csv.read_text().replace("0.300", "0.301"))
    section = frames(material(results))
    assert "Tiny: its data here are not those that were measured" in section.html
    assert {drawing.stem.split("-")[1] for drawing in section.figures} == {"Wee"}


def test_data_that_are_gone_are_told_without_paths(results: ResultTable) -> None:
    (results.folder / "learn" / "3.png").unlink()
    given = material(results)
    assert set(given.absent) == {"Tiny", "Wee"}
    assert "3.png" in given.absent["Tiny"].remedy or str(results.folder) in given.absent["Tiny"].remedy
    assert "Tiny: its data are not here, or not whole." in frames(given).html
    assert str(results.folder) not in frames(given).html


def test_cells_whose_answers_cannot_be_read_are_named(results: ResultTable) -> None:
    missing, damaged = results.frame().query("status == 'ok'")["cell"].tolist()[:2]
    results.trace_path(missing).unlink()
    results.trace_path(damaged).write_bytes(b"nothing")
    given = material(results)
    assert len(given.runs) == 6
    assert list(given.faults) == [missing, damaged]
    assert given.faults[missing].startswith(f"small.traces/{missing}.parquet is missing")
    assert given.faults[damaged].startswith(f"small.traces/{damaged}.parquet is damaged")
    assert escape(given.faults[damaged]) in failures(given).html


def test_a_question_that_is_not_there_is_missed(results: ResultTable) -> None:
    results.question.unlink()
    assert "small.toml does not lie beside the results" in repeat(material(results)).html
    own = read_material(results.csv, routes=results.folder / "routes.toml")
    assert not own.absent


def test_other_tables_beside_the_results_are_shown(results: ResultTable) -> None:
    assert appendices(material(results)) is None
    (results.folder / "small.fit.csv").write_text("encoder,rate\n<i>x,0.1234567\ny,\n")
    (results.folder / "small.previous.csv").write_text("cell\nold\n")
    (results.folder / "other.csv").write_text("a\n1\n")
    section = appendices(material(results))
    assert section is not None
    assert section.html.count("<table>") == 1
    assert '<td>&lt;i&gt;x</td><td class="number">0.123457</td>' in section.html
    assert '<td>y</td><td class="number"></td>' in section.html


def test_differences_are_those_of_the_scores(results: ResultTable) -> None:
    section = differences(material(results))
    assert section is not None
    means = results.frame().query("status == 'ok'").groupby("agent")["accuracy"].mean() * 100
    shown = f"{means.iloc[0] - means.iloc[1]:+.1f}".replace("-", "\N{MINUS SIGN}")
    assert f"{shown}</td>" in section.html
    assert shown in section.figures[1].alt


def test_one_agent_differs_from_nobody(results: ResultTable) -> None:
    rows = pd.read_csv(results.csv, dtype=str, keep_default_na=False)
    rows[rows["agent"] == "_plain"].to_csv(results.csv, index=False)
    assert differences(material(results)) is None


def test_every_section_has_a_title_of_its_own(results: ResultTable) -> None:
    (results.folder / "small.fit.csv").write_text("encoder\nx\n")
    (results.folder / "small.claims.csv").write_text("id\nx\n")
    given = material(results)
    titles = [section.title for make in SECTIONS if (section := make(given)) is not None]
    assert len(set(titles)) == len(SECTIONS)


def test_of_many_sheets_a_page_holds_those_of_whole_routes(results: ResultTable) -> None:
    given = material(results)
    run, routes = given.runs[0], {route: given.routes["Tiny"] for route in "abc"}
    runs = [run._replace(route=route, agent=f"x{agent}", distance=5.0) for route in routes for agent in range(5)]
    section = frames(replace(given, runs=runs, routes=routes))
    assert [drawing.stem for drawing in section.figures] == [f"frames-{r}-x{agent}" for r in "ab" for agent in range(5)]
    assert "x4 on c: a page holds 10 sheets" in section.html
