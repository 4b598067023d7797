from __future__ import annotations

from itertools import pairwise
from zipfile import ZipInfo

from hypothesis import given
from hypothesis import strategies as st

from vprbench.fetch.ranges import stretches


def member(start: int, size: int) -> ZipInfo:
    """A member that lies at a place, with so many bytes of content."""
    info = ZipInfo(f"{start:06d}.png")
    info.header_offset, info.compress_size = start, size
    return info


@given(st.lists(st.integers(1, 5000), min_size=1, max_size=30), st.data(), st.integers(0, 9000), st.integers(1, 20_000))
def test_stretches_hold_every_member_once(sizes: list[int], data: st.DataObject, gap: int, longest: int) -> None:
    starts, place = list[int](), 0
    for size in sizes:
        starts.append(place)
        place += 30 + len("000000.png") + size
    members = [member(*each) for each in zip(starts, sizes, strict=True)]
    wanted = data.draw(st.lists(st.sampled_from(members), unique=True, min_size=1))
    found = stretches(wanted, place, gap, longest)
    assert [info for stretch in found for info in stretch.members] == sorted(
        wanted, key=lambda info: info.header_offset
    )
    for stretch in found:
        assert stretch.stop <= place
        assert len(stretch.members) == 1 or stretch.stop - stretch.start <= longest
        for info in stretch.members:
            assert stretch.start <= info.header_offset
            assert info.header_offset + 40 + info.compress_size <= stretch.stop
    for before, after in pairwise(found):
        together = min(after.members[0].header_offset + 40 + after.members[0].compress_size, place) - before.start
        assert after.start - before.stop > gap or together + 256 > longest


def test_four_hundred_frames_of_kitti_take_few_requests() -> None:
    # Frames of 250 kB that follow one another, as in the archive of grey images: 100 MB.
    members = [member(300 * i * 1000, 250_000) for i in range(400)]
    assert len(stretches(members, 1 << 40)) == 15
