"""What numba cannot tell LLVM of a kernel: that its arrays lie apart, and that vectors of 512 bits are worth having.

LLVM prefers vectors of 256 bits on Intel's processors with AVX-512. And where arrays could overlap, it loads the values
that a loop multiplies with before it checks, at run time, that none do; then it spreads each over a vector in one of
the two units that multiply. Where they cannot overlap, a value is spread as it is loaded.
"""

from __future__ import annotations

from collections.abc import Callable

from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.core.cpu import CPUContext
from numba.core.typing.templates import Signature
from numba.extending import intrinsic

__all__ = ["use_wide_vectors"]

Lowering = Callable[[CPUContext, ir.IRBuilder, Signature, list[ir.Value]], ir.Value]


# numba passes the context of types; that kernels pass nothing is what its default tells mypy.
@intrinsic
def use_wide_vectors(typing_context: object = None) -> tuple[Signature, Lowering]:
    """Compile the kernel that calls this for vectors of 512 bits; its float32 arrays must not overlap.

    Without AVX-512 it does nothing: with 16 registers of vectors, LLVM would have to put some of them by.
    """
    return types.none(), _mark


def _mark(context: CPUContext, builder: ir.IRBuilder, signature: Signature, arguments: list[ir.Value]) -> ir.Value:
    """Set LLVM's attributes that say so, on the kernel and its pointers to float32, as numba does in parallel loops."""
    if "+avx512f" in context.codegen().magic_tuple()[-1]:  # type: ignore[no-untyped-call]
        # The set's own `add` knows no attribute that has a value.
        set.add(builder.function.attributes, '"prefer-vector-width"="512"')
        for argument in builder.function.args:
            if getattr(argument.type, "pointee", None) == ir.FloatType():
                argument.add_attribute("noalias")
    return context.get_dummy_value()  # type: ignore[no-untyped-call]
