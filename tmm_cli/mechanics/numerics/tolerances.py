"""Numbers that decide: what counts as dead, near, converged, equal, parallel, redundant or at rest.

Each has a dimension and a reason; sizes and steps of a search stand where it searches. Two that mean the same are one;
two that have the same size for different reasons are two. Margins are without dimension: the sine of a transmission
angle, or the least singular value of a scaled Jacobian over the largest.
"""

from __future__ import annotations

# Rounding
ROUNDOFF = 2.0**-53  # relative: of float64
ROUNDINGS = 8.0  # units of the last place of the data: a distance below so many of them cannot be told from zero
CONSTRUCTION_ROUNDINGS = 16  # units of the last place that a construction of a few steps may lose
SURE_SIGN = 64 * 2.0**-52  # of a function's largest value: the sign of a larger one is sure

KNOWN_LAW = 1e-12  # relative: a law of motion that was found for a machine is known so far

# Dead positions
DEAD = 1e-6  # margin: the least of it is found to half the digits, 1e-8; a hundred times that is sure
DEAD_SKETCH = 1e-7  # margin in the sketch: closer, the assembly it shows cannot be told
SINGULAR = 1e-16  # margin: less is rounding of the matrix, and no velocity has a digit
NEAR_DEAD = 0.05  # sine of the transmission angle, 3 deg: a warning is due
NEAR_SINGULAR = 0.005  # singular values: likewise; a well-shaped triad has 0.1
BLURRED_PASSIVE = 0.1  # singular values, of a group with passive constraints: float64 leaves 1e-14 of accelerations
DEAD_COSINE = 5e-16  # of the terms of the cosine of a transmission angle in longdouble: 1 but for rounding
DEAD_COSINE_DOUBLE = 4e-15  # of the same terms in float64
DEAD_SWING = 1e-6  # rad: a lever that swings by so little less than half a turn is dead at both ends

# Newton's method, without dimension: sizes of the group, rad
LAST_STEP = 1e-9  # a step below this squares to less than rounding: it was the last
LAST_STEP_EXTENDED = 1e-20  # of double-doubles, whose steps are found in float64: the next is 1e-16 of this
LAST_STEP_AFAR = 1e-12  # the last of damped steps from anywhere: the next one is all rounding
CONVERGED = 1e-6  # a last step, or a residual, above this has not converged
GROUP_CLOSED = 1e-9  # residual of a group that is closed, and is not so to half the digits only

# Crossing of a dead position by a fitted way
CROSSING_AGREES = 1e-13  # scales of the driver: a place known closer than this is good enough at once
CROSSING_KNOWN = 1e-10  # scales of the driver: a place that is known worse is none
CROSSING_ROUNDED = 3e-14  # at the distance h (scales) a smooth way is met to this over h (sizes of the group, rad)
CROSSING_FITTED = 1e-10  # sizes of the group, rad: and to this in any case
SAMPLES_ROUNDED = 1e-16  # roundoff of what the samples are fitted from
NO_DETERMINANT = 1e-8  # of its largest value among the samples: a determinant this small is zero

LIMIT_ROUNDED = 1e-12  # relative: limits are interpolated to this
LIMIT_AGREES = (
    1e-8  # of the largest value of its kind: limits found from farther and from nearer positions agree so far
)

# Equal
SAME_ASSEMBLY = 1e-6  # sizes, rad: two assemblies are the same; found in a dead position they agree to half the digits
ASSEMBLIES_MEET = 1e-4  # sizes, rad: two assemblies this near, both dead, are one
CAME_BACK = 1e-6  # sizes of a group, or of a cycle: what is no farther off after a cycle is back where it was
SAME_DRIVER_POSITION = (
    1e-9  # rad, m: places of the driver, and times of strokes, that differ by rounding of a search only
)
SAME_IN_SKETCH = 1e-9  # sizes of the group, rad: two assemblies that differ by less at a point differ by rounding there
SAME_SKETCH = 1e-6  # of the farthest point: sketches that differ by no more are of one assembly
SAME_STATE = 1e-7  # sizes of the group, rad: states on a branch that are this near are the same
SAME_POSITION = 1e-12  # sine of half the angle between: half a whole turn more is the same angle
SEAM = 1e-12  # rad: a place this near to the end of a cycle is at the beginning of the next one
SEAM_OF_EXTREMES = 1e-7  # rad: the same of an extreme, which is found to half the digits
CONSTANT_INERTIA = 1e-9  # of a link's largest reduced inertia: a change below that over a cycle is rounding
SAME_RATIO = 1e-12  # relative: numbers that differ by what arithmetic on a file's numbers rounds (0.1 + 0.2 is not 0.3)
PARALLEL = 1e-9  # sine: lines that meet under less do not meet
SAME_POINTS = 1e-9  # of the size: places this near are one, and three this near to a line have no circle
PITCHES_TOUCH = 1e-6  # of the distance of the axes: pitch circles that miss one another by less touch
IN_PHASE = 5e-7  # rad: wheels that come round a ring to one place but for less fit, as offsets are rounded
WHOLE_TEETH = 1e-9  # teeth: a number that arithmetic gave is whole but for rounding
END_OF_SLOT = 1e-9  # of the segment: a stone this little beyond its end is at it

# Redundant constraints: the least real singular value of a linkage was 1e-2, an idle one has 1e-16
REDUNDANT = 1e-8  # of the largest singular value
DEPENDENT = 1e-9  # of the largest singular value, or of a row, out of the plane; dependent rows are at 1e-15
SHARED = 1e-6  # of one: a condition with less part in a sum that says nothing new has none
VANISHED = 1e-11  # sizes: a triad's polynomial with less everywhere is zero, and tells nothing
TRUNCATED = 1e-10  # of the largest singular value: what least squares takes for nothing

# At rest, or nothing
RESTS = 1e-12  # of the longest run: less is rounding
AT_REST = 1e-5  # of the largest speed in the mechanism: slower is at rest; lengths typed to 6 figures give such signs
WHOLE_TURNS = 1e-9  # turns: a wheel that has made whole ones but for less has made them but for rounding
SHOCKLESS = 1e-9  # of the largest angular speed: what jumps by less at the ends of a stroke does not jump
NO_DWELL = 1e-6  # rad: about a mere end of a stroke rounding makes a speed of zero over less than that
BESIDE_END = 1e-9  # rad: so far from a place a slope is taken on one side of it
NO_JUMP = 1e-6  # of the largest slope: a slope that is larger where its sign changes jumps there
AT_EDGE_OF_CAM = 2e-14  # rad, share of a piece: so near to a jump of its acceleration a place is behind it
NO_JUMP_OF_CAM = 1e-9  # of the largest rise, a radian: pieces of a cam's law whose slopes differ by less join smoothly
SMOOTH = 1e-13  # of the largest value: what a polynomial leaves of a smooth function
ALIKE_ANGLES = 1e-12  # rad: largest pressure angles that differ by less are one, found at several places
RIGHT_ANGLE = 1e-8  # rad: a pressure angle that goes to a right one at a dead position by less is one there
NO_PRESSURE = 1e-9  # rad: a pressure angle that is zero everywhere but for rounding has no largest place
LOST_IN_ROUNDING = 1e-14  # of what forces in several pairs would give: less is rounding of small ones among them
NO_COORDINATE = 1e-12  # of the linkage's size: a coordinate below that is zero but for rounding
NO_COSINE = 2.5e-16  # the cosine of the double next to a right angle is below this
NO_TURN = 1e-9  # rad: a plane does not turn by less
NO_VECTOR = 1e-9  # of a plan's size: shorter vectors are points
INFINITELY_FAR = 1e9  # sizes: a guide's force that acts farther away is what rounding leaves of a couple
NO_FORCE = 1e-12  # of the largest reaction there: a force below that is zero but for rounding, and points nowhere
NO_MOMENT = 1e-9  # of all forces times the size of the linkage: a balancing moment below that is nothing
NO_WORK = 1e-6  # of all the work that a load does and takes: less in a stroke is none
NO_DIFFERENCE = 1e-9  # of the largest: below, lever and force plan differ by rounding
NO_DEMAND = 1e-12  # of what a synthesis wants: a smaller measured value is zero
FRICTION_AGREES = 1e-13  # of the largest reaction: friction and the reactions that it comes from
FRICTION_ROUNDED = 1e-15  # of the largest reaction: a smaller step of Newton's method is rounding
FRICTION_LOCKS = 1e-9  # of the largest reaction: a last step above this, or a size below minus this, has no solution
NO_VIOLATION = 1e-12  # of its scale: a smaller violation is none that could be shown
DEMAND_MET = 1e-9  # relative: a wanted value is met when it is missed by less
