"""Single expressions of a program otherwise, by what they are.

================  =================================================================================
module            what it holds
================  =================================================================================
``calls``         Calls: another function, other arguments, loops from elsewhere
``comparisons``   Conditions
``constants``     Numbers in the text
``entries``       Entries of arrays and lists: another index, other rows, where a value is put
``names``         Names and attributes
``operators``     Sums, products and signs
``rows``          Rows: entries exchanged, moved on, with other signs
``whole``         Whole numbers in the text, and what is counted by them
================  =================================================================================
"""
