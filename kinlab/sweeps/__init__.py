"""One measure over very many states or designs: chunked, seeded, resumable, on any executor.

===============  =================================================================================
module           what it holds
===============  =================================================================================
``samples``      where the states come from: a seeded box or a given array, in fixed blocks
``measures``     measures by name
``parts``        what is finished: in memory, or a folder of ``.npz`` parts that can be resumed
``pools``        chunks on an executor: bounded in flight, repeated when a worker dies
``run``          :func:`sweep` and its :class:`SweepResult`
===============  =================================================================================

The block (4096 states) is the unit of randomness and of every call to the measure; a chunk is
the number of blocks handed over at once. Hence neither chunks nor workers can change a bit.
"""

from kinlab.sweeps.run import SweepResult, sweep

__all__ = ["SweepResult", "sweep"]
