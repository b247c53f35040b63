# The public figures and where they live; read by type checkers and, at run time, by lazy_loader.

from .arms import ellipses as ellipses
from .canvas import save as save
from .counts import solutions as solutions
from .curves import singular_loci as singular_loci
from .curves import singular_values as singular_values
from .designs import fivebar_design as fivebar_design
from .designs import fivebar_front as fivebar_front
from .drives import torque_speed as torque_speed
from .maps import workspace as workspace
from .maps import workspace_cloud as workspace_cloud
from .maps import workspace_map as workspace_map
from .mechanisms import fivebar as fivebar
from .mechanisms import fivebar_cycle as fivebar_cycle
from .mechanisms import fivebar_gains as fivebar_gains
from .searches import ik_history as ik_history
