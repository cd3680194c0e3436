"""Double-doubles against 60 digits: every operation is good to its last bits, on numbers of all sizes and signs."""

import mpmath as mp
import numpy as np
import pytest

from tmm_cli.mechanics.numerics import EPS, DoubleDouble, array, to_double_double, to_float


@pytest.fixture(autouse=True)
def sixty_digits():
    with mp.workdps(60):
        yield


def some(seed, size=200):
    """Numbers between 1e-6 and 1e6 with all of their bits."""
    random = np.random.default_rng(seed)
    hi = random.choice([-1.0, 1.0], size) * 10.0 ** random.uniform(-6, 6, size)
    return DoubleDouble(hi, np.spacing(hi) * random.uniform(-0.5, 0.5, size))


def true(values):
    """The same numbers in 60 digits."""
    if values.dtype.kind == "c":
        return [mp.mpc(re, im) for re, im in zip(true(values.real), true(values.imag), strict=True)]
    return [mp.mpf(float(hi)) + mp.mpf(float(lo)) for hi, lo in zip(values.hi, values.lo, strict=True)]


def off(found, expected, size=None):
    """The largest error, in units of what was expected, or of a size."""
    return max(float(abs(a - b) / (size or abs(b))) for a, b in zip(true(found), expected, strict=True))


X, Y = some(1), some(2)
Z = X + 1j * Y
W = np.conj(some(3) + 1j * some(4))


@pytest.mark.parametrize(
    "operation", [lambda x, y: x + y, lambda x, y: x - y, lambda x, y: x * y, lambda x, y: x / y], ids="+-*/"
)
@pytest.mark.parametrize("pair", [(X, Y), (Z, W), (X, W), (Z, Y)], ids=["real", "complex", "mixed", "mixed too"])
def test_sums_products_and_quotients_are_good_to_the_last_bits(operation, pair):
    expected = [operation(a, b) for a, b in zip(*map(true, pair), strict=True)]
    assert off(operation(*pair), expected) < 4 * EPS


def test_a_difference_of_nearly_equal_numbers_is_exact():
    near = X + 1e-25 * X
    assert off(near - X, [a - b for a, b in zip(true(near), true(X), strict=True)]) < EPS


def test_roots_sizes_and_powers():
    assert off(np.sqrt(abs(X)), [mp.sqrt(abs(x)) for x in true(X)]) < EPS
    assert off(abs(Z), [abs(z) for z in true(Z)]) < 2 * EPS
    assert off(X**3, [x**3 for x in true(X)]) < 4 * EPS
    assert to_float(2.0 ** to_double_double(3.0)) == 8 and to_float(4.0 ** to_double_double(0.5)) == 2, (
        "of plain numbers too"
    )
    assert off(abs(X) ** -0.5 * abs(X) ** 0.5, [mp.mpf(1)] * len(X)) < 1e-15, "powers that are no whole number round"


@pytest.mark.parametrize("name", ["sin", "cos"])
def test_sines_and_cosines_of_many_turns(name):
    angles = some(5) * 1e-4
    expected = [getattr(mp, name)(a) for a in true(angles)]
    assert off(getattr(np, name)(angles), expected, size=1) < 4 * EPS * 100


def test_angles_of_directions_all_round():
    assert off(np.arctan2(Y, X), [mp.atan2(y, x) for y, x in zip(true(Y), true(X), strict=True)], size=mp.pi) < 2 * EPS
    share = X / abs(Z)
    assert off(np.arccos(share), [mp.acos(x) for x in true(share)], size=1) < 4 * EPS
    assert off(np.arcsin(share), [mp.asin(x) for x in true(share)], size=1) < 4 * EPS


def test_decimals_are_read_to_thirty_digits():
    assert off(DoubleDouble.decimal("38.925549624985472").reshape(1), [mp.mpf("38.925549624985472")]) < EPS
    assert off(DoubleDouble.decimal("0.1").reshape(1), [mp.mpf("0.1")]) < EPS


def test_whole_turns_and_tables():
    turned = np.mod(X, 2 * np.pi)
    assert off(turned, [mp.fmod(x, 2 * mp.mpf(np.pi)) % (2 * mp.mpf(np.pi)) for x in true(X)], size=1) < 1e6 * EPS
    found = np.interp(to_double_double(np.array([0.5, 1.0, 3.0])), (0.0, 1.0, 1.0, 2.0), (0.0, 1.0, 5.0, 7.0))
    assert to_float(found).tolist() == [0.5, 5.0, 7.0], "the table jumps at 1 and stays beyond its end"


def test_what_is_infinite_or_none_stays_so():
    with np.errstate(all="ignore"):
        found = to_double_double(np.array([1.0, -1.0, 0.0])) / 0.0
    assert to_float(found)[:2].tolist() == [np.inf, -np.inf] and np.isnan(found[2])
    assert not np.any(np.isfinite(found))


def test_numbers_are_compared_by_all_of_their_bits():
    above = to_double_double(np.array([1.0])) + 1e-25
    assert above > 1.0 and not above <= 1.0 and above != 1.0
    assert np.maximum(above, 1.0) == above


def test_half_of_the_digits_are_never_lost_unasked():
    with pytest.raises(TypeError, match="astype"):
        np.asarray(X)
    assert array([X[0], 1.0]).hi.shape == (2,)
