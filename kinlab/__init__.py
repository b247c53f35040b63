"""kinlab: DH tables become URDF, load into Pinocchio, and stand beside your formulas.

The public names stand in ``__init__.pyi``, with the module of each; each is imported when it is
first asked for, so that ``import kinlab`` costs next to nothing.
"""

import lazy_loader

from kinlab.host.version import __version__

__getattr__, _, _names = lazy_loader.attach_stub(__name__, __file__)
__all__ = [*_names, "__version__"]  # noqa: PLE0604  (read from the stub)


def __dir__() -> list[str]:
    return __all__
