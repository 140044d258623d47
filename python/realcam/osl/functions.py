"""The OSL functions that a shader of a lens is made of.

Rays go from the film to the scene, in mm. Directions are as long as the index of their medium, so that Snell's law
changes them along the normal alone, and all formulas scale with that length. `forwards` is -1 for light that goes
towards the scene and 1 between two mirrors.
"""

SPHERE = """\
// Takes a ray across a sphere or a plane, `gap` before the vertex it is given from. Returns whether it passes.
int cross_sphere(float gap, float curvature, float rim, float bend, float forwards,
                 output point at, output vector way)
{
    at[2] += gap;
    float squared = dot(way, way);
    float f = curvature * dot(at, at) - 2 * at[2];
    float g = way[2] - curvature * dot(at, way);
    float inside = g * g - curvature * squared * f;
    if (inside <= 0) return 0;
    float root = forwards * sqrt(inside);
    // Of the two forms of a quadratic equation's solution, the one in which nothing cancels.
    float path = g * forwards >= 0 ? f / (g + root) : (g - root) / (curvature * squared);
    at += path * way;
    vector facing = vector(-curvature * at[0], -curvature * at[1], 1 - curvature * at[2]);
    if (at[0] * at[0] + at[1] * at[1] > rim * rim || facing[2] <= 0) return 0;
    float along = g - curvature * squared * path;
    float refracted = along * along + bend * squared;
    if (refracted < 0) return 0;
    way += (forwards * sqrt(refracted) - along) * facing;
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
int cross_mirror(float gap, float curvature, float rim, float forwards,
                 output point at, output vector way)
{
    if (!cross_sphere(gap, curvature, rim, 0, forwards, at, way)) return 0;
    vector facing = vector(-curvature * at[0], -curvature * at[1], 1 - curvature * at[2]);
    way -= 2 * dot(way, facing) * facing;
    return 1;
}
"""

PLANE = """\
// Takes a ray to a plane that only blocks.
int cross_plane(float gap, float rim, output point at, output vector way)
{
    at[2] += gap;
    at -= at[2] / way[2] * way;
    return at[0] * at[0] + at[1] * at[1] <= rim * rim;
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

// Takes a ray to the diaphragm. Its blades are arcs at the apothem's distance, or straight; none is beyond the corners.
int cross_stop(float gap, float corner, float blades, float rounding, float rotation, float apothem,
               output point at, output vector way)
{
    if (!cross_plane(gap, corner, at, way)) return 0;
    if (blades < 3) return 1;
    float squared = at[0] * at[0] + at[1] * at[1];
    float width = 2 * M_PI / blades;
    float turned = mod(atan2(at[1], at[0]) - rotation + 0.5 * width, width) - 0.5 * width;
    float bow = rounding / apothem;
    return bow * (squared + apothem * apothem) + 2 * (1 - rounding) * sqrt(squared) * cos(turned) <= 2 * apothem;
}
"""

ASPHERE = """\
// The same of a conic with even terms from r^4 on, counted in shares of the rim.
int cross_asphere(float gap, float curvature, float conic, float terms[{terms}], float rim, float bend,
                  float forwards, output point at, output vector way)
{{
    at[2] += gap;
    at -= at[2] / way[2] * way;
    float slope = 0;
    float miss = 1;
    for (int step = 0; step < {steps} && abs(miss) > {tolerance} * rim; ++step) {{
        // Newton's method. Beyond the rim the surface goes on as a paraboloid of the same slope: no power runs away,
        // and there is no edge about which the steps could go to and fro.
        float share = (at[0] * at[0] + at[1] * at[1]) / (rim * rim);
        float near = min(share, 1);
        float squared = near * rim * rim;
        float root = sqrt(max(1e-3, 1 - conic * curvature * curvature * squared));
        float height = 0;
        float rise = 0;
        for (int power = {terms} - 1; power >= 0; --power) {{
            height = height * near + terms[power];
            rise = rise * near + (power + 2) * terms[power];
        }}
        slope = curvature / root + 2 * rise * near / (rim * rim);
        height = height * near * near + curvature * squared / (1 + root) + 0.5 * slope * (share - near) * rim * rim;
        miss = at[2] - height;
        float towards = way[2] - slope * (at[0] * way[0] + at[1] * way[1]);
        at -= miss / towards * way;
    }}
    if (abs(miss) > 1e-4 * rim || at[0] * at[0] + at[1] * at[1] > rim * rim) return 0;
    vector facing = normalize(vector(-slope * at[0], -slope * at[1], 1));
    float along = dot(way, facing);
    float refracted = along * along + bend * dot(way, way);
    if (refracted < 0 || along * forwards <= 0) return 0;
    way += (forwards * sqrt(refracted) - along) * facing;
    return 1;
}}
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
