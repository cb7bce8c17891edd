"""Reference values anew, to 32 digits: ``python tests/data/generate.py`` checks the files here.

The closed forms in elliptic integrals, evaluated by mpmath. It exits with 1 if a value in a file
differs by more than the digits that the file has. Shooting on the differential equations agrees to
3e-31. Units: length L, force EI/L^2, moment EI/L, angles in rad.

- ``observables.csv``, ``events.csv``: the paper's boundary value problems
- ``cantilever_tip_load.csv``: Mattiasson (1981); ``column_postbuckling.csv``: Timoshenko and Gere
- ``general_vibrissa.csv``: shooting by DOP853, residual below 1e-13
- ``beyond_*.csv``: shooting of order 8, residual below 1.5e-14, of events 6e-12; in
  ``beyond_friction_space.csv`` the direction again by small steps of Coulomb's law, 5e-10 to 4e-7
"""

import csv
import sys
from pathlib import Path

from mpmath import (
    asin,
    asinh,
    cos,
    diff,
    ellipe,
    ellipf,
    ellipk,
    findroot,
    mp,
    mpf,
    pi,
    radians,
    sin,
    sqrt,
    tan,
)

mp.dps = 32
HERE = Path(__file__).parent
# Of the largest of 1 and the value. Files have 14 or 16 digits; the snap-off in events.csv was
# found by minimising x0, so what it holds besides x0 is good to about 1e-10 only.
DIGITS = mpf("2e-13")
OF_A_MINIMUM = mpf("1e-9")


def catenary(a, c):
    return lambda alpha: (asinh(tan(alpha) / a) / a, sqrt(1 + (tan(alpha) / a) ** 2) + c)


def parabola(a, c):
    return lambda alpha: (tan(alpha) / (2 * a), tan(alpha) ** 2 / (4 * a) + c)


def two_circles(right, left, c):
    def point(alpha):
        radius = right if alpha > 0 else left
        return radius * sin(alpha), c + radius * (1 - cos(alpha))

    return point


PROFILES = {
    "g1": catenary(mpf(1) / 2, mpf(-4) / 5),
    "g2": parabola(mpf(1) / 2, mpf(1) / 2),
    "g3": two_circles(mpf(2), mpf(1) / 2, mpf(1) / 2),
    "gfig12": catenary(mpf(1) / 4, mpf(-4) / 5),
}


def span(alpha, phi1):
    """q, S, C of a span from the clamp to a contact where the beam's slope angle is phi1."""
    k = sin(pi / 4 - (phi1 - alpha) / 2)
    begin = asin(sin(alpha / 2) / k)
    q = ellipk(k * k) - ellipf(begin, k * k)
    return q, 2 * (ellipe(k * k) - ellipe(begin, k * k)) - q, 2 * k * cos(begin)


def rise(alpha, phi1):
    q, s, c = span(alpha, phi1)
    return c * sin(alpha) + s * cos(alpha), q


def tangential_length(profile, alpha):
    up, q = rise(alpha, alpha)
    return q * PROFILES[profile](alpha)[1] / up


def tip_angle(profile, alpha):
    """Phase A: the slope angle at the tip, by halving between the ends of its range."""
    eta = PROFILES[profile](alpha)[1]

    def missed(phi1):
        up, q = rise(alpha, phi1)
        return up / q - eta

    low, high = alpha, min(pi / 2, pi / 2 + 2 * alpha) * (1 - mpf(10) ** -30)
    return findroot(missed, (low, high), solver="anderson", tol=mpf(10) ** -60, verify=False)


def state(profile, alpha):
    """All columns of a contact."""
    xi, eta = PROFILES[profile](alpha)
    tangent = tangential_length(profile, alpha) < 1 and rise(alpha, alpha)[0] > 0
    phi1 = alpha if tangent else tip_angle(profile, alpha)
    q, s, c = span(alpha, phi1)
    root_f = (c * sin(alpha) + s * cos(alpha)) / eta if tangent else q
    f = root_f**2
    return {
        "alpha": alpha, "phase": "B" if tangent else "A", "phi1": phi1, "s1": q / root_f, "f": f,
        "x0": xi - (c * cos(alpha) - s * sin(alpha)) / root_f,
        "F_Ax": -f * sin(alpha), "F_Ay": f * cos(alpha), "M_Az": c * root_f, "xi": xi, "eta": eta,
    }  # fmt: skip


def event(profile, name, near):
    """An event; `near` is where the file has it, to start from."""

    def eta_missed(alpha):
        return PROFILES[profile](alpha)[1] - 1

    def length_missed(alpha):
        return tangential_length(profile, alpha) - 1

    def length_rate(alpha):
        return diff(lambda a: tangential_length(profile, a), alpha)

    def foot_rate(alpha):
        return diff(lambda a: state(profile, a)["x0"], alpha)

    def moment(alpha):  # phi1 is then at the end of its range
        up, q = rise(alpha, pi / 2 + 2 * alpha)
        return up / q - PROFILES[profile](alpha)[1]

    conditions = {
        "first_contact": eta_missed, "phase_b_start": length_missed, "phase_b_end": length_missed,
        "contact_length_minimum": length_rate, "snap_off": foot_rate, "zero_moment": moment,
    }  # fmt: skip
    alpha = findroot(conditions[name], (near, near * (1 + mpf(10) ** -8)), tol=mpf(10) ** -30)
    if name == "first_contact":
        xi, eta = PROFILES[profile](alpha)
        return {"alpha": alpha, "x0": xi, "xi": xi, "eta": eta}
    if name == "contact_length_minimum":
        return {"alpha": alpha, "s1": tangential_length(profile, alpha)}
    if name == "zero_moment":
        q, s, c = span(alpha, pi / 2 + 2 * alpha)
        xi, eta = PROFILES[profile](alpha)
        x0 = xi - (c * cos(alpha) - s * sin(alpha)) / q
        return {"alpha": alpha, "phi1": pi / 2 + 2 * alpha, "f": q**2, "x0": x0, "eta": eta}
    return state(profile, alpha)


def cantilever(load):
    """Mattiasson's cantilever under a dead transverse tip load P L^2/(EI)."""
    load = mpf(load)

    def missed(theta):
        k = sqrt((1 + sin(theta)) / 2)
        return ellipk(k * k) - ellipf(asin(1 / (k * sqrt(2))), k * k) - sqrt(load)

    ends = mpf(10) ** -6, pi / 2 - mpf(10) ** -9
    theta = findroot(missed, ends, solver="anderson", tol=mpf(10) ** -56)
    k = sqrt((1 + sin(theta)) / 2)
    along = ellipe(k * k) - ellipe(asin(1 / (k * sqrt(2))), k * k)
    return {
        "w_over_L": 1 - 2 * along / sqrt(load), "u_over_L": 1 - sqrt(2 * sin(theta) / load),
        "theta_tip_rad": theta, "M0_L_EI": sqrt(2 * load * sin(theta)),
    }  # fmt: skip


def column(degrees_at_tip):
    """The clamped-free column beyond buckling (Timoshenko and Gere)."""
    k = sin(radians(mpf(degrees_at_tip)) / 2)
    whole = ellipk(k * k)
    return {
        "P_over_Pcr": (2 * whole / pi) ** 2, "xa_over_L": 2 * ellipe(k * k) / whole - 1,
        "ya_over_L": 2 * k / whole, "f": whole**2,
    }  # fmt: skip


def anew(file, row):
    """The values of a row, computed again."""
    if file == "observables.csv":
        return state(row["profile"], radians(mpf(row["alpha_deg"])))
    if file == "events.csv":
        return event(row["profile"], row["event"], mpf(row["alpha"]))
    if file == "cantilever_tip_load.csv":
        return cantilever(row["PL2_EI"])
    return column(row["tip_angle_deg"])


def main() -> int:
    wrong = checked = 0
    for path in sorted(HERE.glob("*.csv")):
        with path.open(encoding="utf-8") as file:
            for row in csv.DictReader(file):
                found = anew(path.name, row)
                minimum = row.get("event") == "snap_off"
                for name, value in found.items():
                    if not row.get(name):
                        continue
                    if name == "phase":
                        differs = row[name] != value
                    else:
                        kept = mpf(row[name])
                        allowed = OF_A_MINIMUM if minimum and name != "x0" else DIGITS
                        differs = abs(kept - value) > allowed * max(1, abs(value))
                    checked += 1
                    if differs:
                        wrong += 1
                        print(f"{path.name}: {dict(row)}: {name} is {value}")
    print(f"{checked} values computed again, {wrong} of them differ")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
