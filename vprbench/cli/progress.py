"""Progress of a sweep on the terminal: the whole, and under it each job at work; plain lines where none watches."""

from __future__ import annotations

from collections.abc import Sequence
from types import TracebackType

from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from vprbench.pool import Progress as Step
from vprbench.runner import Outcome
from vprbench.sweep import Job

__all__ = ["SweepProgress"]

# Where each stage of a job begins and ends on its bar. Comparing frames takes the longest, so it is most of it.
STAGES = {"fit": (0.0, 0.05), "fitted": (0.05, 0.05), "describe frames": (0.05, 0.3), "compare frames": (0.3, 0.95)}

# A localizer that can only be played goes through these for each of its cells; where they begin.
CELL_STAGES = {"calibrate": 0.0, "play": 0.8}


class SweepProgress:
    """Bars for a sweep's jobs while it is entered."""

    def __init__(self, jobs: Sequence[Job], console: Console) -> None:
        self.jobs = jobs
        self.console = console
        self._bars = Progress(
            TextColumn("{task.description}", justify="left", markup=False),
            BarColumn(bar_width=28),
            TextColumn("{task.percentage:>3.0f} %"),
            TimeElapsedColumn(),
            TextColumn("left"),
            TimeRemainingColumn(),
            console=console,
            disable=not console.is_terminal,
            transient=True,
        )
        self._cells = sum(len(job.cells) for job in jobs)
        self._finished = 0
        self._told: set[str] = set()
        self._shown: dict[int, TaskID] = {}
        self._done = [0.0] * len(jobs)
        self._answered = [0] * len(jobs)
        self._whole = self._bars.add_task("sweep", total=len(jobs))

    def __enter__(self) -> SweepProgress:
        self._bars.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bars.stop()

    def step(self, step: Step) -> None:
        """Show how far a job is."""
        job = self.jobs[step.job]
        if step.job not in self._shown:
            self._shown[step.job] = self._bars.add_task(f"  {job}", total=1.0)
        if step.stage == "fitted":
            self._remark(job, step.note)
        said = f"  {job}: {step.stage}" + (f" {step.note}" if step.note else "")
        self._advance(step.job, _fraction(step, self._answered[step.job], len(job.cells)), said)

    def finish(self, outcome: Outcome) -> None:
        """Say that a cell is done, and how."""
        self._finished += 1
        number = next(n for n, job in enumerate(self.jobs) if outcome.cell in job.cells)
        self._answered[number] += 1
        if self._answered[number] == len(self.jobs[number].cells):
            self._advance(number, 1.0, f"  {self.jobs[number]}")
            if number in self._shown:
                self._bars.remove_task(self._shown.pop(number))
        self._bars.update(self._whole, description=f"sweep: {self._finished} of {self._cells} cells")
        self.console.print(f"{self._finished:>4}/{self._cells}  {self._line(outcome)}", highlight=False, soft_wrap=True)

    def _remark(self, job: Job, note: str) -> None:
        """A line that stays; what many jobs have to say alike is told once, of the first."""
        if note and note not in self._told:
            self._told.add(note)
            self.console.print(escape(f"           {job}: {note}"), highlight=False, soft_wrap=True)

    def _line(self, outcome: Outcome) -> str:
        """A finished cell in one line; an error that many cells share is told once."""
        row = outcome.row
        if row["status"] != "ok":
            error = "the same" if row["error"] in self._told else row["error"]
            self._told.add(row["error"])
            return f"[red]{escape(f'{outcome.cell.id}  failed: {error}')}[/red]"
        scores = f"AUC {row['auc']:.3f}, over all queries {row['auc_all']:.3f}, top-1 {row['accuracy']:.3f}"
        return f"{escape(outcome.cell.id)}  {row['places']} places, {scores}"

    def _advance(self, number: int, fraction: float, description: str) -> None:
        """Move a job's bar and the whole one; neither ever goes back."""
        self._done[number] = max(self._done[number], fraction)
        if number in self._shown:
            self._bars.update(self._shown[number], completed=self._done[number], description=description)
        self._bars.update(self._whole, completed=sum(self._done))


def _fraction(step: Step, answered: int, cells: int) -> float:
    """How much of its job a step stands for, 0..1, when so many of its cells are answered."""
    if step.stage in CELL_STAGES:
        begin = STAGES["fit"][1]
        return begin + (1 - begin) * (answered + CELL_STAGES[step.stage]) / cells
    begin, end = STAGES.get(step.stage, (0.0, 0.0))
    return begin + (end - begin) * step.done / max(step.total, 1)
