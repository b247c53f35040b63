"""The signs that formulas are typed with, made plain: LaTeX, products without a sign, remarks.

============  ====================================================================================
module        what it holds
============  ====================================================================================
``beside``    Factors side by side in plain text, as in a book: ``2 l1 c12``, ``m2(a + b)``
``brackets``  Where brackets are closed, and what stands outside of all of them
``degrees``   Angles in degrees, as angles in radians
``dressed``   LaTeX as it is dressed for a page: boxes, arrows, colours, old commands
``general``   What is explained for every joint at once: ``c_i = cos(q_i)``
``latex``     LaTeX of the textbooks as plain arithmetic text, which the whitelist parser then
              reads
``letters``   Letters and signs of Unicode as plain text or LaTeX
``macros``    Commands that a writer has made: ``\\newcommand{\\q}{\\theta}``
``named``     What books call entries of quantities that have a long name: x_2, y_{c2}, J_v
``packages``  What programs and packages print: ``\\pdv``, ``\\SI``, sympy's functions of time
``printed``   Exponents on the line above, rows of a matrix by lines alone, names in a scan
``refusals``  What is said of a formula that cannot be read, in the language of the reader
``remarks``   What stands beside a formula and says nothing of its value: tags, units, words, old
              fonts
============  ====================================================================================
"""
