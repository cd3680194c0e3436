"""Numbers of some 31 digits, the sum of two doubles, as arrays that NumPy's functions take.

The ordinary code of the stages runs on them as it stands, alike on every machine; the difference to float64 is the
rounding error itself. A complex number is a sum of two complex ones: real and imaginary parts are sums of their own.
"""

from tmm_cli.double_double import functions  # noqa: F401  NumPy's functions know the numbers from now on
from tmm_cli.double_double.number import EPS, DoubleDouble, array, exactly, rounded
from tmm_cli.double_double.turning import PI

__all__ = ["EPS", "PI", "DoubleDouble", "array", "exactly", "rounded"]
