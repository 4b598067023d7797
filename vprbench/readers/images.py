"""Image files as frames: read when asked for, proven whole, grey, 642 x 188."""

from __future__ import annotations

import hashlib
import zlib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import Float64, UInt8

from vprbench.errors import DataError
from vprbench.readers.bayer import Bayer, demosaiced
from vprbench.readers.crop import Crop
from vprbench.readers.read_ahead import ReadAhead
from vprbench.route import Camera
from vprbench.types import FRAME_HEIGHT, FRAME_WIDTH, Frame

__all__ = ["ImageFiles", "content_hash", "image_files", "image_size", "optics", "read_grey", "scaled_camera"]

_SUFFIXES = {".png", ".jpg", ".jpeg"}
_PNG = b"\x89PNG\r\n\x1a\n"
_JPEG, _JPEG_END = b"\xff\xd8\xff", b"\xff\xd9"

# No focal length is so many times the width, or the width so many times it. Our choice.
_LENS = 1000


@dataclass(frozen=True)
class ImageFiles:
    """Frames that lie as one image file each; a FrameSource.

    Attributes:
        paths: the file of frame 0, 1, ...
        size: width and height that every file must have, pixels; None where they may differ.
        crop: the band of the images that becomes the frame; None for all of them, squeezed.
        bayer: the colour filter of a raw sensor image.
        colour: whether colour is taken, and converted; a grey camera's files hold none.
    """

    paths: tuple[Path, ...]
    size: tuple[int, int] | None
    crop: Crop | None = None
    bayer: Bayer | None = None
    colour: bool = True

    def __getitem__(self, index: int, /) -> Frame:
        """Frame `index`, reduced by pixel area; DataError where its file is not a whole 8-bit image."""
        return self._ahead.get(range(len(self.paths))[index])

    @cached_property
    def _ahead(self) -> ReadAhead:
        return ReadAhead(self._read, len(self.paths))

    def _read(self, index: int) -> Frame:
        path = self.paths[index]
        image = read_grey(path, colour=self.colour)
        if self.size is not None and image.shape[::-1] != self.size:
            raise DataError(
                f"{path}: {_times(image.shape[::-1])} pixels where the drive's other frames have "
                f"{_times(self.size)}: one drive, one camera"
            )
        image = image if self.bayer is None else demosaiced(image, self.bayer)
        image = image if self.crop is None else self.crop.band(image, str(path))
        return cv2.resize(image, (FRAME_WIDTH, FRAME_HEIGHT), interpolation=cv2.INTER_AREA).astype(np.uint8)


def read_grey(path: Path, *, colour: bool = True) -> UInt8[np.ndarray, "height width"]:
    """The grey image in a PNG or JPEG file; damage and 16 bits are a DataError, colour is converted or one too."""
    data = _bytes(path)
    fault = _fault(data)
    if fault:
        raise DataError(f"{path}: {fault}; fetch the file again")
    try:
        image = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_ANYDEPTH | cv2.IMREAD_ANYCOLOR)
    except cv2.error:  # larger than OpenCV reads
        image = None
    if image is None:
        raise DataError(f"{path}: the image cannot be decoded; fetch the file again")
    if image.dtype != np.uint8:
        raise DataError(f"{path}: {8 * image.itemsize} bits a pixel where 8 are due; convert it to 8 bits")
    if image.ndim > 2 and not colour:
        raise DataError(f"{path}: colour, where the camera is grey; put the grey image there or name the colour camera")
    grey = image if image.ndim == 2 else cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
    return np.asarray(grey, np.uint8)


def image_files(folder: Path) -> list[Path]:
    """The PNG and JPEG files of a folder by name; DataError where it cannot be read or has none."""
    try:
        found = sorted(path for path in folder.iterdir() if path.suffix.lower() in _SUFFIXES)
    except OSError as error:
        raise DataError(f"{folder}: cannot be read ({error.strerror})") from error
    if not found:
        raise DataError(f"{folder}: no PNG or JPEG image in it")
    return found


def image_size(path: Path) -> tuple[int, int]:
    """Width and height of an image file, pixels."""
    height, width = read_grey(path).shape
    return width, height


def scaled_camera(fx: float, cx: float, width: int, image: str) -> Camera:
    """The camera of the reduced frames, given its focal length and principal column at full width, pixels.

    DataError, naming `image`, where the principal column lies outside or no lens has such a focal length: they belong
    to another image size.
    """
    if not 0 < cx < width:
        raise DataError(f"{image}: {width} pixels wide, but cx is {cx:g}: not the calibration of these images")
    if not width / _LENS < fx < width * _LENS:
        raise DataError(f"{image}: {width} pixels wide, but fx is {fx:g}: not the calibration of these images")
    scale = FRAME_WIDTH / width
    return Camera(float(fx * scale), float(cx * scale))


def optics(camera: Camera, crop: Crop | None) -> tuple[Float64[np.ndarray, " n"], ...]:
    """The numbers of a camera and a crop, for the checksum of a drive: without a crop those of the camera alone."""
    seen_by = np.array([camera.fx, camera.cx])
    if crop is None:
        return (seen_by,)
    return seen_by, np.array([np.nan if edge is None else edge for edge in (crop.top, crop.rows)], np.float64)


def content_hash(paths: tuple[Path, ...], *arrays: Float64[np.ndarray, "..."]) -> str:
    """Sha256 of a drive: the bytes of its frame files in order, then its motion and camera."""
    digest = hashlib.sha256()
    for part in (*map(_bytes, paths), *(array.tobytes() for array in arrays)):
        digest.update(hashlib.sha256(part).digest())
    return digest.hexdigest()


def _bytes(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise DataError(f"{path}: cannot be read ({error.strerror})") from error


# OpenCV decodes a damaged file to a partly grey image with no more than a line on stderr.
def _fault(data: bytes) -> str | None:
    if not data:
        return "the file is empty"
    if data.startswith(_PNG):
        return _png_fault(data)
    if data.startswith(_JPEG):
        return None if _JPEG_END in data[-64:] else "the JPEG is cut off"
    return "neither PNG nor JPEG"


def _png_fault(data: bytes) -> str | None:
    start = len(_PNG)
    while start + 12 <= len(data):
        end = start + 12 + int.from_bytes(data[start : start + 4], "big")
        if end > len(data):
            break
        if zlib.crc32(memoryview(data)[start + 4 : end - 4]) != int.from_bytes(data[end - 4 : end], "big"):
            return f"the PNG is damaged at byte {start}"
        if data[start + 4 : start + 8] == b"IEND":
            return None
        start = end
    return "the PNG is cut off"


def _times(size: tuple[int, ...]) -> str:
    return "x".join(map(str, size))
