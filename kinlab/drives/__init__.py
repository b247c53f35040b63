"""Motors, gears and cycles: what drives a mechanism, whatever the mechanism is.

===========  =====================================================================================
module       what it holds
===========  =====================================================================================
``cycles``   The pick-and-place cycle: up, across, down, and back, with blended corners
``demand``   What a motion asks of the drives over time, at the joints and at the motors' shafts
``fitting``  One motor against what its duty asks, and the gear ratio that suits it
``motors``   Servomotors as data: the catalogue in ``robots/fivebar/motors.toml`` and files of
             one's own
===========  =====================================================================================
"""
