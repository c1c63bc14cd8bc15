"""What Python gives a run whose steps end with the solution of equations: motion and forces in implicit steps and in statics."""

import json

import numpy as np
import peridyne
import pytest
from test_given import BAR, TOLD, bar, driven, moved

IMPLICIT = ["newmark", "hht"]
NAMES = ["pull_x", "work of boundary conditions", "kinetic energy", "strain energy"]


def implicit(integrator, *conditions, **run):
    return bar(*conditions, integrator=integrator, time_step=0.5, steps=80, **run)


def statics(*conditions, **options):
    deck = json.loads(json.dumps(BAR))
    deck.pop("run")
    deck["boundary_condition"] = [{"set": "left", "displacement": {"x": 0, "y": 0}}, *conditions]
    deck["statics"] = {"increments": 5, **options}
    return peridyne.Deck.from_dict(deck)


def same(ours, theirs, names, by=1e-9):
    for name in names:
        a, b = ours.history[name], theirs.history[name]
        assert np.abs(a - b).max() <= by * np.abs(b).max(), (name, a, b)


@pytest.mark.parametrize("integrator", IMPLICIT)
@pytest.mark.parametrize("condition, call, of", TOLD, ids=["displacement", "velocity"])
def test_motion_in_implicit_steps_is_that_of_a_deck(tmp_path, integrator, condition, call, of):
    written = implicit(integrator, {"set": "right", **condition}).run(tmp_path / "deck", threads=1)

    def prepare(sim):
        sim.add_motion(call, set="right", axes="x", of=of)

    given = implicit(integrator).run(tmp_path / "python", threads=1, prepare=prepare)
    same(given, written, NAMES)
    assert np.abs(given.history["pull_x"]).max() > 1e-3 and given.history["kinetic energy"].max() > 0
    assert any(f"the {of} of `right` along x" in w for w in given.record["warnings"])
    sim = implicit(integrator).simulation(threads=1)
    prepare(sim)
    sim.step(80)
    assert sim.state_hash() == (given.record["state_hash"], given.record["ledger_hash"])
    other = implicit(integrator, {"set": "right", **condition}).simulation(threads=1)
    other.step(80)
    u, v = other.column("displacement"), other.column("velocity")
    assert np.abs(sim.column("displacement") - u).max() <= 1e-11 * np.abs(u).max()
    assert np.abs(sim.column("velocity") - v).max() <= 1e-9 * np.abs(v).max()


@pytest.mark.parametrize("method", ["linear", "newton", "relaxation", "fire"])
def test_motion_in_statics_is_that_of_a_deck(tmp_path, method):
    text = "0.3*t^2*(1 + 0.1*y)"
    written = statics({"set": "right", "displacement": {"x": text}}, method=method).run(tmp_path / "deck", threads=1)
    asked = []

    def call(t, x):
        asked.append(t)
        return 0.3 * t**2 * (1 + 0.1 * x[:, 1])

    given = statics(method=method).run(tmp_path / "python", threads=1, prepare=lambda sim: sim.add_motion(call, set="right", axes="x"))
    same(given, written, ["pull_x", "work of boundary conditions", "strain energy"])
    assert given.history["strain energy"].max() > 0 and max(asked) == pytest.approx(1.0)


def test_a_factor_that_is_sought_is_that_of_a_motion():
    options = {"method": "newton", "control": "arc_length", "arc_length": 0.02}
    deck = statics({"set": "right", "displacement": {"x": "t"}}, **options).simulation(threads=1)
    sim = statics(**options).simulation(threads=1)
    sim.add_motion(lambda t, x: t, set="right", axes="x")
    deck.step(3)
    sim.step(3)
    assert 0 < sim.time == pytest.approx(deck.time, rel=1e-12)
    assert sim.column("displacement") == pytest.approx(deck.column("displacement"), rel=1e-9, abs=1e-14)
    other = statics(**options).simulation(threads=1)
    with pytest.raises(ValueError, match="not proportional to t"):
        other.add_motion(lambda t, x: t**2, set="right", axes="x")


def test_increments_after_a_new_motion_are_of_what_is_held_then():
    sim = statics(method="linear").simulation(threads=1)
    sim.step()
    sim.add_motion(lambda t, x: 0.01 * t, set="right", axes="x")
    sim.step()
    right = sim.members("right")
    assert sim.column("displacement")[right, 0] == pytest.approx(np.full(len(right), 0.004), rel=1e-12)
    assert sim.energies()["strain"] > 0


def test_what_steps_cannot_take_says_why():
    sim = statics(method="newton").simulation(threads=1)
    with pytest.raises(ValueError, match="a prescribed velocity moves its points on and on, and in equilibrium nothing moves"):
        sim.add_motion(lambda t, x: 0.0, set="right", axes="x", of="velocity")
    sim = statics(method="linear").simulation(threads=1)
    with pytest.raises(ValueError, match='changes with their displacements, and a linear solution.*method = "newton"'):
        sim.add_force(lambda t, x, v: [0.0, 0.0])
    deck = json.loads(json.dumps(BAR))
    deck["material"]["heat"] = {"conductivity": 1.0, "capacity": 1.0}
    deck["heat"] = {"reference": 0.0}
    deck["run"] = {"steps": 5, "integrator": "none"}
    still = peridyne.Deck.from_dict(deck).simulation(threads=1)
    with pytest.raises(ValueError, match="points stand still"):
        still.add_motion(lambda t, x: 0.0, set="right", axes="x")
    with pytest.raises(ValueError, match="points stand still"):
        still.add_force(lambda t, x, v: [0.0, 0.0])
    # nothing of it stays
    before = statics(method="linear").simulation(threads=1)
    before.step()
    sim.step()
    assert sim.state_hash() == before.state_hash()


@pytest.mark.parametrize("integrator", IMPLICIT)
def test_a_force_of_time_in_implicit_steps_is_that_of_a_deck(tmp_path, integrator):
    written = implicit(integrator, {"set": "right", "body_force": {"x": "1e-3*sin(0.3*t)", "y": "1e-4*t"}}).run(tmp_path / "deck", threads=1)
    call = lambda t, x, v: [1e-3 * np.sin(0.3 * t), 1e-4 * t]
    given = implicit(integrator).run(tmp_path / "python", threads=1, prepare=lambda sim: sim.add_force(call, set="right"))
    same(given, written, NAMES[1:])
    assert given.history["kinetic energy"].max() > 0


@pytest.mark.parametrize("c", [0.05, 5.0])
def test_a_drag_in_implicit_steps_is_the_damping_of_a_deck(c):
    pull = {"set": "right", "velocity": {"x": "0.01"}}
    deck = implicit("newmark", pull, {"set": "all", "damping": c}).simulation(threads=1)
    sim = implicit("newmark", pull).simulation(threads=1)
    sim.add_force(lambda t, x, v: -c * v)
    for each in [deck, sim]:
        each.step(40)
    ours, theirs = sim.energies(), deck.energies()
    # what a deck's damping takes is an account of its own
    assert ours["work_boundary_conditions"] == pytest.approx(theirs["work_boundary_conditions"] - theirs["dissipated"], rel=1e-8)
    assert theirs["dissipated"] > 0.01 * theirs["work_boundary_conditions"]
    for name in ["kinetic", "strain"]:
        assert ours[name] == pytest.approx(theirs[name], rel=1e-8)
    assert sim.probes()["pull_x"] == pytest.approx(deck.probes()["pull_x"], rel=1e-8)


def test_a_spring_in_implicit_steps_swings_as_the_method_says():
    # points of density 2 on springs of 8 (force / volume / length), all alike: omega = 2; far beyond what an explicit step could take
    dt, omega, n = 1.5, 2.0, 20
    deck = {
        "horizon": {"m_ratio": 1},
        "body": {"lattice": "chain", "spacing": 1.0, "region": {"block": {"low": [-0.5], "high": [9.5]}}},
        "material": {"density": 2.0, "law": {"springs": {"micromodulus": 3.0}}},
        "run": {"steps": n, "time_step": dt, "integrator": "newmark"},
    }
    sim = peridyne.Deck.from_dict(deck).simulation(threads=1)
    reference = sim.column("reference")
    sim.set_column("displacement", np.full((10, 1), 0.01))
    asked = []

    def spring(t, x, v):
        asked.append(t)
        return -8.0 * (x - reference)

    sim.add_force(spring)
    sim.step(n)
    turn = 2 * np.arctan(0.5 * omega * dt)
    assert sim.column("displacement")[:, 0] == pytest.approx(np.full(10, 0.01 * np.cos(n * turn)), abs=1e-10)
    # it knows how the force changes: two calls a look (one axis), with and without velocities, of a trial, its correction and the end
    assert len(asked) <= 12 * n + 4
    energies = sim.energies()
    done = 0.5 * 8.0 * (0.01**2 - sim.column("displacement")[0, 0] ** 2) * 10
    assert energies["work_boundary_conditions"] == pytest.approx(done, rel=1e-9)
    assert energies["kinetic"] == pytest.approx(done, rel=1e-8)


def test_a_force_in_statics_balances_where_the_body_is():
    sim = statics(method="newton").simulation(threads=1)
    right = sim.members("right")
    reference = sim.column("reference")[right]

    def spring(t, x, v):
        assert not v.any()
        # pulls at a place that goes away
        return np.column_stack([0.05 * (reference[:, 0] + t - x[:, 0]), 0 * t * x[:, 1]])

    sim.add_force(spring, set="right")
    sim.step(5)
    u = sim.column("displacement")[right, 0]
    force = sim.column("force_density")
    free = np.setdiff1d(np.arange(sim.points), sim.members("left"))
    assert 0.01 < u.mean() < 0.9
    assert np.abs(force[free]).max() < 1e-9 * 0.05
    # the same as the loads that it ends with, written down
    dead = statics(method="newton").simulation(threads=1)
    end = np.column_stack([0.05 * (1 - u), 0 * u])
    dead.add_force(lambda t, x, v: t * end, set="right")
    dead.step(5)
    assert dead.column("displacement") == pytest.approx(sim.column("displacement"), abs=1e-8)


def prepare(sim):
    sim.add_motion(driven, set="right", axes="x", of="velocity")
    sim.add_force(lambda t, x, v: -0.05 * v + 1e-5 * t * x[:, :1], every=3)


@pytest.mark.parametrize("integrator", IMPLICIT)
def test_a_run_goes_on_with_what_it_was_given_bit_for_bit(tmp_path, integrator):
    deck = implicit(integrator)
    whole = deck.run(tmp_path / "whole", threads=1, prepare=prepare).record
    run = deck.run(tmp_path / "cut", threads=1, prepare=prepare, observe=lambda sim: sim.step_number >= 31)
    assert run.record["status"] == "ended" and run.record["steps"] == 31
    with pytest.raises(peridyne.DeckError, match="a force on `all`.*and now nothing.*prepare="):
        peridyne.resume(run.folder, threads=1)
    run = peridyne.resume(run.folder, threads=2, prepare=prepare)
    assert run.record["status"] == "done"
    assert (run.record["state_hash"], run.record["ledger_hash"]) == (whole["state_hash"], whole["ledger_hash"])
    assert (run.folder / "history.csv").read_bytes() == (tmp_path / "whole/history.csv").read_bytes()


def test_statics_go_on_with_what_they_were_given_bit_for_bit(tmp_path):
    def prepare(sim):
        sim.add_motion(lambda t, x: 0.2 * t**2, set="right", axes="x")
        sim.add_force(lambda t, x, v: -1e-2 * t * (x - 10.0))

    deck = statics(method="newton")
    whole = deck.run(tmp_path / "whole", threads=1, prepare=prepare).record
    run = deck.run(tmp_path / "cut", threads=1, prepare=prepare, observe=lambda sim: sim.step_number == 2)
    assert run.record["status"] == "ended" and run.record["steps"] == 2
    run = peridyne.resume(run.folder, threads=1, prepare=prepare)
    assert (run.record["state_hash"], run.record["ledger_hash"]) == (whole["state_hash"], whole["ledger_hash"])


@pytest.mark.parametrize("kind", ["newmark", "hht", "statics"])
@pytest.mark.parametrize("where", ["motion", "force"])
def test_what_a_function_raises_leaves_the_state_before_the_step(kind, where):
    deck = statics(method="newton") if kind == "statics" else implicit(kind)
    sim, whole = deck.simulation(threads=1), deck.simulation(threads=1)
    fails = []

    def motion(t, x):
        if fails and where == "motion":
            raise LookupError("gone")
        return 1e-2 * t + 1e-4 * t**2

    def force(t, x, v):
        if fails and where == "force":
            fails.append(t)
            # not at the first trial
            if len(fails) > 4:
                raise LookupError("gone")
        return -1e-3 * v - 1e-2 * t * (x - x.mean(axis=0))

    for each in [sim, whole]:
        each.add_motion(motion, set="right", axes="x")
        each.add_force(force)
        each.step(3)
    u, v, f, hashes = sim.column("displacement"), sim.column("velocity"), sim.column("force_density"), sim.state_hash()
    fails.append(0)
    with pytest.raises(LookupError):
        sim.step()
    assert sim.step_number == 3
    assert (sim.column("displacement") == u).all() and (sim.column("velocity") == v).all()
    assert sim.column("force_density") == pytest.approx(f, rel=1e-9, abs=1e-15)
    assert sim.state_hash()[0] == hashes[0]
    fails.clear()
    sim.step(2)
    whole.step(2)
    assert sim.step_number == 5
    assert sim.column("displacement") == pytest.approx(whole.column("displacement"), rel=1e-8, abs=1e-13)
    assert sim.energies()["work_boundary_conditions"] == pytest.approx(whole.energies()["work_boundary_conditions"], rel=1e-8)


def test_a_run_that_a_function_ends_goes_on(tmp_path):
    def gives(late):
        return lambda sim: sim.add_force(lambda t, x, v: [1e-3 * t / (0 if t > late else 1), 0.0], set="right")

    with pytest.raises(ZeroDivisionError):
        implicit("newmark").run(tmp_path / "out", threads=1, prepare=gives(20.1))
    record = peridyne.Run(tmp_path / "out").record
    assert record["status"] == "ended" and record["steps"] == 40
    whole = implicit("newmark").run(tmp_path / "whole", threads=1, prepare=gives(np.inf))
    run = peridyne.resume(tmp_path / "out", threads=1, prepare=gives(np.inf))
    same(run, whole, NAMES[1:])


def test_motion_after_statics_is_that_of_a_deck(tmp_path):
    def staged(integrator, *conditions):
        deck = json.loads(json.dumps(BAR))
        deck["boundary_condition"] = [
            {"set": "left", "displacement": {"x": 0, "y": 0}},
            {"set": "right", "displacement": {"x": "0.1*t"}, "stage": "statics"},
            *({**c, "stage": "motion"} for c in conditions),
        ]
        deck["statics"] = {"method": "newton", "increments": 2}
        deck["run"] = {"steps": 40, "time_step": 0.2, "integrator": integrator}
        return peridyne.Deck.from_dict(deck)

    for integrator in ["verlet", "newmark"]:
        written = staged(integrator, {"set": "right", "displacement": {"x": "0.1 + 0.002*t^2"}}).run(tmp_path / f"{integrator}_deck", threads=1)
        calls = []

        def call(t, x):
            calls.append(t)
            return 0.1 + 0.002 * t**2

        prepare = lambda sim: sim.add_motion(call, set="right", axes="x")
        given = staged(integrator).run(tmp_path / f"{integrator}_python", threads=1, prepare=prepare)
        same(given, written, NAMES)
        assert max(calls) < 8.5
        # one that does not begin where statics ended
        jumps = lambda sim: sim.add_motion(lambda t, x: 0.2, set="right", axes="x")
        with pytest.raises(peridyne.RunError, match="motion asks for a displacement of 200 mm"):
            staged(integrator).run(tmp_path / f"{integrator}_jump", threads=1, prepare=jumps)
    prepare = lambda sim: sim.add_force(lambda t, x, v: [1e-3 * np.cos(t), 0.0], set="right")
    for integrator in ["verlet", "newmark"]:
        written = staged(integrator, {"set": "right", "body_force": {"x": "1e-3*cos(t)"}}).run(tmp_path / f"{integrator}_force_deck", threads=1)
        given = staged(integrator).run(tmp_path / f"{integrator}_force_python", threads=1, prepare=prepare)
        same(given, written, NAMES[1:])
        ends = lambda sim: sim.step_number == 2
        cut = staged(integrator).run(tmp_path / f"{integrator}_cut", threads=1, prepare=prepare, observe=ends)
        assert cut.record["status"] == "ended"
        cut = peridyne.resume(cut.folder, threads=1, prepare=prepare)
        assert cut.record["state_hash"] == given.record["state_hash"]
