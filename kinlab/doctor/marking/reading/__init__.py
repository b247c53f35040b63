"""What is handed in, read: its encoding, its formulas, and which question each of them answers.

=============  ===================================================================================
module         what it holds
=============  ===================================================================================
``encodings``  In which encoding a submission is written: UTF-8, UTF-16, GB18030 or Windows-1252
``labels``     What stands in front of an answer: ``q1:``, ``1)``, ``**q1**:``, ``Aufgabe 1:``,
               ``第1题：``
``latex``      The pieces of a LaTeX file: its formulas, each under the label that stands before it
``measured``   An answer that is a number with its unit
``pieces``     Pieces of a submission: formulas, each with what names it, before they go to their
               questions
``questions``  Which formula answers which question: by a label, by the question's id, by its left
               side
``text``       The pieces of a text or Markdown: lines with a label in front, below a label, or with
               a name
=============  ===================================================================================
"""
