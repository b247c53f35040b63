"""One measure over very many states or designs: chunked, seeded, resumable, on any executor.

=============  ===================================================================================
module         what it holds
=============  ===================================================================================
``measures``   Measures of a robot by name, and what any measure may answer
``parts``      What a sweep has finished: runs of blocks, in memory or as ``.npz`` parts in a
               folder
``pools``      Chunks of a sweep on an executor: few in flight, repeated when a worker dies
``run``        The sweep itself: plan the missing chunks, run them, keep them, hand out the
               answers
``samples``    Where the states of a sweep come from: a seeded box, or an array that is given
``workspace``  Where the tool can be and how well it moves there: samples of joint space, binned
               in space
=============  ===================================================================================

The block (4096 states) is the unit of randomness and of every call to the measure; a chunk is
the number of blocks handed over at once. Hence neither chunks nor workers can change a bit.
"""

from kinlab.sweeps.run import SweepResult, sweep

__all__ = ["SweepResult", "sweep"]
