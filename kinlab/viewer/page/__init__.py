"""The page itself, whatever moves on it: one HTML file, or live on a small server.

===============  =================================================================================
module           what it holds
===============  =================================================================================
``live``         The live page: a small server on loopback that shows a page and passes changes on
                 to it
``page``         Page: what every page has, whatever moves on it: marks, motion, saving, serving
``static_page``  One HTML file with meshcat's viewer, the scene and our script inside: no server,
                 no network
===============  =================================================================================

Two files beside them are the page's own: ``page.js``, its script, and ``page.css``.
"""
