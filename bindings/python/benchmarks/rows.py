"""Rows a second through `fingertip.columns`, on one core: what docs/many_machines.md is sized by."""

from __future__ import annotations

import time

import numpy as np

import fingertip

ROWS = 1_000_000
BALL = {
    "surface": {"shape": "sphere", "radius_m": 0.013},
    "contact": {"least_force_N": 0.05},
    "friction": {"static_coefficient": 0.6},
}
SCENES = {
    "sphere, Coulomb, threshold (one loop in vectors)": {**BALL, "slip": {"detector": "threshold", "noise_N": 0.01}},
    "sphere, Coulomb, drop detector": {**BALL, "slip": {"detector": "drop", "noise_N": 0.01}},
    "soft ellipsoid, limit surface, drop detector": {
        "surface": {"shape": "ellipsoid", "semi_axes_m": [0.008, 0.010, 0.013]},
        "contact": {"model": "soft_finger", "least_force_N": 0.05},
        "friction": {"limit": "soft_finger", "static_coefficient": 0.6, "torque_arm_m": 0.003},
        "slip": {"detector": "drop", "noise_N": 0.01},
    },
}


def main() -> None:
    random = np.random.default_rng(1)
    columns = {"t_s": np.arange(ROWS) * 1e-3}
    columns |= {name: random.normal(0, 0.3, ROWS) for name in ("fx_N", "fy_N")}
    columns["fz_N"] = random.normal(-2, 0.4, ROWS)
    columns |= {name: random.normal(0, 2e-3, ROWS) for name in ("tx_Nm", "ty_Nm", "tz_Nm")}
    table = fingertip.Table(columns)
    print("| scene | ns a row | rows a second | core hours a terabyte |")
    print("|---|---|---|---|")
    for name, sections in SCENES.items():
        scene = fingertip.Scene.from_dict(sections)
        # A time step of its own costs the vectors: a steady rate is told once.
        sense = fingertip.columns(scene, time_step=1e-3)
        times = []
        for _ in range(5):
            start = time.perf_counter()
            sense(table)
            times.append(time.perf_counter() - start)
        row = min(times) / ROWS
        print(f"| {name} | {row * 1e9:.0f} | {1 / row:.2g} | {row * 1e12 / 56 / 3600:.2g} |")


if __name__ == "__main__":
    main()
