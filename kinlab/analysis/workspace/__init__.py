"""The workspace of a serial arm: boundary in the plane, sections in space.

============  ====================================================================================
module        what it holds
============  ====================================================================================
``boundary``  The boundary of a planar arm's workspace as circular arcs in closed form, limits
              included
``sections``  Sections of a spatial arm's workspace through the first joint's axis: edges, voids,
              and the curves inside across which the number of solutions changes
============  ====================================================================================
"""
