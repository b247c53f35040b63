"""Slips within single entries: an entry's derived formula beside somebody's text or function.

================  =================================================================================
module            what it holds
================  =================================================================================
``definitions``   Slips in what a writer's own names stand for, alone or with one more
``regression``    The difference of a function from the derived formula as a short sum of known
                  terms
``search``        Every slip at one place of a formula, and those that turn it into another by
                  their effect
``terms``         The derived formula beside a user's text or function
================  =================================================================================
"""
