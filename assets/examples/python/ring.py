# SPDX-License-Identifier: BSD-3-Clause
"""A ring antenna of twelve units: when it is deployed, and which of its forces the rigid model determines."""
import unfurl

ring = unfurl.Scene("hoop6", set={"structure.units": 12, "solver.stages": 4, "solver.end_time": 30})
run = ring.run(tolerance=1e-8)
print(run)
print("B0 ends at", run.x["B0"][-1])
for rod in run.rods[:3]:
    print(rod, "starts with", run.rod_force[rod][0], "N", "" if run.rod_force_unique[rod][0] else "(one choice of many)")
run.plot("energy", "energy.svg")
run.export("html", "ring")
