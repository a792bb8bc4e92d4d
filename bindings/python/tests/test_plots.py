"""Pictures."""

import fingertip
import numpy as np
import pytest
from test_recordings import recorded  # noqa: F401

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")

from fingertip import plots  # noqa: E402


def test_pictures_show_what_was_found(recorded, tmp_path):  # noqa: F811
    path, scene, _, _ = recorded
    found = fingertip.analyze(path, scene)
    contacts = plots.plot_contacts(found, scene)
    drawn = contacts.collections[0].get_offsets()
    wanted = np.column_stack(scene.project(found.point[found.contact]))
    assert np.allclose(np.sort(drawn, axis=0), np.sort(wanted, axis=0)) and len(drawn) == found.contact.sum()
    slips = (found.slip[found.contact] == fingertip.SlipVerdict.SLIPPING).sum()
    assert slips > 0 and len(contacts.collections[1].get_offsets()) == slips
    forces, ratios = plots.plot_forces(found)
    assert np.array_equal(forces.lines[0].get_ydata(), found.normal_force, equal_nan=True)
    assert len(ratios.patches) > 3 and ratios.get_xlabel() == "time / s"
    space = plots.plot_surface(found)
    assert space.get_zlabel() == "z / mm"
    for name, axes in {"contacts": contacts, "forces": forces, "space": space}.items():
        axes.figure.savefig(tmp_path / f"{name}.png", dpi=60)
        assert (tmp_path / f"{name}.png").stat().st_size > 5000


def test_nothing_touched_is_drawn_too(tmp_path, scene):
    path = tmp_path / "still.csv"
    rows = "\n".join(f"{t / 1000},0,0,0,0,0,0" for t in range(10))
    path.write_text("t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n" + rows + "\n")
    found = fingertip.analyze(path, scene)
    assert plots.plot_contacts(found, scene).get_title() == "0 contacts"
    plots.plot_forces(found), plots.plot_surface(found)
