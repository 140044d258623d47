"""The experiments of Liu and Hsu (2013) again, on a page of HTML with the paper's numbers beside those measured here.

    python examples/paper_page.py --output paper.html

The scene that they share with the benchmarks is in benchmarks/. One of them starts the lens bench (realcam[view]).
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import realcam as rc

sys.path.append(str(Path(__file__).resolve().parents[1] / "benchmarks"))

from paper import EXPERIMENTS, save_page


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", "-o", type=Path, default=Path("paper.html"), help="the page, .html")
    parser.add_argument("--device", default="auto", help="auto (a GPU if there is one), cpu, cuda, or cuda:1")
    parser.add_argument(
        "--only", action="append", choices=EXPERIMENTS, default=[], help="one experiment; may be repeated"
    )
    options = parser.parse_args()
    try:
        save_page(options.output, device=options.device, only=options.only, progress=print)
    except rc.RealcamError as error:
        parser.error(str(error))
    print(f"wrote {options.output}")


if __name__ == "__main__":
    main()
