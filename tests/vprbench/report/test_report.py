"""The report of a sweep, from the command line to the page."""

from __future__ import annotations

import re
import subprocess
import sys
from base64 import b64decode
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path

import cv2
import numpy as np
import pandas as pd
import pytest

from vprbench.results import ResultTable

Tell = Callable[..., tuple[int, str, str]]

VOID = {"meta", "img", "br", "link", "input", "hr"}


class Page(HTMLParser):
    """What a browser would make of a page: its elements, words, and whether every element is closed in turn."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.elements: list[tuple[str, dict[str, str]]] = []
        self.words: list[str] = []
        self.cells: list[str] = []
        self.open: list[str] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, {name: value or "" for name, value in attrs}))
        if tag not in VOID:
            self.open.append(tag)
        if tag in ("td", "th"):
            self.cells.append("")

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.words.append(data)
        if "td" in self.open or "th" in self.open:
            self.cells[-1] += data

    def all(self, tag: str) -> list[dict[str, str]]:
        return [attributes for name, attributes in self.elements if name == tag]

    @property
    def text(self) -> str:
        return re.sub(r"\s+", " ", " ".join(self.words))


def read(folder: Path) -> Page:
    return Page((folder / "report.html").read_text("utf-8"))


@pytest.fixture(scope="module")
def written(measured: Path) -> Path:
    """A report of the results, written once."""
    from vprbench.report.gathering import read_material
    from vprbench.report.writing import write_report

    folder = measured.parent / "written"
    write_report(read_material(measured / "small.csv"), folder)
    return folder


@pytest.fixture(scope="module")
def page(written: Path) -> Page:
    return read(written)


def test_every_element_is_closed_and_every_address_within_the_page(page: Page) -> None:
    assert page.open == []
    ids = [attributes["id"] for _, attributes in page.elements if "id" in attributes]
    assert len(ids) == len(set(ids))
    links = [attributes["href"] for attributes in page.all("a")]
    assert links
    assert {link.removeprefix("#") for link in links} <= set(ids)
    assert {tag for tag, _ in page.elements} & {"script", "link", "iframe", "object", "base"} == set()


def test_nothing_is_fetched(written: Path, page: Page) -> None:
    text = (written / "report.html").read_text("utf-8")
    assert not re.search(r"https?:|//[a-z]|@import|url\(", re.sub(r"base64,[\w+/=]+", "", text))
    sources = [image["src"] for image in page.all("img")]
    assert len(sources) == 5 + 2 + 4  # charts, a map a route, a sheet a route and agent
    for source in sources:
        head, _, body = source.partition(";base64,")
        assert head in ("data:image/png", "data:image/jpeg")
        assert cv2.imdecode(np.frombuffer(b64decode(body), np.uint8), cv2.IMREAD_GRAYSCALE) is not None
    policy = next(meta["content"] for meta in page.all("meta") if meta.get("http-equiv") == "Content-Security-Policy")
    assert policy.startswith("default-src 'none';")


def test_pictures_have_words_and_headings_their_order(page: Page) -> None:
    assert all(len(image["alt"]) > 20 for image in page.all("img"))
    levels = [tag for tag, _ in page.elements if re.fullmatch(r"h\d", tag)]
    assert levels[0] == "h1"
    assert set(levels[1:]) == {"h2"}
    assert page.all("html")[0]["lang"] == "en"


def test_hostile_names_are_only_names(written: Path, page: Page, measured: Path) -> None:
    text = (written / "report.html").read_text("utf-8")
    assert "<script" not in text
    assert "<b>such" not in text
    assert "<size>" not in text
    rows = pd.read_csv(measured / "small.csv")
    for name in {*rows["agent"], *rows["route"]}:
        assert name in page.text
    names = [file.name for file in written.rglob("*") if file.is_file()]
    assert all(re.fullmatch(r"[\w.-]+", name) for name in names)
    assert len([name for name in names if name.startswith("frames-") and name.endswith(".png")]) == 4


def test_the_failed_cell_the_question_and_the_provenance_are_told(page: Page, measured: Path) -> None:
    rows = pd.read_csv(measured / "small.csv").dropna(subset="auc")
    told = ["Tiny/2m/broken/s0", "no <b>such</b> luck", "Does <size> matter?", "1 of 9 cells failed"]
    told += [rows["data_checksum"].iloc[0], rows["libraries"].iloc[0], rows["interval_rule"].iloc[0]]
    told += ["localizer thumbnail; gain 0.5", "vprbench sweep small.toml", 'routes = ["Tiny", "Wee"]']
    for words in told:
        assert str(words) in page.text


@pytest.mark.parametrize("metric", ["auc", "auc_all", "accuracy"])
def test_tables_hold_what_the_results_hold(written: Path, page: Page, measured: Path, metric: str) -> None:
    rows = pd.read_csv(measured / "small.csv").query("status == 'ok'")
    means = rows.groupby(["agent", "sampling_distance_m"])[metric].mean()
    stored = pd.read_csv(written / "tables" / f"{metric}-by-distance.csv").dropna(subset="mean")
    stored = stored[stored["sampling_distance_m"] != "mean"].sort_values(["agent", "sampling_distance_m"])
    assert stored["mean"].tolist() == pytest.approx(means.tolist())
    for mean in means:
        assert any(cell.startswith(f"{mean * 100:.1f}") for cell in page.cells)
    assert (written / "tables" / f"{metric}-by-route.tex").read_text().startswith(r"\begin{table}")
    assert f"{means.max() * 100:.1f}" in (written / "tables" / f"{metric}-by-distance.md").read_text()


def test_the_same_results_give_the_same_bytes(results: ResultTable, written: Path, tell: Tell) -> None:
    code, out, _ = tell("report", results.csv, "--out", results.folder / "again")
    assert (code, out) == (0, f"{results.folder / 'again' / 'report.html'}\n")
    first, second = (
        {file.relative_to(folder): file.read_bytes() for file in folder.rglob("*") if file.is_file()}
        for folder in (written, results.folder / "again")
    )
    assert first.keys() == second.keys()
    assert [name for name in first if first[name] != second[name]] == []


def test_without_roads_and_answers_the_rest_is_told(results: ResultTable, tell: Tell) -> None:
    (results.folder / "routes.toml").unlink()
    cells = results.frame().query("status == 'ok'")["cell"].tolist()
    for cell in cells:
        results.trace_path(cell).unlink()
    code, _, err = tell("report", results.csv)
    assert code == 0
    assert "without frames of Tiny: no route 'Tiny'" in err
    assert "without the answers of 8 cells" in err
    page = read(results.folder / "small.report")
    assert "Left out: Tiny: no route of this name is known here." in page.text
    assert str(results.folder) not in page.text
    assert page.text.count("Left out: no trace of a finished cell could be read.") == 2
    assert f"{cells[0]} : small.traces/{cells[0]}.parquet is missing; measure the cell again" in page.text
    assert len(page.all("img")) == 1


def test_where_everything_failed_that_is_all_there_is(results: ResultTable, tell: Tell) -> None:
    rows = pd.read_csv(results.csv, dtype=str, keep_default_na=False)
    rows[rows["status"] != "ok"].to_csv(results.csv, index=False)
    assert tell("report", results.csv)[0] == 0
    text = read(results.folder / "small.report").text
    assert "1 of 1 cells failed" in text
    assert "Left out: no cell was measured." in text


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["nowhere.csv"], "nowhere.csv: not readable as a result table"),
        (["{csv}", "--data", "nowhere"], "--data names"),
        (["{csv}", "--routes", "nowhere.toml"], "nowhere.toml"),
        (["{csv}", "--out", "{csv}"], "the report cannot be written"),
    ],
)
def test_a_fault_is_one_line(results: ResultTable, tell: Tell, words: list[str], said: str) -> None:
    code, out, err = tell("report", *(word.format(csv=results.csv) for word in words))
    assert code in (2, 3)
    assert out == ""
    assert err.startswith("vprbench: ")
    assert said in err
    assert err.count("\n") == 1


def test_an_empty_table_or_a_damaged_question_is_refused(results: ResultTable, tell: Tell) -> None:
    results.question.write_text("routes = [")
    assert "small.toml: " in tell("report", results.csv)[2]
    results.csv.write_text(results.csv.read_text().splitlines()[0] + "\n")
    assert "no row to report" in tell("report", results.csv)[2]


@pytest.mark.parametrize(("missing", "extra"), [("jinja2", "report"), ("matplotlib", "figures")])
def test_a_missing_extra_is_named(measured: Path, missing: str, extra: str) -> None:
    code = f"import sys; sys.modules[{missing!r}] = None; from vprbench.cli import main; main()"
    words = [sys.executable, "-c", code, "report", str(measured / "small.csv")]
    finished = subprocess.run(words, capture_output=True, text=True, check=False)
    assert finished.returncode == 2
    assert finished.stderr.count("\n") == 1
    assert f"pip install 'vprbench[{extra}]'" in finished.stderr
