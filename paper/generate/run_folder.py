"""Reads the CSV files of a validation run; knows which columns each must have."""

from __future__ import annotations

import csv
import dataclasses
import pathlib

import numpy as np

# Per file: columns of text, columns of numbers. An empty cell of a number is NaN: not measured.
SCHEMA = {
    "coulomb": (
        "geometry distribution solver norm",
        "charges tolerance threads seconds_s error_l2 error_max error_per_bead error_over_tolerance",
    ),
    "coulomb_closed_forms": ("case solver", "charges tolerance value exact relative_error"),
    "trajectory": (
        "scene solver",
        "tolerance rtol time_s position_error_m tip_error path_length_error deposit_mass_error"
        " growth_rate_error evaluations seconds_s",
    ),
    "integrators": (
        "scene method events landings control",
        "value evaluations steps rejected seconds_s position_error_m",
    ),
    "stability": (
        "method refusal",
        "viscosity_pa_s modulus_pa link_length_m charge_factor field_v_per_m largest_step_s theory_step_s"
        " evaluations_1e2 evaluations_1e4",
    ),
    "refinement_convergence": (
        "remap",
        "length_m interval_s beads path_length_m tip_m reference_path_length_m path_length_error tip_error",
    ),
    "refinement_conservation": ("remap", "refinements mass_error charge_error volume_error"),
    "resolving_power": ("mesh", "lambda resolving_power"),
    "varicosity": ("mesh", "arc_length_m radius_m"),
    "mesh": (
        "jet near_field mesh solver",
        "link_length_m length_m interval_s rtol links path_length_m distance_m speed_m_s radius_m radius_scatter_m"
        " evaluations_per_ms",
    ),
    "wear": (
        "mesh",
        "interval_s changes_of_the_mesh path_length_m distance_m speed_m_s radius_m radius_scatter_m"
        " evaluations_per_ms",
    ),
    "snapshots": ("", "length_m time_s bead x_m y_m z_m radius_m"),
    "physics": ("check source", "value reference relative_difference bound passed"),
    "dispersion": ("solver", "wavelength_m tolerance growth_rate_per_s theory_per_s relative_error"),
    "energy": ("scene method solver", "rtol tolerance time_s residual"),
    "table2": (
        "solver method",
        "length_m threads rtol beads_mean beads_paper seconds_s seconds_paper evaluations rejected tip_m"
        " path_length_m deposit_mass_kg tip_error path_length_error deposit_mass_error",
    ),
    "table2_ideas": ("idea", "length_m evaluations rejected seconds_s tip_error"),
    "two_rates": (
        "method",
        "length_m rtol beads evaluations_per_ms inner_evaluations_per_ms full_sums_per_ms seconds_per_ms_s error_m"
        " tip_error path_length_error",
    ),
    "two_rates_stiff": (
        "method",
        "elastic_modulus_Pa viscosity_Pa_s evaluations_per_ms inner_evaluations_per_ms full_sums_per_ms"
        " seconds_per_ms_s error_m",
    ),
    "scaling": (
        "source solver",
        "beads tolerance threads steps seconds_s seconds_per_evaluation_s evaluations time_per_ms_s"
        " memory_bytes",
    ),
    "checks": ("program check", "value bound passed"),
}


class FormatError(Exception):
    """A CSV file breaks the format: the run, not the article, has to be mended."""


class NotMeasured(Exception):
    """The run has no data for a figure, a table or a number."""


@dataclasses.dataclass
class Table:
    """Rows of a CSV file by column; numbers are arrays of floats, text is an array of strings."""

    name: str
    columns: dict[str, np.ndarray]
    comments: dict[str, str]

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def __getitem__(self, column: str) -> np.ndarray:
        return self.columns[column]

    def keep(self, mask: np.ndarray) -> Table:
        """The rows where the mask is true."""
        return Table(self.name, {name: cells[mask] for name, cells in self.columns.items()}, self.comments)

    def where(self, **wanted) -> Table:
        """Rows with these values; a number is met within a millionth of itself."""
        mask = np.ones(len(self), dtype=bool)
        for column, value in wanted.items():
            cells = self[column]
            mask &= cells == value if isinstance(value, str) else np.isclose(cells, value, rtol=1e-6, atol=0)
        return self.keep(mask)

    def measured(self, *columns: str) -> Table:
        """Rows in which none of these numbers is missing."""
        return self.keep(np.all([np.isfinite(self[column]) for column in columns], axis=0))

    def positive(self, *columns: str) -> Table:
        """Rows in which all of these numbers can be drawn on a logarithmic axis."""
        table = self.measured(*columns)
        return table.keep(np.all([table[column] > 0 for column in columns], axis=0))

    def sorted_by(self, *columns: str) -> Table:
        """The same rows in ascending order of the columns, the first one first."""
        order = np.lexsort([self[column] for column in reversed(columns)])
        return Table(self.name, {name: cells[order] for name, cells in self.columns.items()}, self.comments)

    def values_of(self, column: str) -> list:
        """The distinct values of a column, ascending, without what was not measured."""
        cells = self[column]
        if cells.dtype.kind == "f":
            cells = cells[np.isfinite(cells)]
        return sorted(set(cells.tolist()))

    def required(self, what: str = "") -> Table:
        """The table itself, if it has rows."""
        if len(self) == 0:
            raise NotMeasured(f"{self.name}.csv has no rows" + (f" for {what}" if what else ""))
        return self


class RunFolder:
    """A folder of CSV files. A file that is absent is not an error until somebody asks for it."""

    def __init__(self, path: pathlib.Path):
        self.path = path
        self.tables: dict[str, Table] = {}
        problems = []
        for name, (text, numbers) in SCHEMA.items():
            file = path / f"{name}.csv"
            if file.exists() and file.stat().st_size > 0:
                try:
                    self.tables[name] = read_table(file, text.split(), numbers.split())
                except FormatError as error:
                    problems.append(str(error))
        if problems:
            raise FormatError("\n".join(problems))

    def __getitem__(self, name: str) -> Table:
        if name not in self.tables:
            raise NotMeasured(f"{name}.csv is missing")
        return self.tables[name].required()

    def missing_files(self) -> list[str]:
        """The files a complete run has and this one has not."""
        return [f"{name}.csv" for name in SCHEMA if name not in self.tables]

    def failed_checks(self) -> list[str]:
        """The checks whose value is beyond its bound."""
        if "checks" not in self.tables:
            return []
        failed = self.tables["checks"].where(passed=0.0)
        return [f"{program}: {check}" for program, check in zip(failed["program"], failed["check"])]

    def comments(self, key: str) -> list[str]:
        """What the files say about a key of their comment lines, each answer once."""
        return sorted({table.comments[key] for table in self.tables.values() if key in table.comments})

    def is_quick(self) -> bool:
        """Whether any of the files comes from a run of the quick kind."""
        return self.path.resolve().name == "quick" or any(
            "quick" in table.comments.values() or "quick" in table.comments for table in self.tables.values()
        )


def read_table(file: pathlib.Path, text: list[str], numbers: list[str]) -> Table:
    """A CSV file with comment lines `# key: value` before its header line."""
    lines = file.read_text(encoding="utf-8").splitlines()
    comments = {}
    while lines and lines[0].startswith("#"):
        key, _, value = lines.pop(0).lstrip("# ").partition(":")
        comments[key.strip()] = value.strip()
    rows = csv.DictReader(lines)
    header = rows.fieldnames or []
    absent = [column for column in text + numbers if column not in header]
    if absent:
        raise FormatError(f"{file}: no column {', '.join(absent)} (it has: {', '.join(header)})")
    cells = list(rows)
    columns = {column: np.array([row[column] or "" for row in cells], dtype=object) for column in text}
    for column in numbers:
        columns[column] = np.array([parse(file, column, i, row[column]) for i, row in enumerate(cells)], dtype=float)
    return Table(file.stem, columns, comments)


def parse(file: pathlib.Path, column: str, row: int, cell: str | None) -> float:
    """A number of a CSV file, NaN if the cell is empty."""
    if cell is None or not cell.strip():
        return float("nan")
    try:
        return float(cell)
    except ValueError:
        raise FormatError(f"{file}: column {column}, row {row + 1}: '{cell}' is not a number") from None
