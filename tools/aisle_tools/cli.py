"""The console command `aisle`."""

from __future__ import annotations

import argparse
import importlib
import os
import re
import sys
from pathlib import Path

from aisle_tools import __version__
from aisle_tools.errors import UserError

COMMANDS = {
    "map": ("maps", "send a ROS map_server map or a scenario"),
    "vehicle": ("vehicles", "send the vehicle's footprint and limits"),
    "query": ("query", "ask for paths, one row each"),
    "arm": ("arm", "ask for a motion of the arm, with a picture if wished"),
    "goal": ("goals", "send a goal list, with a simulated pose if wished"),
    "watch": ("watch", "live view of the daemon"),
    "sim": ("sim", "a simulated vehicle among simulated movers"),
    "plot": ("plot", "picture of the map and paths"),
    "view": ("view", "a page that plays a recorded run"),
    "check": ("checks", "judge recorded paths independently"),
    "paper": ("paper", "a paper's figures beside ours, with pictures"),
}
WITHOUT_LOG = ("watch", "sim", "plot", "view", "check", "paper")


def join_negative(argv: list[str]) -> list[str]:
    """--start -1,2 to --start=-1,2: argparse takes a leading minus for an option."""
    out: list[str] = []
    for word in argv:
        if re.match(r"-[\d.][^=]*,", word) and out and re.fullmatch(r"--[a-z-]+", out[-1]):
            out[-1] += "=" + word
        else:
            out.append(word)
    return out


def make_parser(names: list[str]) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="aisle", description="Console tools of the Aisle motion planner.")
    parser.add_argument("--version", action="version", version=f"aisle {__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, (module, text) in COMMANDS.items():
        sub = commands.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".")
        if name not in names:
            continue  # only what is asked for is imported
        add_common(sub, name)
        implementation = importlib.import_module(f"aisle_tools.{module}")
        implementation.configure(sub)
        sub.set_defaults(run=implementation.run)
    return parser


def add_common(parser: argparse.ArgumentParser, name: str) -> None:
    group = parser.add_argument_group("bus")
    group.add_argument("--lcm-url", metavar="URL", help="default: $LCM_DEFAULT_URL, else LCM's own")
    group.add_argument("--prefix", default="AISLE", metavar="NAME", help="of the channels; default AISLE")
    group.add_argument("--timeout", type=float, default=10.0, metavar="S", help="wait so long for the daemon; default 10")
    if name not in WITHOUT_LOG:
        group.add_argument("--log", type=Path, metavar="FILE", help="append to this LCM log instead of a bus")


def main(argv: list[str] | None = None) -> int:
    words = join_negative(sys.argv[1:] if argv is None else argv)
    args = make_parser([w for w in words if w in COMMANDS]).parse_args(words)
    try:
        return args.run(args)
    except UserError as e:
        print(f"aisle {args.command}: {e}", file=sys.stderr)
        return 2
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except KeyboardInterrupt:
        return 130
