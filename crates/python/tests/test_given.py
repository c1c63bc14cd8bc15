"""What Python gives a run beside its deck: observers, forces, motion."""

import json
import threading

import numpy as np
import peridyne
import pytest
from test_decks import CHAIN, crack, program

# the left end is held, the right one moves; both are measured
BAR = {
    "horizon": {"m_ratio": 2},
    "body": {"lattice": "square", "spacing": 1.0, "region": {"block": {"low": [-0.5, -0.5], "high": [19.5, 5.5]}}},
    "plane": "stress",
    "material": {"density": 2.0, "law": {"pmb": {"young": 3.0}}},
    "sets": {"left": {"where": "x < 0.5"}, "right": {"where": "x > 18.5"}},
    "probe": [{"name": "pull", "set": "right", "measure": "reaction"}],
    "run": {"steps": 200, "time_step": 0.2},
    "output": {"every": 100, "picture": False},
}
U, V = "0.002*t^2*(1 + 0.1*y)", "0.01*sin(0.3*t)"


def moved(t, x):
    return 0.002 * t**2 * (1 + 0.1 * x[:, 1])


def driven(t, x):
    return 0.01 * np.sin(0.3 * t)


def bar(*conditions, **run):
    deck = json.loads(json.dumps(BAR))
    deck["boundary_condition"] = [{"set": "left", "displacement": {"x": 0, "y": 0}}, *conditions]
    deck["run"].update(run)
    return peridyne.Deck.from_dict(deck)


TOLD = [({"displacement": {"x": U}}, moved, "displacement"), ({"velocity": {"x": V}}, driven, "velocity")]


@pytest.mark.parametrize("condition, call, of", TOLD, ids=["displacement", "velocity"])
def test_motion_of_python_is_that_of_a_deck(tmp_path, condition, call, of):
    written = bar({"set": "right", **condition}).run(tmp_path / "deck", threads=1)
    given = bar().run(tmp_path / "python", threads=1, prepare=lambda sim: sim.add_motion(call, set="right", axes="x", of=of))
    # displacements, reactions and the ledger, to the rounding of two ways to write one function
    for name in ["pull_x", "work of boundary conditions", "kinetic energy", "strain energy"]:
        theirs, ours = written.history[name], given.history[name]
        assert np.abs(ours - theirs).max() <= 1e-9 * np.abs(theirs).max() > 0, name
    assert np.abs(given.history["pull_x"]).max() > 1e-3
    [warning] = [w for w in given.record["warnings"] if "a program gave it" in w]
    assert f"the {of} of `right` along x" in warning
    assert not any("a program gave it" in w for w in written.record["warnings"])
    sim = bar().simulation(threads=1)
    sim.add_motion(call, set="right", axes="x", of=of)
    sim.step(200)
    assert sim.state_hash() == (given.record["state_hash"], given.record["ledger_hash"])


def test_a_rigid_motion_costs_its_kinetic_energy():
    sim = peridyne.Deck.from_dict(CHAIN).simulation(threads=1)
    # x = a t²/2 is integrated exactly
    sim.add_motion(lambda t, x: 0.05 * t**2)
    sim.step(100)
    assert sim.column("displacement")[:, 0] == pytest.approx(np.full(10, 0.05 * 10.0**2), rel=1e-12)
    assert sim.column("velocity")[:, 0] == pytest.approx(np.full(10, 1.0), rel=1e-12)
    energies = sim.energies()
    assert energies["work_boundary_conditions"] == pytest.approx(0.5 * 2.0 * 10 * 1.0**2, rel=1e-12)
    assert abs(energies["balance_error"]) < 1e-10 and energies["strain"] == pytest.approx(0.0, abs=1e-12)


def test_axes_that_are_not_named_are_free():
    sim = bar().simulation(threads=1)
    sim.add_motion(lambda t, x: np.column_stack([1e-3 * t + 0 * x[:, 0]]), set="right", axes="x")
    sim.step(100)
    right = sim.members("right")
    u = sim.column("displacement")[right]
    assert u[:, 0] == pytest.approx(np.full(len(right), 1e-3 * 20.0), rel=1e-12)
    # it becomes thinner
    assert np.abs(u[:, 1]).max() > 1e-5


def prepare(sim):
    sim.add_motion(driven, set="right", axes="x", of="velocity")
    sim.add_force(lambda t, x, v: -0.05 * v)
    sim.set_column("velocity", [0.001, 0.0])


def test_a_run_goes_on_with_what_it_was_given_bit_for_bit(tmp_path):
    (tmp_path / "deck.toml").write_text(bar().text)
    deck = peridyne.Deck.from_toml(tmp_path / "deck.toml")
    whole = deck.run(tmp_path / "whole", threads=1, prepare=prepare).record
    run = deck.run(tmp_path / "cut", threads=1, prepare=prepare, observe=lambda sim: sim.step_number >= 70, every=7)
    assert run.record["status"] == "ended" and run.record["steps"] == 70
    with pytest.raises(peridyne.DeckError, match="a force on `all`.*and now nothing.*prepare="):
        peridyne.resume(run.folder, threads=1)
    with pytest.raises(peridyne.DeckError, match="now a force on `left`"):
        peridyne.resume(run.folder, threads=1, prepare=lambda sim: sim.add_force(lambda t, x, v: 0 * v, set="left"))
    done = program("resume", run.folder)
    assert done.returncode == 2 and "give them again" in done.stderr, done.stderr
    assert peridyne.Run(run.folder).record["steps"] == 70
    run = peridyne.resume(run.folder, threads=2, prepare=prepare)
    assert run.record["status"] == "done"
    assert (run.record["state_hash"], run.record["ledger_hash"]) == (whole["state_hash"], whole["ledger_hash"])
    assert (run.folder / "history.csv").read_bytes() == (tmp_path / "whole/history.csv").read_bytes()


def test_columns_are_set_before_a_run(tmp_path):
    u = np.zeros((10, 1))
    u[4] = 0.01
    run = peridyne.Deck.from_dict({**CHAIN, "output": {"picture": False}}).run(tmp_path / "out", threads=1, prepare=lambda sim: sim.set_column("displacement", u))
    sim = peridyne.Deck.from_dict(CHAIN).simulation(threads=1)
    sim.set_column("displacement", u)
    assert run.history["strain energy"][0] == sim.energies()["strain"] > 0
    sim.step(100)
    assert run.record["state_hash"] == sim.state_hash()[0]


def test_observers_have_their_own_intervals(tmp_path):
    deck = peridyne.Deck.from_dict(crack())
    seen = {name: [] for name in ["steps", "time", "number", "plain"]}

    def look(name):
        return lambda sim: seen[name].append(sim.step_number)

    # steps are 0.1 us long
    observers = [
        peridyne.Every(70, look("steps")),
        peridyne.Every("2.5 us", look("time")),
        peridyne.Every(0.63e-6, look("number")),
        look("plain"),
    ]
    run = deck.run(tmp_path / "out", threads=1, observe=observers, every=100)
    assert seen["steps"] == [70, 140, 210, 280] and seen["plain"] == [100, 200, 300]
    assert seen["time"] == list(range(25, 301, 25))
    # the first step at or after each multiple of 6.3 steps
    assert seen["number"] == [int(np.ceil(6.3 * n - 1e-6)) for n in range(1, 48)]
    # to be looked at changes nothing
    assert run.record["state_hash"] == deck.run(tmp_path / "alone", threads=1).record["state_hash"]
    before = {name: list(steps) for name, steps in seen.items()}
    for steps in seen.values():
        steps.clear()
    # intervals count from the beginning, wherever a run was cut
    ends = peridyne.Every(130, lambda sim: True)
    run = deck.run(tmp_path / "cut", threads=1, observe=[ends, *observers], every=100)
    assert run.record["steps"] == 130
    peridyne.resume(run.folder, threads=1, observe=observers, every=100)
    assert seen == before
    assert repr(observers[1]).startswith("peridyne.Every('2.5 us', <function")


def test_who_writes_is_called_in_the_step_that_ends_a_run(tmp_path):
    written = []
    observers = [lambda sim: True, lambda sim: written.append(sim.step_number)]
    run = peridyne.Deck.from_dict(crack()).run(tmp_path / "out", threads=1, observe=observers, every=40)
    assert run.record["steps"] == 40 and written == [40]


def test_writers_of_tables_and_arrays(tmp_path):
    pandas, h5py = pytest.importorskip("pandas"), pytest.importorskip("h5py")
    rows = []
    with h5py.File(tmp_path / "frames.h5", "w") as file:

        def frame(sim):
            group = file.create_group(f"{sim.step_number:06}")
            group.attrs["time"] = sim.time
            for name in ["displacement", "damage"]:
                group[name] = sim.column(name)

        def row(sim):
            rows.append({"time": sim.time, "broken": sim.broken_bonds, **sim.probes(), **sim.energies()})

        run = peridyne.Deck.from_dict(crack()).run(tmp_path / "out", threads=1, observe=[peridyne.Every(100, frame), peridyne.Every("5 us", row)])
    table = pandas.DataFrame(rows)
    assert len(table) == 6 and table["broken"].iloc[-1] == run.record["broken_bonds"]
    assert table["kinetic"].iloc[-1] == run.history["kinetic energy"][-1]
    with h5py.File(tmp_path / "frames.h5") as file:
        assert list(file) == ["000100", "000200", "000300"]
        last = file["000300"]
        assert last.attrs["time"] == pytest.approx(30e-6) and last["damage"].shape == (800,) and last["damage"][:].max() > 0.1


@pytest.mark.parametrize("where", ["force", "motion", "observer", "prepare"])
def test_what_a_function_raises_ends_the_run_before_the_step(tmp_path, where):
    def late(t):
        if t > 10.1:
            raise LookupError("gone")
        return 0.0

    def gives(sim):
        if where == "prepare":
            raise LookupError("gone")
        sim.add_force(lambda t, x, v: [late(t) if where == "force" else 0.0, 0.0])
        sim.add_motion(lambda t, x: late(t if where == "motion" else 0.0), set="right", axes="x")

    observe = (lambda sim: late(sim.time)) if where == "observer" else None
    with pytest.raises(LookupError, match="gone"):
        bar().run(tmp_path / "out", threads=1, prepare=gives, observe=observe)
    if where == "prepare":
        return
    record = peridyne.Run(tmp_path / "out").record
    # the force at the end of step 51 is the first that has none, the motion is asked two steps ahead
    assert record["status"] == "ended" and record["steps"] == {"force": 50, "motion": 49, "observer": 51}[where]

    def again(sim):
        sim.add_force(lambda t, x, v: [0.0, 0.0])
        sim.add_motion(lambda t, x: 0.0, set="right", axes="x")

    whole = bar().run(tmp_path / "whole", threads=1, prepare=again)
    run = peridyne.resume(tmp_path / "out", threads=1, prepare=again)
    assert run.record["steps"] == 200
    # a step that is taken back is so to rounding
    assert run.history["strain energy"] == pytest.approx(whole.history["strain energy"], rel=1e-9, abs=1e-15)


def test_a_force_that_raises_leaves_the_state_before_the_step():
    sim = peridyne.Deck.from_dict(CHAIN).simulation(threads=1)
    sim.set_column("velocity", 0.01 * np.arange(10.0)[:, None])
    fails = []

    def force(t, x, v):
        if fails:
            raise ZeroDivisionError("gone")
        return -0.1 * v

    sim.add_force(force)
    sim.step(10)
    u, v, energies = sim.column("displacement"), sim.column("velocity"), sim.energies()
    fails.append(True)
    with pytest.raises(ZeroDivisionError):
        sim.step()
    assert sim.step_number == 10
    assert sim.column("displacement") == pytest.approx(u, rel=1e-12) and sim.column("velocity") == pytest.approx(v, rel=1e-12)
    assert sim.energies()["strain"] == pytest.approx(energies["strain"], rel=1e-12)
    fails.clear()
    sim.step(5)
    assert sim.step_number == 15


def motion(call, **more):
    return lambda sim: sim.add_motion(call, **more)


@pytest.mark.parametrize(
    "give, kind, words",
    [
        (motion(3.0), TypeError, r"expected a function of \(t, x\), got float"),
        (motion(lambda t, x: 0.0), ValueError, r"expected an array of shape \(120, 2\), \(2,\), got \[\]"),
        (motion(lambda t, x: np.zeros(7), axes="x"), ValueError, r"\(120, 1\), \(1,\), \(120,\) or \(\), got \[7\]"),
        (motion(lambda t, x: np.nan, axes="x"), ValueError, "not a finite number"),
        (motion(lambda t, x: "far", axes="x"), TypeError, "expected numbers, got str"),
        (motion(lambda t, x: 1 / 0, axes="x"), ZeroDivisionError, "division"),
        (motion(lambda t: 0.0, axes="x"), TypeError, "positional argument"),
        (motion(lambda t, x: x.fill(0.0), axes="x"), ValueError, "read-only"),
        (motion(lambda t, x: 0.0, axes="z"), ValueError, 'axes="z": expected some of "xy"'),
        (motion(lambda t, x: 0.0, axes=""), ValueError, "expected some of"),
        (motion(lambda t, x: [0, 0], axes="yx"), ValueError, "in this order"),
        (motion(lambda t, x: 0.0, axes="x", set="nobody"), KeyError, 'no set "nobody"'),
        (motion(lambda t, x: 0.0, axes="x", of="speed"), ValueError, 'of="speed": expected "displacement" or "velocity"'),
        (motion(lambda t, x: 0.0, axes="x", set="left"), ValueError, "is held along x already; take a set that is disjoint"),
        (lambda sim: sim.set_column("velocity", [np.inf, 0.0]), ValueError, "velocity: expected finite numbers"),
        (lambda sim: sim.step(), RuntimeError, "it may be changed, not stepped"),
    ],
)
def test_wrong_things_to_give(tmp_path, give, kind, words):
    deck = bar()
    with pytest.raises(kind, match=words):
        deck.run(tmp_path / "out", threads=1, prepare=give)
    assert not (tmp_path / "out").exists()
    if kind is RuntimeError:
        return
    sim = deck.simulation(threads=1)
    with pytest.raises(kind, match=words):
        give(sim)
    # nothing of it stays
    sim.step(10)
    assert sim.state_hash() == stepped(deck)


def stepped(deck):
    sim = deck.simulation(threads=1)
    sim.step(10)
    return sim.state_hash()


@pytest.mark.parametrize("every", [0, -1, 0.0, -2.5, float("nan"), "2 mm", "often", "0 s"])
def test_wrong_intervals(tmp_path, every):
    deck = peridyne.Deck.from_dict(crack())
    for observe, interval in [(print, every), (peridyne.Every(every, print), None), ([peridyne.Every(every, print)], 10)]:
        with pytest.raises(ValueError, match="every=.*expected 1 or more steps, or a time above 0"):
            deck.run(tmp_path / "out", observe=observe, every=interval)
    for wrong in [True, [3]]:
        with pytest.raises(TypeError, match="expected steps or a time"):
            deck.run(tmp_path / "out", observe=print, every=wrong)
    assert not (tmp_path / "out").exists()


def test_wrong_observers(tmp_path):
    deck = peridyne.Deck.from_dict(crack())
    with pytest.raises(TypeError, match="expected a function of a Simulation, got int"):
        peridyne.Every(10, 3)
    for observe in [3, "look", [print, 4], {"look": print}]:
        with pytest.raises(TypeError, match=r"peridyne.Every\(interval, function\), or a list of these, got"):
            deck.run(tmp_path / "out", observe=observe)
    for name in ["progress", "prepare"]:
        with pytest.raises(TypeError, match="expected a function of"):
            deck.run(tmp_path / "out", **{name: 3})
    # no unit of time belongs to numbers that have none
    plain = peridyne.Deck.from_dict({**CHAIN, "units": "none"})
    with pytest.raises(ValueError, match="expected 1 or more steps"):
        plain.run(tmp_path / "out", observe=print, every="1 s")


def test_the_engine_giving_up_is_an_exception(tmp_path, capfd):
    sim = peridyne.Deck.from_dict(CHAIN).simulation(threads=1)
    with pytest.raises(peridyne.RunError, match="the engine gave up: asked to; this is a defect of peridyne"):
        sim._give_up()
    with pytest.raises(RuntimeError, match="broke within an earlier call: make a new one"):
        sim.column("displacement")
    # in a run: the state that was written before stays
    deck = peridyne.Deck.from_dict(crack(checkpoint={"every": "1 s"}))
    deck.run(tmp_path / "out", threads=1, observe=lambda sim: sim.step_number == 100)
    with pytest.raises(peridyne.RunError, match="the engine gave up") as caught:
        peridyne.resume(tmp_path / "out", threads=1, prepare=lambda sim: sim._give_up())
    assert isinstance(caught.value, peridyne.Error)
    assert peridyne.resume(tmp_path / "out", threads=1).record["steps"] == 300


def test_a_function_cannot_ask_the_model_that_asks_it():
    sim = peridyne.Deck.from_dict(CHAIN).simulation(threads=1)
    with pytest.raises(RuntimeError, match="one thread, and one call, at a time"):
        sim.add_motion(lambda t, x: sim.time)
    sim.step(3)
    assert sim.step_number == 3


def test_what_was_lent_is_taken_back(tmp_path):
    kept = []
    deck = peridyne.Deck.from_dict(crack())

    def nested(sim):
        # a second run in the folder of this one
        with pytest.raises(peridyne.Error):
            deck.run(tmp_path / "out", threads=1)
        return True

    run = deck.run(tmp_path / "out", threads=1, prepare=kept.append, observe=nested, every=10)
    assert run.record["steps"] == 10
    with pytest.raises(RuntimeError, match="during the call of `observe` or `prepare` alone"):
        kept[0].add_force(lambda t, x, v: v)


def test_a_second_thread_may_ask_while_it_is_observed(tmp_path):
    answers = []

    def observe(sim):
        def ask():
            answers.append(sim.column("damage").shape)

        other = threading.Thread(target=ask)
        other.start()
        other.join()
        return True

    peridyne.Deck.from_dict(crack()).run(tmp_path / "out", threads=1, observe=observe, every=10)
    assert answers == [(800,)]


def test_a_run_knows_the_files_of_its_own_deck_alone(tmp_path):
    # another run of this process reads and writes files, too
    peridyne.Deck.from_dict(crack()).run(tmp_path / "other", threads=1)
    (tmp_path / "deck.toml").write_text(peridyne.Deck.from_dict(crack()).text)
    deck = peridyne.Deck.from_toml(tmp_path / "deck.toml")
    deck.run(tmp_path / "out", threads=1, observe=lambda sim: True, every=100)
    (tmp_path / "other/history.csv").write_text("")
    done = program("resume", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    assert peridyne.Run(tmp_path / "out").record["status"] == "done"
