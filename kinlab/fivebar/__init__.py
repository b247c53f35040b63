"""The five-bar linkage: closed form, Pinocchio closed chain, singularities, servo sizing."""

from kinlab.fivebar.model import FiveBar

__all__ = ["FiveBar"]
