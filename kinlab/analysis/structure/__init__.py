"""What kind of arm it is: its tasks, its joints' ranges, and the geometry of its axes.

==============  ==================================================================================
module          what it holds
==============  ==================================================================================
``axes``        Wrist, shoulder, elbow: what the geometry of the joint axes calls a singularity
``task_space``  The rows of J that a task asks for, in dimensionless form, and the box searches
                draw from
``tasks``       Task spaces: which of the six coordinates of the tool are asked for
==============  ==================================================================================
"""
