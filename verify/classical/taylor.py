"""Taylor's bar of copper by axisymmetric finite elements, the answer that `papers/gallery/taylor-bar` is measured by.

Usage: python taylor.py [ELEMENTS ACROSS ...] > taylor.csv

A bar of radius 3.2 mm and length 32.4 mm strikes a rigid wall without friction at 227 m/s. E = 117 GPa, nu = 0.35, 8930 kg/m3, von
Mises with a yield stress of 400 MPa that grows by 100 MPa per unit of plastic strain. Four-node elements with one point of
integration (forces that do the work of its rates), stiffness against hourglasses (Flanagan & Belytschko 1981), rates of Jaumann with
Hughes and Winget's rotation, the radial return of Wilkins, central differences with a step that follows the smallest element; 80 us.
Prints, as comments, length and foot radius (mm), the largest plastic strain, and the plastic work beside the kinetic energy at first;
of the last mesh the profile: where a place of the bar's side was, and where it is. Needs: pip install numpy; 5, 10 and 20 elements five minutes.
"""

import sys

import numpy as np

LENGTH, RADIUS, SPEED, END = 32.4e-3, 3.2e-3, 227.0, 80e-6
YOUNG, POISSON, DENSITY, YIELD, HARDENING = 117e9, 0.35, 8930.0, 400e6, 100e6
SHEAR = YOUNG / 2 / (1 + POISSON)
BULK = YOUNG / 3 / (1 - 2 * POISSON)
HOURGLASS = 0.05


def bar(across):
    along = round(across * LENGTH / RADIUS)
    r, z = np.meshgrid(np.linspace(0, RADIUS, across + 1), np.linspace(0, LENGTH, along + 1), indexing="ij")
    x = np.stack([r.ravel(), z.ravel()])
    node = np.arange(x.shape[1]).reshape(across + 1, along + 1)
    # counterclockwise in (r, z)
    element = np.stack([node[:-1, :-1], node[1:, :-1], node[1:, 1:], node[:-1, 1:]]).reshape(4, -1)
    count = element.shape[1]

    def shape(x):
        """Mean slopes times area, area, and the pattern of hourglasses."""
        r, z = x[0][element], x[1][element]
        b = 0.5 * np.stack([
            [z[1] - z[3], z[2] - z[0], z[3] - z[1], z[0] - z[2]],
            [r[3] - r[1], r[0] - r[2], r[1] - r[3], r[2] - r[0]],
        ])
        area = 0.5 * ((r[2] - r[0]) * (z[3] - z[1]) + (r[1] - r[3]) * (z[2] - z[0]))
        sign = np.array([1.0, -1.0, 1.0, -1.0])[:, None]
        gamma = sign - (sign * r).sum(0) * b[0] / area - (sign * z).sum(0) * b[1] / area
        return b, area, gamma, r.mean(0)

    b, area, gamma, radius = shape(x)
    mass_of = DENSITY * area * radius
    mass = np.zeros(x.shape[1])
    np.add.at(mass, element, np.broadcast_to(mass_of / 4, (4, count)))
    v = np.stack([np.zeros(x.shape[1]), np.full(x.shape[1], -SPEED)])
    foot, axis = node[:, 0], node[0]
    v[1, foot] = 0
    stress = np.zeros((4, count))  # rr, zz, tt, rz
    glass = np.zeros((2, count))
    plastic, work, time = np.zeros(count), 0.0, 0.0
    sound = np.sqrt((BULK + 4 / 3 * SHEAR) / DENSITY)
    kinetic = lambda v: np.pi * (mass * (v**2).sum(0)).sum()
    first = kinetic(v)
    while time < END:
        b, area, gamma, radius = shape(x)
        assert (area > 0).all()
        span = area / np.sqrt((b**2).sum((0, 1)) * 2)
        dt = min(0.9 * span.min() / sound, END - time)
        # rates at the middle of the step
        half = x + 0.5 * dt * v
        b, area, gamma, radius = shape(half)
        ve = v[:, element]
        grad = np.einsum("ane,bne->abe", ve, b) / area
        hoop = ve[0].mean(0) / radius
        d = np.stack([grad[0, 0], grad[1, 1], hoop]) * dt
        shear, spin = 0.5 * (grad[0, 1] + grad[1, 0]) * dt, 0.5 * (grad[0, 1] - grad[1, 0]) * dt
        # Hughes and Winget in one plane: the angle of the rotation
        angle = 2 * np.arctan(0.5 * spin)
        c, s = np.cos(angle), np.sin(angle)
        rr, zz, tt, rz = stress
        old = np.stack([
            c * c * rr + 2 * c * s * rz + s * s * zz,
            s * s * rr - 2 * c * s * rz + c * c * zz,
            tt,
            (c * c - s * s) * rz + c * s * (zz - rr),
        ])
        dv = d.sum(0)
        trial = old + 2 * SHEAR * np.stack([d[0], d[1], d[2], shear])
        trial[:3] += (BULK - 2 / 3 * SHEAR) * dv
        p = trial[:3].mean(0)
        dev = trial.copy()
        dev[:3] -= p
        q = np.sqrt(1.5 * ((dev[:3] ** 2).sum(0) + 2 * dev[3] ** 2))
        bound = YIELD + HARDENING * plastic
        flow = np.maximum(q - bound, 0) / (3 * SHEAR + HARDENING)
        keep = 1 - 3 * SHEAR * flow / np.maximum(q, 1e-300)
        stress = dev * keep
        stress[:3] += p
        plastic += flow
        # forces at the end of the step
        x = x + dt * v
        time += dt
        b, area, gamma, radius = shape(x)
        work += 2 * np.pi * (radius * area * flow * (YIELD + HARDENING * (plastic - 0.5 * flow))).sum()
        spring = HOURGLASS * SHEAR * (b**2).sum((0, 1)) / area
        glass += dt * spring * np.einsum("ane,ne->ae", ve, gamma) / 2
        rr, zz, tt, rz = stress
        # what does the work of these rates, per radian
        f = np.stack([
            -radius * (rr * b[0] + rz * b[1]) - area / 4 * tt - radius * glass[0] * gamma,
            -radius * (rz * b[0] + zz * b[1]) - radius * glass[1] * gamma,
        ])
        force = np.zeros_like(x)
        np.add.at(force[0], element, f[0])
        np.add.at(force[1], element, f[1])
        v = v + dt * force / mass
        v[0, axis] = 0
        v[1, foot] = 0
    kept = kinetic(v)
    print(
        f"# {across} across: length {1e3 * x[1].max():.3f} mm, foot radius {1e3 * x[0, foot].max():.3f} mm, plastic strain {plastic.max():.3f}, "
        f"plastic work {work:.1f} J of {first:.1f} J, {kept:.2f} J still move",
        flush=True,
    )
    return np.stack([np.linspace(0, LENGTH, along + 1), x[1, node[-1]], x[0, node[-1]]])


for n in [int(a) for a in sys.argv[1:]] or [5, 10, 20]:
    profile = bar(n)
print("reference z (mm),z (mm),r (mm)")
count = profile.shape[1]
for row in 1e3 * profile[:, sorted({*range(0, count, count // 50), count - 1})].T:
    print(",".join(f"{v:.4f}" for v in row))
