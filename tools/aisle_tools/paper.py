"""aisle paper: a paper's figures beside ours, with pictures."""

from __future__ import annotations

import argparse
import importlib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
PAPERS = {1: "paper1", 2: "paper2", 3: "paper3", 4: "paper4", 5: "paper5"}


def configure(parser: argparse.ArgumentParser) -> None:
    papers = "1: safety path by PSO in a factory store (2018); 2: local swarm among mobile obstacles (2013); "
    papers += "3: arm by GA (2012); 4: sampling planners (2023); 5: genetic search through barriers (2010)"
    parser.add_argument("number", type=int, choices=sorted(PAPERS), help=papers)
    parser.add_argument("--programs", type=Path, default=ROOT / "build" / "release", metavar="DIR", help="of the build")
    parser.add_argument("--scenarios", type=Path, default=ROOT / "tests" / "data" / "scenarios", metavar="DIR")
    parser.add_argument("--seeds", type=int, default=30, metavar="N", help="runs of the paper's method; default 30")
    parser.add_argument("--margin", type=float, default=0.1, metavar="M", help="m, default 0.1 (paper 1)")
    parser.add_argument("--out", type=Path, metavar="DIR", help="write pictures here")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures as JSON too")


def run(args: argparse.Namespace) -> int:
    return importlib.import_module(f"aisle_tools.{PAPERS[args.number]}").run(args)
