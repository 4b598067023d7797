"""The commands and their options; each imports what it runs only when it runs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from vprbench.cli.arguments import Data, Routes
from vprbench.cli.data import data
from vprbench.cli.results_commands import claims, compare, report, score, table

__all__ = [
    "app",
    "check",
    "claims",
    "compare",
    "fetch",
    "fit",
    "frequency",
    "list_",
    "report",
    "reproduce",
    "run",
    "scale",
    "score",
    "sweep",
    "table",
]

app = typer.Typer(
    name="vprbench",
    help="Benchmark visual place recognition: sweep agents over roads driven twice.",
    epilog="Start with: vprbench sweep streets",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.add_typer(data, name="data")

Cache = Annotated[
    Path | None,
    typer.Option(help="Folder that keeps fitted encoders, or none. Default: $VPRBENCH_CACHE, else the user's cache."),
]
Out = Annotated[Path, typer.Option(help="Folder of the result tables.")]
Timed = Annotated[list[str] | None, typer.Argument(help="lpmp, hsd-15-30, cohog, ...; or insides of TOML tables.")]


@app.command(epilog="Example: vprbench sweep k0-2 --data ~/kitti --jobs 2")
def sweep(
    name: Annotated[
        str, typer.Argument(help="A built-in sweep (see: vprbench list sweeps) or a .toml file.")
    ] = "streets",
    out: Out = Path("runs"),
    data: Data = None,
    routes: Routes = None,
    jobs: Annotated[int | None, typer.Option(min=1, help="Worker processes. Default: one a core.")] = None,
    filter: Annotated[str | None, typer.Option(help="Only cells whose id holds this; * and ? are wildcards.")] = None,
    timeout: Annotated[
        float | None, typer.Option(min=0.001, help="Seconds that one agent may take on one route.")
    ] = None,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Measure again what is already there.")] = False,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Only say which cells would run, and how long.")] = False,
    cache: Cache = None,
    present: Annotated[
        bool, typer.Option("--present", help="Leave out the routes whose data are not all here, and say which.")
    ] = False,
) -> None:
    """Measure every cell of a sweep (route x sampling distance x agent x seed) that is not yet in its table.

    Leaves OUT/NAME.toml (the question), OUT/NAME.csv and .parquet (the answer, one row a cell) and
    OUT/NAME.traces/ (every answer behind it). Stop it when you like: the next call goes on where it stopped.
    Exit code 1 if a cell failed.
    """
    from vprbench.cli.sweeping import Request, sweep_command

    request = Request(name, out, data, routes, jobs, filter, timeout, overwrite, dry_run, cache, present)
    raise typer.Exit(sweep_command(request))


@app.command(epilog='Example: vprbench run Street-Wide \'localizer="max-pi", encoder="log-polar"\' --distance 3')
def run(
    route: Annotated[str, typer.Argument(help="A route (see: vprbench list routes).")],
    agent: Annotated[str, typer.Argument(help="A localizer's name, or the inside of a TOML table.")],
    distance: Annotated[float, typer.Option(min=0.001, help="Mean metres between places.")] = 3.0,
    seed: Annotated[int, typer.Option(min=0, help="For agents that learn from random numbers.")] = 0,
    data: Data = None,
    routes: Routes = None,
    trace: Annotated[Path | None, typer.Option(help="Save every answer to this .parquet file.")] = None,
    video: Annotated[
        Path | None, typer.Option(help="Film the test drive into this .mp4 file (needs the video extra).")
    ] = None,
    cache: Cache = None,
) -> None:
    """Measure one agent on one route, and print its scores."""
    from vprbench.cli.single import Single, run_command

    run_command(Single(route, agent, distance, seed, data, routes, trace, video, cache))


@app.command(epilog="Example: vprbench fetch KITTI-K5-1 --data ~/kitti --dry-run")
def fetch(
    names: Annotated[
        list[str],
        typer.Argument(metavar="ROUTE", help="Routes, or sweeps whose routes are meant, for example paper."),
    ],
    data: Data = None,
    routes: Routes = None,
    accept_licence: Annotated[
        bool, typer.Option("--accept-licence", help="You accept the data's licence; without it, it is only shown.")
    ] = False,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Only say what is there, and how much there is to fetch.")
    ] = False,
    source: Annotated[
        list[str] | None,
        typer.Option(
            help="A zip in place of its publisher's: path or address, or NAME=path; or a folder of such zips, or a "
            "mirror's address that ends in /. May be given several times."
        ),
    ] = None,
) -> None:
    """Fetch the public data that routes need, and no more: single files out of KITTI's archives.

    Of each archive only the table of contents and those files are read. Files that are there already, whole and
    unchanged, are left alone. Stop it when you like: the next call goes on where it stopped.
    """
    from vprbench.cli.fetching import Fetching, fetch_command

    raise typer.Exit(fetch_command(Fetching(names, data, routes, accept_licence, dry_run, source or ())))


@app.command(epilog="Example: vprbench fit hsd-12 hsd-15-30 --route Street-Wide --seeds 0,1,2")
def fit(
    encoders: Annotated[list[str], typer.Argument(help="Encoders' names, or the insides of TOML tables: 'name=...'.")],
    route: Annotated[str, typer.Option(help="The route whose training drives they learn from.")],
    seeds: Annotated[str, typer.Option(help="Whole numbers, with commas between.")] = "0",
    out: Annotated[Path, typer.Option(help="Folder of what they learned.")] = Path("runs"),
    data: Data = None,
    routes: Routes = None,
    cache: Cache = None,
    refit: Annotated[bool, typer.Option("--refit", help="Learn, and time, again what was learned before.")] = False,
    figures: Annotated[
        bool, typer.Option("--figures", help="Draw what was learned (needs the figures extra).")
    ] = False,
) -> None:
    """Let encoders learn from the training drives of a route, and measure what they learned.

    Leaves OUT/ENCODER-sSEED.npz, OUT/fit.csv (the measures), OUT/fit-timings.json and, if asked for, OUT/figures/.
    A sweep that needs the same encoder then takes it as it is. Exit code 1 if one failed.
    """
    from vprbench.cli.fitting import Fitting, fit_command

    raise typer.Exit(fit_command(Fitting(encoders, route, seeds, out, data, routes, cache, refit, figures)))


@app.command(epilog="Example: vprbench frequency lpmp hsd-15-30 cohog --route Street-Wide --places 10,100")
def frequency(
    route: Annotated[str, typer.Option(help="The route whose frames are learned and asked for.")],
    agents: Timed = None,
    places: Annotated[str | None, typer.Option(help="Numbers of places. Default: the paper's, 1,5,10 to 1000.")] = None,
    rounds: Annotated[int | None, typer.Option(min=1, help="How often each is timed. Default: 15.")] = None,
    seed: Annotated[int, typer.Option(min=0, help="For agents that learn from random numbers.")] = 0,
    out: Annotated[Path, typer.Option(help="Folder of the table.")] = Path("runs"),
    data: Data = None,
    routes: Routes = None,
    cache: Cache = None,
    figures: Annotated[bool, typer.Option("--figures", help="Draw the curves (needs the figures extra).")] = False,
) -> None:
    """Time queries against the number of places learned, on one thread: the paper's figure of frequency.

    Leaves OUT/frequency.csv (medians and quartiles, encoding and the rest apart), OUT/frequency.json (the machine and
    the rules) and, if asked for, OUT/figures/. Stop it when you like: finished rounds count.
    """
    from vprbench.cli.timing import Timing, frequency_command

    request = Timing(agents or [], route, places, rounds, seed, out, data, routes, cache, figures)
    raise typer.Exit(frequency_command(request))


@app.command(epilog="Example: vprbench scale hsd-15-30 cohog --route Street-Wide --places 100,1000,10000")
def scale(
    route: Annotated[str, typer.Option(help="The route of whose landmarks and frames the map is made.")],
    agents: Timed = None,
    places: Annotated[str | None, typer.Option(help="Numbers of places. Default: 100,300,1000 to 100000.")] = None,
    queries: Annotated[int, typer.Option(min=1, help="At each number of places.")] = 15,
    gigabytes: Annotated[float, typer.Option(min=0, help="Stop an agent whose places would hold more.")] = 8.0,
    seconds: Annotated[float, typer.Option(min=0, help="Stop an agent whose query would take longer.")] = 5.0,
    seed: Annotated[int, typer.Option(min=0, help="Of the map, and for agents that learn from random numbers.")] = 0,
    out: Annotated[Path, typer.Option(help="Folder of the table.")] = Path("runs"),
    data: Data = None,
    routes: Routes = None,
    cache: Cache = None,
    figures: Annotated[bool, typer.Option("--figures", help="Draw the curves (needs the figures extra).")] = False,
) -> None:
    """Time queries and learning, and weigh places, on a map that grows to the size of a city: 500 km at 5 m.

    Leaves OUT/scale.csv, OUT/scale.json (the machine and the rules) and, if asked for, OUT/figures/. Stop it when you
    like: finished sizes count.
    """
    from vprbench.cli.scaling import Scaling, scale_command
    from vprbench.scale.growth import Limits

    limits = Limits(gigabytes, seconds)
    request = Scaling(agents or [], route, places, queries, limits, seed, out, data, routes, cache, figures)
    raise typer.Exit(scale_command(request))


app.command(epilog="Example: vprbench table runs/streets.csv --columns route --metric auc_all --format latex")(table)
app.command(epilog="Example: vprbench compare runs/streets.csv --metric auc_all --reference LPMP")(compare)
app.command(epilog="Example: vprbench claims runs --format markdown")(claims)
app.command(epilog="Example: vprbench report runs/streets.csv")(report)
app.command(epilog="Example: vprbench score runs/streets.csv")(score)


@app.command(epilog="Example: vprbench reproduce reconstruction auc-hsd --data ~/kitti")
def reproduce(
    studies: Annotated[list[str] | None, typer.Argument(help="Studies (see --list). Default: all.")] = None,
    out: Annotated[Path, typer.Option(help="Folder of everything that comes of it.")] = Path("runs/paper"),
    data: Data = None,
    jobs: Annotated[int | None, typer.Option(min=1, help="Worker processes of sweeps. Default: one a core.")] = None,
    cache: Cache = None,
    file: Annotated[Path | None, typer.Option(help="TOML file with studies of your own, in place of ours.")] = None,
    list: Annotated[bool, typer.Option("--list", help="Only list the studies.")] = False,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Only say what would be run, and what could not.")] = False,
) -> None:
    """Reproduce the paper's figures and tables on the data present, and judge its claims by what comes out.

    Measures what is not there yet; then writes OUT/claims.csv, OUT/figures/ and a report of each sweep, and says in a
    line for each study what could not be run and why. Exit code 1 if something failed.
    """
    from vprbench.cli.reproducing import reproduce_command
    from vprbench.cli.studying import Reproduction

    request = Reproduction(tuple(studies or ()), out, data, jobs, cache, file, list, dry_run)
    raise typer.Exit(reproduce_command(request))


@app.command(name="list", epilog="Example: vprbench list routes --data ~/kitti")
def list_(
    what: Annotated[
        str, typer.Argument(help="routes, encoders, localizers or sweeps; all of them by default.")
    ] = "all",
    data: Data = None,
    routes: Routes = None,
) -> None:
    """List routes (and which of their data are present), encoders, localizers and sweeps."""
    from vprbench.cli.listing import list_command

    list_command(what, data, routes)


@app.command(epilog="Example: vprbench check log-polar")
def check(
    name: Annotated[str, typer.Argument(help="An encoder or localizer (see: vprbench list).")],
    encoder: Annotated[str | None, typer.Option(help="Encoder to check a localizer with, where it needs one.")] = None,
) -> None:
    """Check that a plug-in keeps its protocol: one line a check.

    Exit code 1 where one fails.
    """
    from vprbench.cli.checking import check_command

    raise typer.Exit(check_command(name, encoder))
