# SPDX-License-Identifier: BSD-3-Clause
"""Deployment time over fold angle and hinge force, and the force for a wanted time."""
import numpy as np
import unfurl

ring = unfurl.Scene("hoop6_sector")
table = ring.sweep({"structure.fold_angle": np.linspace(40, 80, 5), "structure.hinge_force": [100, 200, 400]}, ["deploy_time", "peak_energy"], threads=2)
print(table["deploy_time_s"].reshape(5, 3))
print("deployed in 4 s with", ring.solve("structure.hinge_force", deploy_time=4.0), "N")
