"""Scenes of Ambit, run from Python.

`run` runs a scene, given as text or as the name of a file, by the command `ambit`, and returns what was recorded:

    found = ambit.run('''
    local ambit = require "ambit"
    local decay = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
    ambit.simulate { decay, initial = { x = ambit.around(1, "1%") }, t = { 0, 1 } }
    ''')
    result = found.results[-1]
    print(result.status, result.steps[-1].x["x"])

Bounds are the doubles that Ambit proved, unchanged. Needs nothing but Python and the command; arrays are numpy's where
numpy is there.
"""

import json
import os
import subprocess
import tempfile
from dataclasses import dataclass, field
from typing import Any, Dict, Iterator, List, Optional, Sequence

__all__ = ["AmbitError", "Event", "Interval", "Result", "Run", "Step", "Value", "run", "stream"]


class AmbitError(Exception):
    """The scene is wrong, a plugin is broken, or the command could not be run."""


@dataclass(frozen=True)
class Interval:
    """All numbers from lo to hi."""

    lo: float
    hi: float

    @property
    def width(self) -> float:
        return self.hi - self.lo

    @property
    def mid(self) -> float:
        return self.lo + (self.hi - self.lo) / 2

    def __contains__(self, x: float) -> bool:
        return self.lo <= x <= self.hi


@dataclass(frozen=True)
class Step:
    """Where the states are at t, and in `tube` all the time in `span`; {} if the solver does not say it."""

    t: Interval
    span: Interval
    x: Dict[str, Interval]
    tube: Dict[str, Interval]
    order: int
    rigorous: bool


@dataclass(frozen=True)
class Event:
    """What was found of an event; `record` is all that was recorded of it."""

    t: Interval
    x: Dict[str, Interval]
    record: Dict[str, Any]


@dataclass(frozen=True)
class Value:
    """A result of an evaluation: an interval, or what else was recorded."""

    name: str
    value: Any
    record: Dict[str, Any]


@dataclass
class Result:
    """The outcome of a verb, and what it recorded on its way."""

    verb: str
    status: str
    code: str
    reason: str = ""
    t_reached: Optional[float] = None
    cpu_seconds: float = 0.0
    settings: Dict[str, Any] = field(default_factory=dict)
    steps: List[Step] = field(default_factory=list)
    events: List[Event] = field(default_factory=list)
    values: List[Value] = field(default_factory=list)

    @property
    def proved(self) -> bool:
        """Was everything that was asked proved?"""
        return self.code == "ok"

    def arrays(self) -> Dict[str, Any]:
        """{"t": [n], "lo": {state: [n]}, "hi": {state: [n]}} at the ends of steps; t is the middle of a time that is
        no double. numpy arrays if numpy is there, otherwise lists."""
        names = list(self.steps[0].x) if self.steps else []
        lists = {
            "t": [step.t.mid for step in self.steps],
            "lo": {name: [step.x[name].lo for step in self.steps] for name in names},
            "hi": {name: [step.x[name].hi for step in self.steps] for name in names},
        }
        try:
            import numpy
        except ImportError:
            return lists
        return {
            "t": numpy.array(lists["t"]),
            "lo": {name: numpy.array(list_) for name, list_ in lists["lo"].items()},
            "hi": {name: numpy.array(list_) for name, list_ in lists["hi"].items()},
        }


@dataclass
class Run:
    """What a scene recorded."""

    records: List[Dict[str, Any]]
    results: List[Result]
    code: str
    exit: int
    printed: str
    picture: str = ""

    @property
    def proved(self) -> bool:
        """Did the scene end with everything done and proved?"""
        return self.exit == 0

    def _repr_svg_(self) -> Optional[str]:  # what a notebook shows
        return self.picture or None


def _interval(pair: Sequence[float]) -> Interval:
    return Interval(float(pair[0]), float(pair[1]))


def _intervals(record: Optional[Dict[str, Sequence[float]]]) -> Dict[str, Interval]:
    return {name: _interval(pair) for name, pair in (record or {}).items()}


def _instant(t: Any) -> Interval:
    return _interval(t) if isinstance(t, list) else Interval(float(t), float(t))


def _step(record: Dict[str, Any]) -> Step:
    return Step(_instant(record["t"]), _instant(record["span"]), _intervals(record["x"]),
                _intervals(record.get("tube")), record.get("order", 0), record.get("rigorous", False))


def _value(record: Dict[str, Any]) -> Value:
    value = record.get("value")
    if isinstance(value, list) and len(value) == 2 and all(isinstance(x, (int, float)) for x in value):
        value = _interval(value)
    return Value(record.get("name", ""), value, record)


def _result(record: Dict[str, Any], before: List[Dict[str, Any]]) -> Result:
    own = Result(record["verb"], record["status"], record["code"], record.get("reason", ""),
                 record.get("t_reached"), record.get("cpu_seconds", 0.0), record.get("settings", {}))
    for other in before:
        kind = other["record"]
        if kind == "step":
            own.steps.append(_step(other))
        elif kind == "event":
            own.events.append(Event(_instant(other["t"]), _intervals(other.get("x")), other))
        elif kind == "value":
            own.values.append(_value(other))
    return own


def _results(records: List[Dict[str, Any]]) -> List[Result]:
    """What is recorded before a result belongs to it."""
    results, before = [], []
    for record in records:
        if record["record"] == "result":
            results.append(_result(record, before))
            before = []
        else:
            before.append(record)
    return results


def _line(scene: str, words: Sequence[str], options: Dict[str, Any], picture: str) -> List[str]:
    is_text = "\n" in scene or not os.path.exists(scene)
    line = [options["command"], "run", "--quiet", "--json", "-"]
    if options["sandbox"]:
        line.append("--sandbox")
    for path in options["allow_read"]:
        line += ["--allow-read", os.fspath(path)]
    for name in ("time", "memory", "output"):
        if options[name] is not None:
            line += ["--" + name, str(options[name])]
    if picture:
        line += ["--plot", picture]
    return line + ["-" if is_text else scene] + [str(word) for word in words]


def _open(scene: str, words: Sequence[str], options: Dict[str, Any], errors: Any, picture: str = ""):
    line = _line(scene, words, options, picture)
    try:
        process = subprocess.Popen(line, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=errors,
                                   encoding="utf-8", errors="replace")
    except OSError as problem:
        raise AmbitError(f"cannot run `{options['command']}`: {problem}") from problem
    try:
        if line[-1 - len(words)] == "-":
            process.stdin.write(scene)
        process.stdin.close()
    except BrokenPipeError:
        pass  # it ended before it read the scene, and says why
    return process


def _options(command=None, sandbox=False, allow_read=(), time=None, memory=None, output=None) -> Dict[str, Any]:
    return {"command": command or os.environ.get("AMBIT_COMMAND", "ambit"), "sandbox": sandbox,
            "allow_read": allow_read, "time": time, "memory": memory, "output": output}


def stream(scene: str, *words: Any, **options: Any) -> Iterator[Dict[str, Any]]:
    """The records of a scene as they are written, as dictionaries. What the scene prints goes to standard error.
    Options are those of `run`, but for `check` and `plot`. A reader that leaves off ends the scene."""
    process = _open(scene, words, _options(**options), None)
    try:
        for line in process.stdout:
            yield json.loads(line)
    finally:
        process.stdout.close()
        if process.poll() is None:
            process.terminate()
        process.wait()


def run(scene: str, *words: Any, plot: bool = False, check: bool = True, **options: Any) -> Run:
    """Runs a scene: its text, or the name of its file. `words` are what it finds in `arg`.

    command      the program; otherwise that of AMBIT_COMMAND, or `ambit`
    sandbox      True: the scene is a stranger's (no files but those of `allow_read`, a list; no processes, no network)
    time, memory, output
                 limits: seconds, sizes such as "512M"; a run that reaches one has the code "stopped.time" ...
    plot         True: `picture` is an SVG of the last simulation, which a notebook shows
    check        False: an error of the scene raises nothing; `code`, `exit` and `printed` tell of it

    Raises AmbitError if the scene is wrong or a plugin is broken (exit code 1 or 2). What could not be proved is no
    error: see `proved`, and `code` of the results.
    """
    picture = ""
    with tempfile.TemporaryDirectory() as folder:
        name = os.path.join(folder, "plot.svg") if plot else ""
        with tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace", dir=folder) as errors:
            process = _open(scene, words, _options(**options), errors, name)
            lines = process.stdout.read().splitlines()
            process.stdout.close()
            code = process.wait()
            errors.seek(0)
            printed = errors.read()
        pictures = sorted(os.listdir(folder), key=lambda one: (len(one), one))
        if pictures:
            with open(os.path.join(folder, pictures[-1]), encoding="utf-8") as file:
                picture = file.read()
    records = [json.loads(line) for line in lines]
    last = records[-1] if records and records[-1]["record"] == "end" else {}
    if check and code in (1, 2):
        raise AmbitError(printed.strip() or f"exit code {code}")
    return Run(records, _results(records), last.get("code", "invalid"), code, printed, picture)
