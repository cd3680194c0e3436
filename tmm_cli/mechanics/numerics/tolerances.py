"""Tolerances: thresholds that decide if something is dead, nearly dead, converged, equal, parallel, redundant, at rest.

The unit and the reason of each are given beside it; step sizes and iteration counts are in the module that searches.
Two thresholds with the same meaning are one constant; two with the same value for different reasons are two. A margin
is dimensionless: the sine of a transmission angle, or the smallest singular value of a scaled Jacobian divided by the
largest.
"""

from __future__ import annotations

# Rounding
ROUNDOFF = 2.0**-53  # relative: of float64
ROUNDINGS = 8.0  # units in the last place of the data: smaller distances cannot be distinguished from zero
CONSTRUCTION_ROUNDINGS = 16  # units in the last place that a construction of a few steps may lose
SURE_SIGN = 64 * 2.0**-52  # fraction of the largest value of a function: the sign of greater values is certain

KNOWN_LAW = 1e-12  # relative accuracy of a law of motion computed for a machine

# Dead positions
DEAD = 1e-6  # margin: its minimum is accurate to half the digits, 1e-8; a hundred times that is certain
DEAD_SKETCH = 1e-7  # margin in the sketch: below it the assembly cannot be determined
SINGULAR = 1e-16  # margin: less is rounding of the matrix, and velocities have no correct digit
NEAR_DEAD = 0.05  # sine of the transmission angle, 3 deg: limit of the warning
NEAR_SINGULAR = 0.005  # singular values: limit of the warning; a well-proportioned triad has 0.1
BLURRED_PASSIVE = 0.1  # singular values, group with redundant constraints: float64 then gives accelerations to 1e-14
DEAD_COSINE = 5e-16  # fraction of the terms of the cosine of a transmission angle in longdouble: 1 within rounding
DEAD_COSINE_DOUBLE = 4e-15  # the same in float64
DEAD_SWING = 1e-6  # rad: a lever whose swing angle is this close to half a turn is dead at both ends

# Newton's method, dimensionless: sizes of the group, rad
LAST_STEP = 1e-9  # the square of a smaller step is below rounding: it was the last
LAST_STEP_EXTENDED = 1e-20  # in double-doubles, with steps computed in float64: the next is 1e-16 of this
LAST_STEP_AFAR = 1e-12  # last damped step from an arbitrary guess: the next one is rounding
CONVERGED = 1e-6  # last step or residual above which the iteration has not converged
GROUP_CLOSED = 1e-9  # residual of a closed group; more is closed to half the digits only

# Crossing of a dead position on a fitted branch; unit of q: see BranchFollower.scale
CROSSING_AGREES = 1e-13  # units of q: uncertainty that is accepted at once
CROSSING_KNOWN = 1e-10  # units of q: largest uncertainty of a crossing
CROSSING_ROUNDED = (
    3e-14  # at the distance h (units of q) a smooth branch is met to this over h (sizes of the group, rad)
)
CROSSING_FITTED = 1e-10  # sizes of the group, rad: added to the above
SAMPLES_ROUNDED = 1e-16  # roundoff of the fitted samples
NO_DETERMINANT = 1e-8  # fraction of its largest value among the samples: a smaller determinant is zero

LIMIT_ROUNDED = 1e-12  # relative accuracy of interpolated limits
LIMIT_AGREES = 1e-8  # fraction of the largest value of its kind: agreement of limits from farther and nearer positions

# Equality
SAME_ASSEMBLY = 1e-6  # sizes, rad: two assemblies are equal; in a dead position they agree to half the digits
ASSEMBLIES_MEET = 1e-4  # sizes, rad: two dead assemblies this near are one
CAME_BACK = 1e-6  # sizes of a group, or fraction of a cycle: a smaller deviation after a cycle is a return
SAME_DRIVER_POSITION = (
    1e-9  # rad, m: driver coordinates, and times of strokes, that differ by rounding of a search only
)
SAME_IN_SKETCH = 1e-9  # sizes of the group, rad: a smaller difference of two assemblies at a point is rounding
SAME_SKETCH = 1e-6  # fraction of the farthest point: sketches that differ by less show one assembly
SAME_STATE = 1e-7  # sizes of the group, rad: states on a branch this near are the same
SAME_POSITION = 1e-12  # sine of half the difference of two angles that are equal up to full turns
SEAM = 1e-12  # rad: a driver coordinate this near to the end of a cycle is the beginning of the next one
SEAM_OF_EXTREMES = 1e-7  # rad: the same for an extreme, which is accurate to half the digits
CONSTANT_INERTIA = 1e-9  # fraction of the largest reduced inertia of a link: smaller changes over a cycle are rounding
SAME_RATIO = 1e-12  # relative: numbers that differ by rounding of arithmetic in a file (0.1 + 0.2 is not 0.3)
PARALLEL = 1e-9  # sine of the angle of two lines that count as parallel
SAME_POINTS = 1e-9  # fraction of the size: points this near coincide, and three this near to a line have no circle
PITCHES_TOUCH = 1e-6  # fraction of the centre distance: pitch circles that miss each other by less touch
IN_PHASE = 5e-7  # rad: closing error of gears round a ring that is due to rounded offsets
WHOLE_TEETH = 1e-9  # teeth: deviation from an integer that is rounding
END_OF_SLOT = 1e-9  # fraction of the segment: a sliding block this little beyond its end is at the end

# Redundant constraints: the least true singular value of a linkage was 1e-2, a redundant one has 1e-16
REDUNDANT = 1e-8  # fraction of the largest singular value
DEPENDENT = 1e-9  # fraction of the largest singular value, out of the plane; dependent rows are at 1e-15
SHARED = 1e-6  # least coefficient of a condition in a redundant combination
VANISHED = 1e-11  # sizes: the polynomial of a triad with smaller values everywhere vanishes identically
TRUNCATED = 1e-10  # fraction of the largest singular value: least squares treats smaller ones as zero

# At rest, or zero
RESTS = 1e-12  # fraction of the longest run: less is rounding
AT_REST = 1e-5  # fraction of the largest speed: slower is at rest; lengths typed to 6 figures give such speeds
WHOLE_TURNS = 1e-9  # turns: deviation from an integer that is rounding
SHOCKLESS = 1e-9  # fraction of the largest angular speed: smaller jumps at the ends of a stroke are none
NO_DWELL = 1e-6  # rad: a shorter dwell at the end of a stroke is rounding of the speed
BESIDE_END = 1e-9  # rad: distance at which a slope is taken on one side
NO_JUMP = 1e-6  # fraction of the largest slope: a greater slope at a change of sign is a jump
AT_EDGE_OF_CAM = 2e-14  # rad, fraction of a piece: a cam angle this near to a jump of the acceleration is beyond it
NO_JUMP_OF_CAM = (
    1e-9  # fraction of the largest rise, per radian: pieces of a cam law whose slopes differ by less join smoothly
)
SMOOTH = 1e-13  # fraction of the largest value: residual of a polynomial fit of a smooth function
ALIKE_ANGLES = 1e-12  # rad: maxima of a pressure angle that differ by less are equal
RIGHT_ANGLE = 1e-8  # rad: a pressure angle this near to 90 deg at a dead position tends to 90 deg
NO_PRESSURE = 1e-9  # rad: a smaller pressure angle is zero
LOST_IN_ROUNDING = 1e-14  # fraction of the sum of force components: less is rounding
NO_COORDINATE = 1e-12  # fraction of the size of the linkage: a smaller coordinate is zero
NO_COSINE = 2.5e-16  # the cosine of the double nearest to 90 deg is below this
NO_TURN = 1e-9  # rad: a smaller rotation is none
NO_VECTOR = 1e-9  # fraction of the size of a plan: shorter vectors are points
INFINITELY_FAR = 1e9  # sizes: a guide force that acts farther away is a couple within rounding
NO_FORCE = 1e-12  # fraction of the largest reaction: a smaller force is zero and has no direction
NO_MOMENT = 1e-9  # fraction of all forces times the size of the linkage: a smaller balancing moment is zero
NO_WORK = 1e-6  # fraction of the total absolute work of a load: less in a stroke is zero
NO_DIFFERENCE = 1e-9  # fraction of the largest: smaller differences of Zhukovsky lever and force plan are rounding
NO_DEMAND = 1e-12  # fraction of the required value of a synthesis: a smaller result is zero
FRICTION_AGREES = 1e-13  # fraction of the largest reaction: agreement of friction and the reactions that cause it
FRICTION_ROUNDED = 1e-15  # fraction of the largest reaction: a smaller step of Newton's method is rounding
FRICTION_LOCKS = (
    1e-9  # fraction of the largest reaction: no solution with a greater last step, or a force below minus this
)
NO_VIOLATION = 1e-12  # fraction of its scale: a smaller violation is none
DEMAND_MET = 1e-9  # relative: a required value is met within this
