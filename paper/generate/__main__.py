"""The command behind paper/build: python3 -m generate article|readme RUN_FOLDER OUTPUT [TEX]"""

from __future__ import annotations

import pathlib
import re
import sys

from . import figures, style, tables, values
from .run_folder import FormatError, NotMeasured, RunFolder


def write_figures(run: RunFolder, folder: pathlib.Path) -> list[str]:
    """Draws every figure that the run has data for; returns what is missing."""
    missing = []
    for name, draw in figures.FIGURES.items():
        try:
            figure, absent = draw(run)
            figure.savefig(folder / f"figure-{name}.pdf", metadata={"CreationDate": None})
            style.plt.close(figure)
            missing += [f"a panel of figure {name}: {reason}" for reason in dict.fromkeys(absent)]
        except NotMeasured as error:
            missing.append(f"figure {name}: {error}")
    return missing


def write_tables(run: RunFolder, folder: pathlib.Path) -> list[str]:
    """Writes every table that the run has data for; returns what is missing."""
    missing = []
    for name, make in tables.TABLES.items():
        try:
            (folder / f"table-{name}.tex").write_text(make(run), encoding="utf-8")
        except NotMeasured as error:
            missing.append(f"table {name}: {error}")
    return missing


def write_numbers(run: RunFolder, folder: pathlib.Path, source: pathlib.Path) -> list[str]:
    """Writes numbers.tex; a key in the article that nothing defines is an error. Returns what is missing."""
    results, absent = values.evaluate(run)
    used = used_keys(source)
    lines = ["% Written by paper/build. Every number of the text: \\val{key}"]
    lines += [rf"\defineval{{{key}}}{{{result}}}" for key, result in results.items()]
    lines.append(r"\quickruntrue" if run.is_quick() else r"\quickrunfalse")
    (folder / "numbers.tex").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return [f"number {key}: {reason}" for key, reason in absent.items() if key in used]


def used_keys(source: pathlib.Path) -> set[str]:
    """The keys of all \\val in the article, each of which has to be known."""
    used = set()
    for line, words in enumerate(source.read_text(encoding="utf-8").splitlines(), 1):
        for key in re.findall(r"\\val\{([^}#]*)\}", re.sub(r"(?<!\\)%.*", "", words)):
            if key not in values.VALUES:
                raise FormatError(f"{source}:{line}: there is no number '{key}' (generate/values.py)")
            used.add(key)
    return used


def write_readme(run: RunFolder, folder: pathlib.Path) -> list[str]:
    """Writes the pictures and the table of the README; returns what is missing."""
    folder.mkdir(exist_ok=True)
    missing = []
    for name, panel in figures.HEADLINES.items():
        try:
            figure, _ = figures.panel_row(run, (panel,), 4.6, 3.4)
            figure.savefig(folder / f"{name}.png", metadata={"Software": None})
        except NotMeasured as error:
            missing.append(f"{name}.png: {error}")
    try:
        (folder / "table2.md").write_text(tables.readme_table2(run), encoding="utf-8")
    except NotMeasured as error:
        missing.append(f"table2.md: {error}")
    return missing


def main(arguments: list[str]) -> int:
    """Writes what was asked for and lists what the run lacks."""
    what, folder, output = arguments[0], pathlib.Path(arguments[1]), pathlib.Path(arguments[2])
    style.set_up()
    try:
        run = RunFolder(folder)
        if what == "readme":
            missing = write_readme(run, output)
        else:
            missing = write_numbers(run, output, pathlib.Path(arguments[3]))
            missing += write_figures(run, output) + write_tables(run, output)
    except FormatError as error:
        print(f"paper/build: {error}", file=sys.stderr)
        return 2
    files = run.missing_files()
    print(f"Run folder: {folder}" + (" (quick)" if run.is_quick() else ""))
    if files:
        print("Missing files: " + ", ".join(files))
    if missing:
        print("Not measured in this run:\n  " + "\n  ".join(missing))
    if failed := run.failed_checks():
        print("Checks of this run that failed:\n  " + "\n  ".join(failed))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
