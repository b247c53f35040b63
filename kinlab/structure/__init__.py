"""What kind of arm it is: its tasks, its joints' ranges, and the geometry of its axes.

==============  ===============================================================================
module          what it holds
==============  ===============================================================================
``tasks``       names and masks of task coordinates; which of them an arm can have
``task_space``  the task's rows of one arm's J in one length unit; the box that searches draw from
``axes``        joint axes as screws: parallel, meeting, wrist and shoulder centre, structure
==============  ===============================================================================
"""
