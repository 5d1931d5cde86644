"""Scenes are read, checked and changed like those of the command."""

import numpy as np
import pytest
from conftest import JET

import ehdjet


def test_file_text_and_mapping_are_the_same_scene(scenes):
    file = ehdjet.Scene(scenes / "quickstart.toml")
    text = ehdjet.Scene.from_text((scenes / "quickstart.toml").read_text())
    tables = ehdjet.Scene(file.to_dict())
    assert file.resolved == text.resolved == tables.resolved
    assert file["run.end_time"] == 8e-3
    assert file["integrator"]["method"] == "auto"  # a default
    assert "nozzle" in file and "refinement" not in file and "run.end" not in file


def test_changes_are_those_of_the_command(scene):
    scene["run.end_time"] = np.float64(2e-3)
    with pytest.raises(ehdjet.InputError, match="rtol.*rk4"):  # one without the others makes no sense
        scene["integrator.method"] = "rk4"
    scene.update({"integrator.method": "rk4", "integrator.rtol": None, "integrator.step": 1e-8})
    assert scene["run.end_time"] == 2e-3
    assert scene["integrator"]["step"] == 1e-8
    del scene["surface_tension"]
    assert "surface_tension" not in scene
    scene["gravity"] = {"acceleration": 9.8}
    assert scene["gravity.acceleration"] == 9.8
    scene["collector"] = {"distance": 0.1}  # the whole table: charge = "kept" goes with the old one
    assert scene["collector.charge"] != "kept" and scene["collector.distance"] == 0.1


def test_a_copy_changes_alone(scene):
    other = scene.copy()
    other["run.end_time"] = 5e-3
    assert scene["run.end_time"] == 1e-3


@pytest.mark.parametrize(("key", "value", "parts"), [
    ("nozzle.radius", -1.0, ['scene["nozzle.radius"] = -1.0', "nozzle.radius", "m"]),
    ("nozzle.raduis", 1e-5, ["nozzle.raduis", "nozzle.radius"]),  # with a suggestion
    ("coulomb.solver", "fast", ["coulomb.solver", "fmm"]),
    ("run.end_time", "soon", ["run.end_time", "soon"]),
    ("run.end_time", None, ["end_time", "missing"]),
    ("output.frames", object(), ["output.frames", "object"]),
])
def test_what_is_refused_leaves_the_scene(scene, key, value, parts):
    before = scene.resolved
    with pytest.raises(ValueError) as refused:
        scene[key] = value
    assert isinstance(refused.value, ehdjet.InputError)
    for part in parts:
        assert part in str(refused.value)
    assert "--set" not in str(refused.value)
    assert scene.resolved == before
    scene["run.end_time"] = 2e-3  # and it can still be changed


def test_a_message_names_file_and_line(tmp_path):
    file = tmp_path / "wrong.toml"
    file.write_text("[run]\nend_time = -1\n")
    with pytest.raises(ehdjet.InputError, match=r"wrong\.toml:2.*end_time"):
        ehdjet.Scene(file)
    with pytest.raises(ehdjet.InputError, match="nothing-here.toml"):
        ehdjet.Scene(tmp_path / "nothing-here.toml")
    with pytest.raises(ehdjet.InputError, match=r"wrong:1:"):
        ehdjet.Scene.from_text("[run", name="wrong")


def test_texts_of_all_characters_get_through(scene):
    scene["title"] = 'Ä "jet" \\ of\tPVP\x7f'
    assert scene["title"] == 'Ä "jet" \\ of\tPVP\x7f'
    mapping = dict(JET, title='"quoted"\n')
    assert ehdjet.Scene(mapping)["title"] == '"quoted"\n'


def test_chain_files_are_looked_for_in_the_folder(scenes, tmp_path, monkeypatch):
    tables = ehdjet.Scene(scenes / "chain.toml").to_dict()
    tables["chain"]["file"] = "chain.csv"
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ehdjet.InputError, match="chain.csv"):
        ehdjet.Scene(tables)
    assert len(ehdjet.Simulation(ehdjet.Scene(tables, folder=scenes)).jet) == 12


def test_missing_keys_raise_key_errors(scene):
    with pytest.raises(KeyError, match="nozzle.colour"):
        scene["nozzle.colour"]
    with pytest.raises(KeyError, match="gravity"):
        del scene["gravity"]


def test_reports(scene):
    assert "Weber" in scene.report() or "dimensionless" in scene.report().lower()
    assert "run.end_time" in ehdjet.key_reference() or "end_time" in ehdjet.key_reference()
