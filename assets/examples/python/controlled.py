# SPDX-License-Identifier: BSD-3-Clause
"""Step by step: stop a double pendulum when its tip is highest."""
import unfurl

stepper = unfurl.Scene("double_pendulum", set={"solver.end_time": 5, "solver.step": 0.005}).stepper()
highest, at = stepper.x[-1, 2], 0.0
while stepper.step():
    if stepper.x[-1, 2] > highest:
        highest, at = stepper.x[-1, 2], stepper.t
print(f"the tip is highest, {highest:.6f} m, at {at:.3f} s")
