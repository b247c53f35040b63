"""Commands about five-bars.

============  ====================================================================================
module        what it holds
============  ====================================================================================
``design``    The command fivebar design: the lengths of a five-bar for a rectangle, and Pareto
              fronts
``linkages``  Commands about one five-bar: list, analyse, export
``sizing``    The command fivebar size: servos for a workspace, or for a cycle
``words``     What the commands about five-bars share: their options, and numbers as text
============  ====================================================================================
"""

from __future__ import annotations

import typer

from kinlab.cli.fivebar.design import design
from kinlab.cli.fivebar.linkages import analyse, export, list_fivebars
from kinlab.cli.fivebar.sizing import size

GROUP = typer.Typer(
    help="Five-bar linkages: analyse, size the servos, export.",
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)
"""The commands under ``kinlab fivebar``."""

GROUP.command("list")(list_fivebars)
GROUP.command("analyse")(analyse)
GROUP.command("size")(size)
GROUP.command("servo", hidden=True)(size)
GROUP.command("design")(design)
GROUP.command("export")(export)
