"""The command line: each command parses, calls the API, prints.

=====================  ===========================================================================
module                 what it holds
=====================  ===========================================================================
``against``            ``kinlab check mine.toml --against other``: which cell of a DH table is
                       wrong?
``analysis``           Commands about dexterity: singular, isotropy, workspace
``analysis_tables``    What the commands about dexterity print
``check``              The command check: hand formulas beside the engine
``derive``             The command derive: an arm's formulas, derived from its DH table
``fivebar/``           Commands about five-bars: list, analyse, size, design, export
``ik``                 Command ``ik``: one pose from the command line
``mark``               Command ``mark``: a class's submissions, judged
``motion``             Command ``motion``: a motion of an arm, checked, drawn, saved
``robots``             Commands about robots: list, info, urdf, dh
``screen``             The one door to the terminal: what comes from a file is shown, never obeyed
``view``               Command view: a robot or five-bar in the browser, or as one HTML file
=====================  ===========================================================================

One file per group of commands, which its ``COMMANDS`` names; a new file is a word in ``_GROUPS``. A
:class:`kinlab.errors.KinlabError` becomes one line on stderr and exit code 2.
"""

from __future__ import annotations

import functools
import inspect
import io
import os
import signal
import sys
import threading
import warnings
from collections.abc import Callable, Iterator, Sequence
from types import FrameType
from typing import Annotated, Any, get_type_hints

import typer
from typer.core import TyperGroup

from kinlab.cli import analysis, check, derive, fivebar, ik, mark, motion, robots, view
from kinlab.cli.screen import complain
from kinlab.errors import KinlabError, KinlabWarning
from kinlab.host.language import LANGUAGES, _, all_speaking

_GROUPS = (robots, check, mark, derive, ik, motion, analysis, view)

_OLDER = {"tip": "tool"}
"""What options were called before, which is still understood."""

_IMPORTING = "<frozen importlib._bootstrap>"
"""The file of the frames in which Python imports a module."""

LANG = Annotated[
    str | None,
    typer.Option(
        "--lang",
        help=f"Language of what is said ({', '.join(LANGUAGES)}); otherwise KINLAB_LANG, or the "
        "locale.",
        show_default=False,
    ),
]


class _Commands(TyperGroup):
    """The commands; the language is spoken before any of them is read."""

    def main(self, args: Sequence[str] | None = None, *more: Any, **given: Any) -> Any:
        """Runs a command in the language that its words ask for."""
        words = list(sys.argv[1:] if args is None else args)
        with all_speaking(_asked(words)):
            for one in (self, *all_commands(self)):
                one.help = _(one.help) if one.help else None
                for parameter in one.params:
                    if getattr(parameter, "help", None):
                        parameter.help = _(parameter.help)
            return super().main(words, *more, **given)


def all_commands(group: Any) -> Iterator[Any]:
    """The commands of a group and of the groups in it, and these groups themselves."""
    for one in group.commands.values():
        yield one
        if hasattr(one, "commands"):
            yield from all_commands(one)


def _asked(words: Sequence[str]) -> str | None:
    """The language that the words of a command line ask for; JSON is English everywhere."""
    if "--json" in words:
        return "en"
    for k, word in enumerate(words):
        option, _sign, name = word.partition("=")
        if option == "--lang":
            return name or next(iter(words[k + 1 : k + 2]), None)
    return None


def _with_language(command: Callable[..., Any]) -> Callable[..., Any]:
    """Gives a command the option ``--lang``, which is obeyed before the command is called."""

    @functools.wraps(command)
    def called(*args: Any, lang: str | None = None, **given: Any) -> Any:
        del lang
        return command(*args, **given)

    signature = inspect.signature(command)
    # read in the command's own module, as the words of its file mean it
    hints = get_type_hints(command, include_extras=True)
    option = inspect.Parameter("lang", inspect.Parameter.KEYWORD_ONLY, default=None)
    given = [one.replace(annotation=hints[name]) for name, one in signature.parameters.items()]
    given.append(option.replace(annotation=LANG))
    called.__signature__ = signature.replace(parameters=given)  # type: ignore[attr-defined]
    called.__annotations__ = {**hints, "lang": LANG}
    return called


def _offer_languages(group: typer.Typer) -> None:
    """Gives every command ``--lang``."""
    for info in group.registered_commands:
        assert info.callback is not None
        info.callback = _with_language(info.callback)
    for inside in group.registered_groups:
        assert inside.typer_instance is not None
        _offer_languages(inside.typer_instance)


app = typer.Typer(
    cls=_Commands,
    help="DH tables become URDF, load into Pinocchio, and stand beside your formulas.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={
        "help_option_names": ["-h", "--help"],
        "token_normalize_func": lambda word: _OLDER.get(word, word),
    },
)


@app.callback()
def _root(lang: LANG = None) -> None:
    """Keeps commands named, even where there is only one."""
    del lang  # spoken already


for _group in _GROUPS:
    for _name, _command in _group.COMMANDS.items():
        app.command(_name)(_command)
app.add_typer(fivebar.GROUP, name="fivebar")
_offer_languages(app)


def main() -> None:
    """Entry point of the ``kinlab`` command."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # a terminal without the letters still gets them
            stream.reconfigure(errors="backslashreplace")
    in_front = threading.current_thread() is threading.main_thread()
    before = signal.signal(signal.SIGTERM, _stop) if in_front else None
    if in_front and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _interrupt)
    warnings.showwarning = _once(set())
    if not sys.warnoptions:
        warnings.simplefilter("always", KinlabWarning)
    try:
        app()
    except KinlabError as problem:
        complain(problem)
        sys.exit(2)
    except KeyboardInterrupt:
        print(_("kinlab: stopped"), file=sys.stderr)
        sys.exit(130)
    except MemoryError:
        print(_("kinlab: not enough memory for this"), file=sys.stderr)
        sys.exit(2)
    except BrokenPipeError:  # the reader of our output has gone, as in `kinlab list | head`
        sys.stderr.close()
        sys.exit(0)
    finally:
        if before is not None:
            signal.signal(signal.SIGTERM, before)
        if in_front and signal.getsignal(signal.SIGINT) is _interrupt:
            signal.signal(signal.SIGINT, signal.default_int_handler)


def _once(said: set[str]) -> Callable[..., None]:
    """Shows each warning as one line on stderr, whatever line of code it points to."""

    def show(message: Warning | str, *_more: Any, **_given: Any) -> None:
        if str(message) not in said:
            said.add(str(message))
            complain(_("warning: {message}").format(message=message))

    return show


def _interrupt(number: int, frame: FrameType | None) -> None:
    """Ctrl-C, which ends the program at once while modules are being imported.

    Some of those that we import catch every exception of their own imports, this one among them,
    and go on as if nothing had been asked; nothing has to be cleaned up there.
    """
    while frame is not None:
        if frame.f_code.co_filename == _IMPORTING:
            os.write(2, b"kinlab: stopped\n")
            os._exit(130)
        frame = frame.f_back
    signal.default_int_handler(number, frame)


def _stop(number: int, frame: Any) -> None:
    """SIGTERM is Ctrl-C to all who clean up behind themselves; a second one ends at once."""
    del frame
    signal.signal(number, signal.SIG_DFL)
    raise KeyboardInterrupt
