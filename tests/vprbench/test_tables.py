"""Pivoted tables and their formats, worked by hand."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pandas as pd
import pytest
from rich.console import Console

from vprbench.errors import ConfigError, DataError
from vprbench.metrics import METRICS
from vprbench.tables import Entry, Table, make_table, to_csv, to_latex, to_markdown, to_terminal

NONE = float("nan")
ENVIRONMENTS = {"R1": "mixed", "R2": "narrow"}


def cell(route: str, distance: float, agent: str, auc: float, seed: int = 0, **more: Any) -> dict[str, Any]:  # noqa: ANN401
    """One finished cell, its interval a tenth to either side."""
    return {
        "cell": f"{route}/{distance:g}m/{agent}/s{seed}",
        "status": "ok",
        "agent": agent,
        "seed": seed,
        "route": route,
        "sampling_distance_m": distance,
        "environment": ENVIRONMENTS[route],
        "auc": auc,
        "auc_low": auc - 0.1,
        "auc_high": auc + 0.1,
        **more,
    }


def failed(route: str, distance: float, agent: str, seed: int = 0) -> dict[str, Any]:
    """A failed cell, which has no measurement at all."""
    row = cell(route, distance, agent, NONE, seed)
    return row | {"status": "failed", "environment": NONE, "auc_low": NONE, "auc_high": NONE}


ONE_ROUTE = pd.DataFrame(
    [cell("R1", 2, "A", 0.8), cell("R1", 5, "A", 0.6), cell("R1", 2, "B", 0.7), cell("R1", 5, "B", 0.9)]
)


def entry(table: Table, row: str, column: str) -> Entry:
    return table.entries[table.rows.index(row)][table.columns.index(column)]


def test_single_cells_keep_their_interval_and_the_mean_has_none() -> None:
    table = make_table(ONE_ROUTE)
    assert (table.rows, table.columns) == (("A", "B"), ("2 m", "5 m", "mean"))
    single = entry(table, "A", "2 m")
    assert (single.mean, single.low, single.high, single.cells) == pytest.approx((0.8, 0.7, 0.9, 1))
    assert np.isnan(single.sd)
    mean = entry(table, "A", "mean")
    assert (mean.mean, mean.sd, mean.cells) == pytest.approx((0.7, 0.02**0.5, 2))
    assert np.isnan(mean.low)
    assert not mean.partial


def test_the_best_agent_of_each_column_is_marked() -> None:
    table = make_table(ONE_ROUTE)
    assert [[e.best for e in line] for line in table.entries] == [[True, False, False], [False, True, True]]


def test_smaller_errors_are_better_and_plain_numbers_have_no_best() -> None:
    results = ONE_ROUTE.assign(error_mean_m=[1.0, 2.0, 3.0, 1.0], places=[10, 20, 30, 40])
    errors = make_table(results, metric="error_mean_m")
    assert [[e.best for e in line] for line in errors.entries] == [[True, False, True], [False, True, False]]
    places = make_table(results, metric="places")
    assert not any(e.best for line in places.entries for e in line)
    assert entry(places, "B", "mean").mean == 35.0


def test_scores_that_look_equal_are_best_together() -> None:
    results = pd.DataFrame([cell("R1", 2, "A", 0.80012), cell("R1", 2, "B", 0.80044), cell("R1", 2, "C", 0.7994)])
    assert [line[0].best for line in make_table(results).entries] == [True, True, False]


def test_a_lone_agent_is_not_called_best() -> None:
    table = make_table(pd.DataFrame([cell("R1", 2, "A", 0.8)]))
    assert table.columns == ("2 m",)
    assert not table.entries[0][0].best


def test_seeds_are_averaged_before_configurations() -> None:
    # Route R1 has three seeds with mean 0.5, R2 one: each route counts once.
    seeds = [cell("R1", 2, "A", auc, seed) for seed, auc in enumerate([0.4, 0.5, 0.6])]
    table = make_table(pd.DataFrame([*seeds, cell("R2", 2, "A", 0.9)]))
    got = entry(table, "A", "2 m")
    assert (got.mean, got.sd, got.cells) == pytest.approx((0.7, 0.08**0.5, 4))


def test_of_one_configuration_the_spread_is_over_its_seeds() -> None:
    seeds = [cell("R1", 2, "A", auc, seed) for seed, auc in enumerate([0.4, 0.5, 0.6])]
    got = entry(make_table(pd.DataFrame(seeds)), "A", "2 m")
    assert (got.mean, got.sd, got.cells) == pytest.approx((0.5, 0.1, 3))
    assert np.isnan(got.low)


def test_routes_and_environments_can_be_columns() -> None:
    results = pd.DataFrame([cell("R1", 2, "A", 0.5), cell("R1", 5, "A", 0.7), cell("R2", 2, "A", 0.8)])
    by_route = make_table(results, columns="route")
    assert by_route.columns == ("R1", "R2", "mean")
    assert entry(by_route, "A", "R1").mean == pytest.approx(0.6)
    assert entry(by_route, "A", "mean").mean == pytest.approx(0.7)
    by_environment = make_table(results, columns="environment")
    assert by_environment.columns == ("mixed", "narrow", "mean")
    assert repr(by_environment.entries) == repr(by_route.entries)


def test_agents_as_columns_are_the_same_table_turned() -> None:
    turned = make_table(ONE_ROUTE, rows="sampling_distance_m", columns="agent")
    assert repr(turned) == repr(make_table(ONE_ROUTE).transposed())
    assert turned.rows == ("2 m", "5 m", "mean")
    assert turned.axes == ("sampling_distance_m", "agent")


def test_distances_stand_in_order_and_agents_as_they_come() -> None:
    rows = [cell("R1", distance, agent, 0.5) for agent in ("Z", "A") for distance in (10, 2)]
    table = make_table(pd.DataFrame(rows))
    assert (table.rows, table.columns) == (("Z", "A"), ("2 m", "10 m", "mean"))


def test_a_failed_cell_is_told_and_never_best() -> None:
    results = pd.DataFrame(
        [
            *(cell("R1", 2, "A", 0.9), failed("R2", 2, "A")),
            *(cell("R1", 2, "B", 0.5), cell("R2", 2, "B", 0.3)),
            *(cell("R1", 2, "C", 0.2), cell("R2", 2, "C", 0.2)),
        ]
    )
    table = make_table(results)
    got = entry(table, "A", "2 m")
    assert (got.mean, got.cells, got.partial, got.best) == (0.9, 1, True, False)
    assert entry(table, "B", "2 m").best
    assert (table.cells, table.failed) == (6, ("R2/2m/A/s0",))
    # The failed cell has no environment of its own, but its route has one.
    assert entry(make_table(results, columns="environment"), "A", "narrow").cells == 0


def test_a_value_of_a_failed_cell_does_not_count() -> None:
    stale = cell("R2", 2, "A", 0.1) | {"status": "failed"}
    got = entry(make_table(pd.DataFrame([cell("R1", 2, "A", 0.9), stale])), "A", "2 m")
    assert (got.mean, got.cells, got.partial) == (0.9, 1, True)


def test_a_configuration_that_only_others_were_run_with_is_told() -> None:
    results = pd.DataFrame([cell("R1", 2, "A", 0.9), cell("R1", 2, "B", 0.5), cell("R2", 2, "B", 0.3)])
    table = make_table(results)
    assert entry(table, "A", "2 m").partial
    assert not entry(table, "B", "2 m").partial
    assert not entry(make_table(results, columns="route"), "A", "R1").partial
    by_route = make_table(results, columns="route")
    assert entry(by_route, "A", "R2").cells == 0
    assert entry(by_route, "A", "mean").partial


def test_an_undefined_score_is_not_averaged_away() -> None:
    results = pd.DataFrame([cell("R1", 2, "A", 0.9, roc_auc=NONE), cell("R2", 2, "A", 0.9, roc_auc=0.6)])
    got = entry(make_table(results, metric="roc_auc"), "A", "2 m")
    assert (got.mean, got.cells, got.partial) == (0.6, 1, True)


def test_a_sweep_that_failed_whole_is_a_table_of_nothing() -> None:
    results = pd.DataFrame([failed("R1", 2, "A"), failed("R1", 5, "A")]).drop(columns=["auc", "auc_low", "auc_high"])
    for table in (make_table(results), make_table(results, columns="environment")):
        assert all(e.cells == 0 and e.partial for line in table.entries for e in line)
        assert len(table.failed) == 2
        assert "2 cells, 2 failed" in to_markdown(table)


@pytest.mark.parametrize(
    ("request_", "message"),
    [
        ({"metric": "aux"}, r"no metric 'aux': did you mean 'auc'"),
        ({"metric": "auc_low"}, r"no metric 'auc_low'"),
        ({"metric": "agent"}, r"no metric 'agent'"),
        ({"rows": "agents"}, r"no axis 'agents': did you mean 'agent'"),
        ({"columns": "seed"}, r"no axis 'seed'"),
        ({"columns": "agent"}, r"both 'agent'"),
        ({"rows": "route"}, r"would average different agents"),
    ],
)
def test_senseless_requests_are_refused(request_: dict[str, str], message: str) -> None:
    with pytest.raises(ConfigError, match=message):
        make_table(ONE_ROUTE, **request_)


def test_results_that_are_not_one_row_a_cell_are_refused() -> None:
    with pytest.raises(DataError, match=r"no column 'status'"):
        make_table(ONE_ROUTE.drop(columns="status"))
    with pytest.raises(DataError, match=r"no rows"):
        make_table(ONE_ROUTE.iloc[:0])
    with pytest.raises(DataError, match=r"cell R1/2m/A/s0 stands twice"):
        make_table(pd.concat([ONE_ROUTE, ONE_ROUTE]))


def test_every_metric_can_be_tabled() -> None:
    results = ONE_ROUTE.assign(**dict.fromkeys(METRICS, 0.25))
    for metric in METRICS:
        assert entry(make_table(results, metric=metric), "A", "2 m").mean == 0.25


NAMES = pd.DataFrame(
    [
        cell("R1", 2, "[a_1|*x*]", 0.8),
        cell("R1", 5, "[a_1|*x*]", 0.6),
        cell("R1", 2, r"50% & \#", 0.7),
        failed("R1", 5, r"50% & \#"),
    ]
)


def test_markdown() -> None:
    assert to_markdown(make_table(NAMES)) == (
        "**PR-AUC, recall over the correct top-1s (place-field rule), in %, by sampling distance**\n"
        "\n"
        "| agent | 2 m | 5 m | mean |\n"
        "| --- | ---: | ---: | ---: |\n"
        "| \\[a\\_1\\|\\*x\\*\\] | **80.0** (70.0 to 90.0) | 60.0 (50.0 to 70.0) | 70.0 ± 14.1 |\n"
        "| 50% & \\\\# | 70.0 (60.0 to 80.0) | -† | 70.0† |\n"
        "\n"
        "4 cells, 1 failed: R1/5m/50% & \\\\#/s0; "
        "± standard deviation over routes and distances (of one: over seeds; of the mean: over its entries); "
        "(low to high) block-bootstrap interval of a single cell; bold: best agent; "
        "† some of its cells failed, were not run or have no value: not comparable.\n"
    )


def test_latex() -> None:
    lines = to_latex(make_table(NAMES)).splitlines()
    assert lines[2].startswith(
        r"\caption{PR-AUC, recall over the correct top-1s (place-field rule), in \%, by sampling distance. 4 cells,"
    )
    assert lines[3:] == [
        r"\begin{tabular}{lrrr}",
        r"\toprule",
        r"agent & 2 m & 5 m & mean \\",
        r"\midrule",
        r"{[}a\_1\textbar{}*x*] & \textbf{80.0} (70.0 to 90.0) & 60.0 (50.0 to 70.0) & 70.0 $\pm$ 14.1 \\",
        r"50\% \& \textbackslash{}\# & 70.0 (60.0 to 80.0) & -$^\dagger$ & 70.0$^\dagger$ \\",
        r"\bottomrule",
        r"\end{tabular}",
        r"\end{table}",
    ]


def test_csv_holds_the_exact_figures() -> None:
    table = make_table(ONE_ROUTE)
    read = pd.read_csv(io.StringIO(to_csv(table)))
    assert list(read.columns[:4]) == ["agent", "sampling_distance_m", "metric", "mean"]
    assert read["mean"].tolist() == [e.mean for line in table.entries for e in line]
    assert read.query("agent == 'B' and sampling_distance_m == 'mean'")["sd"].item() == entry(table, "B", "mean").sd


def test_terminal() -> None:
    console = Console(width=120, file=io.StringIO(), force_terminal=False)
    console.print(to_terminal(make_table(NAMES)))
    shown = console.file.getvalue()  # type: ignore[attr-defined]
    for text in ("[a_1|*x*]", "80.0", "(70.0 to 90.0)", "-†", "70.0 ± 14.1", "4 cells, 1 failed: R1/5m/50% & \\#/s0"):
        assert text in shown


def test_a_narrow_terminal_cuts_no_figure_and_no_sentence() -> None:
    table = make_table(ONE_ROUTE)
    console = Console(width=30, file=io.StringIO(), force_terminal=False)
    console.print(to_terminal(table), soft_wrap=True)
    lines = console.file.getvalue().splitlines()  # type: ignore[attr-defined]
    assert lines[0] == "PR-AUC, recall over the correct top-1s (place-field rule), in %, by sampling distance"
    assert sum("(70.0 to 90.0)" in line and "(50.0 to 70.0)" in line for line in lines) == 1
    assert "± standard deviation over routes and distances (of one: over seeds; of the mean: over its entries)" in lines
    console = Console(width=30, file=io.StringIO(), force_terminal=False)
    console.print(to_terminal(table, legend=False), soft_wrap=True)
    assert console.file.getvalue().splitlines() == lines[: lines.index("4 cells, 0 failed")]  # type: ignore[attr-defined]


def test_titles_name_metric_rule_and_unit() -> None:
    results = ONE_ROUTE.assign(auc_all_metric=0.5, error_median_m=1.234, vigilance=0.8765)
    titles = {
        "auc_all_metric": "**PR-AUC, recall over all queries (metric rule), in %, by sampling distance**",
        "error_median_m": "**median error, in m, by sampling distance**",
        "vigilance": "**vigilance, by sampling distance**",
    }
    for metric, title in titles.items():
        assert to_markdown(make_table(results, metric=metric)).startswith(title + "\n")
    assert "| 1.23 | 1.23 | 1.23 ± 0.00 |" in to_markdown(make_table(results, metric="error_median_m")).replace(
        "**", ""
    )
    assert "0.876" in to_markdown(make_table(results, metric="vigilance"))


def test_many_failed_cells_are_counted_not_all_listed() -> None:
    rows = [failed("R1", distance, "A") for distance in range(1, 9)]
    assert "8 cells, 8 failed: R1/1m/A/s0" in to_markdown(make_table(pd.DataFrame(rows)))
    assert "R1/6m" not in to_markdown(make_table(pd.DataFrame(rows)))
