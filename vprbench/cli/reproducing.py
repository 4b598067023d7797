"""`vprbench reproduce`: the paper's figures, tables and claims, and a line on all that could not be run."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from importlib.util import find_spec
from pathlib import Path

from rich.console import Console
from rich.table import Table
from rich.text import Text

from vprbench.atomic import replacing
from vprbench.claims import evaluate
from vprbench.claims.formats import counted
from vprbench.cli.studying import Ended, Interrupted, Reproduction, question_of, run_study
from vprbench.data_root import data_root
from vprbench.errors import ConfigError, VprbenchError
from vprbench.studies import Study, SweepStudy, choose_studies, load_studies

__all__ = ["Reproduction", "reproduce_command"]

_STYLES: Mapping[str, str] = {"done": "green", "already there": "green", "could not be run": "yellow", "failed": "red"}
_NEEDED = {"matplotlib": "figures", "jinja2": "report"}


def reproduce_command(request: Reproduction) -> int:
    """Run the studies, then judge the claims and write the reports; exit code 1 if something failed."""
    console = Console(stderr=True)
    studies = choose_studies(load_studies(request.file), request.studies)
    if request.list:
        Console().print(_listed(studies))
        return 0
    data_root(request.data)
    for package, extra in _NEEDED.items():
        if find_spec(package) is None:
            raise ConfigError(f"reproduce needs {package}: pip install 'vprbench[{extra}]'")
    try:
        ended = [(study, _run(study, request, console)) for study in studies]
        faults = [] if request.dry_run else _conclude(studies, request, console)
    except (KeyboardInterrupt, Interrupted):
        console.print("interrupted: what was finished is kept, and the same command goes on from there")
        return 130
    _summarise(ended, console)
    return 1 if faults or any(end.state == "failed" for _, end in ended) else 0


def _run(study: Study, request: Reproduction, console: Console) -> Ended:
    """Run one study; a fault in it is no reason not to go on."""
    console.rule(Text(f"{study.name}: {study.title}"), align="left")
    try:
        return run_study(study, request)
    except VprbenchError as error:
        return Ended("failed", str(error))


def _conclude(studies: Sequence[Study], request: Reproduction, console: Console) -> list[str]:
    """Figures, claims and reports of what is there; what failed among them."""
    from vprbench.cli.study_figures import draw_study

    console.rule(Text("figures, claims and reports"), align="left")
    sweeps = [(study, request.out / f"{Path(question_of(study, request)).stem}.csv") for study in _sweeps(studies)]
    present = [(study, results) for study, results in sweeps if results.exists()]
    faults = list[str]()
    if request.out.is_dir():
        faults += _attempt("claims", partial(_judge, present, request, console), console)
    for study, results in present:
        figures = partial(draw_study, study, results, request.out / "figures")
        faults += _attempt(f"figures of {study.name}", figures, console)
        faults += _attempt(f"report of {study.name}", partial(_report, results, request, console), console)
    return faults


def _attempt(what: str, work: Callable[[], None], console: Console) -> list[str]:
    """Do something; its name if it fails, which is told and is no reason not to go on."""
    try:
        work()
    except VprbenchError as error:
        console.print(Text(f"{what}: {error}", "red"), soft_wrap=True)
        return [what]
    return []


def _judge(present: Sequence[tuple[SweepStudy, Path]], request: Reproduction, console: Console) -> None:
    """Write OUT/claims.csv, and the same beside the results that decide claims, for their reports."""
    table = evaluate(request.out, request.data)
    text = table.to_csv(index=False, lineterminator="\n")
    beside = [results.with_suffix(".claims.csv") for study, results in present if study.claims]
    for path in (request.out / "claims.csv", *beside):
        _write(path, text)
    console.print(f"{request.out / 'claims.csv'}: {counted(table)}", markup=False, highlight=False, soft_wrap=True)


def _report(results: Path, request: Reproduction, console: Console) -> None:
    """Write the report of a sweep, unless it is younger than all that it shows."""
    from vprbench.report.gathering import read_material
    from vprbench.report.writing import write_report

    folder = results.with_suffix(".report")
    page = folder / "report.html"
    shown = [path for path in (results, results.with_suffix(".claims.csv")) if path.exists()]
    if not page.exists() or max(path.stat().st_mtime for path in shown) > page.stat().st_mtime:
        with console.status(f"report of {results.stem}"):
            write_report(read_material(results, request.data), folder)
    console.print(str(page), markup=False, highlight=False, soft_wrap=True)


def _write(path: Path, text: str) -> None:
    """Write a file, but for one that says the same already: it is not made younger."""
    if not path.exists() or path.read_text("utf-8") != text:
        with replacing(path) as temporary:
            temporary.write_text(text, "utf-8")


def _sweeps(studies: Sequence[Study]) -> list[SweepStudy]:
    return [study for study in studies if isinstance(study, SweepStudy)]


def _listed(studies: Sequence[Study]) -> Table:
    """Every study."""
    table = Table(box=None, pad_edge=False)
    for column in ("study", "kind", "paper", "shows"):
        table.add_column(column)
    for study in studies:
        table.add_row(*(Text(text) for text in (study.name, study.kind, study.paper or "-", study.title)))
    return table


def _summarise(ended: Sequence[tuple[Study, Ended]], console: Console) -> None:
    """How each study ended, a line each; then what is missing of the routes that were left out, each once."""
    console.rule(Text("what came of it"), align="left")
    lacking = dict[str, str]()
    for study, end in ended:
        lacking |= end.lacking
        without = f"without {', '.join(end.lacking)}" if end.lacking else ""
        said = "; ".join(filter(None, (end.note, without)))
        line = Text.assemble(f"{study.name}: ", (end.state, _STYLES.get(end.state, "")), f" ({said})" if said else "")
        console.print(line, soft_wrap=True, highlight=False)
    for route, reason in lacking.items():
        console.print(Text(f"{route} needs {reason}"), soft_wrap=True, highlight=False)
