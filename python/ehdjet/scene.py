"""Scenes: what is simulated."""

from __future__ import annotations

import json
import os
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from . import _core
from .errors import InputError


class Scene:
    """A scene that has been read and found valid.

    Arguments:
        source: a scene file (TOML), or a mapping of tables: ``{"run": {"end_time": 1e-3}, ...}``
        folder: resolves relative paths in a mapping; by default the current folder

    ``scene["run.end_time"] = 0.02`` overrides a key, ``del scene["gravity"]`` removes a key or a table, and `update`
    changes several keys at once. Each change reads and checks the whole scene again, as ``ehdjet run --set`` does; if
    it is refused, the scene stays as it was. ``scene["run.end_time"]`` is the value that a run would take, defaults
    included. `key_reference` has all keys.

    Raises:
        InputError: names file, line, key, value, unit and allowed range; for an unknown key the nearest known one;
            for contradicting keys both of them
        KeyError: for ``scene[key]`` of a key that the scene does not have
    """

    def __init__(self, source: str | os.PathLike[str] | Mapping[str, Any], *,
                 folder: str | os.PathLike[str] | None = None) -> None:
        if isinstance(source, Mapping):
            self._begin(to_toml(source), "scene", folder if folder is not None else ".")
        elif folder is not None:
            raise TypeError("folder goes with a mapping: paths in a file are relative to the file")
        else:
            self._begin(None, os.fspath(source), ".")

    @classmethod
    def from_text(cls, text: str, *, name: str = "scene", folder: str | os.PathLike[str] = ".") -> Scene:
        """A scene from TOML text. `name` stands for the file in messages; `folder` resolves relative paths."""
        scene = cls.__new__(cls)
        scene._begin(text, name, folder)
        return scene

    def _begin(self, text: str | None, name: str, folder: str | os.PathLike[str]) -> None:
        self._text, self._name, self._folder = text, name, os.fspath(folder)
        self._overrides: dict[str, str] = {}  # as for --set
        self._core = self._read(self._overrides)

    def _read(self, overrides: dict[str, str]) -> _core.Scene:
        given = [f"{key}={value}" for key, value in overrides.items()]
        try:
            if self._text is None:
                return _core.read_scene(self._name, given)
            return _core.read_scene_text(self._text, self._name, self._folder, given)
        except InputError as error:
            text = str(error)
            for key, value in overrides.items():  # as it would be written here
                here = f'scene["{key}"] = {value}' if value else f'del scene["{key}"]'
                text = text.replace(f"--set {key}={value}", here)
            raise InputError(text) from None

    def update(self, changes: Mapping[str, Any]) -> None:
        """Changes keys or whole tables at once; None removes. `changes`: ``{"table.key": value, ...}``."""
        overrides = dict(self._overrides)
        for key, value in changes.items():
            if isinstance(value, Mapping):
                for name in [k for k in overrides if k.startswith(key + ".")]:
                    del overrides[name]
                overrides[key] = ""  # an old table goes
                for name, entry in value.items():
                    overrides[f"{key}.{name}"] = to_literal(entry, f"{key}.{name}")
                continue
            overrides.pop(key, None)  # the last change comes last
            overrides[key] = "" if value is None else to_literal(value, key)
        self._core = self._read(overrides)
        self._overrides = overrides

    def __setitem__(self, key: str, value: Any) -> None:
        self.update({key: value})

    def __delitem__(self, key: str) -> None:
        self[key]  # it must be there
        self.update({key: None})

    def __getitem__(self, key: str) -> Any:
        entry: Any = self.to_dict()
        for name in key.split("."):
            if not isinstance(entry, dict) or name not in entry:
                raise KeyError(key)
            entry = entry[name]
        return entry

    def __contains__(self, key: object) -> bool:
        try:
            self[key]  # type: ignore[index]
        except (KeyError, AttributeError):
            return False
        return True

    def __iter__(self) -> Iterator[str]:
        return iter(self.to_dict())

    def __repr__(self) -> str:
        return f"<ehdjet.Scene {self._core.title!r} from {self._name}>"

    def copy(self) -> Scene:
        """A scene that can be changed on its own."""
        scene = type(self).__new__(type(self))
        scene.__dict__.update(self.__dict__)
        scene._overrides = dict(self._overrides)
        return scene

    @property
    def resolved(self) -> str:
        """The scene as TOML, with every default filled in and each key's unit and meaning as a comment."""
        return self._core.resolved

    def to_dict(self) -> dict[str, Any]:
        """The scene as tables, with every default filled in."""
        return tomllib.loads(self._core.resolved)

    def report(self) -> str:
        """What a run would simulate: dimensionless groups, stability limits, cost (as ``ehdjet check``)."""
        return self._core.report()

    @property
    def file(self) -> str:
        """The scene file, or the name that stands for it, in the folder that resolves paths."""
        return self._name if self._text is None else os.path.normpath(os.path.join(self._folder, self._name))


def key_reference() -> str:
    """All tables and keys with unit, range, default and meaning (Markdown)."""
    return _core.key_reference()


def to_literal(value: Any, key: str) -> str:
    """A value as TOML. errors: InputError naming the key if TOML has no such value"""
    if hasattr(value, "tolist"):  # numpy's numbers and arrays
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (str, Path)):
        return json.dumps(os.fspath(value), ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(to_literal(entry, key) for entry in value) + "]"
    if isinstance(value, Mapping):
        entries = (f"{json.dumps(name)} = {to_literal(entry, key)}" for name, entry in value.items())
        return "{" + ", ".join(entries) + "}"
    raise InputError(f"{key}: a {type(value).__name__} cannot be a value of a scene: give a number, text, bool, list "
                     "or None")


def to_toml(tables: Mapping[str, Any]) -> str:
    lines = [f"{json.dumps(key)} = {to_literal(value, key)}" for key, value in tables.items()
             if not isinstance(value, Mapping) and value is not None]
    for name, table in tables.items():
        if isinstance(table, Mapping):
            lines += ["", f"[{json.dumps(name)}]"]
            lines += [f"{json.dumps(key)} = {to_literal(value, f'{name}.{key}')}" for key, value in table.items()
                      if value is not None]
    return "\n".join(lines) + "\n"
