"""Decks, runs and models from Python."""

import io
import json
import subprocess
import sys
import threading
import warnings
from pathlib import Path

import numpy as np
import peridyne
import pytest

CRACK = {
    "title": "A small crack",
    "plane": "stress",
    "thickness": "1 mm",
    "horizon": {"m_ratio": 3},
    "body": {"lattice": "square", "spacing": "1 mm", "region": {"block": {"low": [0, 0], "high": ["40 mm", "20 mm"]}}},
    "material": {"density": "2440 kg/m^3", "law": {"pmb": {"young": "72 GPa"}}, "fracture": {"energy": "135 J/m^2"}},
    "precrack": [{"segment": {"from": [0, "10 mm"], "to": ["20 mm", "10 mm"]}}],
    "sets": {"top": {"where": "y > 19 mm"}, "bottom": {"where": "y < 1 mm"}},
    "boundary_condition": [
        {"set": "top", "traction": {"y": "12 MPa"}},
        {"set": "bottom", "traction": {"y": "-12 MPa"}},
    ],
    "probe": [{"name": "top", "set": "top", "measure": "mean", "of": "displacement", "component": "y"}],
    "run": {"steps": 300, "time_step": "0.1 us"},
    "output": {"every": 100, "picture": False},
}
# a chain of springs
CHAIN = {
    "horizon": {"m_ratio": 1},
    "body": {"lattice": "chain", "spacing": 1.0, "region": {"block": {"low": [-0.5], "high": [9.5]}}},
    "material": {"density": 2.0, "law": {"springs": {"micromodulus": 3.0}}},
    "run": {"steps": 100, "time_step": 0.1},
}


def crack(**output):
    deck = json.loads(json.dumps(CRACK))
    deck["output"].update(output)
    return deck


def program(*words, **more):
    return subprocess.run([sys.executable, "-m", "peridyne", *map(str, words)], capture_output=True, text=True, **more)


def test_a_run_is_that_of_the_program(tmp_path):
    deck = peridyne.Deck.from_dict(crack())
    run = deck.run(tmp_path / "own", threads=1)
    (tmp_path / "deck.toml").write_text(deck.text)
    done = program("run", tmp_path / "deck.toml", "--out", tmp_path / "program", "--threads", 1)
    assert done.returncode == 0, done.stderr
    other = peridyne.Run(tmp_path / "program")
    assert run.record["state_hash"] == other.record["state_hash"]
    assert run.record["ledger_hash"] == other.record["ledger_hash"]
    assert run.record["broken_bonds"] > 0
    for name in ["history.csv", run.frames[-1].name]:
        assert (run.folder / name).read_bytes() == (other.folder / name).read_bytes()
    assert len(run.frames) == 4
    history = run.history
    assert history["step"][-1] == 300 and run.units["kinetic energy"] == "J"
    assert history["kinetic energy"][-1] == run.record["energy"]["kinetic"]
    assert "<iframe" in run._repr_html_() and "small crack" in run._repr_html_()


def test_a_model_led_step_by_step_is_that_run(tmp_path):
    deck = peridyne.Deck.from_dict(crack())
    record = deck.run(tmp_path / "out", threads=1).record
    sim = deck.simulation(threads=2)
    assert (sim.points, sim.dimension, sim.step_number) == (800, 2, 0)
    sim.step(100)
    sim.step(200)
    assert sim.state_hash() == (record["state_hash"], record["ledger_hash"])
    assert sim.broken_bonds == record["broken_bonds"]
    u, damage = sim.column("displacement"), sim.column("damage")
    assert u.shape == (800, 3) and damage.shape == (800,) and damage.max() > 0.1
    # it is the caller's
    u[:] = 7.0
    assert sim.column("displacement").max() < 1.0
    top = sim.members("top")
    [mean] = sim.probes().values()
    assert mean == pytest.approx(sim.column("displacement")[top, 1].mean(), rel=1e-12)
    energies = sim.energies()
    v, volume = sim.column("velocity"), sim.column("volume")
    assert energies["kinetic"] == pytest.approx(0.5 * 2440 * (volume * (v**2).sum(axis=1)).sum(), rel=1e-12)
    assert abs(energies["balance_error"]) < 0.05 * energies["work_boundary_conditions"]
    assert "points in 2-D, step 300" in repr(sim)


def test_columns_are_set():
    sim = peridyne.Deck.from_dict(CHAIN).simulation(threads=1)
    u = np.zeros((10, 1))
    u[4] = 0.01
    sim.set_column("displacement", u)
    assert np.array_equal(sim.column("displacement")[:, 0], u[:, 0])
    # pulled back by both neighbours, which it pulls
    force = sim.column("force_density")[:, 0]
    assert force[3] == force[5] == pytest.approx(-0.5 * force[4]) and force[3] > 0.0
    assert sim.energies()["strain"] == pytest.approx(-0.5 * (force * u[:, 0]).sum())
    sim.set_column("velocity", [0.5])
    assert (sim.column("velocity")[:, 0] == 0.5).all()


def test_a_force_of_python_acts():
    # all points alike: a body that falls, exact for velocity Verlet
    sim = peridyne.Deck.from_dict(CHAIN).simulation(threads=1)
    seen = []

    def weight(t, x, v):
        seen.append((t, x.shape, v.shape))
        return [-2.0 * 9.81]

    sim.add_force(weight)
    sim.step(50)
    assert sim.column("displacement")[:, 0] == pytest.approx(-0.5 * 9.81 * 5.0**2, rel=1e-12)
    assert seen[-1] == (pytest.approx(5.0), (10, 3), (10, 3))
    # a damper on one point takes what the body loses
    sim = peridyne.Deck.from_dict({**CHAIN, "sets": {"end": {"where": "x > 8.5"}}}).simulation(threads=1)
    sim.set_column("velocity", [0.01])
    sim.add_force(lambda t, x, v: -0.5 * v, set="end")
    before = sim.energies()["kinetic"]
    sim.step(400)
    assert sim.energies()["kinetic"] < 0.9 * before


def test_a_bar_shows_how_far_a_run_is(tmp_path):
    text = io.StringIO()
    run = peridyne.Deck.from_dict(crack()).run(tmp_path / "out", progress=peridyne.progress_bar(file=text, desc="crack"))
    assert run.record["steps"] == 300
    shown = text.getvalue()
    assert shown.startswith("\rcrack:") and "300/300" in shown and "100%" in shown


def test_a_run_is_observed_and_ended(tmp_path):
    deck = peridyne.Deck.from_dict(crack())
    kept, steps, told = [], [], []

    def observe(sim):
        kept.append(sim)
        steps.append(sim.step_number)
        # to look at everything changes nothing
        arrays = {name: sim.column(name) for name in sim.columns}
        assert len(arrays["damage"]) == 800 and all(sim.describe(name) for name in arrays)
        sim.energies(), sim.probes(), sim.virial(), sim.fragments()
        for change in [sim.step, lambda: sim.set_column("velocity", [0, 0]), lambda: sim.add_force(print)]:
            with pytest.raises(RuntimeError, match="it may be asked, not changed"):
                change()
        return sim.broken_bonds > 0

    run = deck.run(tmp_path / "out", threads=1, observe=observe, every=20, progress=lambda *at: told.append(at))
    assert run.record["status"] == "ended" and run.record["steps"] == steps[-1] < 300
    assert steps == list(range(20, steps[-1] + 1, 20))
    with pytest.raises(RuntimeError, match="during the call"):
        kept[0].column("displacement")
    run = peridyne.resume(run.folder, threads=1)
    assert run.record["status"] == "done" and run.record["steps"] == 300
    whole = deck.run(tmp_path / "whole", threads=1).record
    assert run.record["state_hash"] == whole["state_hash"]


def test_what_a_call_raises_comes_back(tmp_path):
    deck = peridyne.Deck.from_dict(crack())

    def observe(sim):
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        deck.run(tmp_path / "out", threads=1, observe=observe, every=50)
    # the last good state is there
    assert peridyne.resume(tmp_path / "out", threads=1).record["steps"] == 300
    sim = peridyne.Deck.from_dict(CHAIN).simulation(threads=1)
    sim.step(5)

    def force(t, x, v):
        if t > 0.85:
            raise ZeroDivisionError("gone")
        return [0.0]

    sim.add_force(force)
    with pytest.raises(ZeroDivisionError):
        sim.step(50)
    # it can still be asked
    assert sim.column("displacement").shape == (10, 3)


def test_mistakes_name_file_line_and_help(tmp_path):
    path = tmp_path / "deck.toml"
    good = peridyne.Deck.from_dict(crack()).text
    path.write_text(good.replace("m_ratio", "m_ration"))
    with pytest.raises(peridyne.DeckError) as caught:
        peridyne.Deck.from_toml(path)
    error = caught.value
    line = 1 + good.split("m_ratio")[0].count("\n")
    assert error.file == str(path) and error.line == line and "m_ratio" in f"{error.help} {error.message}"
    assert str(error).startswith(f"{path}:{line}: ")
    with pytest.raises(peridyne.DeckError) as caught:
        peridyne.Deck.from_dict(crack(), set={"run.stepps": 3})
    assert "run.stepps" in str(caught.value)
    # found when the model is built
    late = crack()
    late["boundary_condition"][0]["set"] = "middle"
    with pytest.raises(peridyne.DeckError, match="middle"):
        peridyne.Deck.from_dict(late).simulation()
    with pytest.raises(OSError):
        peridyne.Deck.from_toml(tmp_path / "nothing.toml")
    assert issubclass(peridyne.DeckError, peridyne.Error) and issubclass(peridyne.RunError, peridyne.Error)


@pytest.mark.parametrize(
    "wrong, kind, words",
    [
        ({"run": {"steps": object()}}, TypeError, "`steps`: expected a number, a string, a list or a dictionary, got object"),
        ({1: 2}, TypeError, "keys are strings, got int"),
        ({"run": {"steps": 10**30}}, OverflowError, "too large"),
    ],
)
def test_what_a_deck_cannot_hold(wrong, kind, words):
    with pytest.raises(kind, match=words):
        peridyne.Deck.from_dict({**CRACK, **wrong})


def test_wrong_arrays_names_and_types():
    sim = peridyne.Deck.from_dict(CHAIN).simulation(threads=1)
    for values in [np.zeros((9, 1)), np.zeros((10, 2)), np.zeros(10), 3.0]:
        with pytest.raises(ValueError, match="expected an array of shape"):
            sim.set_column("displacement", values)
    with pytest.raises(TypeError, match="expected numbers, got str"):
        sim.set_column("displacement", "far")
    for ask in [sim.column, sim.describe, lambda name: sim.set_column(name, [0.0])]:
        with pytest.raises(KeyError, match='there is no column "colour"; this model has'):
            ask("colour")
    with pytest.raises(KeyError, match='no set "nobody"'):
        sim.members("nobody")
    with pytest.raises(TypeError, match="expected a function"):
        sim.add_force(3.0)
    with pytest.raises(ValueError, match="every=0"):
        sim.add_force(lambda t, x, v: [0.0], every=0)
    with pytest.raises(ValueError, match="not a finite number"):
        sim.add_force(lambda t, x, v: [np.nan])
    with pytest.raises(ValueError, match="at least one thread"):
        peridyne.Deck.from_dict(CHAIN).simulation(threads=0)
    with pytest.raises(OverflowError):
        sim.step(-1)
    with pytest.raises(FileNotFoundError):
        peridyne.Run("nowhere")


def test_a_run_that_goes_bad_says_where(tmp_path):
    deck = peridyne.Deck.from_dict({**CHAIN, "initial": [{"velocity": {"x": "0.1*sin(3*x)"}}]}, set={"run.time_step": 3.0, "run.force_unstable": True})
    with pytest.raises(peridyne.RunError) as caught:
        deck.run(tmp_path / "out", threads=1)
    assert caught.value.folder == str(tmp_path / "out") and 0 <= caught.value.step < 100
    assert json.loads((tmp_path / "out" / "run.json").read_text())["status"] != "done"
    sim = deck.simulation(threads=1)
    with pytest.raises(peridyne.RunError) as caught:
        sim.step(1000)
    assert caught.value.step == sim.step_number <= 500


def test_a_second_thread_is_told():
    sim = peridyne.Deck.from_dict(crack(), set={"run.steps": 3000}).simulation(threads=1)
    said, begun = [], threading.Event()

    def ask():
        begun.wait()
        while not said and worker.is_alive():
            try:
                sim.column("displacement")
            except RuntimeError as error:
                said.append(str(error))

    def work():
        begun.set()
        for _ in range(200):
            try:
                sim.step(20)
            except RuntimeError:
                pass
            if said:
                return

    worker = threading.Thread(target=work)
    other = threading.Thread(target=ask)
    worker.start(), other.start()
    worker.join(), other.join()
    assert said and "one thread, and one call, at a time" in said[0]
    assert np.isfinite(sim.column("displacement")).all()


def test_the_interpreter_is_free_while_it_steps():
    sim = peridyne.Deck.from_dict(crack()).simulation(threads=1)
    count, done = [0], threading.Event()

    def counts():
        while not done.is_set():
            count[0] += 1

    other = threading.Thread(target=counts)
    other.start()
    sim.step(300)
    done.set()
    other.join()
    assert count[0] > 1000


def test_check_and_what_is_told():
    deck = peridyne.Deck.from_dict(crack())
    found = deck.check(threads=1)
    assert found["particles"] == 800 and found["time_step"] == pytest.approx(1e-7)
    assert found["materials"][0]["whole"]["young"][0] == pytest.approx(72e9, rel=0.1)
    assert deck.title == "A small crack" and "72 GPa" in deck.describe()
    assert "0.1 us" in deck.text and repr(deck).startswith("<peridyne.Deck")


def test_the_program_is_there():
    assert program("laws").stdout.count("\n") > 20
    done = program("run", "nothing.toml")
    assert done.returncode == 2 and "nothing.toml" in done.stderr


def test_warnings_are_those_of_python(tmp_path):
    (tmp_path / "out").mkdir()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        peridyne.Deck.from_dict(crack(every=300)).run(tmp_path / "out", threads=1)
