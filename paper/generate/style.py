"""How figures look: sizes in print, colours of Okabe and Ito, a marker and a line style for each curve."""

from __future__ import annotations

import itertools

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend has to be chosen first)

BLACK, ORANGE, SKY, GREEN, YELLOW, BLUE, RED, PURPLE = (
    "#000000", "#E69F00", "#56B4E9", "#009E73", "#F0E442", "#0072B2", "#D55E00", "#CC79A7",
)

PAGE_WIDTH = 6.92    # and both

SOLVERS = {
    "direct": dict(color=BLACK, marker="o"),
    "treecode": dict(color=ORANGE, marker="s"),
    "fmm": dict(color=BLUE, marker="^"),
    "auto": dict(color=GREEN, marker="D"),
}
SOLVER_NAMES = {"direct": "direct sum", "treecode": "treecode", "fmm": "fast multipole", "auto": "auto"}
LINE_STYLES = ["-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 2))]
COLOURS = [BLUE, RED, GREEN, ORANGE, PURPLE, SKY, BLACK]
MARKERS = ["o", "s", "^", "D", "v", "P", "X"]


def set_up() -> None:
    """Settings for all figures: nothing smaller than 8 points in print."""
    plt.rcParams.update({
        "font.family": "STIXGeneral", "mathtext.fontset": "stix", "font.size": 8,
        "axes.labelsize": 8, "axes.titlesize": 8.5, "legend.fontsize": 8, "xtick.labelsize": 8,
        "ytick.labelsize": 8, "figure.titlesize": 9,
        "axes.linewidth": 0.6, "lines.linewidth": 1.1, "lines.markersize": 3.8,
        "axes.grid": True, "grid.linewidth": 0.4, "grid.color": "#DDDDDD", "axes.axisbelow": True,
        "axes.spines.top": False, "axes.spines.right": False,
        "legend.frameon": False, "legend.handlelength": 2.2, "legend.borderaxespad": 0.2,
        "legend.labelspacing": 0.3, "legend.handletextpad": 0.5, "legend.columnspacing": 1.2,
        "pdf.fonttype": 42, "savefig.dpi": 200, "figure.constrained_layout.use": True,
    })


def solver_style(solver: str) -> dict:
    """Colour and marker of a Coulomb solver, the same in every figure."""
    return SOLVERS.get(solver, dict(color=PURPLE, marker="v"))


def solver_name(solver: str) -> str:
    """The name of a solver in words."""
    return SOLVER_NAMES.get(solver, solver)


def tolerance_name(tolerance: float) -> str:
    """A tolerance as a power of ten, in TeX as matplotlib and LaTeX read it."""
    mantissa, exponent = f"{tolerance:.0e}".split("e")
    power = f"10^{{{int(exponent)}}}"
    return f"${power}$" if mantissa == "1" else rf"${mantissa}\times{power}$"


def curve_styles(names) -> dict:
    """A colour, a marker and a line style for each name, in order."""
    looks = zip(itertools.cycle(COLOURS), itertools.cycle(MARKERS), itertools.cycle(LINE_STYLES))
    return {name: dict(color=c, marker=m, linestyle=l) for name, (c, m, l) in zip(names, looks)}


def length_name(length: float) -> str:
    """A refinement length in centimetres; 0 is no refinement."""
    return f"{100 * length:g} cm" if length > 0 else "none"
