from __future__ import annotations

from functools import cache
from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vprbench.errors import DataError
from vprbench.readers.images import ImageFiles, content_hash, image_size, read_grey, scaled_camera


def encoded(suffix: str, image: np.ndarray) -> bytes:
    return cv2.imencode(suffix, image)[1].tobytes()


@cache
def noise(height: int = 12, width: int = 20) -> np.ndarray:
    return np.random.default_rng(0).integers(0, 256, (height, width), np.uint8)


@pytest.fixture(scope="module")
def image_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("images") / "000007.png"


def test_a_frame_is_the_mean_of_the_pixels_it_covers(image_file: Path) -> None:
    full = noise(376, 1284)
    image_file.write_bytes(encoded(".png", full))
    frame = ImageFiles((image_file,), (1284, 376))[0]
    means = full.reshape(188, 2, 642, 2).astype(float).mean(axis=(1, 3))
    assert frame.shape == (188, 642)
    assert frame.dtype == np.uint8
    assert np.abs(frame - means).max() <= 0.5


def test_a_frame_is_a_fresh_array_at_every_call(image_file: Path) -> None:
    image_file.write_bytes(encoded(".png", noise(188, 642)))
    files = ImageFiles((image_file,), (642, 188))
    files[0][:] = 0
    assert files[0].any()


def test_colour_becomes_luma(image_file: Path) -> None:
    bgr = np.zeros((2, 2, 3), np.uint8)
    bgr[0, 0], bgr[0, 1], bgr[1, 0] = (255, 0, 0), (0, 255, 0), (0, 0, 255)
    image_file.write_bytes(encoded(".png", bgr))
    assert read_grey(image_file).tolist() == [[29, 150], [76, 0]]  # 255 times ITU-R 601's 0.114, 0.587, 0.299


@pytest.mark.parametrize("suffix", [".png", ".jpg"])
def test_size_is_width_by_height(image_file: Path, suffix: str) -> None:
    image_file.write_bytes(encoded(suffix, noise()))
    assert image_size(image_file) == (20, 12)


@given(st.data(), st.sampled_from([".png", ".jpg"]))
def test_no_part_of_a_file_passes_for_the_whole(image_file: Path, data: st.DataObject, suffix: str) -> None:
    whole = encoded(suffix, noise())
    image_file.write_bytes(whole[: data.draw(st.integers(0, len(whole) - 1))])
    with pytest.raises(DataError, match=r"000007\.png: .*(empty|cut off|neither PNG nor JPEG)"):
        read_grey(image_file)


@given(st.data())
def test_no_flipped_bit_of_a_png_goes_unseen(image_file: Path, data: st.DataObject) -> None:
    damaged = bytearray(encoded(".png", noise()))
    damaged[data.draw(st.integers(0, len(damaged) - 1))] ^= 1 << data.draw(st.integers(0, 7))
    image_file.write_bytes(bytes(damaged))
    with pytest.raises(DataError, match=r"000007\.png: "):
        read_grey(image_file)


def test_a_png_may_be_followed_by_padding(image_file: Path) -> None:
    image_file.write_bytes(encoded(".png", noise()) + bytes(100))
    assert np.array_equal(read_grey(image_file), noise())


def test_sixteen_bits_are_refused(image_file: Path) -> None:
    image_file.write_bytes(encoded(".png", noise().astype(np.uint16) * 256))
    with pytest.raises(DataError, match="16 bits a pixel where 8 are due"):
        read_grey(image_file)


def test_another_size_is_refused(image_file: Path) -> None:
    image_file.write_bytes(encoded(".png", noise()))
    with pytest.raises(DataError, match=r"000007\.png: 20x12 pixels where the drive's other frames have 1241x376"):
        ImageFiles((image_file,), (1241, 376))[0]


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"gone\.png: cannot be read \(No such file"):
        read_grey(tmp_path / "gone.png")


def test_the_camera_shrinks_with_the_frame() -> None:
    camera = scaled_camera(718.856, 607.1928, 1241, "a.png")
    assert camera.fx == pytest.approx(718.856 * 642 / 1241)
    assert camera.cx == pytest.approx(607.1928 * 642 / 1241)


def test_a_camera_of_other_images_is_refused() -> None:
    with pytest.raises(DataError, match=r"a\.png: 640 pixels wide, but cx is 960"):
        scaled_camera(700.0, 960.0, 640, "a.png")


def test_the_hash_depends_on_every_part(tmp_path: Path) -> None:
    files = (tmp_path / "a", tmp_path / "b")
    files[0].write_bytes(b"12")
    files[1].write_bytes(b"3")
    before = content_hash(files, np.zeros(2))
    assert before == content_hash(files, np.zeros(2))
    others = {content_hash(files[::-1], np.zeros(2)), content_hash(files, np.ones(2)), content_hash(files)}
    files[0].write_bytes(b"1")
    files[1].write_bytes(b"23")
    others.add(content_hash(files, np.zeros(2)))
    assert len(others) == 4
    assert before not in others
