"""A check written down: summary, one self-contained HTML page, or Markdown.

=================  ===============================================================================
module             what it holds
=================  ===============================================================================
``html``           A check as one self-contained HTML page: MathML, inline SVG, no network, no
                   script
``markdown``       A check as Markdown with LaTeX formulas
``markdown_text``  The door of the Markdown reports: every text from a file passes through here
``summary``        Rows put together by formula, and as plain data for machines
``words``          What the page and the Markdown report share: headings, words, small pictures of
                   errors
``write``          A check written down: one self-contained HTML page, or Markdown
=================  ===============================================================================
"""
