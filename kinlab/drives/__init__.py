"""Motors, gears and cycles: what drives a mechanism.

==========  ======================================================================================
module      what it holds
==========  ======================================================================================
``motors``  Servomotors as data: the catalogue in ``robots/fivebar/motors.toml`` and files of
            one's own
==========  ======================================================================================
"""
