"""Two coupled wheels that roll without slipping: the linear part of the plant, solved exactly.

While both tyres hold, the robot has two degrees of freedom, its wheel speeds, and between two changes of its dry
friction it is linear:  M w' = b - A w  with the 2x2 inertia matrix M (chassis reflected to the wheels) and the
diagonal damping A (back-EMF and viscous friction).  Its matrix exponential has a closed form, because the
eigenvalues of M^-1 A are real (M and A are symmetric and not negative).

Sources: elementary linear systems.
"""

from __future__ import annotations

from math import exp, expm1, sqrt


def decay(rate: float, span: float) -> tuple[float, float, float]:
    """exp(-rate t), its integral from 0 to `span`, and the integral of that, for `rate` >= 0."""
    x = rate * span
    if x < 1e-3:
        return (
            exp(-x),
            span * (1.0 - x * (0.5 - x * (1.0 / 6.0 - x / 24.0))),
            span * span * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x / 120.0))),
        )
    gone = -expm1(-x)
    once = gone / rate
    return 1.0 - gone, once, (span - once) / rate


def one_wheel(omega: float, torque: float, damping: float, inertia: float, span: float) -> tuple[float, float]:
    """A single degree of freedom: speed after `span` seconds and the angle turned."""
    _, once, twice = decay(damping / inertia, span)
    start = (torque - damping * omega) / inertia
    return omega + start * once, omega * span + start * twice


def two_wheels(
    left: float,
    right: float,
    start_left: float,
    start_right: float,
    p: tuple[float, float, float, float],
    span: float,
) -> tuple[float, float, float, float]:
    """Speeds after `span` seconds and angles turned, from speeds and accelerations now.

    `p` is M^-1 A by rows.  With a = the accelerations now:  w(t) = w + F1(P) a  and  angle = w t + F2(P) a, where
    F1, F2 are the first and second integral of exp(-P t); for a 2x2 matrix F(P) = f0 + f1 P.
    """
    p11, p12, p21, p22 = p
    mean = 0.5 * (p11 + p22)
    under = 0.25 * (p11 - p22) * (p11 - p22) + p12 * p21
    # Interpolating F between the eigenvalues; ones that (nearly) coincide are bracketed, which costs less than 1e-9.
    split = max(sqrt(under) if under > 0.0 else 0.0, 1e-3 * mean + 1e-9)
    _, once_low, twice_low = decay(mean - split, span)
    _, once_high, twice_high = decay(mean + split, span)
    gap = 0.5 / split
    once_1 = (once_high - once_low) * gap
    twice_1 = (twice_high - twice_low) * gap
    low = mean - split
    once_0 = once_low - low * once_1
    twice_0 = twice_low - low * twice_1
    turned_left = p11 * start_left + p12 * start_right
    turned_right = p21 * start_left + p22 * start_right
    return (
        left + once_0 * start_left + once_1 * turned_left,
        right + once_0 * start_right + once_1 * turned_right,
        left * span + twice_0 * start_left + twice_1 * turned_left,
        right * span + twice_0 * start_right + twice_1 * turned_right,
    )
