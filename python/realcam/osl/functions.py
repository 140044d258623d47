"""Templates of the OSL functions that make up a lens shader.

Rays are traced from the film to the scene, in mm. Directions have the length of the refractive index of their medium
(optical directions), so that Snell's law changes them only along the normal; all formulas scale with that length.
`forwards` is the sign of the ray's z direction: -1 towards the scene, 1 between two mirrors. `at`: position, mm, in the
frame of the vertex of the last surface; `way`: optical direction. Functions return 1 if the ray passes, otherwise 0.
"""

SPHERE = """\
// Traces a ray through a sphere or a plane. gap: distance from its vertex to that of the last surface. rim: clear
// semi-diameter. before, behind: squares of the indices in the order of the ray.
int cross_sphere(float gap, float curvature, float rim, float before, float behind, float forwards,
                 output point at, output vector way)
{
    at[2] += gap;
    float f = curvature * dot(at, at) - 2 * at[2];
    float g = way[2] - curvature * dot(at, way);
    // Squared components of the direction along the normal, before and behind the surface; they differ by the squared
    // indices.
    float inside = g * g - curvature * before * f;
    float refracted = inside + (behind - before);
    if (inside <= 0 || refracted < 0) return 0;
    float along = forwards * (curvature == 0 ? abs(g) : sqrt(inside));
    // The form of the quadratic equation's solution without cancellation.
    float path = g * forwards >= 0 ? f / (g + along) : (g - along) / (curvature * before);
    at += path * way;
    float facing = 1 - curvature * at[2];
    if (at[0] * at[0] + at[1] * at[1] > rim * rim || facing <= 0) return 0;
    float turn = forwards * sqrt(refracted) - along;
    way += turn * vector(-curvature * at[0], -curvature * at[1], facing);
    return 1;
}
"""

HOLE = """\
// Returns 1 if a point of a surface is outside of its central hole, of this radius.
int misses_hole(float hole, point at)
{
    return at[0] * at[0] + at[1] * at[1] >= hole * hole;
}
"""

MIRROR = """\
// Traces a ray to a mirror; parameters as for cross_sphere. medium: squared index in front of it.
int cross_mirror(float gap, float curvature, float rim, float medium, float forwards,
                 output point at, output vector way)
{
    if (!cross_sphere(gap, curvature, rim, medium, medium, forwards, at, way)) return 0;
    vector facing = vector(-curvature * at[0], -curvature * at[1], 1 - curvature * at[2]);
    way -= 2 * dot(way, facing) * facing;
    return 1;
}
"""

PLANE = """\
// Intersection of a ray with the plane z = 0.
point met(point at, vector way)
{
    return at - at[2] / way[2] * way;
}

// Returns 1 if a ray passes a plane aperture. The ray's position is only converted to the frame of the plane.
int pass_plane(float gap, float rim, output point at, vector way)
{
    at[2] += gap;
    point here = met(at, way);
    return here[0] * here[0] + here[1] * here[1] <= rim * rim;
}
"""

STOP = """\
// Area of a diaphragm opening over the square of its apothem: n arcs that touch the unit circle, within a circle of
// radius `rim`.
float opening_area(float blades, float rounding, float rim)
{
    float half = M_PI / blades;
    float cosine = cos(half);
    float linear = (1 - rounding) * cosine;
    float corner = (2 - rounding) / (linear + sqrt(linear * linear + rounding * (2 - rounding)));
    float edge = half;
    if (corner > rim) {
        // Azimuth at which the arc meets the rim.
        edge = rounding >= 1 ? half : acos(min(1, (2 - rounding - rounding * rim * rim) / (2 * (1 - rounding) * rim)));
        corner = rim;
    }
    // Half of the area under an arc: the sector of its circle minus the triangle of both centres and the corner.
    float piece = 0.5 * corner * cos(edge) * corner * sin(edge);
    if (rounding > 0) {
        float radius = 1 / rounding;
        float reach = corner * sin(edge);
        piece = 0.5 * radius * radius * asin(min(1, reach / radius)) - 0.5 * (radius - 1) * reach;
    }
    return 2 * blades * (piece + 0.5 * rim * rim * (half - edge));
}

// Apothem of a diaphragm whose opening has the area of a circle of this radius, within a circle of radius `rim`; by
// bisection.
float apothem_of(float blades, float rounding, float radius, float rim)
{
    if (radius >= rim) return rim;
    float low = 0.5 * radius;
    float high = radius;
    for (int i = 0; i < 20; ++i) {
        float middle = 0.5 * (low + high);
        if (middle * middle * opening_area(blades, rounding, rim / middle) < M_PI * radius * radius) low = middle;
        else high = middle;
    }
    return high;
}

// Returns 1 if a ray passes the diaphragm. Its blades are arcs or straight lines at the apothem's distance from the
// axis; corner: radius of the circle through the opening's corners.
int pass_stop(float gap, float corner, float blades, float rounding, float rotation, float apothem,
              output point at, vector way)
{
    if (!pass_plane(gap, corner, at, way)) return 0;
    if (blades < 3) return 1;
    point here = met(at, way);
    float squared = here[0] * here[0] + here[1] * here[1];
    float width = 2 * M_PI / blades;
    float turned = mod(atan2(here[1], here[0]) - rotation + 0.5 * width, width) - 0.5 * width;
    float bow = rounding / apothem;
    return bow * (squared + apothem * apothem) + 2 * (1 - rounding) * sqrt(squared) * cos(turned) <= 2 * apothem;
}
"""

ASPHERE = """\
// Sag of surface {number} in mm, and its first and second derivative (slope, bow) by t. t is linear in the squared
// distance from the axis: -1 on the axis, 1 at the rim.
void shape_{number}(float t, output float height, output float slope, output float bow)
{{
{powers}    height = {height};
    slope = {slope};
    bow = {bow};
}}

// As cross_sphere for an asphere, by Newton's method from the plane z = {start}.
int cross_surface_{number}(float gap, float before, float behind, float forwards, output point at, output vector way)
{{
    at[2] += gap;
    // Along the ray, t is a quadratic polynomial of the path.
    float start = {scale} * (at[0] * at[0] + at[1] * at[1]) - 1;
    float b = {scale} * (at[0] * way[0] + at[1] * way[1]);
    float a = {scale} * (way[0] * way[0] + way[1] * way[1]);
    float path = ({start} - at[2]) / way[2];
    float next = start + path * (2 * b + path * a);
    float t = next;
    float height = 0;
    float slope = 0;
    float bow = 0;
    float step = 0;
{steps}    if (abs(step) > {farthest} || next > 1) return 0;
    at += path * way;
    // Slope at the end of the last step, by the second derivative.
    slope += bow * (next - t);
    float lean = {lean} * slope;
    float along = way[2] - 2 * slope * (b + path * a);
    float squared = 1 + 2 * lean * slope * (1 + next);
    float refracted = along * along + (behind - before) * squared;
    if (refracted < 0 || along * forwards <= 0) return 0;
    way += {turn} * (1 / squared) * vector(-lean * at[0], -lean * at[1], 1);
    return 1;
}}
"""

ROUGH_STEP = """\
    // A Newton step with a polynomial of few terms.
    slope = {slope};
    path -= (at[2] + path * way[2] - ({height})) / (way[2] - 2 * slope * (b + path * a));
    next = start + path * (2 * b + path * a);
"""

STEP = """\
    // A Newton step with the sag, which is continued linearly in t beyond the rim.
    t = next;
    shape_{number}(min(t, 1), height, slope, bow);
    step = (at[2] + path * way[2] - height - slope * max(t - 1, 0)) / (way[2] - 2 * slope * (b + path * a));
    path -= step;
    next = start + path * (2 * b + path * a);
"""

PUPIL = """\
// Interpolates the pupil table: the ellipse of direction cosines (l, m) in which light reaches a film point on the x
// axis, with its centre `middle` in l, its half axes, and the central obstruction `hole` relative to the half axes.
// share: film radius relative to the largest one of the table. open: radius of the stop's corners relative to the fully
// open stop.
void find_pupil(float share, float focus, float open, float colour, output float middle, output float half_l,
                output float half_m, output float hole)
{{
    float ellipses[{count}] = {ellipses};
    float levels[{stops}] = {levels};{drifts}
    int stop = {choice};
    float closing = clamp((levels[stop] - open) / (levels[stop] - levels[stop + 1]), 0, 1);
    float place = (1 - sqrt(1 - share)) * ({rows} - 1);
    int row = min((int)place, {rows} - 2);
    float focal = focus * ({foci} - 1);
    int state = min((int)focal, {foci} - 2);
    float bulge = 0;
    for (int i = 0; i < 4; ++i) {{
        int next_state = i / 2;
        int next_row = i % 2;
        float weight = (next_state ? focal - state : 1 + state - focal) * (next_row ? place - row : 1 + row - place);
        int wide = (((state + next_state) * {stops} + stop) * {rows} + row + next_row) * {columns};
        int narrow = wide + {rows} * {columns};
        middle += weight * mix(ellipses[wide], ellipses[narrow], closing);
        half_l += weight * mix(ellipses[wide + 1], ellipses[narrow + 1], closing);
        half_m += weight * mix(ellipses[wide + 2], ellipses[narrow + 2], closing);
        bulge += weight * ellipses[wide + 3];{hole}{drift}
    }}
    // Vignetting makes the pupil larger between two stops than the interpolated one, but not its central obstruction.
    float growth = 1 + 4 * closing * (1 - closing) * bulge;
    hole /= growth;
    // The last factor is for stops smaller than those of the table.
    float size = growth * min(1, open / {last});
    half_l *= size;
    half_m *= size;
}}
"""
