"""Motors, gears and cycles: what drives a mechanism, whatever the mechanism is.

=============  =====================================================================================
module         what it holds
=============  =====================================================================================
``arm``        Drives of a serial arm: what a motion asks of each joint, and the motors and gears
               that do it
``cycles``     The pick-and-place cycle: up, across, down, and back, with blended corners
``demand``     What a motion asks of the drives over time, at the joints and at the motors' shafts
``fitting``    Motors and gears against what a duty asks: pairs that can be bought, or the ratio
               that suits
``gears``      Gearboxes as data, and a drive: one motor behind one gearbox
``laws``       Time laws along a way of length 1: trapezoid of the velocity, and the polynomial of
               degree five
``motors``     Servomotors as data: the catalogue in ``robots/fivebar/motors.toml`` and files of
               one's own
``records``    Catalogues of one's own: TOML or CSV files of motors and gearboxes, read with every
               row named
``waypoints``  Cycles of one's own: way points with dwell, blend, speed and payload, from TOML or
               CSV
=============  =====================================================================================
"""
