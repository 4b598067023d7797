"""What the entries of a user's own images share: where they lie, the camera, the crop, and that no drive shares one."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import combinations
from os.path import realpath  # Path.resolve raises where links run in a circle
from pathlib import Path
from typing import Annotated

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, ValidationInfo, model_validator

from vprbench.data_root import expanded
from vprbench.entries.base import Entry
from vprbench.errors import DataError
from vprbench.readers.crop import Crop
from vprbench.readers.images import scaled_camera
from vprbench.route import Camera

__all__ = ["ImagesEntry", "OwnCamera", "OwnPath", "beside_the_file", "refuse_shared"]


def beside_the_file(path: Path, info: ValidationInfo) -> Path:
    """A path of an entry, relative to the catalogue file that states it."""
    return Path(info.context["folder"], expanded(path)) if info.context else path


def _crop(value: object) -> object:
    if isinstance(value, str) and value != "centre":
        raise ValueError(f'{value!r} is neither "centre" nor a table like {{ top = 120, rows = 300 }}')
    return {} if value == "centre" else value


OwnPath = Annotated[Path, AfterValidator(beside_the_file)]


class OwnCamera(BaseModel):
    """A user's camera: focal length and principal column, or the horizontal field of view.

    Attributes:
        fx: pixels of the original image.
        cx: pixels of the original image.
        field_of_view_deg: degrees, with the principal column in the middle.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    fx: Annotated[float, Field(gt=0)] | None = None
    cx: Annotated[float, Field(gt=0)] | None = None
    field_of_view_deg: Annotated[float, Field(gt=0, lt=180)] | None = None

    @model_validator(mode="after")
    def _one_way(self) -> OwnCamera:
        given = tuple(value is not None for value in (self.fx, self.cx, self.field_of_view_deg))
        if given not in {(True, True, False), (False, False, True)}:
            raise ValueError("a camera has either fx and cx or field_of_view_deg")
        return self

    def reduced(self, width: int) -> Camera:
        """The camera of the reduced frames, given the width of the original image, pixels."""
        if self.fx is not None and self.cx is not None:
            return scaled_camera(self.fx, self.cx, width, "the images")
        assert self.field_of_view_deg is not None
        return scaled_camera(width / 2 / math.tan(math.radians(self.field_of_view_deg) / 2), width / 2, width, "")


class ImagesEntry(Entry):
    """A route of a user's own images.

    Attributes:
        camera: of all drives.
        crop: the band of every image that becomes the frame; without it the whole image is squeezed.
    """

    camera: OwnCamera
    crop: Annotated[Crop | None, BeforeValidator(_crop)] = None


def refuse_shared(drives: Iterable[tuple[Path | str, Sequence[Path]]]) -> None:
    """Refuse drives, each a name and its images, of which two share an image, whatever name it goes by: DataError."""
    for (a, images), (b, others) in combinations(drives, 2):
        shared = sorted({realpath(image) for image in images} & {realpath(image) for image in others})
        if shared:
            more = f" and {len(shared) - 1} more" if len(shared) > 1 else ""
            raise DataError(f"{a} and {b} share the image {shared[0]}{more}; leave them out of one")
