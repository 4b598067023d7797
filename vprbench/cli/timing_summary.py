"""Frequencies on the terminal, and what must be said of how they were taken."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

import pandas as pd
from rich import box
from rich.console import Group
from rich.table import Table
from rich.text import Text

from vprbench.frequency.crossing import cheaper_from
from vprbench.frequency.question import Question

__all__ = ["frequency_to_terminal", "remarks"]

# CPU time over time by the clock: above, more than one thread was at work; below, others had the processor.
_THREADS, _BUSY = 1.1, 0.8

# Encoding and the rest, each timed by itself, together differ by more than this share from whole queries.
_GAP = 0.15


def frequency_to_terminal(table: pd.DataFrame, question: Question) -> Group:
    """Queries a second, one line for each number of places and one column an agent; below, where lines cross."""
    agents = list(dict.fromkeys(table["agent"]))
    drawn = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    drawn.add_column("places", justify="right")
    for agent in agents:
        drawn.add_column(Text(agent), justify="right", no_wrap=True)
    for places, rows in table.groupby("places"):
        found = rows.set_index("agent")["hz"]
        drawn.add_row(str(places), *(f"{found[agent]:.4g}" if agent in found else "-" for agent in agents))
    drawn.add_section()
    encode = table.groupby("agent")["encode_ms"].median()
    drawn.add_row("encode, ms", *(f"{encode[agent]:.2f}" for agent in agents))
    head = Text(f"{table['route'].iloc[0]}: queries a second, median of {table['rounds'].iloc[0]} rounds", "bold")
    return Group(head, drawn, *(Text(line) for line in _crossings(table, agents, question.reference)))


def _crossings(table: pd.DataFrame, agents: list[str], reference: str) -> Iterator[str]:
    """From how many places on each agent is cheaper than the reference."""
    for agent in agents if reference in agents else ():
        if agent == reference:
            continue
        start, most = cheaper_from(table, agent, reference), table["places"].max()
        said = "at any number of places" if start == 0 else f"from {start:.0f} places on"
        yield f"{agent} is cheaper than {reference} " + (f"nowhere up to {most} places" if start == inf else said)


def remarks(table: pd.DataFrame) -> Iterator[str]:
    """What a reader must know of the times, in lines; none where nothing is out of the ordinary."""
    shares = table.groupby("agent", sort=False)["cpu_per_wall"].median()
    for agent, share in shares[shares > _THREADS].items():
        yield f"{agent} works on more than one thread (CPU time {share:.1f} of the clock's): its times do not compare"
    if (shares < _BUSY).any():
        yield "the machine was busy with other things: compare agents, do not take the times for what it can do"
    apart = table[(table["parts_per_query"] - 1).abs() > _GAP]
    if len(apart):
        listed = ", ".join(f"{row.agent} {row.places}" for row in apart.itertuples())
        yield f"encode and respond do not add up to the query's time within {100 * _GAP:.0f} %: {listed}"
    again = table[table["filled_from"].str.contains("again")]["places"]
    if len(again):
        yield f"from {again.min()} places on, frames stand for several places (column filled_from)"
