"""Templates of the OSL functions that make up a lens shader.

Rays are traced from the film to the scene, in mm. Directions have the length of the refractive index of their medium
(optical directions), so that Snell's law changes them only along the normal; all formulas scale with that length.
`forwards` is the sign of the ray's z direction: -1 towards the scene, 1 between two mirrors.
"""

SPHERE = """\
// Takes a ray across a sphere or a plane, `gap` before the vertex it is given from. Returns whether it passes.
// `before` and `behind`: squares of the indices, as the light goes.
int cross_sphere(float gap, float curvature, float rim, float before, float behind, float forwards,
                 output point at, output vector way)
{
    at[2] += gap;
    float f = curvature * dot(at, at) - 2 * at[2];
    float g = way[2] - curvature * dot(at, way);
    // The squares of what is along the normal differ as those of the indices: both roots are there before the path.
    float inside = g * g - curvature * before * f;
    float refracted = inside + (behind - before);
    if (inside <= 0 || refracted < 0) return 0;
    float along = forwards * (curvature == 0 ? abs(g) : sqrt(inside));
    // Of the two forms of a quadratic equation's solution, the one in which nothing cancels.
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
// Whether a ray, on a surface, is outside of its hole.
int misses_hole(float hole, point at)
{
    return at[0] * at[0] + at[1] * at[1] >= hole * hole;
}
"""

MIRROR = """\
// The same of a mirror.
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
// Where a ray meets the plane z = 0.
point met(point at, vector way)
{
    return at - at[2] / way[2] * way;
}

// Whether a ray passes a plane that only blocks. The ray begins where it did before.
int pass_plane(float gap, float rim, output point at, vector way)
{
    at[2] += gap;
    point here = met(at, way);
    return here[0] * here[0] + here[1] * here[1] <= rim * rim;
}
"""

STOP = """\
// The area, over the apothem's square, of an opening of n arcs that touch the unit circle; the circle `rim` cuts it.
float opening_area(float blades, float rounding, float rim)
{
    float half = M_PI / blades;
    float cosine = cos(half);
    float linear = (1 - rounding) * cosine;
    float corner = (2 - rounding) / (linear + sqrt(linear * linear + rounding * (2 - rounding)));
    float edge = half;
    if (corner > rim) {
        // At this azimuth the arc meets the rim; the way there is the same equation, solved for the cosine.
        edge = rounding >= 1 ? half : acos(min(1, (2 - rounding - rounding * rim * rim) / (2 * (1 - rounding) * rim)));
        corner = rim;
    }
    // Sector of the arc's own circle, less the triangle between both middles and the corner.
    float piece = 0.5 * corner * cos(edge) * corner * sin(edge);
    if (rounding > 0) {
        float radius = 1 / rounding;
        float reach = corner * sin(edge);
        piece = 0.5 * radius * radius * asin(min(1, reach / radius)) - 0.5 * (radius - 1) * reach;
    }
    return 2 * blades * (piece + 0.5 * rim * rim * (half - edge));
}

// The apothem of a diaphragm that leaves as much open as a circle of this radius, inside of the rim.
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

// Whether a ray passes the diaphragm. Its blades are arcs at the apothem's distance, or straight; none is beyond the
// corners.
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
// Of surface {number} the height over its vertex in mm and its derivatives. t is -1 on the axis and 1 at the rim, and
// grows as the square of the distance from the axis.
void shape_{number}(float t, output float height, output float slope, output float bow)
{{
{powers}    height = {height};
    slope = {slope};
    bow = {bow};
}}

// The same as cross_sphere, by Newton's method from the plane z = {start} on.
int cross_surface_{number}(float gap, float before, float behind, float forwards, output point at, output vector way)
{{
    at[2] += gap;
    // Along the ray t is a quadratic polynomial of the path.
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
    // At the end of the last step the slope is another one.
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
    // With a polynomial of few terms.
    slope = {slope};
    path -= (at[2] + path * way[2] - ({height})) / (way[2] - 2 * slope * (b + path * a));
    next = start + path * (2 * b + path * a);
"""

STEP = """\
    // With the surface, which goes on beyond the rim with the slope in t that it has there.
    t = next;
    shape_{number}(min(t, 1), height, slope, bow);
    step = (at[2] + path * way[2] - height - slope * max(t - 1, 0)) / (way[2] - 2 * slope * (b + path * a));
    path -= step;
    next = start + path * (2 * b + path * a);
"""

PUPIL = """\
// The ellipse of directions in which light passes, of a film point on the x axis, in direction cosines.
// `share`: of the largest film radius. `open`: of the largest stop, to the blades' corners.
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
    // Rims make the pupil larger between two stops than their mean, but not what is blocked in its middle.
    float growth = 1 + 4 * closing * (1 - closing) * bulge;
    hole /= growth;
    // The last factor is for stops beyond the table.
    float size = growth * min(1, open / {last});
    half_l *= size;
    half_m *= size;
}}
"""
