"""Data files of the cases, the same every time."""
import os
import random

SPACING = 0.0005
HORIZON = 0.0015001
SHAPE = (8, 7, 7)


def sites():
    """Sites of a block of the simple cubic lattice, x fastest (the order of `create_atoms`)."""
    nx, ny, nz = SHAPE
    return [[i * SPACING, j * SPACING, k * SPACING] for k in range(nz) for j in range(ny) for i in range(nx)]


def perturbed(draw, part):
    """Sites moved by up to `part` spacings along every axis."""
    return [[x + draw.uniform(-part, part) * SPACING for x in site] for site in sites()]


def clear_of_horizon(points):
    """Whether no pair is within round-off of the horizon."""
    for i, a in enumerate(points):
        for b in points[:i]:
            r = sum((x - y) ** 2 for x, y in zip(a, b)) ** 0.5
            if abs(r / HORIZON - 1) < 1e-9:
                return False
    return True


def own_volume(draw):
    """A volume of about a cell. A whole multiple of 2^-40, so that sums of volumes, and with them the damage,
    are free of round-off whatever the order of summation."""
    return draw.randint(100, 175) * 2.0**-40


def cloud(path, title, seed, varied=False, speed=0.0):
    """A LAMMPS data file of `atom_style peri`: irregular points; volumes and densities of their own; velocities."""
    draw = random.Random(seed)
    points = perturbed(draw, 0.2)
    assert clear_of_horizon(points)
    with open(path, "w") as file:
        file.write(f"{title}\n\n{len(points)} atoms\n1 atom types\n\n")
        for axis, n in zip("xyz", SHAPE):
            file.write(f"{-2 * SPACING!r} {(n + 1) * SPACING!r} {axis}lo {axis}hi\n")
        file.write("\nAtoms # peri\n\n")
        for i, p in enumerate(points, 1):
            volume = own_volume(draw) if varied else 1.25e-10
            density = float(draw.randint(1900, 2500)) if varied else 2200.0
            file.write(f"{i} 1 {volume!r} {density!r} {p[0]!r} {p[1]!r} {p[2]!r}\n")
        if speed:
            file.write("\nVelocities\n\n")
            for i in range(1, len(points) + 1):
                v = [round(draw.uniform(-speed, speed), 6) for _ in range(3)]
                file.write(f"{i} {v[0]!r} {v[1]!r} {v[2]!r}\n")


def start(path, seed):
    """A dump with random displacements (up to 0.02 spacings) and velocities (up to 8 m/s) of the block."""
    draw = random.Random(seed)
    points = perturbed(draw, 0.02)
    with open(path, "w") as file:
        file.write(f"ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{len(points)}\nITEM: BOX BOUNDS ff ff ff\n")
        for n in SHAPE:
            file.write(f"{-2 * SPACING!r} {(n + 1) * SPACING!r}\n")
        file.write("ITEM: ATOMS id type x y z vx vy vz\n")
        for i, p in enumerate(points, 1):
            v = [round(draw.uniform(-8, 8), 6) for _ in range(3)]
            file.write(f"{i} 1 {p[0]!r} {p[1]!r} {p[2]!r} {v[0]!r} {v[1]!r} {v[2]!r}\n")


def write(folder):
    """Write all data files of the cases."""

    def at(name):
        return os.path.join(folder, name)

    start(at("block_pmb_random.start"), 11)
    start(at("block_lps_random.start"), 12)
    cloud(at("cloud_pmb_smooth.data"), "irregular points", 21)
    cloud(at("cloud_lps_smooth.data"), "irregular points", 22)
    varied = "irregular points with volumes and densities of their own"
    cloud(at("cloud_lps_displaced.data"), varied, 23, varied=True)
    cloud(at("cloud_lps_break.data"), varied, 25, varied=True)
    cloud(at("cloud_pmb_break.data"), varied + ", random velocities", 24, varied=True, speed=40.0)
