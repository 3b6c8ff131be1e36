#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Reads exports with programs that we did not write: numpy, meshio, vtk, the Khronos glTF validator.

    python3 tests/support/check_exports.py build/release/unfurl [folder with node_modules/gltf-validator]

Needs python3-numpy, python3-meshio, python3-vtk9; `npm install gltf-validator` for the glTF part.
"""
import csv
import glob
import json
import re
import subprocess
import sys
import tempfile

import meshio
import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

folder = tempfile.TemporaryDirectory(prefix="unfurl_exports_")
out = folder.name
subprocess.run([sys.argv[1], "run", "hoop6", "-o", out, "--quiet", "--export", "vtk,gltf,csv,npy,mat,html"], check=True)
table = list(csv.reader(open(f"{out}/trajectory.csv")))
names = [h[:-4] for h in table[0] if h.endswith(".x_m")]
numbers = np.array(table[1:], dtype=float)
t, states = numbers[:, 0], numbers[:, 1:].reshape(len(numbers), len(names), 6)
rods = list(csv.reader(open(f"{out}/rod_forces.csv")))
forces = np.array(rods[1:], dtype=float)[:, 1:]
count = sum(h.endswith(".axial_force_N") for h in rods[0])
forces, unique = forces[:, :count], forces[:, count:] != 0
assert [h.removesuffix("_N") for h in rods[0][1:1 + count]] == [h.removesuffix("_unique") for h in rods[0][1 + count:]]

# numpy: the same bits as the tables.
load = lambda name: np.load(f"{out}/npy/{name}.npy")
assert np.array_equal(load("t_s"), t)
assert np.array_equal(load("positions_m"), states[:, :, :3])
assert np.array_equal(load("velocities_m_s"), states[:, :, 3:])
assert np.array_equal(load("axial_forces_N"), forces, equal_nan=True)
assert np.array_equal(load("axial_forces_unique"), unique)
ends = load("rod_nodes")
assert ends.shape == (forces.shape[1], 2)
print("npy: equal to trajectory.csv, bit for bit")

# VTK's own reader and meshio: every tenth state, and the PVD's times.
files = sorted(glob.glob(f"{out}/vtk/*.vtu"))
assert len(files) == len(t)
for i in range(0, len(t), 10):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(files[i])
    reader.Update()
    grid = reader.GetOutput()
    assert np.array_equal(vtk_to_numpy(grid.GetPoints().GetData()), states[i, :, :3])
    assert np.array_equal(vtk_to_numpy(grid.GetPointData().GetArray("velocity_m_s")), states[i, :, 3:])
    assert np.array_equal(vtk_to_numpy(grid.GetCellData().GetArray("axial_force_N")), forces[i], equal_nan=True)
    assert np.array_equal(vtk_to_numpy(grid.GetCellData().GetArray("axial_force_unique")) != 0, unique[i])
    assert grid.GetFieldData().GetArray("TimeValue").GetValue(0) == t[i]
    for r in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(r)
        assert [cell.GetPointId(0), cell.GetPointId(1)] == list(ends[r]) and cell.GetCellType() == 3
    text = lambda row: bytes(row).rstrip(b"\0").decode()
    names = [text(row) for row in vtk_to_numpy(grid.GetPointData().GetArray("name"))]
    rods = [text(row) for row in vtk_to_numpy(grid.GetCellData().GetArray("name"))]
    assert "B0" in names and len(set(names)) == len(names) and len(set(rods)) == len(rods)
    mesh = meshio.read(files[i])
    assert [text(row) for row in mesh.point_data["name"]] == names
    assert [text(row) for row in mesh.cell_data["name"][0]] == rods
    assert np.array_equal(mesh.points, states[i, :, :3])
    assert np.array_equal(mesh.cells_dict["line"], ends)
import xml.etree.ElementTree as xml

(pvd,) = glob.glob(f"{out}/vtk/*.pvd")
sets = xml.parse(pvd).getroot().findall("Collection/DataSet")
assert [float(s.get("timestep")) for s in sets] == list(t)
print(f"vtu: {len(files)} states read by VTK {vtk.vtkVersion().GetVTKVersion()} and meshio {meshio.__version__}")

# csv, long form.
long = list(csv.DictReader(open(f"{out}/csv/nodes.csv")))
assert len(long) == len(t) * len(names)
assert float(long[len(names)]["t_s"]) == t[1] and long[-1]["node"] == names[-1]
print("csv: complete")

# Octave: the same bits.
script = f"""
r = load('{out}/run.mat'); t = dlmread('{out}/trajectory.csv', ',', 1, 0); f = dlmread('{out}/rod_forces.csv', ',', 1, 0);
n = numel(r.node_names); m = numel(r.rod_names);
assert(isequal(size(r.positions_m), [rows(t) n 3])); assert(isequal(r.t_s, t(:, 1)));
for k = 1:n
  assert(isequal(squeeze(r.positions_m(:, k, :)), t(:, 6*k-4:6*k-2))); assert(isequal(squeeze(r.velocities_m_s(:, k, :)), t(:, 6*k-1:6*k+1)));
end
assert(isequal(r.axial_forces_N, f(:, 2:m+1))); assert(islogical(r.axial_forces_unique));
assert(isequal(double(r.axial_forces_unique), f(:, m+2:2*m+1)));
a = squeeze(r.positions_m(1, r.rod_nodes(1, 1), :)); b = squeeze(r.positions_m(1, r.rod_nodes(1, 2), :));
s = dlmread('{out}/series.csv', ',', 1, 1); assert(isequaln(r.series, s)); assert(columns(s) == numel(r.series_names));
printf('%s %s %.12g', r.node_names{{1}}, r.rod_names{{1}}, norm(a - b));
"""
done = subprocess.run(["octave-cli", "--quiet", "--no-init-file", "--eval", script], capture_output=True, text=True)
assert done.returncode == 0, done.stderr
node, rod, length = done.stdout.split()
assert node == names[0] and abs(float(length) - 3) < 1e-11, done.stdout  # a chord of the paper's ring is 3 m
print("mat: equal to the tables in Octave, bit for bit")

def dom(file, time, gl=("--disable-gpu", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"), there=r"at pixel -?\d"):
    for _ in range(5):  # on a busy machine it may be told before the page's script, which is in it, has run
        page = subprocess.run(
            ["chromium", "--headless", "--no-sandbox", *gl,
             "--window-size=1000,700", "--virtual-time-budget=4000", "--dump-dom", f"file://{file}#t={time}&positions"],
            capture_output=True, text=True, timeout=90).stdout
        if re.search(there, page):
            break
    return page


# A browser: node positions that the page's own interpolation shows between two frames.
page = dom(f"{out}/viewer.html", 4.5)
i = int(np.searchsorted(t, 4.5))
assert abs(t[i] - 4.5) < 1e-12
shown = {name: numbers for name, *numbers in re.findall(r"(?:^|>)([^<>\s]+) (\S+) (\S+) (\S+)   at pixel \d", page, re.M)}
assert set(shown) == set(names)
# A cubic through frames 1/30 s apart of a motion that takes 5 s: h^4 / 100 of its fourth derivative, below a pixel of 1 cm by far.
worst = max(np.abs(np.array(shown[name], dtype=float) - states[i, k, :3]).max() for k, name in enumerate(names))
assert worst < 1e-4, worst
print(f"html: in Chromium, nodes within {worst:.1e} m")

# Marks of events stand below the slider's thumb at their times; browsers have thumbs 16 pixels wide.
with open(f"{out}/viewer.html") as page, open(f"{out}/marks.html", "w") as probe:
    probe.write(page.read().replace("</body>", """<p id="probe"></p><script>
const track = $("scrub").getBoundingClientRect(), off = data.events.map(({ t }) => {
  const at = track.left + 8 + (track.width - 16) * (t - data.start) / span;
  return Math.min(...marks.map(({ mark }) => mark.getBoundingClientRect()).map(r => Math.min(Math.abs(r.left + 1 - at), Math.abs(r.right - 1 - at)))); });
$("probe").textContent = off.length + " marks off by " + Math.max(...off);
</script></body>"""))
marks = re.search(r">(\d+) marks off by ([-0-9.e]+)<", dom(f"{out}/marks.html", 4.5))
assert marks and int(marks[1]) > 0 and float(marks[2]) <= 2, marks
print("html: marks of events are below the slider at their times")

# Without WebGL 2 the figures are drawn as the page says.
with open(f"{out}/viewer.html") as page, open(f"{out}/flat.html", "w") as probe:
    probe.write(page.read().replace("</body>", """<p id="probe"></p><script>
setInterval(() => { $("probe").textContent = (gl ? "with" : "without") + " gl painted " +
  [...document.querySelectorAll(".plot canvas")].map(c => c.getContext("2d").getImageData(0, 0, c.width, c.height).data.filter(x => x > 0).length); }, 200);
</script></body>"""))
painted = re.search(r">without gl painted (\d+),(\d+)<", dom(f"{out}/flat.html", 4.5, ["--disable-3d-apis"], r"painted [1-9]\d*,[1-9]"))
assert painted and min(map(int, painted.groups())) > 1000, painted
print("html: without WebGL 2 its figures are drawn")

# What stands upright is whole in the first view, two thirds of the window high at most.
subprocess.run([sys.argv[1], "run", "scissor_mast", "-o", f"{out}/mast", "--quiet", "--export", "html"], check=True)
pixels = np.array(re.findall(r"at pixel ([-0-9.]+), ([-0-9.]+)", dom(f"{out}/mast/viewer.html", 0.947)), dtype=float)
assert len(pixels) == 20 and pixels.min() > 0 and pixels[:, 1].max() < 0.66 * 700, pixels
print("html: all of a mast is in the picture")

# What is no rod, of every kind: the page has them in its legend and goes on.
with open(f"{out}/lines.toml", "w") as scene:
    scene.write('''[structure]
kind = "custom"
nodes = [{name = "A", position = [0, 0, 0], fixed = true}, {name = "B", position = [1, 0, 0], mass = 1},
  {name = "C", position = [2, 0, 0], mass = 1}, {name = "D", position = [0, 0, 1], fixed = true}]
[[constraints]]
kind = "telescope"
nodes = ["A", "B", "C"]
[[forces]]
kind = "spring"
nodes = ["B", "D"]
stiffness = 10
[[forces]]
kind = "cable"
nodes = ["C", "D"]
axial_stiffness = 100
[[forces]]
kind = "cable"
nodes = ["B", "D"]
axial_stiffness = 100
smoothing = 0.01
[solver]
end_time = 0.1
''')
subprocess.run([sys.argv[1], "run", f"{out}/lines.toml", "-o", f"{out}/lines", "--quiet", "--export", "html"], check=True)
page = dom(f"{out}/lines/viewer.html", 0.05)
assert len(re.findall(r"at pixel -?\d", page)) == 4, page[-2000:]
for group in ("spring", "cable", "net", "actuator"):
    assert f'<div>{group}<i style="background' in page, group
print("html: springs, cables, nets and actuators")

if len(sys.argv) > 2:
    script = (
        "const v=require(process.argv[1]+'/node_modules/gltf-validator'),fs=require('fs');"
        "v.validateBytes(new Uint8Array(fs.readFileSync(process.argv[2])),{maxIssues:20})"
        ".then(r=>console.log(JSON.stringify(r)))"
    )
    # The dish has surfaces, which morph.
    subprocess.run([sys.argv[1], "run", "dish", "-o", f"{out}/dish", "--quiet", "--export", "gltf"], check=True)
    for file in (f"{out}/animation.glb", f"{out}/dish/animation.glb"):
        done = subprocess.run(["node", "-e", script, sys.argv[2], file], capture_output=True, text=True, check=True)
        report = json.loads(done.stdout)
        assert report["issues"]["numErrors"] == 0 and report["issues"]["numWarnings"] == 0, report["issues"]
        info = report["info"]
        print(f"glb: no error, no warning, {report['issues']['numInfos']} notes; {info['totalTriangleCount']} triangles, "
              f"{info['animationCount']} animation, morph targets: {info['hasMorphTargets']}")
        for message in report["issues"]["messages"][:3]:
            print("   ", message["code"], message["message"])
