# SPDX-License-Identifier: BSD-3-Clause
"""A linkage from arrays: a pantograph arm let go under gravity."""
import numpy as np
import unfurl

n = 4  # cells
x = np.arange(n + 1)
nodes = np.vstack([np.column_stack([x, 0 * x]), np.column_stack([x, 0 * x + 1]), np.column_stack([x[:-1] + 0.5, 0 * x[:-1] + 0.5])])
low, high, pin = (lambda i: i), (lambda i: n + 1 + i), (lambda i: 2 * n + 2 + i)
rods = [(a, b) for i in range(n) for a, b in ((low(i), pin(i)), (pin(i), high(i + 1)), (high(i), pin(i)), (pin(i), low(i + 1)))]
straight = [{"kind": "collinear", "nodes": [f"n{a}", f"n{pin(i)}", f"n{b}"]} for i in range(n) for a, b in ((low(i), high(i + 1)), (high(i), low(i + 1)))]

arm = unfurl.Structure(nodes, rods, fixed=[low(0)], mass=0.2, gravity=(0, -9.81, 0), constraints=straight,
                       set={"solver.end_time": 0.4, "solver.stages": 4})
run = arm.run()
print(run)
print("lowest point", np.asarray(run.x)[:, :, 1].min(), "m; constraint error", run.series["constraint_max_m"].max(), "m")
