"""The surrogate of the gel as kernels of Warp, for simulators that capture their steps in graphs:
the formulas of `twintac.arrays`, without gradients.
"""

from .gels import WarpGels

__all__ = ["WarpGels"]
