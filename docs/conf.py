"""The site: pages of docs/, the reference from the docstrings, pages made from the project's data.

``pip install -e '.[docs]' && python -m sphinx -W docs docs/_build/html``. Nothing is fetched while
it is built, and a page that is opened asks for nothing either: formulas are MathML.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "_ext"))

import kinlab

os.environ["KINLAB_PROGRESS"] = "0"  # pages hold answers, not how long they took

project = "kinlab"
author = "the kinlab authors"
copyright = "the kinlab authors"
version = release = kinlab.__version__

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "sphinx_design",
    "docstrings",
    "links",
    "mathml",
    "made_pages",
    "notebooks",
    "live",
]
exclude_patterns = [
    "_build",
    "_ext",
    "**/generated/summary.md",
    "benchmarks/generated",
    "**/.ipynb_checkpoints",
]
# one kind of page holds code that is run, the other does not: both are Markdown
source_suffix = {".rst": "restructuredtext", ".md": "myst-nb"}

suppress_warnings = ["ref.python"]  # the Arc of a motion and the Arc of a boundary

html_theme = "furo"
html_title = "kinlab"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sphinx = False
html_copy_source = False
html_theme_options = {"navigation_with_keys": True}
html_math_renderer = "mathml"

myst_enable_extensions = [
    "amsmath",
    "colon_fence",
    "deflist",
    "dollarmath",
    "attrs_block",
    "attrs_inline",
]
myst_heading_anchors = 3
myst_update_mathjax = False

nb_execution_mode = "cache"
nb_execution_cache_path = str(Path(__file__).parent / "_build" / "executed")
nb_execution_raise_on_error = True
nb_execution_timeout = 300
nb_execution_in_temp = True
nb_merge_streams = True
nb_ipywidgets_js = {}  # no script from elsewhere
nb_number_source_lines = False

copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True
copybutton_exclude = ".linenos, .gp, .go"

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
autodoc_class_signature = "mixed"
napoleon_google_docstring = True
napoleon_numpy_docstring = False
napoleon_use_ivar = False
napoleon_use_rtype = False
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 88
add_module_names = False
modindex_common_prefix = ["kinlab."]
toc_object_entries_show_parents = "hide"
