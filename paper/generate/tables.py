"""The tables of the article, and Table 2 for the README, from the CSV files."""

from __future__ import annotations

import math
import re

import numpy as np

from . import style, tex
from .run_folder import RunFolder, Table

MOST_ROWS = 20


def cell(value: float, digits: int = 2) -> str:
    """A number in a table; a dash if it was not measured."""
    return tex.number(value, digits) if math.isfinite(value) else "--"


def whole(value: float) -> str:
    """A whole number in a table; a dash if it was not measured."""
    return tex.count(value) if math.isfinite(value) else "--"


def tabular(columns: str, heads: list[str], rows: list[list[str]], rules: set[int] = frozenset()) -> str:
    """A LaTeX table; a thin rule stands before the rows whose numbers are in `rules`."""
    lines = [rf"\begin{{tabular}}{{{columns}}}", r"\toprule", " & ".join(heads) + r" \\", r"\midrule"]
    for i, row in enumerate(rows):
        lines += [r"\addlinespace"] * (i in rules) + [" & ".join(row) + r" \\"]
    return "\n".join([*lines, r"\bottomrule", r"\end{tabular}"]) + "\n"


def length_changes(table: Table) -> set[int]:
    """The rows at which another refinement length begins."""
    lengths = table["length_m"]
    return {i for i in range(1, len(table)) if lengths[i] != lengths[i - 1]}


def table2_rows(run: RunFolder) -> Table:
    """The rows of Table 2 in the paper's order; with most threads only, if there are too many."""
    table = run["table2"]
    if len(table) > MOST_ROWS:
        table = table.where(threads=max(table.values_of("threads")))
    lengths = table["length_m"]
    coarsest_first = np.where(lengths > 0, -lengths, -np.inf)
    order = np.lexsort((table["threads"], table["method"].astype(str), -table["rtol"],
                        table["solver"].astype(str), coarsest_first))
    return Table(table.name, {name: cells[order] for name, cells in table.columns.items()}, table.comments)


def table2(run: RunFolder) -> str:
    """Table 2 side by side with the paper."""
    table = table2_rows(run)
    heads = [r"$\tilde l$", "solver", "rates", "rtol", "threads", r"$\langle n\rangle$", r"$n$ \cite{lauricella2016}",
             "time (s)", r"time \cite{lauricella2016} (s)", "gain", "evaluations", "tip", "path", "deposit"]
    rows = []
    for i in range(len(table)):
        row = {name: cells[i] for name, cells in table.columns.items()}
        rows.append([
            style.length_name(row["length_m"]), tex.text(style.solver_name(row["solver"])), rates(row),
            tex.power(row["rtol"]),
            whole(row["threads"]), cell(row["beads_mean"], 4), whole(row["beads_paper"]),
            cell(row["seconds_s"], 3), whole(row["seconds_paper"]),
            cell(row["seconds_paper"] / row["seconds_s"], 2), whole(row["evaluations"]), cell(row["tip_error"]),
            cell(row["path_length_error"]), cell(row["deposit_mass_error"])])
    return tabular("@{}llrrrrrrrrrrrr@{}", heads, rows, length_changes(table))


def rates(row: dict) -> str:
    """How many rates the steps of a row have."""
    return "2" if row["method"] == "two-rate" else "1"


def physics(run: RunFolder) -> str:
    """Checks against references: what, by how much, against what bound."""
    table = run["physics"]
    heads = ["quantity", "value", "reference", "difference", "bound", "source"]
    columns = ("check", "value", "reference", "relative_difference", "bound", "passed", "source")
    rows = []
    for check, value, reference, difference, bound, passed, source in zip(*(table[column] for column in columns)):
        mark = "" if passed else r"\,!"
        rows.append([tex.text(check), cell(value, 5), cell(reference, 5), cell(difference) + mark, cell(bound),
                     tex.text(source)])
    left, right = r"@{}>{\raggedright}p{0.33\textwidth}", r">{\raggedright\arraybackslash}p{0.285\textwidth}@{}"
    return tabular(left + "rrrr" + right, heads, rows)


def ideas(run: RunFolder) -> str:
    """What each way of saving evaluations brings: a row per way, a group of columns per refinement length."""
    table = run["table2_ideas"]
    lengths = table.values_of("length_m")
    names = ["not refined" if length == 0 else style.length_name(length) for length in lengths]
    groups = [rf"\multicolumn{{3}}{{c}}{{{name}}}" for name in names]
    rules = "".join(rf"\cmidrule(lr){{{2 + 3 * i}-{4 + 3 * i}}}" for i in range(len(lengths)))
    rows = []
    for idea in dict.fromkeys(table["idea"]):
        row = [tex.text(idea)]
        for length in lengths:
            one = table.where(idea=idea).keep(table.where(idea=idea)["length_m"] == length)
            if len(one):
                row += [whole(one["evaluations"][0]), cell(one["seconds_s"][0]), cell(one["tip_error"][0])]
            else:
                row += ["--"] * 3
        rows.append(row)
    heads = [""] + ["evaluations", "time (s)", "tip error"] * len(lengths)
    head = " & ".join(["", *groups]) + r" \\" + "\n" + rules + "\n" + heads[0]
    return tabular("l" + "rrr" * len(lengths), [head, *heads[1:]], rows)


TABLES = {"table2": table2, "physics": physics, "ideas": ideas}


def readme_table2(run: RunFolder) -> str:
    """Table 2 side by side with the paper in Markdown, with date and processor."""
    table = table2_rows(run)
    compared = table.keep(np.isfinite(table["seconds_paper"]))
    table = compared if len(compared) else table
    about = [f"{key}: {answer}" for key in ("date", "processor", "simd", "commit")
             if (answer := table.comments.get(key))]
    lines = [
        "| L~ | solver | rates | threads | links | beads, paper | time | time, paper (24 cores) | gain "
        "| error of the path length |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for i in range(len(table)):
        row = {name: cells[i] for name, cells in table.columns.items()}
        lines.append("| " + " | ".join([
            style.length_name(row["length_m"]), style.solver_name(row["solver"]), rates(row),
            plain(row["threads"], "{:.0f}"),
            plain(row["beads_mean"], "{:.1f}"), plain(row["beads_paper"], "{:.0f}"),
            plain(row["seconds_s"], "{:.3g} s"),
            plain(row["seconds_paper"], "{:,.0f} s"), plain(row["seconds_paper"] / row["seconds_s"], "{:,.0f}"),
            plain(row["path_length_error"], "{:.1e}")]) + " |")
    kind = ["", "From a quick run: shorter than the paper's."] if run.is_quick() else []
    return "\n".join([*lines, "", "; ".join(about), *kind]).rstrip() + "\n"


def plain(value: float, form: str) -> str:
    """A number in Markdown, empty if it was not measured."""
    return re.sub(r"^nan.*", "", form.format(value))
