"""What can be measured of speed: frequencies, their ratios and where two agents' cost is equal, from frequency.csv.

Each row of it is one agent with so many places in memory: agent, places, and the median over rounds of the time of a
query (query_ms) between its quartiles (query_ms_q1, query_ms_q3). The interval of a ratio is from the fast quartile of
one over the slow quartile of the other and back: wider than a 95 % interval of the medians over many rounds.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, NamedTuple

import pandas as pd

from vprbench.claims.reading import Evidence, Measurement, Reading, Untestable, canonical
from vprbench.errors import DataError
from vprbench.frequency.crossing import crossing

__all__ = ["Crossing", "Frequency", "FrequencyRatio"]

COLUMNS = ["places", "query_ms_q1", "query_ms", "query_ms_q3"]


class Frequency(Measurement):
    """How many queries a second an agent answers, with so many places in memory.

    Attributes:
        agent: canonical name.
        places: in memory.
    """

    kind: Literal["frequency"]
    agent: str
    places: int

    def read(self, evidence: Evidence, study: str, routes: Sequence[str]) -> Reading:
        """The median frequency between its quartiles."""
        time = _at(_curve(evidence, study, self.agent), self)
        return Reading(1000 / time.median, 1000 / time.slow, 1000 / time.fast, f"{study}.csv")


class FrequencyRatio(Measurement):
    """How many times as many queries a second an agent answers as another, with so many places in memory.

    Attributes:
        agent: canonical name.
        reference: canonical name.
        places: in memory.
    """

    kind: Literal["frequency-ratio"]
    agent: str
    reference: str
    places: int

    def read(self, evidence: Evidence, study: str, routes: Sequence[str]) -> Reading:
        """The ratio of the medians, between those of opposite quartiles."""
        one, other = (_at(_curve(evidence, study, name), self) for name in (self.agent, self.reference))
        remark = f"{1000 / one.median:.1f} Hz and {1000 / other.median:.1f} Hz"
        low, high = other.fast / one.slow, other.slow / one.fast
        return Reading(other.median / one.median, low, high, f"{study}.csv, {self.places} places", remark=remark)


class Crossing(Measurement):
    """With how many places in memory an agent becomes cheaper than another.

    Between the numbers of places that were measured, times are taken to grow linearly.

    Attributes:
        agent: canonical name of the one that is dearer with few places.
        reference: canonical name of the other.
    """

    kind: Literal["crossing"]
    agent: str
    reference: str

    def read(self, evidence: Evidence, study: str, routes: Sequence[str]) -> Reading:
        """The number of places, between those by opposite quartiles; 0 for cheaper always, infinity for never."""
        both = _curve(evidence, study, self.agent).merge(_curve(evidence, study, self.reference), on="places")
        if both.empty:
            raise Untestable(f"{study}.csv has no number of places that {self.agent} and {self.reference} share")
        ends = {"query_ms": "query_ms", "query_ms_q1": "query_ms_q3", "query_ms_q3": "query_ms_q1"}
        value, low, high = (
            crossing(both["places"].to_numpy(float), (both[f"{a}_x"] - both[f"{b}_y"]).to_numpy(float))
            for a, b in ends.items()
        )
        span = f"{both['places'].min()} to {both['places'].max()} places"
        return Reading(value, low, high, f"{study}.csv, {span}")


class _Time(NamedTuple):
    """Milliseconds a query: the quick quartile, the median and the slow quartile."""

    fast: float
    median: float
    slow: float


def _curve(evidence: Evidence, study: str, agent: str) -> pd.DataFrame:
    """An agent's times by number of places, in order."""
    path = evidence.folder / f"{study}.csv"
    if not path.exists():
        raise Untestable(f"no {path.name}")
    try:
        table = pd.read_csv(path)
        found = table[table["agent"].map(canonical) == agent][COLUMNS].astype(float).sort_values("places")
    except (OSError, ValueError, KeyError) as error:
        raise DataError(f"{path}: not readable as a table of frequencies: {error}") from error
    if found.empty:
        raise Untestable(f"{path.name} has no row of {agent}")
    if found["places"].duplicated().any():
        raise DataError(f"{path}: {agent} stands there twice with the same number of places")
    return found


def _at(curve: pd.DataFrame, asked: Frequency | FrequencyRatio) -> _Time:
    """The times with the number of places asked for."""
    rows = curve[curve["places"] == asked.places]
    if rows.empty:
        raise Untestable(f"not measured with {asked.places} places")
    return _Time(*rows.iloc[0][["query_ms_q1", "query_ms", "query_ms_q3"]])
