# SPDX-License-Identifier: BSD-3-Clause
"""Unfurl: how deployable structures unfold.

    import unfurl
    ring = unfurl.Scene("hoop6", set={"structure.units": 12, "solver.stages": 4})
    run = ring.run(tolerance=1e-8)
    run.t, run.x["B0"], run.rod_force["B0-Mb0"]

Lengths are metres, times seconds, forces newtons (tension positive), angles of scenes degrees. Arrays are views of the
run's own memory: they cannot be written into, and keep what they came from alive.
"""
from __future__ import annotations

import json
import os
import re
import tempfile
import warnings
from typing import Any, Iterable, Mapping, Sequence

import numpy as np

from . import _unfurl
from ._unfurl import Error, FileError, GraphicsError, NotFound, SceneError, StructureError, StudyError, UnreadableScene, __version__, measures, scenes

__all__ = ["Scene", "Structure", "Run", "Named", "Study", "Stepper", "Error", "SceneError", "StructureError", "StudyError", "FileError",
           "GraphicsError", "NotFound", "UnreadableScene", "measures", "scenes", "__version__"]


def _toml(value: Any) -> str:
    """A Python value as TOML; strings that are no words stand in quotes."""
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value[()]
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007F")  # TOML has no surrogate pairs
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{k} = {_toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, Iterable):
        return "[" + ", ".join(_toml(v) for v in value) + "]"
    raise TypeError(f"{value!r} is no value of a scene: a number, a word, a list or a dict is")


def _axis(values: Any) -> list:
    """The values of a key as numbers or, where one is none, as texts of TOML, words as they are."""
    values = [values] if isinstance(values, str) else list(values)

    def is_number(x: Any) -> bool:
        return not isinstance(x, (str, bool, np.bool_)) and hasattr(x, "__float__") and np.ndim(x) == 0

    def is_word(x: Any) -> bool:
        return isinstance(x, str) and re.fullmatch("[A-Za-z_][A-Za-z0-9_-]*", x) is not None and x not in ("true", "false", "inf", "nan")

    if all(map(is_number, values)):
        return [float(x) for x in values]
    return [x if is_word(x) else _toml(x) for x in values]


def _needed(package: str, by: str):
    """A package that not everybody has."""
    import importlib
    try:
        return importlib.import_module(package)
    except ImportError as error:
        raise ImportError(f"{by}() needs the Python package {package}, which is not installed (python3-{package}, or pip install {package})") from error


class Named:
    """An array whose second axis (nodes, rods) goes by name: run.x["B0"] is [steps, 3].

    Numbers are those of the array: run.x[k] is state k of all nodes, run.x[:, i] node i in all states.
    """

    def __init__(self, array: np.ndarray, names: Sequence[str], what: str):
        self.array, self.names, self._what = array, list(names), what
        self._index = {name: i for i, name in enumerate(self.names)}

    def __getitem__(self, key):
        if isinstance(key, str):
            if key not in self._index:
                raise KeyError(f"no {self._what} {key!r}; there are {', '.join(self.names[:12])}{', ...' if len(self.names) > 12 else ''}")
            return self.array[:, self._index[key]]
        return self.array[key]

    def __contains__(self, name) -> bool:
        """Is there a node (rod) of that name?"""
        return name in self._index

    def __array__(self, dtype=None, copy=None):
        return np.array(self.array, dtype=dtype) if copy else np.asarray(self.array, dtype=dtype)

    def __len__(self):
        return len(self.array)

    @property
    def shape(self):
        return self.array.shape

    def __repr__(self):
        return f"<{self._what}s {self.array.shape}: {', '.join(self.names[:6])}{', ...' if len(self.names) > 6 else ''}>"


class Run:
    """A finished run. `status` is completed, deployed, stopped or failed; of a failed one the good part is there."""

    def __init__(self, run: _unfurl.Run):
        self._run = run
        self.t: np.ndarray = run.t  # [steps]
        self.series: dict[str, np.ndarray] = run.series  # columns of series.csv, each [steps]
        self.x = Named(run.x, run.nodes, "node")  # positions [steps, nodes, 3]
        self.v = Named(run.v, run.nodes, "node")  # velocities
        self.rod_force = Named(run.force, run.rods, "rod")  # axial forces [steps, rods]
        self.rod_force_unique = Named(run.unique, run.rods, "rod")  # False: one choice of many (rigid rods)

    status = property(lambda self: self._run.status)
    message = property(lambda self: self._run.message)
    warnings = property(lambda self: self._run.warnings)
    events = property(lambda self: self._run.events)  # [(name, t)]
    nodes = property(lambda self: self._run.nodes)
    rods = property(lambda self: self._run.rods)
    rod_nodes = property(lambda self: self._run.rod_nodes)
    title = property(lambda self: self._run.title)

    @property
    def summary(self) -> dict:
        """summary.json."""
        return json.loads(self._run.summary_json())

    def at(self, t: float) -> np.ndarray:
        """Positions [nodes, 3] at any time of the run, as accurate as its states."""
        return self._run.at(t)

    def measure(self, name: str) -> float:
        """One number: unfurl.measures(), or max:, min:, final: and a column."""
        return self._run.measure(name)

    def plot(self, name: str, file: str | os.PathLike | None = None, style: str = "screen"):
        """A figure of Unfurl's own as PNG, SVG or PDF; without a file an object that a notebook shows."""
        if file is not None:
            self._run.plot(name, os.fspath(file), style)
            return None
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "figure.svg")
            self._run.plot(name, path, style)
            with open(path, encoding="utf-8") as svg:
                return Svg(svg.read())

    def frame(self, t: float, file: str | os.PathLike) -> None:
        """The picture of the structure at a time of the run, as PNG: what a film of the scene shows then."""
        self._run.frame(t, os.fspath(file))

    def film(self, file: str | os.PathLike) -> None:
        """The film of the run as the scene's [render] has it: .mp4 (by ffmpeg), .webp or .gif."""
        self._run.film(os.fspath(file))

    def export(self, format: str, directory: str | os.PathLike) -> None:
        """vtk, gltf, csv, npy, mat or html."""
        self._run.export(format, os.fspath(directory))

    def to_pandas(self):
        """The series as a DataFrame over time."""
        pandas = _needed("pandas", "to_pandas")
        return pandas.DataFrame(self.series, index=pandas.Index(self.t, name="t_s"))

    def to_xarray(self):
        """Positions, velocities, rod forces and the series as a Dataset over time, nodes and rods by name."""
        xarray = _needed("xarray", "to_xarray")
        places = ("t_s", "node", "axis")
        data = {"x_m": (places, self.x.array), "v_m_s": (places, self.v.array), "rod_force_N": (("t_s", "rod"), self.rod_force.array),
                "rod_force_unique": (("t_s", "rod"), self.rod_force_unique.array)}
        data.update({name: (("t_s",), values) for name, values in self.series.items()})
        return xarray.Dataset(data, coords={"t_s": self.t, "node": self.nodes, "rod": self.rods, "axis": ["x", "y", "z"]},
                              attrs={"title": self.title})

    def _repr_html_(self) -> str:
        import html
        with tempfile.TemporaryDirectory() as folder:
            self.export("html", folder)
            with open(os.path.join(folder, "viewer.html"), encoding="utf-8") as page:
                return f'<iframe style="width:100%;height:720px;border:0" srcdoc="{html.escape(page.read())}"></iframe>'

    def __repr__(self):
        return f"<run of {self.title!r}: {self.status} at {self.t[-1]:.6g} s, {len(self.t)} states>"


class _Force(np.ndarray):
    """A force between steps, as a number is one: `stepper.force[node] += f` sets another, its parts cannot be set."""

    def __iadd__(self, other):
        return np.asarray(self) + other

    def __isub__(self, other):
        return np.asarray(self) - other

    def __imul__(self, other):
        return np.asarray(self) * other

    def __itruediv__(self, other):
        return np.asarray(self) / other


def _force(array: np.ndarray) -> _Force:
    array.flags.writeable = False
    return array.view(_Force)


class Stepper(_unfurl.Stepper):
    """A run step by step: while s.step(): s.t, s.x, s.v. `status` is running until it has ended."""

    def finish(self) -> Run:
        """The run so far."""
        return Run(super().finish())


class Svg(str):
    """A figure as text; a notebook draws it."""

    def _repr_svg_(self) -> str:
        return str(self)


class Study(dict):
    """What methods cost and how far they are off: the columns of study.csv by name; `sentence` names the cheapest settings for
    errors, `reference` says what they are measured against."""

    def __init__(self, columns: Mapping[str, Any], sentence: str, reference: str):
        super().__init__(columns)
        self.sentence, self.reference = sentence, reference


class Scene:
    """A scene by name, file or (text=...) content, with keys changed as --set does."""

    def __init__(self, scene: str | os.PathLike | None = None, set: Mapping[str, Any] | None = None, *, text: str | None = None):
        if (scene is None) == (text is None):
            raise TypeError("a scene comes from a name or file, or from text=...")
        self._scene, self._text, self._set = (None if scene is None else os.fspath(scene)), text, dict(set or {})
        self._source = _unfurl.SceneSource(self._scene if text is None else text, self._overrides(self._set), text is not None)
        self.title: str = self._source.title  # reads the scene: what is wrong is said here

    @staticmethod
    def _overrides(changes: Mapping[str, Any]) -> list[str]:
        return [f"{key}={_toml(value)}" for key, value in changes.items()]

    @property
    def text(self) -> str:
        """All of it as TOML, defaults included."""
        return self._source.text

    def run(self, tolerance: float | None = None, set: Mapping[str, Any] | None = None) -> Run:
        """Simulate; Ctrl-C raises KeyboardInterrupt. `tolerance`: metres, stages and step are picked."""
        changes = dict(set or {})
        if tolerance is not None:
            changes["solver.tolerance"] = float(tolerance)
        return Run(self._source.run(self._overrides(changes)))

    def stepper(self) -> Stepper:
        """Step by step, through events, stops and latches: while s.step(): s.t, s.x, s.v. The whole model, in the scene's steps."""
        stepper = Stepper(self._source)
        for said in stepper.idle:  # keys of the scene that do nothing here
            warnings.warn(said, stacklevel=2)
        return stepper

    def sweep(self, vary: Mapping[str, Sequence[Any]], measures: Sequence[str] | str, threads: int = 1, out: str | os.PathLike | None = None) -> dict:
        """The measures at every point of the grid: arrays by column (lists of texts where values are no numbers), the last key runs fastest.

        With out=, a folder, finished points are kept in its sweep.csv: after Ctrl-C the same call does only what is missing.
        """
        axes = [(key, _axis(values)) for key, values in vary.items()]
        measures = [measures] if isinstance(measures, str) else list(measures)
        return self._source.sweep(axes, measures, threads, "" if out is None else os.fspath(out))

    def study(self, steps: tuple[float, float] | None = None, methods: Sequence[str] = (), repeats: int = 5) -> Study:
        """Speed against accuracy of all methods, or of those named, in steps from the largest to the smallest [s]."""
        if steps is not None:
            largest, smallest = steps
            steps = float(largest), float(smallest)
        columns, sentence, reference, idle = self._source.study(steps, list(methods), int(repeats))
        for said in idle:
            warnings.warn(said, stacklevel=2)
        return Study(columns, sentence, reference)

    def solve(self, key: str, between: tuple[float, float] | None = None, **target: float) -> float:
        """The value of the key for which a measure takes a value: ring.solve("structure.fold_angle", deploy_time=4.92)."""
        if len(target) != 1:
            raise TypeError("one measure with its value is the target: deploy_time=4.92")
        (measure, value), = target.items()
        if between is not None:
            low, high = between
            between = float(low), float(high)
        return self._source.solve(key, measure, float(value), between)

    def __repr__(self):
        return f"<scene {self.title!r}>"


def _numbers(values: Any, what: str, dtype: Any = None) -> np.ndarray:
    try:
        return np.asarray(values, dtype=dtype)
    except (TypeError, ValueError) as error:
        raise StructureError(f"{what} are no array of numbers: {error}") from error


def Structure(nodes, rods, fixed: Sequence[int] = (), mass: float | Sequence[float] = 1.0, velocities=None, gravity=(0.0, 0.0, 0.0),
              constraints: Sequence[Mapping[str, Any]] = (), set: Mapping[str, Any] | None = None) -> Scene:
    """A scene of rods between points: nodes (n, 3) or (n, 2), rods (m, 2) of indices from 0, mass of each rod [kg].

    `fixed` are indices of nodes, or one True or False for each.

    Nodes are called n0, n1, ...; `constraints` are entries as in a scene, {"kind": "collinear", "nodes": ["n0", "n1", "n2"]};
    further keys, forces too, by `set`. Nodes of two coordinates stay in their plane.
    """
    points = _numbers(nodes, "nodes", float)
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise StructureError(f"nodes are rows of 2 or 3 coordinates; got the shape {points.shape}")
    ends = _numbers(rods, "rods")
    if ends.ndim != 2 or ends.shape[1] != 2 or not np.issubdtype(ends.dtype, np.integer):
        raise StructureError(f"rods are rows of two indices of nodes; got the shape {ends.shape}, type {ends.dtype}")
    if ends.size and (ends.min() < 0 or ends.max() >= len(points)):
        raise StructureError(f"a rod names node {ends.max() if ends.max() >= len(points) else ends.min()}; there are 0 to {len(points) - 1}")
    held = _numbers(fixed, "fixed")
    if held.dtype == bool:
        if held.shape != (len(points),):
            raise StructureError(f"fixed has one True or False for each of {len(points)} nodes; got the shape {held.shape}")
        held = np.flatnonzero(held)
    if held.size and (held.ndim != 1 or not np.issubdtype(held.dtype, np.integer)):
        raise StructureError(f"fixed are indices of nodes; got the shape {held.shape}, type {held.dtype}")
    if held.size and (held.min() < 0 or held.max() >= len(points)):
        raise StructureError(f"fixed names node {held.max() if held.max() >= len(points) else held.min()}; there are 0 to {len(points) - 1}")
    flat = points.shape[1] == 2
    points = np.column_stack([points, np.zeros(len(points))]) if flat else points
    speeds = None if velocities is None else _numbers(velocities, "velocities", float)
    if speeds is not None and speeds.shape not in ((len(points), 2), (len(points), 3)):
        raise StructureError(f"velocities are rows of 2 or 3 components, one row a node ({len(points)}); got the shape {speeds.shape}")
    masses = _numbers(mass, "mass", float)
    if masses.shape not in ((), (1,), (len(ends),)):
        raise StructureError(f"mass is one number or one for each of {len(ends)} rods; got the shape {masses.shape}")
    masses = np.broadcast_to(masses, len(ends))
    table = {"kind": "custom",
             "nodes": [{"name": f"n{i}", "position": p.tolist(), **({} if speeds is None else {"velocity": [*speeds[i], 0.0][:3]})} for i, p in enumerate(points)],
             "rods": [{"nodes": [f"n{a}", f"n{b}"], "mass": float(m)} for (a, b), m in zip(ends, masses)],
             "constraints": [{"kind": "fixed", "nodes": [f"n{i}"]} for i in held.tolist()]
             + ([{"kind": "plane", "nodes": [f"n{i}" for i in range(len(points))], "normal": [0, 0, 1]}] if flat else []) + list(constraints)}
    text = "[structure]\n" + "".join(f"{k} = {_toml(v)}\n" for k, v in table.items())
    text += f"[gravity]\nacceleration = {_toml(list(map(float, gravity)))}\n"
    return Scene(text=text, set=set)
