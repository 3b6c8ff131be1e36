# SPDX-License-Identifier: BSD-3-Clause
"""The Python module against the command line, closed forms and its own promises: python3 -m pytest tests/python"""
import ast
import csv
import gc
import json
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import threading
import time
import types
import warnings
import zlib
from pathlib import Path

import numpy as np
import pytest
import unfurl

PROGRAM = os.environ["UNFURL_PROGRAM"]


def columns(path):
    head = open(path).readline().strip().split(",")
    return head, np.loadtxt(path, delimiter=",", skiprows=1)


def test_same_bits_as_the_command_line(tmp_path):
    changes = {"structure.units": 8, "structure.fold_angle": 70.5, "solver.stages": 4, "solver.step": 0.02, "solver.end_time": 1.3}
    sets = [word for key, value in changes.items() for word in ("--set", f"{key}={value}")]
    subprocess.run([PROGRAM, "run", "hoop6", "-o", tmp_path / "out", "--quiet", *sets], check=True)
    run = unfurl.Scene("hoop6", set=changes).run()
    head, table = columns(tmp_path / "out/trajectory.csv")
    assert np.array_equal(run.t, table[:, 0])
    for name in ("B0", "Mt3", "T7"):
        at = head.index(f"{name}.x_m")
        assert np.array_equal(run.x[name], table[:, at:at + 3])
        assert np.array_equal(run.v[name], table[:, at + 3:at + 6])
    head, table = columns(tmp_path / "out/series.csv")
    for name, values in run.series.items():
        assert np.array_equal(values, table[:, head.index(name)], equal_nan=True), name
    head, table = columns(tmp_path / "out/rod_forces.csv")
    rod = run.rods[5]
    assert np.array_equal(run.rod_force[rod], table[:, head.index(f"{rod}.axial_force_N")])
    shell = json.load(open(tmp_path / "out/summary.json"))
    assert run.summary["forces"] == shell["forces"] and run.summary["forces"]["rods"] == len(run.rods)
    assert run.summary["model"]["nodes"] == len(run.nodes) == 32


def test_structure_from_arrays_swings_as_the_pendulum_does():
    # A point mass on a massless rod, let go level: quarter period of the largest swing but one, L = g = 1: x reaches 0 at
    # K(sin 45 deg) = 1.8540746773013719.
    quarter = 1.8540746773013719
    pendulum = unfurl.Structure(nodes=[[0, 0, 0], [1, 0, 0]], rods=[[0, 1]], fixed=[0], mass=0.0, gravity=(0, 0, -1),
                                set={"structure.nodes[1].mass": 2.5, "solver.stages": 5, "solver.step": 0.01, "solver.end_time": 2.0})
    run = pendulum.run()
    assert abs(run.at(quarter)[1, 0]) < 1e-10
    assert abs(run.at(quarter)[1, 2] + 1) < 1e-10
    assert run.status == "completed"


def test_flat_structures_stay_in_their_plane():
    run = unfurl.Structure(nodes=[[0, 0], [1, 0], [1.6, 0.7]], rods=[[0, 1], [1, 2]], fixed=[0], mass=[1.0, 0.3], gravity=(0, -9.81, 0),
                           set={"solver.end_time": 0.5}).run()
    assert np.abs(np.asarray(run.x)[:, :, 2]).max() == 0
    lengths = np.linalg.norm(run.x["n2"] - run.x["n1"], axis=1)
    assert np.abs(lengths - np.hypot(0.6, 0.7)).max() < 1e-13


def test_velocities_are_those_of_their_nodes():
    # Free nodes without rods or loads keep the velocities that they were given.
    given = np.array([[0.0, 0, 0], [0, 0, 1], [0, 0, 2], [3, 4, 5]])

    def masses(velocities):
        return unfurl.Structure(np.eye(4, 3), np.empty((0, 2), int), velocities=velocities, set={
            "solver.end_time": 0.1, **{f"structure.nodes[{i}].mass": 1 for i in range(4)}})
    assert np.array_equal(masses(given).run().v[0], given)
    assert np.array_equal(masses(given[:, :2]).run().v[0], given * [1, 1, 0])
    for wrong in (given.T, given.ravel(), np.ones((4, 5)), np.ones((4, 1)), np.ones(4), given[:3], 1.0):
        with pytest.raises(unfurl.StructureError, match="velocities are rows of 2 or 3 components, one row a node \\(4\\); got the shape"):
            masses(wrong)


def test_views_cannot_be_written_into_and_outlive_their_run():
    run = unfurl.Scene("pendulum", set={"solver.end_time": 0.3}).run()
    x, energy = np.asarray(run.x), run.series["kinetic_energy_J"]
    with pytest.raises(ValueError):
        x[0, 0, 0] = 1.0
    before = x.copy(), energy.copy()
    del run
    gc.collect()
    [unfurl.Scene("pendulum", set={"solver.end_time": 0.3, "structure.angle": 20}).run() for _ in range(3)]
    assert np.array_equal(x, before[0]) and np.array_equal(energy, before[1])


def test_errors_are_unfurls_own_sentences():
    with pytest.raises(unfurl.SceneError, match="did you mean 'units'"):
        unfurl.Scene("hoop6", set={"structure.unit": 3})
    with pytest.raises(unfurl.UnreadableScene, match="did you mean 'hoop6'"):
        unfurl.Scene("hop6")
    with pytest.raises(unfurl.StudyError, match="no measure 'deploy_tme'; did you mean 'deploy_time'"):
        unfurl.Scene("hoop6").sweep({"structure.fold_angle": [30, 40]}, ["deploy_tme"])
    with pytest.raises(KeyError, match="no node 'B9'"):
        unfurl.Scene("pendulum", set={"solver.end_time": 0.1}).run().x["B9"]
    with pytest.raises(unfurl.StructureError, match="a rod names node 7; there are 0 to 1"):
        unfurl.Structure([[0, 0, 0], [1, 0, 0]], [[0, 7]])
    for fixed, said in (([5], "fixed names node 5; there are 0 to 1"), ([-1], "fixed names node -1"), ([0.0], "fixed are indices"),
                        ([True], "one True or False for each of 2 nodes")):
        with pytest.raises(unfurl.StructureError, match=said):
            unfurl.Structure([[0, 0, 0], [1, 0, 0]], [[0, 1]], fixed=fixed)
    for changed, said in (({"mass": [1, 2, 3]}, "mass is one number or one for each of 1 rods; got the shape \\(3,\\)"),
                          ({"mass": "heavy"}, "mass are no array of numbers: could not convert"),
                          ({"nodes": [[0, 0, 0], [1, 0]]}, "nodes are no array of numbers: "), ({"rods": [[0, 1], [0]]}, "rods are no array of numbers: "),
                          ({"nodes": [0, 1]}, "nodes are rows of 2 or 3 coordinates"), ({"rods": [0, 1]}, "rods are rows of two indices")):
        with pytest.raises(unfurl.StructureError, match=said):
            unfurl.Structure(**{"nodes": [[0, 0, 0], [1, 0, 0]], "rods": [[0, 1]], **changed})
    held = [unfurl.Structure([[0, 0], [1, 0]], [[0, 1]], fixed=f, gravity=(0, -10, 0), set={"solver.end_time": 0.3}).run().x["n0"]
            for f in ([0], np.array([True, False]))]
    assert (held[0] == held[1]).all() and (held[0] == 0).all()
    assert issubclass(unfurl.SceneError, unfurl.Error) and issubclass(unfurl.Error, ValueError)


def test_stepper_goes_through_events_and_gives_the_same_run():
    ring = unfurl.Scene("hoop6_sector", set={"solver.end_time": 6})
    stepper, times = ring.stepper(), []
    while stepper.step():
        times.append(stepper.t)
    assert stepper.status == "deployed" and stepper.events[-1][0] == "deployed"
    whole, stepped = ring.run(), stepper.finish()
    assert np.array_equal(whole.t, stepped.t) and np.array_equal(np.asarray(whole.x), stepped.x)
    assert np.array_equal(stepper.x, stepped.x[-1])


def test_a_stepper_ends_with_what_rods_stretch_and_with_the_warnings_of_the_start():
    soft = unfurl.Scene("hoop6", set={"structure.youngs_modulus": 7e8, "structure.rod_model": "quasi-static", "solver.end_time": 2})
    with pytest.warns(UserWarning, match="a stepper's x is that of rigid rods, until finish"):
        stepper = soft.stepper()
    while stepper.step():
        pass
    whole, stepped = soft.run(), stepper.finish()
    assert np.array_equal(np.asarray(whole.x), np.asarray(stepped.x)) and np.abs(stepped.x[-1] - stepper.x).max() > 1e-4
    assert "B0" in stepped.x and "X0" not in stepped.x and 3 not in stepped.x
    # Velocities along a rod are taken away, and it is said.
    rod = unfurl.Scene(text="[structure]\nkind = 'custom'\nnodes = [{name = 'A', position = [0, 0, 0], fixed = true}, "
                            "{name = 'B', position = [1, 0, 0], mass = 1, velocity = [0.5, 1, 0]}]\nrods = [{nodes = ['A', 'B'], mass = 0}]\n"
                            "[solver]\nend_time = 0.1\n")
    stepper = rod.stepper()
    assert any("were projected" in said for said in stepper.warnings)
    assert stepper.finish().warnings[:1] == rod.run().warnings[:1]


def test_ctrl_c_ends_a_stepper_on_its_way():
    stepper = unfurl.Scene("double_pendulum", set={"solver.step": 1e-5, "solver.end_time": 60}).stepper()
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        stepper.advance_to(60)
    reached = stepper.t
    assert 0 < reached < 60
    assert stepper.step() and stepper.t > reached


def test_forces_are_added_to_and_logged():
    mass = unfurl.Scene(text="[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'P'\nposition = [1, 0, 0]\nmass = 2\n"
                             "[solver]\nstep = 0.1\nend_time = 1\n")
    with mass.stepper() as stepper:
        stepper.force["P"] = [4, 0, 0]
        log = [stepper.force["P"]]
        stepper.step()  # to 0.2 m/s
        stepper.force["P"] += [2, 8, 0]
        log.append(stepper.force["P"])
        stepper.step()  # by 0.3, and 0.4 across
        assert np.abs(stepper.v[0] - [0.5, 0.4, 0]).max() < 1e-14
        assert np.array_equal(log, [[4, 0, 0], [6, 8, 0]])
        # A part that is set would be lost: it is a number that was asked for, and no memory of the stepper's.
        with pytest.raises(ValueError, match="read-only"):
            stepper.force["P"][2] = 5
        half = stepper.force["P"] / 2
        half[2] = 5
        mine = stepper.force["P"]
        mine -= [1, 1, 1]
        assert np.array_equal(half, [3, 4, 5]) and np.array_equal(mine, [5, 7, -1]) and np.array_equal(stepper.force["P"], [6, 8, 0])
        stepper.force["P"] *= 2
        stepper.force["P"] /= 4
        stepper.force["P"] -= [-3, 4, 0]
        assert np.array_equal(stepper.force["P"], [6, 0, 0])
        stepper.force["P"] = [6, 8, 0]
        with pytest.raises(unfurl.StudyError, match="three finite numbers"):
            stepper.force["P"] += np.nan
        assert stepper.step() and np.abs(stepper.v[0] - [0.8, 0.8, 0]).max() < 1e-14


def test_a_signal_handler_may_look_at_the_stepper():
    stepper = unfurl.Scene("double_pendulum", set={"solver.step": 1e-5, "solver.end_time": 3}).stepper()
    seen = []
    before = signal.signal(signal.SIGALRM, lambda *_: seen.append((stepper.t, stepper.x[1, 0])))
    signal.setitimer(signal.ITIMER_REAL, 0.15, 0.15)
    try:
        stepper.advance_to(1.0)
        assert seen and stepper.t == 1.0
        stepper.finish()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def test_forces_are_set_between_steps():
    # A free mass of 2 kg: the force of each step gives parabola after parabola.
    mass = unfurl.Scene(text="[structure]\nkind = 'custom'\n[[structure.nodes]]\nname = 'P'\nposition = [1, 0, 0]\nmass = 2\n"
                             "[solver]\nstep = 0.1\nend_time = 1\n")
    x, v = np.array([1.0, 0, 0]), np.zeros(3)
    with mass.stepper() as stepper:
        while stepper.t < 0.95:
            force = -3 * stepper.x[0] - 0.5 * stepper.v[0] + [0, stepper.t, 0]
            stepper.force["P"] = force
            assert np.array_equal(stepper.force[0], force)
            stepper.step()
            x, v = x + 0.1 * v + 0.0025 * force, v + 0.05 * force
            assert np.abs(stepper.x[0] - x).max() < 1e-13
        for key, error in ((None, TypeError), (1.5, TypeError), (b"P", TypeError), (-1, IndexError), (1, IndexError), (10**30, IndexError)):
            with pytest.raises(error):
                stepper.force[key]
        with pytest.raises(unfurl.StudyError, match="advances to a time"):
            stepper.advance_to(np.nan)
        with pytest.raises(KeyError):
            stepper.force["Q"] = [1, 0, 0]
        assert "P" in stepper.force and 0 in stepper.force and list(stepper.force) == ["P"]
        assert not any(key in stepper.force for key in ("Q", 1, -1, None, b"P", 10**30))
        with pytest.raises(ValueError):
            stepper.force["P"] = [np.nan, 0, 0]
        run = stepper.finish()
    assert np.abs(run.series["energy_balance_J"]).max() < 1e-13


def test_sweep_and_solve_agree_with_single_runs():
    # The method of the scene in both: a sweep would take the path, which knows no steps.
    ring = unfurl.Scene("hoop6_sector", set={"solver.step": 0.05, "solver.stages": 5, "solver.model": "full"})
    angles = np.array([40.0, 55.0, 70.0])
    table = ring.sweep({"structure.fold_angle": angles, "structure.hinge_force": [150, 300]}, ["deploy_time"], threads=2)
    assert table["outcome"] == ["deployed"] * 6
    one = unfurl.Scene("hoop6_sector", set={"solver.step": 0.05, "solver.stages": 5, "structure.fold_angle": 55, "structure.hinge_force": 300}).run()
    assert table["deploy_time_s"][3] == one.measure("deploy_time")
    # At rest, without gravity, time scales with the force as f^(-1/2).
    ratio = table["deploy_time_s"][0::2] / table["deploy_time_s"][1::2]
    assert np.abs(ratio - np.sqrt(2)).max() < 1e-6
    at_55 = unfurl.Scene("hoop6_sector", set={"solver.step": 0.05, "solver.stages": 5, "structure.fold_angle": 55})
    found = at_55.solve("structure.hinge_force", deploy_time=float(table["deploy_time_s"][2]), between=(100, 400))
    assert abs(found - 150) < 1e-5


def test_numbers_are_those_of_the_array():
    run = unfurl.Scene("double_pendulum", set={"solver.end_time": 0.1}).run()
    for i, name in enumerate(run.nodes):
        assert np.array_equal(run.x[:, i], run.x[name])
    # As NumPy 2 asks: what it calls a copy is one, which may be written into.
    mine = run.x.__array__(copy=True)
    mine[:] = 1
    assert not np.shares_memory(mine, run.x.array) and np.shares_memory(run.x.__array__(), run.x.array)
    assert run.x.__array__(np.float32, copy=True).dtype == np.asarray(run.x, dtype=np.float32).dtype == np.float32


def test_sweeps_take_words_truth_values_and_lists():
    swing = unfurl.Scene("pendulum", set={"solver.end_time": 0.1})
    table = swing.sweep({"solver.method": ["dvm", "rk4"], "solver.adaptive": [True, False]}, "final:kinetic_energy_J")
    assert table["outcome"] == ["completed"] * 4
    assert table["solver.method"] == ["dvm", "dvm", "rk4", "rk4"]
    assert table["solver.adaptive"] == ["true", "false"] * 2
    one = unfurl.Scene("pendulum", set={"solver.end_time": 0.1, "solver.method": "rk4"}).run()
    assert table["final_kinetic_energy_J"][3] == one.measure("final:kinetic_energy_J")
    bars = unfurl.Scene("hoop6", set={"solver.end_time": 0.05, "structure.units": 4, "structure.youngs_modulus": 7e10})
    table = bars.sweep({"structure.rod_model": ["quasi-static", "rigid"]}, "energy")
    assert table["structure.rod_model"] == ["quasi-static", "rigid"]
    pulls = [[0, 0, -1], (0, 0, -4)]
    table = swing.sweep({"gravity.acceleration": pulls}, ["energy"])
    for pull, energy in zip(pulls, table["energy_J"]):
        one = unfurl.Scene("pendulum", set={"solver.end_time": 0.1, "gravity.acceleration": pull})
        assert energy == one.run().measure("energy")
    pushed = unfurl.Scene("pendulum", set={"solver.end_time": 0.1, "loads": [{"nodes": ["*"], "force": [0, 0, -1]}]})
    loads = [{"nodes": ["*"], "force": [0.5, 0, k]} for k in (0, -2)]
    table = pushed.sweep({"loads[0]": loads}, ["energy"])
    for load, energy in zip(loads, table["energy_J"]):
        one = unfurl.Scene("pendulum", set={"solver.end_time": 0.1, "loads": [load]})
        assert energy == one.run().measure("energy")
    with pytest.raises(TypeError, match="None is no value of a scene"):
        swing.sweep({"solver.step": [None]}, "energy")
    with pytest.raises(unfurl.SceneError, match="must be a number"):  # which a text is not
        swing.sweep({"solver.step": ["0.01"]}, "energy")


def test_what_is_solved_for_tells_what_its_run_is_warned_of():
    square = unfurl.Structure([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2], [1, 3]], fixed=[0],
                              gravity=(0, -10, 0), set={"solver.end_time": 0.1, "solver.step": 0.01})
    with pytest.warns(RuntimeWarning, match="peak_rod_force is not unique there"):  # both diagonals
        square.solve("gravity.acceleration[1]", peak_rod_force=30)
    bob = unfurl.Structure([[0, 0], [1, 0]], [[0, 1]], fixed=[0], gravity=(0, -10, 0), set={"solver.end_time": 1})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        # A rod let go level passes the bottom at 3 g / l; the mean of its length is pulled by 3/2 m g.
        assert abs(bob.solve("structure.rods[0].mass", peak_tension=35) - 7 / 3) < 1e-5


def test_threads_run_at_once_and_agree():
    ring = unfurl.Scene("hoop6", set={"solver.end_time": 1, "solver.step": 0.0005})
    alone, results = np.asarray(ring.run().x), [None] * 2

    def work(i):
        results[i] = np.asarray(ring.run().x)

    threads = [threading.Thread(target=work, args=(i,)) for i in range(2)]
    ticks = []
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):  # this thread lives on: the lock is free
        ticks.append(time.monotonic())
        time.sleep(0.001)
    assert len(ticks) > 3
    assert all(np.array_equal(r, alone) for r in results)


def test_ctrl_c_ends_a_long_run():
    code = "import unfurl\nprint('ready', flush=True)\nunfurl.Scene('chain', set={'structure.links': 60, 'solver.end_time': 1000}).run()"
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    child.stdout.readline()
    time.sleep(1.0)
    begin = time.monotonic()
    child.send_signal(signal.SIGINT)
    _, err = child.communicate(timeout=20)
    assert "KeyboardInterrupt" in err
    assert time.monotonic() - begin < 5


def test_ten_thousand_runs_do_not_leak():
    # A run of a pendulum over three steps holds some 10 kB: a hundredth of it kept a run would be 1 MB in 10^4.
    scene = unfurl.Scene("pendulum", set={"solver.end_time": 0.03})
    for _ in range(1000):
        scene.run()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for _ in range(10000):
        scene.run()
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 4096  # [kB]


@pytest.mark.parametrize("script", sorted((Path(__file__).parents[2] / "assets/examples/python").glob("*.py")), ids=lambda p: p.name)
def test_examples_run(script, tmp_path):
    done = subprocess.run([sys.executable, script], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout


@pytest.mark.parametrize("notebook", sorted((Path(__file__).parents[2] / "assets/examples/python").glob("*.ipynb")), ids=lambda p: p.name)
def test_notebooks_run(notebook, tmp_path, monkeypatch):
    """Every cell, and what a notebook would show of its last line."""
    monkeypatch.chdir(tmp_path)
    shown, names = 0, {}
    for cell in json.loads(notebook.read_text())["cells"]:
        if cell["cell_type"] != "code":
            continue
        assert cell["outputs"] == [], "committed without outputs"
        *body, last = ast.parse("".join(cell["source"])).body
        if not isinstance(last, ast.Expr):
            body, last = [*body, last], None
        exec(compile(ast.Module(body, []), notebook.name, "exec"), names)
        if last is None:
            continue
        value = eval(compile(ast.Expression(last.value), notebook.name, "eval"), names)
        picture = getattr(value, "_repr_svg_", None) or getattr(value, "_repr_html_", None) or (lambda: repr(value))
        shown += picture() not in ("", "None")
    assert shown >= 3


def test_stubs_name_what_is_there():
    folder = Path(unfurl.__file__).parent
    assert (folder / "py.typed").exists()
    told = {}
    for node in ast.parse((folder / "_unfurl.pyi").read_text()).body:
        if isinstance(node, ast.ClassDef):
            told[node.name] = {m.name if isinstance(m, ast.FunctionDef) else m.target.id for m in node.body
                               if isinstance(m, (ast.FunctionDef, ast.AnnAssign))}
        elif isinstance(node, ast.FunctionDef):
            told[node.name] = set()
        elif isinstance(node, ast.AnnAssign):
            told[node.target.id] = set()
    there = {name: value for name, value in vars(unfurl._unfurl).items() if not name.startswith("__") or name == "__version__"}
    assert set(told) == set(there)
    for name, value in there.items():
        if isinstance(value, type) and not issubclass(value, Exception):
            public = {m for m in vars(value) if not m.startswith("_")}
            assert {m for m in told[name] if not m.startswith("_")} == public, name


def test_pictures_and_files(tmp_path):
    run = unfurl.Scene("hoop6_sector", set={"solver.end_time": 0.2, "render.size": [96, 64]}).run()
    run.plot("energy", tmp_path / "energy.svg")
    assert (tmp_path / "energy.svg").read_text().startswith("<?xml")
    assert "<svg" in run.plot("energy")._repr_svg_()
    run.frame(0.1, tmp_path / "frame.png")
    assert (tmp_path / "frame.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    run.export("npy", tmp_path)
    assert np.array_equal(np.load(tmp_path / "npy/positions_m.npy"), np.asarray(run.x))
    assert "viewer" in run._repr_html_() or "srcdoc" in run._repr_html_()
    with pytest.raises(unfurl.StudyError, match="no figure 'enrgy' of this run; did you mean 'energy'"):
        run.plot("enrgy", tmp_path / "x.svg")
    assert unfurl.scenes() and "deploy_time" in unfurl.measures()


def pixels(path):
    """Of a PNG without interlacing: what its header says, and its bytes with the filters undone (numpy, [rows, columns, channels])."""
    data, at, packed = Path(path).read_bytes(), 8, b""
    while at < len(data):
        length = int.from_bytes(data[at:at + 4], "big")
        kind, body = data[at + 4:at + 8], data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, color = int.from_bytes(body[:4], "big"), int.from_bytes(body[4:8], "big"), body[9]
        packed += body if kind == b"IDAT" else b""
        at += length + 12
    channels = {2: 3, 6: 4}[color]
    rows = np.frombuffer(zlib.decompress(packed), dtype=np.uint8).reshape(height, 1 + width * channels)
    out = np.zeros((height + 1, width + 1, channels), dtype=int)
    for y in range(height):
        line = rows[y, 1:].reshape(width, channels).astype(int)
        for x in range(width):
            left, up, corner = out[y + 1, x], out[y, x + 1], out[y, x]
            guess = left + up - corner
            a, b, c = abs(guess - left), abs(guess - up), abs(guess - corner)
            paeth = np.where((a <= b) & (a <= c), left, np.where(b <= c, up, corner))
            out[y + 1, x + 1] = (line[x] + [0, left, up, (left + up) // 2, paeth][rows[y, 0]]) % 256
    return out[1:, 1:]


@pytest.mark.parametrize("more", [{"render.supersample": 2}, {"render.transparent": True}, {"render.look": "blueprint", "render.fit": True},
                                  {"render.motion_blur": 0.5, "render.depth_of_field": 0.05}, {"render.orbit": 40, "render.hold_start": 0.1}],
                         ids=lambda more: "+".join(more))
def test_a_frame_is_that_of_the_film(tmp_path, more):
    changes = {"solver.end_time": 0.2, "render.size": [64, 48], "render.fps": 20, "render.hold": 0, **more}
    sets = [word for key, value in changes.items() for word in ("--set", f"{key}={json.dumps(value)}")]
    subprocess.run([PROGRAM, "render", "hoop6_sector", "-o", tmp_path / "out", "--quiet", "--dpi", "60", *sets], check=True)
    run = unfurl.Scene("hoop6_sector", set=changes).run()
    first = 2 if "render.hold_start" in more else 0  # 0.1 s of film at rest
    for k in (0, 2, 4):  # at 0, 0.1 and 0.2 s
        run.frame(0.05 * k, tmp_path / "frame.png")
        film = pixels(tmp_path / f"out/frames/frame_{first + k:05d}.png")
        assert np.array_equal(pixels(tmp_path / "frame.png"), film)


def test_what_a_person_can_mend_is_an_error_of_unfurl(tmp_path):
    run = unfurl.Scene("hoop6_sector", set={"solver.end_time": 0.2}).run()
    with pytest.raises(unfurl.StudyError, match="a figure is written as .png, .svg or .pdf, not '.bmp'"):
        run.plot("energy", tmp_path / "g.bmp")
    with pytest.raises(unfurl.StudyError, match="no style 'slides'; did you mean 'slide'\\?"):
        run.plot("energy", tmp_path / "g.pdf", style="slides")
    for threads in (0, -3, 1025):
        with pytest.raises(unfurl.StudyError, match=f"threads: must be a whole number from 1 to 1024; got {threads}"):
            unfurl.Scene("hoop6_sector").sweep({"structure.fold_angle": [40, 50]}, "deploy_time", threads=threads)
    with pytest.raises(unfurl.StudyError, match="a frame is written as .png, not '.jpg'"):
        run.frame(0.1, tmp_path / "g.jpg")
    (tmp_path / "file").write_text("")
    with pytest.raises(unfurl.FileError, match="file/below: not a directory"):
        run.export("html", tmp_path / "file/below")
    for t in (100, -0.1, float("nan")):
        with pytest.raises(IndexError, match="is not within the run"):
            run.frame(t, tmp_path / "g.png")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_an_array_of_no_dimension_is_a_value():
    for end in (np.array(0.25), np.float64(0.25), np.asarray([0.25, 1])[0]):
        assert unfurl.Scene("pendulum", set={"solver.end_time": end}).text == unfurl.Scene("pendulum", set={"solver.end_time": 0.25}).text


def test_any_text_is_a_value():
    for title in ("\U0001F600 x", "a\x7fb", "\u00e9 \\ \" \t \x01", "\U0010FFFF"):
        assert unfurl.Scene("pendulum", set={"title": title}).title == title


def test_a_stepper_is_read_in_one_thread_while_another_steps_it():
    stepper = unfurl.Scene("pendulum", set={"solver.end_time": 0.4, "solver.step": 1e-5}).stepper()
    done, seen = threading.Event(), []

    def read():
        while not done.is_set():
            x, t = stepper.x, stepper.t
            seen.append((t, float(np.linalg.norm(x[-1])), stepper.status, len(stepper.events), len(stepper.warnings)))

    readers = [threading.Thread(target=read) for _ in range(3)]
    for reader in readers:
        reader.start()
    while stepper.step():
        pass
    done.set()
    for reader in readers:
        reader.join()
    assert all(0 <= t <= 0.4 for t, *_ in seen) and len(seen) > 10


def test_a_stepper_says_how_far_it_is_and_gives_a_run_as_a_scene_does():
    stepper = unfurl.Scene("pendulum", set={"solver.end_time": 0.2}).stepper()
    assert isinstance(stepper, unfurl.Stepper) and stepper.status == "running"
    stepper.step()
    assert stepper.status == "running"
    early = stepper.finish()
    assert early.status == "stopped"
    while stepper.step():
        pass
    assert stepper.status == "completed"
    run = stepper.finish()
    assert isinstance(run, unfurl.Run) and len(early.t) == 2 and len(run.t) == 21
    assert run.summary["final"]["t_s"] == 0.2 and run.rod_force.shape == (21, len(run.rods))
    assert np.array_equal(run.x[run.nodes[-1]][-1], stepper.x[-1])


def test_work_on_a_run_leaves_other_threads_alone(tmp_path):
    run = unfurl.Scene("hoop6", set={"solver.step": 0.002, "render.size": [640, 480]}).run()
    stepper = unfurl.Scene("hoop6", set={"solver.step": 0.002}).stepper()
    stepper.advance_to(4.0)
    work = {"frame": lambda: run.frame(1.0, tmp_path / "a.png"), "plot": lambda: run.plot("poses", tmp_path / "b.png"),
            "export": lambda: run.export("html", tmp_path), "finish": stepper.finish}
    for name, call in work.items():
        thread, ticks = threading.Thread(target=call), [time.monotonic()]
        thread.start()
        while thread.is_alive():
            ticks.append(time.monotonic())
            time.sleep(0.001)
        # With the lock held there would be one tick or two, whatever the machine does besides; the work takes 0.1 s and more.
        assert len(ticks) > 10, name


def test_threads_may_use_one_run(tmp_path):
    run = unfurl.Scene("hoop6_sector", set={"solver.end_time": 1, "render.size": [96, 64]}).run()
    alone = np.array([run.at(t) for t in np.linspace(0, 1, 50)])
    results = [None] * 3

    def work(i):
        run.plot("energy", tmp_path / f"{i}.png")
        run.frame(0.1 * i, tmp_path / f"f{i}.png")
        results[i] = np.array([run.at(t) for t in np.linspace(0, 1, 50)])

    threads = [threading.Thread(target=work, args=(i,)) for i in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(r, alone) for r in results)
    assert (tmp_path / "0.png").read_bytes() == (tmp_path / "2.png").read_bytes()


def test_ctrl_c_ends_a_large_sweep():
    code = ("import unfurl\ns = unfurl.Scene('hoop6_sector')\nprint('ready', flush=True)\n"
            "s.sweep({'structure.fold_angle': [40 + 1e-3 * i for i in range(30000)]}, ['peak_rod_force'])")
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    child.stdout.readline()
    time.sleep(1.0)
    begin = time.monotonic()
    child.send_signal(signal.SIGINT)
    _, err = child.communicate(timeout=60)
    assert "KeyboardInterrupt" in err
    assert time.monotonic() - begin < 5


def parallelogram(**changes):
    """Cranks of 0.5 m at 0.3 rad that turn at 2 rad/s, without gravity: they go on doing so, through both poses in one line."""
    angle, rate, crank = 0.3, 2.0, 0.5
    along, across = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    ends = [[0, 0], [1, 0], crank * along, [1, 0] + crank * along]
    speeds = [[0, 0], [0, 0], rate * crank * across, rate * crank * across]
    return unfurl.Structure(ends, [[0, 2], [2, 3], [1, 3]], fixed=[0, 1], velocities=speeds,
                            set={"solver.end_time": 3.5, "solver.stages": 5, "solver.step": 0.02, **changes})


def test_singular_poses_are_among_the_events(tmp_path):
    # In one line at (k pi - 0.3) / 2 s. The poses are states of order 10 to round-off; a dip is located to some 1e-9 s.
    scene = parallelogram()
    stepper = scene.stepper()
    while stepper.step():
        pass
    for run in (scene.run(), stepper.finish()):
        assert [name for name, _ in run.events] == ["singular pose"] * 2
        assert np.abs([t - (k * np.pi - 0.3) / 2 for k, (_, t) in enumerate(run.events, 1)]).max() < 1e-8
        assert [(event["name"], event["t_s"]) for event in run.summary["events"]] == run.events
    (tmp_path / "scene.toml").write_text(scene.text)
    subprocess.run([PROGRAM, "run", tmp_path / "scene.toml", "-o", tmp_path / "out", "--quiet"], check=True)
    assert json.load(open(tmp_path / "out/summary.json"))["events"] == run.summary["events"]


def test_solve_takes_the_model_that_the_program_takes():
    # Both bracket in the same way with runs that are the same to the bit, so the answers are.
    asked = [PROGRAM, "solve", "hoop6_sector", "--find", "structure.fold_angle", "--target", "deploy_time=4.92", "--quiet"]
    found = subprocess.run(asked, check=True, capture_output=True, text=True).stdout
    ring = unfurl.Scene("hoop6_sector")
    assert found == f"structure.fold_angle = {ring.solve('structure.fold_angle', deploy_time=4.92)!r}\n"
    # The method's own key: full, as there. What the scene says goes first.
    full = unfurl.Scene("hoop6_sector", set={"solver.model": "full"})
    assert found != f"structure.fold_angle = {full.solve('structure.fold_angle', deploy_time=4.92)!r}\n"


def test_solve_refuses_what_the_program_refuses():
    ring = unfurl.Scene("hoop6_sector")
    with pytest.raises(unfurl.SceneError, match="did you mean 'fold_angle'"):
        ring.solve("structure.fold_angl", deploy_time=4.92)
    with pytest.raises(unfurl.SceneError, match="structure.fold_angle"):
        ring.solve("structure.fold_angle", deploy_time=4.92, between=(-1000, 80))
    with pytest.raises(unfurl.StudyError, match="a target is a finite number; got nan"):
        unfurl.Scene("hoop6").solve("structure.hinge_force", deploy_time=float("nan"))
    with pytest.raises(unfurl.StudyError, match="takes whole numbers"):
        ring.solve("structure.units", deploy_time=4.92)
    # A range is looked in or refused: a search from the scene's own value would find one outside it.
    for between in ((80, 70), (80, 80), (0, 0), (70, float("nan"))):
        with pytest.raises(unfurl.StudyError, match="between is \\(low, high\\) with low < high; got "):
            ring.solve("structure.fold_angle", deploy_time=4.92, between=between)


def test_what_never_deploys_is_infinite_as_in_the_table(tmp_path):
    # Drawn in, the ring moves away from its deployed pose. JSON has no infinity.
    ring = unfurl.Scene("hoop6_sector", set={"solver.end_time": 1.0})
    table = ring.sweep({"structure.hinge_force": [-10, -20]}, ["deploy_time"], out=tmp_path)
    assert np.isinf(table["deploy_time_s"]).all()
    assert [row["deploy_time_s"] for row in csv.DictReader(open(tmp_path / "sweep.csv"))] == ["inf", "inf"]
    run = ring.run(set={"structure.hinge_force": -10})
    assert run.measure("deploy_time") == np.inf and run.summary["measures"]["deploy_time_s"] is None


def test_a_stepper_says_what_it_does_not_do():
    idle = {"solver.model": "path", "solver.tolerance": 1e-9, "solver.end_time": 0.2}
    with pytest.warns(UserWarning) as told:
        stepper = unfurl.Scene("hoop6", set=idle).stepper()
    said = ['solver.model = "path" does nothing here: a stepper steps the whole model',
            "solver.tolerance does nothing here: a stepper takes the stages and the step as they are"]
    assert [str(warning.message) for warning in told] == said == stepper.warnings
    stepper.step()
    run = stepper.finish()
    assert run.warnings[:2] == said
    assert run.summary["model"]["solved_as"] == "full" and run.summary["model"]["why"] == "a stepper steps the whole model"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for model in ("full", "auto"):  # what "auto" takes is up to the program
            stepper = unfurl.Scene("hoop6", set={"solver.model": model, "solver.end_time": 0.2}).stepper()
            assert not stepper.warnings


def frames_of(path):
    """What a film shows, without what it says of itself."""
    data = Path(path).read_bytes()
    if path.suffix == ".webp":
        at, frames = 12, []
        while at < len(data):
            size = int.from_bytes(data[at + 4:at + 8], "little")
            frames += [data[at:at + 8 + size]] if data[at:at + 4] == b"ANMF" else []
            at += 8 + size + size % 2
        return frames
    if path.suffix == ".gif":
        begin = data.find(b"\x21\xfe")
        end = begin + 2 if begin >= 0 else 0
        while end > 0 and data[end]:
            end += 1 + data[end]
        return data[:begin] + data[end + 1:] if begin >= 0 else data
    return subprocess.run(["ffmpeg", "-v", "error", "-i", path, "-f", "framemd5", "-"], check=True, capture_output=True).stdout


@pytest.mark.parametrize("more", [{}, {"render.supersample": 2, "render.hold_start": 0.2}], ids=["plain", "more"])
def test_a_film_is_that_of_the_program(tmp_path, more):
    changes = {"solver.end_time": 0.4, "render.size": [64, 48], "render.fps": 10, "render.gif_width": 40, **more}
    sets = [word for key, value in changes.items() for word in ("--set", f"{key}={json.dumps(value)}")]
    subprocess.run([PROGRAM, "render", "hoop6_sector", "-o", tmp_path / "out", "--quiet", "--dpi", "60", *sets], check=True)
    run = unfurl.Scene("hoop6_sector", set=changes).run()
    for kind in (".webp", ".gif") + ((".mp4",) if shutil.which("ffmpeg") else ()):
        run.film(tmp_path / f"film{kind}")
        frames = frames_of(tmp_path / f"film{kind}")
        assert len(frames) > 4 and frames == frames_of(tmp_path / f"out/animation{kind}"), kind


def test_films_that_cannot_be_made(tmp_path, monkeypatch):
    run = unfurl.Scene("hoop6_sector", set={"solver.end_time": 0.2, "render.size": [64, 48]}).run()
    with pytest.raises(unfurl.StudyError, match="a film is written as .mp4, .webp or .gif, not '.avi'"):
        run.film(tmp_path / "film.avi")
    with pytest.raises(unfurl.FileError):
        run.film(tmp_path / "none/film.gif")
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(unfurl.FileError, match="ffmpeg"):
        run.film(tmp_path / "film.mp4")
    assert not list(tmp_path.iterdir())


def test_ctrl_c_ends_a_long_film(tmp_path):
    code = ("import sys, unfurl\nrun = unfurl.Scene('hoop6', set={'render.fps': 1000, 'render.size': [64, 48]}).run()\n"
            "print('ready', flush=True)\nrun.film(sys.argv[1])")
    child = subprocess.Popen([sys.executable, "-c", code, tmp_path / "film.webp"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    child.stdout.readline()
    time.sleep(1.0)
    child.send_signal(signal.SIGINT)
    _, err = child.communicate(timeout=60)
    assert "KeyboardInterrupt" in err
    assert not list(tmp_path.iterdir())


def test_ctrl_c_ends_exports_plots_and_frames(tmp_path):
    """Each takes half a second and more; a signal comes after a twentieth."""
    run = unfurl.Scene("hoop6", set={"structure.units": 24, "solver.step": 0.0003, "render.fps": 1000, "render.size": [1280, 720],
                                     "render.depth_of_field": 0.05}).run()

    def stop(*_):
        raise KeyboardInterrupt

    files = {"vtk": "vtk/hoop6.pvd", "csv": "csv/nodes.csv", "npy": "npy/t_s.npy", "mat": "run.mat",
             "gltf": "animation.glb", "html": "viewer.html"}
    works = {file: (lambda kind=kind: run.export(kind, tmp_path)) for kind, file in files.items()}
    works["plot.svg"] = lambda: run.plot("rod_forces", tmp_path / "plot.svg")
    works["frame.png"] = lambda: run.frame(1.0, tmp_path / "frame.png")
    before = signal.signal(signal.SIGALRM, stop)
    try:
        for file, work in works.items():
            signal.setitimer(signal.ITIMER_REAL, 0.05)
            with pytest.raises(KeyboardInterrupt):
                work()
            assert not (tmp_path / file).exists(), file
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert unfurl.Scene("pendulum", set={"solver.end_time": 0.1}).run().plot("energy").startswith("<?xml")  # and others go on


def test_letters_that_no_font_has_are_warned_of(tmp_path):
    run = unfurl.Scene("hoop6_sector", set={"solver.end_time": 0.1, "title": "\u6e2c\u8a66", "render.size": [320, 180]}).run()
    for _ in range(2):  # of each picture that lacks them
        with pytest.warns(RuntimeWarning, match="DejaVu Sans has no \u6e2c, \u8a66: pictures and figures show signs") as told:
            run.frame(0.05, tmp_path / "frame.png")
        assert [w.filename for w in told] == [__file__]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run.plot("energy", tmp_path / "energy.svg")  # has all letters
        unfurl.Scene("pendulum", set={"solver.end_time": 0.1, "render.size": [320, 180]}).run().frame(0.05, tmp_path / "frame.png")


def test_a_study_is_that_of_the_program(tmp_path):
    asked = ["--steps", "0.08:0.02", "--methods", "rk4_projected", "--repeats", "1", "--set", "solver.end_time=0.8"]
    subprocess.run([PROGRAM, "study", "pendulum", "-o", tmp_path / "out", "--quiet", *asked], check=True)
    with open(tmp_path / "out/study.csv") as file:
        rows = list(csv.DictReader(file))
    pendulum = unfurl.Scene("pendulum", set={"solver.end_time": 0.8})
    study = pendulum.study((0.08, 0.02), methods=["rk4_projected"], repeats=1)
    assert list(study) == list(rows[0])
    assert study["setting"] == [row["setting"] for row in rows]
    for name in ("steps", "position_error_m"):  # costs differ from time to time
        assert np.array_equal(study[name], [float(row[name]) for row in rows])
    assert study.sentence.startswith("The cheapest setting for 0.001 m is ") and study.reference
    with pytest.raises(unfurl.StudyError, match="did you mean 'rk4_projected'"):
        pendulum.study(methods=["rk4_projectd"])
    for steps in ((0.01, 0.08), (-0.08, 0.01), (0.08, float("nan")), (0, 0)):
        with pytest.raises(unfurl.StudyError):
            pendulum.study(steps)
    with pytest.warns(UserWarning, match="solver.model does nothing here: every method steps the whole model"):
        unfurl.Scene("pendulum", set={"solver.end_time": 0.8, "solver.model": "path"}).study((0.08, 0.04), ["rk4_projected"], 1)


def test_a_sweep_keeps_its_points(tmp_path):
    asked = ["--vary", "structure.fold_angle=40,55,70", "--measure", "deploy_time"]
    subprocess.run([PROGRAM, "sweep", "hoop6_sector", "-o", tmp_path / "shell", "--quiet", *asked], check=True)
    ring, folder = unfurl.Scene("hoop6_sector"), tmp_path / "points"
    table = ring.sweep({"structure.fold_angle": [40, 55, 70]}, ["deploy_time"], out=folder)
    kept = (folder / "sweep.csv").read_text()
    assert kept == (tmp_path / "shell/sweep.csv").read_text()
    # A point that is there is not computed again, one that is not is.
    head, first, *rest = kept.splitlines(keepends=True)
    (folder / "sweep.csv").write_text(head + first.replace(repr(float(table["deploy_time_s"][0])), "123.25"))
    again = ring.sweep({"structure.fold_angle": [40, 55, 70]}, ["deploy_time"], out=folder)
    assert again["deploy_time_s"][0] == 123.25 and np.array_equal(again["deploy_time_s"][1:], table["deploy_time_s"][1:])
    # What no run leaves is computed anew, and told.
    (folder / "sweep.csv").write_text(head + first.replace("deployed", "banana") + "".join(rest))
    with pytest.warns(RuntimeWarning, match="line 2 is no finished result and is computed anew"):
        anew = ring.sweep({"structure.fold_angle": [40, 55, 70]}, ["deploy_time"], out=folder)
    assert np.array_equal(anew["deploy_time_s"], table["deploy_time_s"])
    for other, measure in ((unfurl.Scene("hoop6_sector", set={"structure.hinge_force": 200}), "deploy_time"), (ring, "peak_energy")):
        with pytest.raises(unfurl.FileError):
            other.sweep({"structure.fold_angle": [40, 55, 70]}, [measure], out=folder)
    with pytest.raises(unfurl.FileError, match="1 result that is not asked for now and would be lost; ask for them, too"):
        ring.sweep({"structure.fold_angle": [40, 55]}, ["deploy_time"], out=folder)
    assert len((folder / "sweep.csv").read_text().splitlines()) == 4


def test_tables_of_other_packages(monkeypatch):
    run = unfurl.Scene("pendulum", set={"solver.end_time": 0.1}).run()
    for name in ("xarray", "pandas"):
        monkeypatch.setitem(sys.modules, name, None)  # not installed
        with pytest.raises(ImportError, match=f"to_{name}\\(\\) needs the Python package {name}"):
            getattr(run, f"to_{name}")()
    monkeypatch.setitem(sys.modules, "xarray", types.SimpleNamespace(Dataset=lambda data, coords, attrs: (data, coords, attrs)))
    data, coords, _ = run.to_xarray()
    sizes = {name: len(values) for name, values in coords.items()}
    for dimensions, values in data.values():
        assert values.shape == tuple(sizes[name] for name in dimensions)
    assert data["x_m"][1] is run.x.array and data["kinetic_energy_J"][0] == ("t_s",)


def test_what_python_writes_carries_its_receipt(tmp_path):
    ring = unfurl.Scene("hoop6_sector", set={"solver.end_time": 0.2, "render.size": [64, 48], "render.fps": 10})
    run = ring.run()
    for kind in ("svg", "pdf", "png"):
        run.plot("energy", tmp_path / f"plot.{kind}")
    run.frame(0.1, tmp_path / "frame.png")
    for kind in ("webp", "gif") + (("mp4",) if shutil.which("ffmpeg") else ()):
        run.film(tmp_path / f"film.{kind}")
    run.export("gltf", tmp_path)
    run.export("html", tmp_path)
    files = sorted(tmp_path.iterdir())
    assert len(files) >= 8
    for file in files:
        whole = subprocess.run([PROGRAM, "verify", file], capture_output=True, text=True)
        assert whole.returncode == 0 and "Python, hoop6_sector: run()." in whole.stdout, (file, whole.stderr)
        again = subprocess.run([PROGRAM, "reproduce", file], capture_output=True, text=True)
        assert again.returncode == 5 and "was made by Python, hoop6_sector: run()." in again.stderr
        data = bytearray(file.read_bytes())
        data[len(data) // 3] ^= 1
        (tmp_path / ("changed" + file.suffix)).write_bytes(data)
        changed = subprocess.run([PROGRAM, "verify", tmp_path / ("changed" + file.suffix)], capture_output=True)
        assert changed.returncode in (5, 7)  # 5 where the byte is one of the receipt itself
    note = json.loads(re.search(r'\{"unfurl_receipt".*\}(?=<)', (tmp_path / "plot.svg").read_text())[0])
    assert note["command"] == ["python", "hoop6_sector", 'run().plot("energy", style="screen")']
    assert note["scene"] == ring.text and note["unfurl"] == unfurl.__version__
    assert note["errors"]["energy_balance_J"] == np.abs(run.series["energy_balance_J"]).max()
    # Forces that were set between steps are in no scene: it is said that there were some.
    stepper = ring.stepper()
    stepper.force[0] = [0, 0, 1]
    stepper.step()
    assert "with forces set between steps" in stepper.finish().plot("energy")
