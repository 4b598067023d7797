"""HSD, Hierarchical Sparse Dictionaries: two learned sparse layers, S1 and S2, each ordered on a map and pooled.

frame -> halved, whitened -> the disk around each focus point -> S1 -> C1 -> S2 -> C2, the signature (the paper's
figure "Diagram of HSD operation"). HSD-n has n x n atoms on an n x n map, HSD-n/m has n x n atoms on an m x m map.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import KW_ONLY, dataclass, field, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from jaxtyping import Float32, Int64

from vprbench.errors import ConfigError, DataError, PhaseError
from vprbench.types import FRAME_HEIGHT, Frame, Landmarks, LearningStep
from vprbench_encoders import hierarchy, hsd_store
from vprbench_encoders.code_match import Similarity, match_all, match_pairs
from vprbench_encoders.focus import FocusDetector
from vprbench_encoders.hierarchy import Hierarchy
from vprbench_encoders.homeostasis import Kind
from vprbench_encoders.hsd_store import Learned
from vprbench_encoders.layers import LayerRecipe, LayerReport, TopologicalLayer
from vprbench_encoders.local_views import LocalViews, ViewSampling
from vprbench_encoders.patches import LocalView
from vprbench_encoders.som import KohonenMap
from vprbench_encoders.sparse_hebbian import Rule, SparseHebbian
from vprbench_encoders.stepwise import named
from vprbench_encoders.whitening import CUTOFF

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["HSD"]


@dataclass(eq=False, repr=False)
class HSD:
    """The learned signature: which units of S2's map the view around a focus point excites, pooled.

    Attributes:
        size: rows and columns of atoms in each dictionary, n; the paper has 12 to 30.
        map_size: rows and columns of each map; None: as many as of atoms. The paper's HSD-15/30 has 30 for 15.
        seed: of everything that is drawn: jitter, batches, and what the dictionaries and maps start from.
        points, radius, margin, alpha, sigmas, floor: of the focus points; see `FocusDetector`.
        focus_reduction: they are sought at 1/focus_reduction of the frame's resolution (1: all of it).
        window: width of a local view, px of the frame, even (the paper's 54).
        whitening: whether the halved frame is whitened (the paper does); cutoff: f0, cycles/px (public code).
        jitter: training views are moved by up to so many px of the frame (our choice) ...
        copies: ... so that each point gives so many, the first unmoved (our choice).
        training_frames: at most so many frames, evenly spaced, are learned from (our choice); bounds the memory.
        held_out: share of those, the last, that only the reports see (our choice).
        picks: N0 of S1 and of S2 (the paper's).
        homeostasis, homeostasis_rate, bins, rule, rate, batch, steps, passes, tolerance, rectified: see
            `SparseHebbian`. The paper's rule in full is rule="plain", rate=0.02, batch=256, steps=4000, passes=40.
        topology: whether the atoms are ordered on a map (the paper does).
        epochs, neighbourhood, final_neighbourhood: of that map; see `KohonenMap`.
        pool: width of the pooling windows (the paper's 2); 1: no pooling.
        centred: whether C1 loses its training mean before S2 (our choice: else one common direction takes every atom).
        equalised: whether homeostasis goes on in use, followed anew on the map's units (our choice: it does not).
        signature: "c2" (the paper's), or "c1" for the first layer alone.
        similarity: of signatures: "overlap", 1 - L1(a, b) / (L1(a) + L1(b)) (our choice), or "cosine".
        layers: what `fit` learned, S1 first.
        reports: of each layer.

    Raises:
        ConfigError: an option is out of its range.
    """

    size: int = 15
    map_size: int | None = None
    _: KW_ONLY
    seed: int = 0
    points: int = 25
    radius: float = 20.0
    margin: int = 27
    alpha: float = 1.0
    sigmas: tuple[float, float] = (2.0, 4.0)
    floor: float = 1e-3
    focus_reduction: int = 1
    window: int = 54
    whitening: bool = True
    cutoff: float = CUTOFF
    jitter: int = 6
    copies: int = 5
    training_frames: int = 1000
    held_out: float = 0.1
    picks: tuple[int, int] = (10, 5)
    homeostasis: Kind = "heh"
    homeostasis_rate: float = 0.01
    bins: int = 128
    rule: Rule = "scaled"
    rate: float = 0.4
    batch: int = 1024
    steps: int = 200
    passes: int = 20
    tolerance: float = 0.0
    rectified: bool = True
    topology: bool = True
    epochs: int = 60
    neighbourhood: float = 4.0
    final_neighbourhood: float = 0.5
    pool: int = 2
    centred: bool = True
    equalised: bool = False
    signature: Literal["c1", "c2"] = "c2"
    similarity: Similarity = "overlap"
    layers: tuple[TopologicalLayer, ...] = field(default=(), init=False)
    reports: tuple[LayerReport, ...] = field(default=(), init=False)

    def __post_init__(self) -> None:
        """Make the parts, refusing options with which they could not work."""
        self._check()
        focus = FocusDetector(
            alpha=self.alpha,
            sigmas=self.sigmas,
            points=self.points,
            radius=self.radius,
            margin=self.margin,
            floor=self.floor,
        )
        self._views = LocalViews(
            focus, LocalView(self.window), self.cutoff if self.whitening else None, self.focus_reduction
        )
        self._sampling = ViewSampling(
            frames=self.training_frames, held_out=self.held_out, jitter=self.jitter, copies=self.copies
        )
        self._recipes = [self._recipe(layer) for layer in range(2 if self.signature == "c2" else 1)]

    def fit(self, frames: Sequence[Frame]) -> None:
        """Learn both dictionaries from the local views of these frames; each frame is read once.

        Raises:
            DataError: the frames have no focus points.
        """
        for _ in self.learning(frames):
            pass

    def learning(self, frames: Sequence[Frame]) -> Iterator[LearningStep]:
        """What `fit` does, step by step; what was learned before stays until it is done.

        The stages are "local views", then "S1 dictionary", "S1 map", "C1", "S2 dictionary" and "S2 map".

        Raises:
            DataError: the frames have no focus points.
        """
        random = np.random.default_rng(self.seed)
        views = yield from named("local views", self._sampling.drawing(self._views, frames, random))
        self.layers, self.reports = yield from hierarchy.learning(self._recipes, views, random)

    def measures(self) -> dict[str, float]:
        """What was learned, in numbers; see `hierarchy.measures`.

        Raises:
            PhaseError: nothing has been learned yet.
        """
        self._must_have_learned()
        return hierarchy.measures(Hierarchy(self.layers, self.reports))

    def encode(self, frame: Frame) -> Landmarks:
        """The signatures of the frame's focus points.

        Raises:
            PhaseError: nothing has been learned yet.
        """
        self._must_have_learned()
        points = self._views.points(frame)
        signatures = self._views.cut(frame, points)
        for layer in self.layers:
            signatures = layer.pooled(signatures)
        return Landmarks(signatures, points)

    def match(
        self, queries: Float32[np.ndarray, "points size"], memory: Float32[np.ndarray, "units size"]
    ) -> Float32[np.ndarray, "points units"]:
        """How alike every query is to every stored signature, 0..1."""
        return match_all(queries, memory, self.similarity)

    def match_pairs(
        self,
        queries: Float32[np.ndarray, "points size"],
        memory: Float32[np.ndarray, "units size"],
        query_index: Int64[np.ndarray, " pairs"],
        memory_index: Int64[np.ndarray, " pairs"],
    ) -> Float32[np.ndarray, " pairs"]:
        """The same as `match`, for chosen pairs only."""
        return match_pairs(queries, memory, query_index, memory_index, self.similarity)

    @property
    def matches_by_overlap(self) -> bool:
        """Whether a localizer may match signatures itself: they are sparse, and only what two of them share counts."""
        return self.similarity == "overlap"

    def figures(self) -> dict[str, Figure]:
        """Drawings, by file stem: the units of S1, what those of S2 look for, and how often each is used.

        Raises:
            PhaseError: nothing has been learned yet.
            ConfigError: matplotlib is not installed.
        """
        self._must_have_learned()
        from vprbench_encoders.hsd_figures import DrawnHSD

        return DrawnHSD(self.layers, self.reports, self._views.view, self.pool, self.topology).figures()

    def save(self, path: Path | str) -> None:
        """Write the options, the dictionaries and their reports to one .npz file, whole or not at all.

        Raises:
            PhaseError: nothing has been learned yet.
        """
        self._must_have_learned()
        options = {option.name: getattr(self, option.name) for option in fields(self) if option.init}
        learned = tuple(Learned(layer.units, layer.mean, *layer.selection) for layer in self.layers)
        hsd_store.write(Path(path), hsd_store.Stored(options, learned, self.reports))

    @classmethod
    def load(cls, path: Path | str) -> HSD:
        """The encoder that `save` wrote: it encodes bit by bit as that one did.

        Raises:
            DataError: the file is missing, damaged or none of ours.
        """
        stored = hsd_store.read(Path(path))
        # JSON has lists where the options are tuples.
        options: dict[str, Any] = {
            name: tuple(value) if isinstance(value, list) else value for name, value in stored.options.items()
        }
        try:
            encoder = cls(**options)
            encoder.layers = tuple(hierarchy.restored(encoder._recipes, stored.layers, encoder._views.view.size))
        except (ConfigError, TypeError, ValueError) as error:
            raise DataError(f"{path}: does not hold what its options say, or they are not this version's") from error
        encoder.reports = stored.reports
        return encoder

    def _must_have_learned(self) -> None:
        if not self.layers:
            raise PhaseError("hsd: there are no dictionaries yet: call fit(frames), or load saved ones")

    def _check(self) -> None:
        side = self.map_size or self.size
        for rule, kept in (
            (f"size must be at least 2, not {self.size}", self.size >= 2),
            (f"map_size must be at least 2, not {self.map_size}", self.map_size is None or self.map_size >= 2),
            (
                f"without topology the map has the atoms' size {self.size}, not {side}",
                self.topology or side == self.size,
            ),
            (
                f"window must be even, 4..{FRAME_HEIGHT}, not {self.window}",
                4 <= self.window <= FRAME_HEIGHT and self.window % 2 == 0,
            ),
            (f"focus_reduction must be 1..8, not {self.focus_reduction}", 1 <= self.focus_reduction <= 8),
            (f"cutoff must be above 0, not {self.cutoff}", self.cutoff > 0),
            (f"pool must be 1..{side}, not {self.pool}", 1 <= self.pool <= side),
            (f"picks must be below the {self.size**2} atoms, not {self.picks}", max(self.picks) < self.size**2),
        ):
            if not kept:
                raise ConfigError(f"hsd: {rule}")

    def _recipe(self, layer: int) -> LayerRecipe:
        """How S1 (0) or S2 (1) is learned; a local view has no mean left to centre."""
        learning = SparseHebbian(
            picks=self.picks[layer],
            homeostasis=self.homeostasis,
            homeostasis_rate=self.homeostasis_rate,
            bins=self.bins,
            rule=self.rule,
            rate=self.rate,
            batch=self.batch,
            steps=self.steps,
            passes=self.passes,
            tolerance=self.tolerance,
            rectified=self.rectified,
        )
        ordering = KohonenMap(
            epochs=self.epochs, neighbourhood=self.neighbourhood, final_neighbourhood=self.final_neighbourhood
        )
        return LayerRecipe(
            learning=learning,
            atoms=self.size**2,
            side=self.map_size or self.size,
            ordering=ordering if self.topology else None,
            pool=self.pool,
            centred=self.centred and layer == 1,
            equalised=self.equalised,
        )
